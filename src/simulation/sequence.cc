#include "simulation/sequence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {
namespace {

using product::Mate;
using product::MateKind;
using product::OccurrenceId;
using product::Product;

constexpr double kDepthTolerance = 50e-6;  // [m]; drawn surfaces may touch this deep
constexpr double kParallel = 1e-3;         // sine or cosine that counts as zero

struct MateView {
  const Mate* mate;
  OccurrenceId other;
  Vec3 axis_W;  // axis, or outward normal of this part's face
  bool is_a;
};

/** What stands in the way of a part along a direction. */
struct Blocker {
  OccurrenceId occurrence;
  double travelled{0};  // [m] before it was met
};

class Planner {
 public:
  explicit Planner(const SequenceInput& input)
      : input_(input), product_(*input.product), is_present_(product_.occurrences.size(), true) {
    mates_of_.resize(product_.occurrences.size());
    for (const Mate& mate : product_.mates) {
      const product::Pose& X_WA = product_.occurrences[mate.a.occurrence.index()].X_WB;
      const product::Pose& X_WB = product_.occurrences[mate.b.occurrence.index()].X_WB;
      const Vec3 axis_a = (X_WA * mate.a.X_BM).q() * Vec3::UnitZ();
      const Vec3 axis_b = (X_WB * mate.b.X_BM).q() * Vec3::UnitZ();
      mates_of_[mate.a.occurrence.index()].push_back({&mate, mate.b.occurrence, axis_a, true});
      mates_of_[mate.b.occurrence.index()].push_back({&mate, mate.a.occurrence, axis_b, false});
    }
    for (const product::Occurrence& occurrence : product_.occurrences) {
      boxes_.push_back(spatial::Transform(occurrence.X_WB, product_.part_of(occurrence.id).box_B));
    }
  }

  Sequence Plan();

 private:
  void FindOverlaps();
  [[nodiscard]] std::vector<contact::IgnoredPair> CollectIgnored(OccurrenceId id) const;
  [[nodiscard]] std::vector<Vec3> CandidateDirections(OccurrenceId id) const;
  [[nodiscard]] bool MatesAllow(OccurrenceId id, const Vec3& direction) const;
  [[nodiscard]] std::optional<Blocker> FindBlocker(OccurrenceId id, const Vec3& direction);
  [[nodiscard]] double ExitDistance(OccurrenceId id, const Vec3& direction) const;
  [[nodiscard]] double EngageDistance(OccurrenceId id, const Vec3& direction) const;
  [[nodiscard]] std::string Describe(OccurrenceId id) const;
  bool TryRemove(OccurrenceId id, std::vector<SequenceStep>* removed);
  void Remove(OccurrenceId id);

  struct Attempt {
    Vec3 direction;
    std::optional<Blocker> blocker;  // none: the mates forbid it
  };

  const SequenceInput& input_;
  const Product& product_;
  std::vector<bool> is_present_;
  std::vector<std::vector<MateView>> mates_of_;
  std::vector<spatial::Box> boxes_;
  std::vector<DrawnOverlap> overlaps_;
  std::vector<std::vector<contact::BodyId>> overlapped_;  // by occurrence
  std::vector<std::vector<Attempt>> attempts_;            // of the last try, by occurrence
  std::vector<std::ptrdiff_t> mates_at_attempt_;
  contact::QueryWorkspace workspace_;
};

std::vector<Vec3> Planner::CandidateDirections(OccurrenceId id) const {
  std::vector<Vec3> directions;
  const auto add = [&directions](const Vec3& d) {
    for (const Vec3& known : directions) {
      if (known.dot(d) > 1 - kParallel * kParallel) {
        return;
      }
    }
    directions.push_back(d);
  };
  for (const MateView& view : mates_of_[id.index()]) {
    if (!is_present_[view.other.index()]) {
      continue;
    }
    if (view.mate->kind == MateKind::kAxisHole) {
      add(view.axis_W);
      add(-view.axis_W);
    } else {
      add(-view.axis_W);  // away from the partner's face
    }
  }
  for (const Vec3& d : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0),
                        Vec3(0, 0, -1)}) {
    add(d);
  }
  // From above is how people assemble: try the upward ways out first.
  std::stable_sort(directions.begin(), directions.end(),
                   [](const Vec3& x, const Vec3& y) { return x.z() > y.z() + 1e-9; });
  return directions;
}

bool Planner::MatesAllow(OccurrenceId id, const Vec3& direction) const {
  for (const MateView& view : mates_of_[id.index()]) {
    if (!is_present_[view.other.index()]) {
      continue;
    }
    const double along = view.axis_W.dot(direction);
    if (view.mate->kind == MateKind::kAxisHole) {
      if (std::abs(along) < 1 - kParallel) {
        return false;
      }
    } else if (along > kParallel) {
      return false;  // the outward normal points into the partner
    }
  }
  return true;
}

double Planner::ExitDistance(OccurrenceId id, const Vec3& direction) const {
  const spatial::Box& box = boxes_[id.index()];
  double farthest = 0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (i == id.index() || !is_present_[i]) {
      continue;
    }
    // Distance after which the boxes are apart for good: the earliest over the three axes.
    double apart = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double d = direction[k];
      if (std::abs(d) < 1e-9) {
        const bool overlaps = boxes_[i].low[k] < box.high[k] && box.low[k] < boxes_[i].high[k];
        apart = overlaps ? apart : 0.0;
        continue;
      }
      const double gap = d > 0 ? boxes_[i].high[k] - box.low[k] : box.high[k] - boxes_[i].low[k];
      apart = std::min(apart, std::max(0.0, gap / std::abs(d)));
    }
    farthest = std::max(farthest, std::isfinite(apart) ? apart : 0.0);
  }
  return farthest;
}

double Planner::EngageDistance(OccurrenceId id, const Vec3& direction) const {
  double farthest = 0;
  bool has_axis = false;
  for (const MateView& view : mates_of_[id.index()]) {
    const Mate& mate = *view.mate;
    if (!is_present_[view.other.index()] || mate.kind != MateKind::kAxisHole) {
      continue;
    }
    has_axis = true;
    const bool is_shaft = !view.is_a;
    const double sense = view.axis_W.dot(direction) * (is_shaft ? 1.0 : -1.0);
    const double travel =
        sense > 0 ? mate.hole_high - mate.shaft_low : mate.shaft_high - mate.hole_low;
    farthest = std::max(farthest, travel);
  }
  return has_axis ? farthest : std::min(ExitDistance(id, direction), 20e-3);
}

std::string Planner::Describe(OccurrenceId id) const {
  return id.is_valid() ? product_.occurrences[id.index()].path : std::string("the table");
}

std::vector<contact::IgnoredPair> Planner::CollectIgnored(OccurrenceId id) const {
  std::vector<contact::IgnoredPair> ignored;
  for (const MateView& view : mates_of_[id.index()]) {
    if (!is_present_[view.other.index()] || view.mate->kind != MateKind::kAxisHole) {
      continue;
    }
    const auto& own = (view.is_a ? input_.faces_a : input_.faces_b)[view.mate->id.index()];
    const auto& other = (view.is_a ? input_.faces_b : input_.faces_a)[view.mate->id.index()];
    const contact::BodyId body(view.other.index());
    ignored.push_back({body, own->mating, other->with_neighbours});
    ignored.push_back({body, own->with_neighbours, other->mating});
  }
  return ignored;
}

void Planner::FindOverlaps() {
  overlapped_.resize(product_.occurrences.size());
  for (const product::Occurrence& occurrence : product_.occurrences) {
    const contact::BodyId self(occurrence.id.index());
    const std::vector<contact::IgnoredPair> ignored = CollectIgnored(occurrence.id);
    contact::QueryOptions query;
    query.margin = -kDepthTolerance;
    query.ignored = ignored;
    query.self = self;
    std::vector<contact::BodyId>& left_out = overlapped_[self.index()];
    // A query reports a limited number of contacts: ask again without those found until none is
    // left.
    for (bool is_clear = false; !is_clear;) {
      query.left_out = left_out;
      input_.scene->Query(input_.scene->shape(self), occurrence.X_WB, query, &workspace_);
      std::map<contact::BodyId, double> depths;
      for (const contact::Contact& contact : workspace_.contacts()) {
        if (contact.body.is_valid() && contact.distance < -kDepthTolerance) {
          double& depth = depths[contact.body];
          depth = std::max(depth, -contact.distance);
        }
      }
      is_clear = depths.empty();
      for (const auto& [body, depth] : depths) {
        left_out.push_back(body);
        const auto& mirrored = overlapped_[body.index()];
        if (std::find(mirrored.begin(), mirrored.end(), self) == mirrored.end()) {
          overlapped_[body.index()].push_back(self);
          overlaps_.push_back({occurrence.id, OccurrenceId(body.index()), depth});
        }
      }
    }
  }
}

std::optional<Blocker> Planner::FindBlocker(OccurrenceId id, const Vec3& direction) {
  const std::vector<contact::IgnoredPair> ignored = CollectIgnored(id);
  contact::QueryOptions query;
  query.margin = -kDepthTolerance;
  query.ignored = ignored;
  query.left_out = overlapped_[id.index()];
  query.self = contact::BodyId(id.index());
  const contact::Shape& shape = input_.scene->shape(query.self);
  const product::Pose& X_WB = product_.occurrences[id.index()].X_WB;
  const double exit = ExitDistance(id, direction);
  const double step = std::clamp(0.01 * shape.box_B().size().norm(), 0.25e-3, 2e-3);
  for (double s = 0; s <= exit; s += step) {
    const spatial::Pose X(X_WB.q(), X_WB.p() + s * direction);
    if (!input_.scene->IsFree(shape, X, kDepthTolerance, query, &workspace_)) {
      const auto contacts = workspace_.contacts();
      const OccurrenceId other =
          contacts.empty() ? OccurrenceId() : OccurrenceId(contacts[0].body.index());
      return Blocker{other, s};
    }
  }
  return std::nullopt;
}

void Planner::Remove(OccurrenceId id) {
  is_present_[id.index()] = false;
  input_.scene->SetEnabled(contact::BodyId(id.index()), false);
}

bool Planner::TryRemove(OccurrenceId id, std::vector<SequenceStep>* removed) {
  std::vector<Attempt>& attempts = attempts_[id.index()];
  const auto present =
      std::count_if(mates_of_[id.index()].begin(), mates_of_[id.index()].end(),
                    [this](const MateView& view) { return is_present_[view.other.index()]; });
  if (!attempts.empty() && present == mates_at_attempt_[id.index()]) {
    // Nothing has changed for this part while its mates and all that blocked it are still there.
    const bool is_unchanged =
        std::all_of(attempts.begin(), attempts.end(), [this](const Attempt& a) {
          return a.blocker && a.blocker->occurrence.is_valid() &&
                 is_present_[a.blocker->occurrence.index()];
        });
    if (is_unchanged) {
      return false;
    }
  }
  mates_at_attempt_[id.index()] = present;
  std::vector<Attempt> tried;
  bool mates_forbid_all = true;
  for (const Vec3& direction : CandidateDirections(id)) {
    if (!MatesAllow(id, direction)) {
      continue;
    }
    mates_forbid_all = false;
    const auto known = std::find_if(attempts.begin(), attempts.end(), [&](const Attempt& a) {
      return a.blocker && a.direction == direction && a.blocker->occurrence.is_valid() &&
             is_present_[a.blocker->occurrence.index()];
    });
    if (known != attempts.end()) {
      tried.push_back(*known);
      continue;
    }
    const std::optional<Blocker> blocker = FindBlocker(id, direction);
    if (!blocker) {
      removed->push_back({id, direction, EngageDistance(id, direction), false});
      Remove(id);
      return true;
    }
    tried.push_back({direction, blocker});
  }
  if (mates_forbid_all) {
    tried.push_back({Vec3::Zero(), std::nullopt});
  }
  attempts = std::move(tried);
  return false;
}

Sequence Planner::Plan() {
  std::vector<OccurrenceId> rest;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    rest.push_back(occurrence.id);
  }
  const auto size = [this](OccurrenceId id) {
    const product::Part& part = product_.part_of(id);
    return part.mass.volume > 0 ? part.mass.volume : part.box_B.size().prod();
  };
  // Small parts come off first (they go in last); the largest is the base and stays.
  std::stable_sort(rest.begin(), rest.end(),
                   [&](OccurrenceId x, OccurrenceId y) { return size(x) < size(y); });
  const std::size_t total = rest.size();
  attempts_.resize(product_.occurrences.size());
  mates_at_attempt_.resize(product_.occurrences.size(), -1);
  std::vector<SequenceStep> removed;
  FindOverlaps();
  Sequence sequence;
  sequence.overlaps = overlaps_;
  while (rest.size() > 1) {
    std::vector<OccurrenceId> blocked;
    const OccurrenceId base = rest.back();
    rest.pop_back();
    for (const OccurrenceId id : rest) {
      if (!TryRemove(id, &removed)) {
        blocked.push_back(id);
      }
      if (input_.progress) {
        input_.progress(static_cast<double>(removed.size() + sequence.gaps.size()) /
                        static_cast<double>(total));
      }
    }
    const bool is_stuck = blocked.size() == rest.size();
    rest = std::move(blocked);
    rest.push_back(base);
    if (is_stuck && rest.size() > 1) {
      const OccurrenceId id = rest.front();
      std::string reason = "its mates leave no straight way out";
      const auto& attempts = attempts_[id.index()];
      const auto farthest = std::max_element(attempts.begin(), attempts.end(),
                                             [](const Attempt& a, const Attempt& b) {
                                               return (a.blocker ? a.blocker->travelled : -1) <
                                                      (b.blocker ? b.blocker->travelled : -1);
                                             });
      if (farthest != attempts.end() && farthest->blocker) {
        const Blocker& blocker = *farthest->blocker;
        reason = fmt::format("no free path: meets {} after {:.1f} mm along its best way out",
                             Describe(blocker.occurrence), units::ToMm(blocker.travelled));
      }
      sequence.gaps.push_back({id, reason});
      Remove(id);
      rest.erase(rest.begin());
    }
  }
  sequence.steps.push_back({rest.front(), Vec3::UnitZ(), 0, true});
  sequence.steps.insert(sequence.steps.end(), removed.rbegin(), removed.rend());
  return sequence;
}

}  // namespace

Sequence PlanSequence(const SequenceInput& input) {
  return Planner(input).Plan();
}

Result<Sequence> Reorder(const product::Product& product, const Sequence& sequence,
                         const std::vector<std::string>& names) {
  Sequence result;
  result.gaps = sequence.gaps;
  result.overlaps = sequence.overlaps;
  std::vector<SequenceStep> rest = sequence.steps;
  for (const std::string& name : names) {
    const auto found = std::find_if(rest.begin(), rest.end(), [&](const SequenceStep& step) {
      const product::Occurrence& occurrence = product.occurrences[step.occurrence.index()];
      return occurrence.path == name || occurrence.name == name ||
             fmt::format("o{}", step.occurrence.value()) == name;
    });
    if (found == rest.end()) {
      return Fail(ErrorCode::kNotFound, fmt::format("no part left to order is called '{}'", name),
                  product.source, "hvas inspect lists names and ids");
    }
    result.steps.push_back(*found);
    rest.erase(found);
  }
  result.steps.insert(result.steps.end(), rest.begin(), rest.end());
  return result;
}

}  // namespace hvas::simulation
