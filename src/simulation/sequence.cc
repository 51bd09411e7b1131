#include "simulation/sequence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {
namespace {

using product::Mate;
using product::MateKind;
using product::OccurrenceId;
using product::Product;

constexpr double kDepthTolerance = 50e-6;  // [m]; drawn surfaces may touch this deep
constexpr double kShortestStep = 0.25e-3;  // [m] between looks along a way
constexpr double kLongestStep = 2e-3;      // [m]; longer ones could pass through a thin wall.
constexpr double kParallel = 1e-3;         // sine or cosine that counts as zero

struct MateView {
  const Mate* mate;
  OccurrenceId other;
  Vec3 axis_W;  // axis, or outward normal of this part's face
  bool is_a;
  double cos_half_angle;  // of a conical seat
};

/** What stands in the way of a part along a direction. */
struct Blocker {
  OccurrenceId occurrence;
  double travelled{0};  // [m] before it was met
};

/** Parts that move as one: a single part, or what is there of a subassembly. The first leads. */
using Unit = std::vector<OccurrenceId>;

class Planner {
 public:
  explicit Planner(const SequenceInput& input);

  Sequence Plan();

 private:
  struct Attempt {
    Vec3 direction;
    std::optional<Blocker> blocker;  // none: the mates forbid it
  };

  /** What was tried last, so that it is tried again only when something has changed. */
  struct Memory {
    std::vector<Attempt> attempts;
    std::ptrdiff_t mates_around{-1};
  };

  void FindOverlaps();

  [[nodiscard]] bool IsAround(OccurrenceId id) const {
    return is_present_[id.index()] && !is_in_unit_[id.index()];
  }

  void SetUnit(const Unit& unit, bool is_in_unit) {
    for (const OccurrenceId id : unit) {
      is_in_unit_[id.index()] = is_in_unit;
    }
  }

  [[nodiscard]] double SizeOf(OccurrenceId id) const;
  [[nodiscard]] std::string Describe(OccurrenceId id) const;
  [[nodiscard]] std::vector<contact::IgnoredPair> CollectIgnored(OccurrenceId id) const;
  [[nodiscard]] std::vector<Vec3> CandidateDirections(const Unit& unit) const;
  [[nodiscard]] bool MatesAllow(const Unit& unit, const Vec3& direction) const;
  [[nodiscard]] double ExitDistance(const Unit& unit, const Vec3& direction) const;
  [[nodiscard]] double EngageDistance(const Unit& unit, const Vec3& direction) const;
  [[nodiscard]] std::optional<Blocker> FindBlocker(const Unit& unit, const Vec3& direction);
  [[nodiscard]] std::optional<SequenceStep> TryRemove(const Unit& unit, Memory* memory);
  void SetPresent(const Unit& unit, bool is_present);
  [[nodiscard]] std::string ExplainStuck(OccurrenceId id) const;
  /** Where a shaft of one part would have to pass a smaller hole of the other: says so, with both
   diameters. Else empty. */
  [[nodiscard]] std::string ExplainTooWide(OccurrenceId id, OccurrenceId other,
                                           const Vec3& direction) const;

  /** Takes apart the parts given, with nothing else there; appends the steps that put them
   together, those of subassemblies first. */
  void PlanLevel(Unit parts, Sequence* sequence);
  /** Finds a subassembly that comes out of `rest` as one body, and plans it. */
  [[nodiscard]] bool TakeOutSubassembly(Unit* rest, std::vector<SequenceStep>* removed,
                                        Sequence* sequence);
  [[nodiscard]] Unit PresentBelow(product::SubassemblyId id) const;

  const SequenceInput& input_;
  const Product& product_;
  std::vector<bool> is_present_;
  std::vector<bool> is_in_unit_;
  std::vector<std::vector<MateView>> mates_of_;
  std::vector<spatial::Box> boxes_;
  std::vector<DrawnOverlap> overlaps_;
  std::vector<std::vector<contact::BodyId>> overlapped_;  // by occurrence
  std::vector<Memory> memories_;                          // by occurrence, of the present level
  contact::QueryWorkspace workspace_;
  std::size_t planned_{0};
};

Planner::Planner(const SequenceInput& input)
    : input_(input),
      product_(*input.product),
      is_present_(product_.occurrences.size(), true),
      is_in_unit_(product_.occurrences.size(), false),
      mates_of_(product_.occurrences.size()),
      memories_(product_.occurrences.size()) {
  for (const Mate& mate : product_.mates) {
    const product::Pose& X_WA = product_.occurrences[mate.a.occurrence.index()].X_WB;
    const product::Pose& X_WB = product_.occurrences[mate.b.occurrence.index()].X_WB;
    const Vec3 axis_a = (X_WA * mate.a.X_BM).q() * Vec3::UnitZ();
    const Vec3 axis_b = (X_WB * mate.b.X_BM).q() * Vec3::UnitZ();
    const product::Part& part = product_.part_of(mate.a.occurrence);
    const double cosine = mate.kind == MateKind::kConeSeat
                              ? std::cos(part.features[mate.a.feature.index()].half_angle)
                              : 1.0;
    mates_of_[mate.a.occurrence.index()].push_back(
        {&mate, mate.b.occurrence, axis_a, true, cosine});
    mates_of_[mate.b.occurrence.index()].push_back(
        {&mate, mate.a.occurrence, axis_b, false, cosine});
  }
  for (const product::Occurrence& occurrence : product_.occurrences) {
    boxes_.push_back(spatial::Transform(occurrence.X_WB, product_.part_of(occurrence.id).box_B));
  }
}

double Planner::SizeOf(OccurrenceId id) const {
  const product::Part& part = product_.part_of(id);
  return part.mass.volume > 0 ? part.mass.volume : part.box_B.size().prod();
}

std::string Planner::Describe(OccurrenceId id) const {
  return id.is_valid() ? product_.occurrences[id.index()].path : std::string("the table");
}

std::vector<Vec3> Planner::CandidateDirections(const Unit& unit) const {
  std::vector<Vec3> directions;
  const auto add = [&directions](const Vec3& d) {
    for (const Vec3& known : directions) {
      if (known.dot(d) > 1 - kParallel * kParallel) {
        return;
      }
    }
    directions.push_back(d);
  };
  for (const OccurrenceId id : unit) {
    for (const MateView& view : mates_of_[id.index()]) {
      if (!IsAround(view.other)) {
        continue;
      }
      switch (view.mate->kind) {
        case MateKind::kAxisHole:
          add(view.axis_W);
          add(-view.axis_W);
          break;
        case MateKind::kFaceFace:
          add(-view.axis_W);  // away from the partner's face
          break;
        case MateKind::kConeSeat:
        case MateKind::kSphereSeat:
          add(view.is_a ? Vec3(-view.axis_W) : view.axis_W);  // z points out of the seat
          break;
      }
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

bool Planner::MatesAllow(const Unit& unit, const Vec3& direction) const {
  for (const OccurrenceId id : unit) {
    for (const MateView& view : mates_of_[id.index()]) {
      if (!IsAround(view.other)) {
        continue;
      }
      const double along = view.axis_W.dot(direction);
      switch (view.mate->kind) {
        case MateKind::kAxisHole:
          if (std::abs(along) < 1 - kParallel) {
            return false;
          }
          break;
        case MateKind::kFaceFace:
          if (along > kParallel) {
            return false;  // the outward normal points into the partner
          }
          break;
        case MateKind::kConeSeat:
          // Up to the half angle from the axis; steeper ways run into the other side of the seat.
          if ((view.is_a ? -along : along) < view.cos_half_angle - kParallel) {
            return false;
          }
          break;
        case MateKind::kSphereSeat:
          break;  // how far the socket reaches around the ball is left to contact
      }
    }
  }
  return true;
}

double Planner::ExitDistance(const Unit& unit, const Vec3& direction) const {
  spatial::Box box;
  for (const OccurrenceId id : unit) {
    box.Add(boxes_[id.index()]);
  }
  double farthest = 0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!IsAround(OccurrenceId(i))) {
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

double Planner::EngageDistance(const Unit& unit, const Vec3& direction) const {
  double farthest = 0;
  bool has_axis = false;
  for (const OccurrenceId id : unit) {
    for (const MateView& view : mates_of_[id.index()]) {
      const Mate& mate = *view.mate;
      if (!IsAround(view.other) || mate.kind != MateKind::kAxisHole) {
        continue;
      }
      has_axis = true;
      const bool is_shaft = !view.is_a;
      const double sense = view.axis_W.dot(direction) * (is_shaft ? 1.0 : -1.0);
      const double travel =
          sense > 0 ? mate.hole_high - mate.shaft_low : mate.shaft_high - mate.hole_low;
      farthest = std::max(farthest, travel);
    }
  }
  return has_axis ? farthest : std::min(ExitDistance(unit, direction), 20e-3);
}

std::vector<contact::IgnoredPair> Planner::CollectIgnored(OccurrenceId id) const {
  std::vector<contact::IgnoredPair> ignored;
  for (const MateView& view : mates_of_[id.index()]) {
    if (!IsAround(view.other) || view.mate->kind != MateKind::kAxisHole) {
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
      query.left_out[0] = left_out;
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

std::optional<Blocker> Planner::FindBlocker(const Unit& unit, const Vec3& direction) {
  struct Member {
    OccurrenceId id;
    std::vector<contact::IgnoredPair> ignored;
    std::vector<contact::BodyId> left_out;
  };

  std::vector<Member> members;
  double step = kLongestStep;
  for (const OccurrenceId id : unit) {
    Member member{id, CollectIgnored(id), overlapped_[id.index()]};
    for (const OccurrenceId other : unit) {
      member.left_out.emplace_back(other.index());
    }
    members.push_back(std::move(member));
    const contact::Shape& shape = input_.scene->shape(contact::BodyId(id.index()));
    step = std::min(step, std::max(kShortestStep, 0.01 * shape.box_B().size().norm()));
  }
  const double exit = ExitDistance(unit, direction);
  const int last = static_cast<int>(exit / step);
  for (int i = 0; i <= last; ++i) {
    const double s = i * step;
    for (const Member& member : members) {
      contact::QueryOptions query;
      query.margin = -kDepthTolerance;
      query.ignored = member.ignored;
      query.left_out[0] = member.left_out;
      query.self = contact::BodyId(member.id.index());
      const product::Pose& X_WB = product_.occurrences[member.id.index()].X_WB;
      const spatial::Pose X(X_WB.q(), X_WB.p() + s * direction);
      if (!input_.scene->IsFree(input_.scene->shape(query.self), X, kDepthTolerance, query,
                                &workspace_)) {
        const auto contacts = workspace_.contacts();
        return Blocker{contacts.empty() ? OccurrenceId() : OccurrenceId(contacts[0].body.index()),
                       s};
      }
    }
  }
  return std::nullopt;
}

void Planner::SetPresent(const Unit& unit, bool is_present) {
  for (const OccurrenceId id : unit) {
    is_present_[id.index()] = is_present;
    input_.scene->SetEnabled(contact::BodyId(id.index()), is_present);
  }
}

std::optional<SequenceStep> Planner::TryRemove(const Unit& unit, Memory* memory) {
  SetUnit(unit, true);
  std::ptrdiff_t mates_around = 0;
  for (const OccurrenceId id : unit) {
    mates_around += std::count_if(mates_of_[id.index()].begin(), mates_of_[id.index()].end(),
                                  [this](const MateView& view) { return IsAround(view.other); });
  }
  const auto still_blocked = [this](const Attempt& attempt) {
    return attempt.blocker && attempt.blocker->occurrence.is_valid() &&
           IsAround(attempt.blocker->occurrence);
  };
  std::optional<SequenceStep> step;
  const bool is_unchanged =
      !memory->attempts.empty() && mates_around == memory->mates_around &&
      std::all_of(memory->attempts.begin(), memory->attempts.end(), still_blocked);
  if (!is_unchanged) {
    std::vector<Attempt> tried;
    for (const Vec3& direction : CandidateDirections(unit)) {
      if (!MatesAllow(unit, direction)) {
        continue;
      }
      const auto known = std::find_if(
          memory->attempts.begin(), memory->attempts.end(),
          [&](const Attempt& a) { return a.direction == direction && still_blocked(a); });
      if (known != memory->attempts.end()) {
        tried.push_back(*known);
        continue;
      }
      const std::optional<Blocker> blocker = FindBlocker(unit, direction);
      if (!blocker) {
        step.emplace();
        step->occurrence = unit.front();
        step->members.assign(unit.begin() + 1, unit.end());
        step->extraction_W = direction;
        step->engage_distance = EngageDistance(unit, direction);
        break;
      }
      tried.push_back({direction, blocker});
    }
    if (tried.empty()) {
      tried.push_back({Vec3::Zero(), std::nullopt});
    }
    *memory = {std::move(tried), mates_around};
  }
  SetUnit(unit, false);
  if (step) {
    SetPresent(unit, false);
  }
  return step;
}

std::string Planner::ExplainTooWide(OccurrenceId id, OccurrenceId other,
                                    const Vec3& direction) const {
  constexpr double kCollinear = 20e-6;  // [m] between axes that count as one
  if (!other.is_valid()) {
    return {};
  }
  const product::Pose& X_WB = product_.occurrences[id.index()].X_WB;
  const product::Pose& X_WO = product_.occurrences[other.index()].X_WB;
  std::string text;
  double least = 0;  // The narrowest place tells it best.
  for (const product::Feature& own : product_.part_of(id).features) {
    const Vec3 axis_W = X_WB.q() * own.axis_B;
    if (std::abs(axis_W.dot(direction)) < 1 - kParallel) {
      continue;
    }
    for (const product::Feature& its : product_.part_of(other).features) {
      const bool is_pair =
          (own.kind == product::FeatureKind::kShaft && its.kind == product::FeatureKind::kHole) ||
          (own.kind == product::FeatureKind::kHole && its.kind == product::FeatureKind::kShaft);
      const Vec3 between = X_WO * its.origin_B - X_WB * own.origin_B;
      const bool is_own_shaft = own.kind == product::FeatureKind::kShaft;
      const double excess = is_own_shaft ? own.radius - its.radius : its.radius - own.radius;
      if (!is_pair || excess < kDepthTolerance - 1e-9 ||
          between.cross(axis_W).norm() > kCollinear ||
          std::abs((X_WO.q() * its.axis_B).dot(axis_W)) < 1 - kParallel ||
          (least > 0 && excess > least)) {
        continue;
      }
      least = excess;
      const double own_mm = units::ToMm(2 * own.radius);
      const double its_mm = units::ToMm(2 * its.radius);
      text = is_own_shaft
                 ? fmt::format("its diameter of {:.3f} mm does not pass the hole of {:.3f} mm",
                               own_mm, its_mm)
                 : fmt::format("its hole of {:.3f} mm does not pass the diameter of {:.3f} mm",
                               own_mm, its_mm);
    }
  }
  return text;
}

std::string Planner::ExplainStuck(OccurrenceId id) const {
  const Attempt* farthest = nullptr;
  for (const Attempt& attempt : memories_[id.index()].attempts) {
    if (attempt.blocker &&
        (farthest == nullptr || attempt.blocker->travelled > farthest->blocker->travelled)) {
      farthest = &attempt;
    }
  }
  if (farthest != nullptr) {
    const Blocker& blocker = *farthest->blocker;
    const std::string why = ExplainTooWide(id, blocker.occurrence, farthest->direction);
    return fmt::format("no free path: meets {} after {:.1f} mm along its best way out{}{}",
                       Describe(blocker.occurrence), units::ToMm(blocker.travelled),
                       why.empty() ? "" : ", as drawn: ", why);
  }
  std::set<OccurrenceId> partners;
  for (const MateView& view : mates_of_[id.index()]) {
    if (is_present_[view.other.index()]) {
      partners.insert(view.other);
    }
  }
  std::string names;
  for (const OccurrenceId partner : partners) {
    names += (names.empty() ? "" : " and ") + Describe(partner);
  }
  return fmt::format("its mates with {} leave no straight way out", names);
}

Unit Planner::PresentBelow(product::SubassemblyId id) const {
  Unit unit;
  const product::Subassembly& node = product_.subassemblies[id.index()];
  for (const OccurrenceId occurrence : node.occurrences) {
    if (is_present_[occurrence.index()]) {
      unit.push_back(occurrence);
    }
  }
  for (const product::SubassemblyId child : node.subassemblies) {
    const Unit below = PresentBelow(child);
    unit.insert(unit.end(), below.begin(), below.end());
  }
  return unit;
}

bool Planner::TakeOutSubassembly(Unit* rest, std::vector<SequenceStep>* removed,
                                 Sequence* sequence) {
  for (const product::Subassembly& node : product_.subassemblies) {
    Unit unit = PresentBelow(node.id);
    const bool has_base = std::find(unit.begin(), unit.end(), rest->back()) != unit.end();
    if (unit.size() < 2 || unit.size() >= rest->size() || has_base) {
      continue;
    }
    std::stable_sort(unit.begin(), unit.end(),
                     [this](OccurrenceId x, OccurrenceId y) { return SizeOf(x) > SizeOf(y); });
    Memory memory;
    std::optional<SequenceStep> step = TryRemove(unit, &memory);
    if (!step) {
      continue;
    }
    rest->erase(std::remove_if(rest->begin(), rest->end(),
                               [&unit](OccurrenceId id) {
                                 return std::find(unit.begin(), unit.end(), id) != unit.end();
                               }),
                rest->end());
    // Put together by itself, with nothing else there, then set aside until its turn.
    const Unit others = *rest;
    SetPresent(others, false);
    SetPresent(unit, true);
    const std::size_t first = sequence->steps.size();
    PlanLevel(unit, sequence);
    SetPresent(unit, false);
    SetPresent(others, true);
    // Only what went into it moves with it, led by its base: the last one that was put in a
    // fixture.
    std::set<OccurrenceId> members;
    for (std::size_t i = first; i < sequence->steps.size(); ++i) {
      members.insert(sequence->steps[i].occurrence);
      if (sequence->steps[i].kind == SequenceStep::Kind::kBase) {
        step->occurrence = sequence->steps[i].occurrence;
      }
    }
    members.erase(step->occurrence);
    step->members.assign(members.begin(), members.end());
    SequenceStep park = *step;
    park.kind = SequenceStep::Kind::kPark;
    park.extraction_W = Vec3::UnitY();
    park.engage_distance = 0;
    sequence->steps.push_back(std::move(park));
    removed->push_back(std::move(*step));
    return true;
  }
  return false;
}

void Planner::PlanLevel(Unit rest, Sequence* sequence) {
  // Small parts come off first (they go in last); the largest is the base and stays.
  std::stable_sort(rest.begin(), rest.end(),
                   [this](OccurrenceId x, OccurrenceId y) { return SizeOf(x) < SizeOf(y); });
  for (const OccurrenceId id : rest) {
    memories_[id.index()] = {};
  }
  std::vector<SequenceStep> removed;
  while (rest.size() > 1) {
    // Always the smallest that can go: what lies on a part goes before the part.
    std::optional<SequenceStep> step;
    for (std::size_t i = 0; i + 1 < rest.size() && !step; ++i) {
      step = TryRemove({rest[i]}, &memories_[rest[i].index()]);
    }
    if (step) {
      rest.erase(std::find(rest.begin(), rest.end(), step->occurrence));
      removed.push_back(std::move(*step));
    } else if (!TakeOutSubassembly(&rest, &removed, sequence)) {
      const OccurrenceId id = rest.front();
      sequence->gaps.push_back({id, ExplainStuck(id)});
      SetPresent({id}, false);
      rest.erase(rest.begin());
    }
    if (input_.progress) {
      input_.progress(static_cast<double>(++planned_) /
                      static_cast<double>(product_.occurrences.size()));
    }
  }
  SequenceStep base;
  base.kind = SequenceStep::Kind::kBase;
  base.occurrence = rest.front();
  sequence->steps.push_back(base);
  sequence->steps.insert(sequence->steps.end(), removed.rbegin(), removed.rend());
}

Sequence Planner::Plan() {
  FindOverlaps();
  Sequence sequence;
  sequence.overlaps = overlaps_;
  Unit all;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    all.push_back(occurrence.id);
  }
  PlanLevel(std::move(all), &sequence);
  return sequence;
}

}  // namespace

Sequence PlanSequence(const SequenceInput& input) {
  return Planner(input).Plan();
}

const SequenceStep* FindInsertion(const Sequence& sequence, OccurrenceId id) {
  const auto found =
      std::find_if(sequence.steps.begin(), sequence.steps.end(), [id](const SequenceStep& step) {
        return step.occurrence == id && step.kind == SequenceStep::Kind::kInsert;
      });
  return found == sequence.steps.end() ? nullptr : &*found;
}

Result<Sequence> Reorder(const product::Product& product, const Sequence& sequence,
                         const std::vector<std::string>& names) {
  Sequence result;
  result.gaps = sequence.gaps;
  result.overlaps = sequence.overlaps;
  // Subassemblies are put together before the product's base is in the fixture; they stay there.
  const auto last_park =
      std::find_if(sequence.steps.rbegin(), sequence.steps.rend(),
                   [](const SequenceStep& step) { return step.kind == SequenceStep::Kind::kPark; });
  result.steps.assign(sequence.steps.begin(), last_park.base());
  std::vector<SequenceStep> rest(last_park.base(), sequence.steps.end());
  result.steps.push_back(rest.front());  // The base stays first, named or not.
  for (const std::string& name : names) {
    const auto found = std::find_if(rest.begin(), rest.end(), [&](const SequenceStep& step) {
      const product::Occurrence& occurrence = product.occurrences[step.occurrence.index()];
      return occurrence.path == name || occurrence.name == name ||
             fmt::format("o{}", step.occurrence.value()) == name;
    });
    if (found == rest.begin()) {
      continue;
    }
    if (found == rest.end()) {
      return Fail(ErrorCode::kNotFound, fmt::format("no part left to order is called '{}'", name),
                  product.source, "hvas inspect lists names and ids");
    }
    result.steps.push_back(*found);
    rest.erase(found);
  }
  result.steps.insert(result.steps.end(), rest.begin() + 1, rest.end());
  return result;
}

}  // namespace hvas::simulation
