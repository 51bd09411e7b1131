#include "mates/place_by_mates.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "mates/explain_freedom.h"
#include "mates/infer.h"
#include "mates/place_bodies.h"
#include "mates/stated_fits.h"
#include "mates/user_mate.h"

namespace hvas::mates {
namespace {

using product::Mate;
using product::MateId;
using product::MateKind;
using product::MateOrigin;
using product::Occurrence;
using product::OccurrenceId;
using product::Product;

/** Sets of numbers that are united step by step. */
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  [[nodiscard]] std::size_t Find(std::size_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  void Unite(std::size_t i, std::size_t j) {
    const auto [low, high] = std::minmax({Find(i), Find(j)});
    parent_[high] = low;
  }

 private:
  std::vector<std::size_t> parent_;
};

/** The mates between two parts that the drawn poses fulfil. */
struct DrawnJoint {
  OccurrenceId a, b;
  std::vector<MateId> mates;
  int free_count{0};
  bool is_engaged{false};  // More than planes that touch, or the user's.
};

/** Whether a mate that the drawn poses fulfil is one that parts are not drawn with by accident. */
bool IsMeant(const Mate& mate) {
  return mate.kind != MateKind::kFaceFace || mate.origin == MateOrigin::kUser;
}

std::vector<DrawnJoint> ListDrawnJoints(const Product& product, const std::set<MateId>& open) {
  std::map<std::pair<OccurrenceId, OccurrenceId>, DrawnJoint> joints;
  for (const Mate& mate : product.mates) {
    if (open.count(mate.id) > 0) {
      continue;
    }
    DrawnJoint& joint = joints[std::minmax(mate.a.occurrence, mate.b.occurrence)];
    std::tie(joint.a, joint.b) = std::minmax(mate.a.occurrence, mate.b.occurrence);
    joint.mates.push_back(mate.id);
    joint.is_engaged = joint.is_engaged || IsMeant(mate);
  }
  std::vector<DrawnJoint> all;
  for (auto& [pair, joint] : joints) {
    std::vector<MateConstraint> constraints;
    for (const MateId id : joint.mates) {
      constraints.push_back(MakeConstraint(product.mates[id.index()], joint.b,
                                           product.occurrences[joint.a.index()].X_WB));
    }
    joint.free_count =
        CalcFreeTwists(constraints, product.occurrences[joint.b.index()].X_WB).count();
    all.push_back(std::move(joint));
  }
  std::stable_sort(all.begin(), all.end(), [](const DrawnJoint& x, const DrawnJoint& y) {
    return x.is_engaged != y.is_engaged ? x.is_engaged : x.free_count < y.free_count;
  });
  return all;
}

double SizeOfPart(const Product& product, OccurrenceId id) {
  const product::Part& part = product.part_of(id);
  return part.mass.volume > 0 ? part.mass.volume : part.box_B.size().prod();
}

/** The bodies of a product and the mates between them. */
struct ProductBodies {
  std::vector<std::size_t> body_of;  // By occurrence.
  BodyProblem problem;
  std::vector<MateId> ids;    // Of problem.mates.
  std::vector<bool> is_open;  // Of problem.mates: the user's that the drawn poses do not fulfil.
};

/** Groups the parts that move as one. @param are_contacts_kept  Whether parts that touch stay
 together although mates of the user move one of them. */
Groups GroupParts(const Product& product, const std::vector<DrawnJoint>& joints,
                  const std::set<MateId>& open, bool are_contacts_kept) {
  std::set<OccurrenceId> moved;
  for (const MateId id : open) {
    moved.insert(product.mates[id.index()].a.occurrence);
    moved.insert(product.mates[id.index()].b.occurrence);
  }
  Groups groups(product.occurrences.size());
  const auto is_pulled_apart = [&](std::size_t i, std::size_t j) {
    return std::any_of(open.begin(), open.end(), [&](MateId id) {
      const Mate& mate = product.mates[id.index()];
      const std::size_t a = groups.Find(mate.a.occurrence.index());
      const std::size_t b = groups.Find(mate.b.occurrence.index());
      return std::minmax(a, b) == std::minmax(groups.Find(i), groups.Find(j));
    });
  };
  for (const DrawnJoint& joint : joints) {
    const bool is_loose = !joint.is_engaged && !are_contacts_kept &&
                          (moved.count(joint.a) > 0 || moved.count(joint.b) > 0);
    if (!is_loose && !is_pulled_apart(joint.a.index(), joint.b.index())) {
      groups.Unite(joint.a.index(), joint.b.index());
    }
  }
  return groups;
}

/** Adds a mate unless one body has both sides of it. */
void AddBodyMate(const Product& product, const Mate& mate, bool is_open, ProductBodies* bodies) {
  BodyMate made = MakeBodyMate(product, mate);
  made.a = bodies->body_of[mate.a.occurrence.index()];
  made.b = bodies->body_of[mate.b.occurrence.index()];
  made.is_sense_open = is_open && mate.kind == MateKind::kAxisHole;
  if (made.a != made.b) {
    bodies->problem.mates.push_back(made);
    bodies->ids.push_back(mate.id);
    bodies->is_open.push_back(is_open);
  }
}

/** Fixes the body with the largest part of each group of bodies that mates join. */
void FixLargest(const Product& product, std::size_t count, ProductBodies* bodies) {
  Groups joined(count);
  for (const BodyMate& mate : bodies->problem.mates) {
    joined.Unite(mate.a, mate.b);
  }
  bodies->problem.is_fixed.assign(count, false);
  std::vector<double> largest(count, -1);
  std::vector<std::size_t> base(count, 0);
  for (const Occurrence& occurrence : product.occurrences) {
    const std::size_t body = bodies->body_of[occurrence.id.index()];
    const std::size_t group = joined.Find(body);
    const double size = SizeOfPart(product, occurrence.id);
    if (size > largest[group]) {
      largest[group] = size;
      base[group] = body;
    }
  }
  for (std::size_t body = 0; body < count; ++body) {
    bodies->problem.is_fixed[base[joined.Find(body)]] = true;
  }
}

/** @param are_contacts_kept  See GroupParts. */
ProductBodies MakeBodies(const Product& product, const std::set<MateId>& open,
                         bool are_contacts_kept) {
  const std::vector<DrawnJoint> joints = ListDrawnJoints(product, open);
  Groups groups = GroupParts(product, joints, open, are_contacts_kept);
  ProductBodies bodies;
  std::map<std::size_t, std::size_t> number_of;
  for (std::size_t i = 0; i < product.occurrences.size(); ++i) {
    bodies.body_of.push_back(number_of.try_emplace(groups.Find(i), number_of.size()).first->second);
  }
  for (const DrawnJoint& joint : joints) {
    for (const MateId id : joint.mates) {
      if (IsMeant(product.mates[id.index()])) {
        AddBodyMate(product, product.mates[id.index()], false, &bodies);
      }
    }
  }
  for (const MateId id : open) {
    AddBodyMate(product, product.mates[id.index()], true, &bodies);
  }
  FixLargest(product, number_of.size(), &bodies);
  return bodies;
}

/** A mate that is off where the others put the parts. */
struct RejectedMate {
  std::size_t mate{0};              // Of ProductBodies::problem.
  std::vector<std::size_t> others;  // Which exclude it.
  MateError error;
};

struct PlacedBodies {
  ProductBodies bodies;
  std::vector<Pose> X_WB;
  std::vector<bool> is_used;
  std::vector<RejectedMate> rejected;
  bool is_given_up{false};  // Some combinations of the ends of shafts were not tried.
};

/** Finds out which mates exclude each other, in the order in which they are given. */
class ContradictionSearch {
 public:
  ContradictionSearch(const ProductBodies& bodies, WorkWatch* watch)
      : bodies_(bodies), watch_(watch) {}

  PlacedBodies Run() {
    std::vector<std::size_t> pending;
    std::vector<bool> accepted(bodies_.ids.size(), true);
    for (std::size_t i = 0; i < bodies_.ids.size(); ++i) {
      if (bodies_.is_open[i]) {
        accepted[i] = false;
        pending.push_back(i);
      }
    }
    std::vector<RejectedMate> rejected;
    while (!pending.empty() && MayGoOn(watch_)) {
      if (IsPossible(With(accepted, pending, pending.size()))) {
        accepted = With(accepted, pending, pending.size());
        break;
      }
      // The first `low` can be fulfilled, the first `high` cannot.
      std::size_t low = 0;
      std::size_t high = pending.size();
      while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (IsPossible(With(accepted, pending, middle)) ? low : high) = middle;
      }
      accepted = With(accepted, pending, low);
      rejected.push_back({pending[low], FindOthers(accepted, pending[low]), {}});
      pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(high));
    }
    PlacedBodies placed{
        bodies_, PlaceBodies(bodies_.problem, accepted, watch_).X_WB, accepted, {}, is_given_up_};
    Approach(rejected, &placed);
    for (RejectedMate& mate : rejected) {
      mate.error = CalcError(bodies_.problem.mates[mate.mate], placed.X_WB);
    }
    placed.rejected = std::move(rejected);
    return placed;
  }

 private:
  [[nodiscard]] static std::vector<bool> With(std::vector<bool> accepted,
                                              const std::vector<std::size_t>& pending,
                                              std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      accepted[pending[i]] = true;
    }
    return accepted;
  }

  [[nodiscard]] bool IsPossible(const std::vector<bool>& used) {
    const BodyPoses poses = PlaceBodies(bodies_.problem, used, watch_);
    is_given_up_ = is_given_up_ || poses.is_given_up;
    return poses.is_fulfilled;
  }

  /** A smallest set of accepted mates that excludes one; empty where there are too many to look. */
  [[nodiscard]] std::vector<std::size_t> FindOthers(const std::vector<bool>& accepted,
                                                    std::size_t mate) {
    constexpr std::size_t kMost = 60;  // Mates that are left out one by one: a choice.
    std::vector<std::size_t> others;
    std::vector<bool> used = accepted;
    used[mate] = true;
    for (std::size_t i = used.size(); i-- > 0;) {
      if (used[i] && i != mate && MayGoOn(watch_)) {
        if (others.size() + i > kMost) {
          return {};
        }
        used[i] = false;
        if (IsPossible(used)) {
          used[i] = true;
          others.push_back(i);
        }
      }
    }
    std::reverse(others.begin(), others.end());
    return others;
  }

  /** Moves what the accepted mates leave free so that the rejected ones are off by the least. */
  void Approach(const std::vector<RejectedMate>& rejected, PlacedBodies* placed) const {
    if (rejected.empty()) {
      return;
    }
    // Weights beside those of accepted mates, which stay within 1e-6 of the last: a choice, in
    // steps that each begin near their end.
    constexpr std::array<double, 4> kSlighter{1, 0.1, 1e-2, 1e-3};
    std::vector<BodyMate> mates;
    std::vector<double> weights;
    for (std::size_t i = 0; i < bodies_.ids.size(); ++i) {
      if (placed->is_used[i]) {
        mates.push_back(bodies_.problem.mates[i]);
        weights.push_back(1);
      }
    }
    const std::size_t accepted = mates.size();
    for (const RejectedMate& mate : rejected) {
      mates.push_back(bodies_.problem.mates[mate.mate]);
      weights.push_back(1);
    }
    for (const double slight : kSlighter) {
      std::fill(weights.begin() + static_cast<std::ptrdiff_t>(accepted), weights.end(), slight);
      SolveTogether(mates, weights, bodies_.problem.is_fixed, &placed->X_WB);
    }
    mates.resize(accepted);
    weights.resize(accepted);
    SolveTogether(mates, weights, bodies_.problem.is_fixed, &placed->X_WB);
  }

  const ProductBodies& bodies_;
  WorkWatch* watch_;
  bool is_given_up_{false};
};

PlacedBodies PlaceParts(const Product& product, const std::set<MateId>& open, WorkWatch* watch) {
  for (const bool are_contacts_kept : {true, false}) {
    ProductBodies bodies = MakeBodies(product, open, are_contacts_kept);
    const std::vector<bool> all(bodies.ids.size(), true);
    BodyPoses poses = PlaceBodies(bodies.problem, all, watch);
    if (poses.is_fulfilled) {
      return {std::move(bodies), std::move(poses.X_WB), all, {}, false};
    }
  }
  const ProductBodies bodies = MakeBodies(product, open, false);
  return ContradictionSearch(bodies, watch).Run();
}

/** Infers the mates of the poses that a product has now, without the removed ones, and makes the
 user's anew. @returns the removed ones that would be there. */
Result<std::vector<Mate>> InferAgain(Product* product, Diagnostics* diagnostics, WorkWatch* watch) {
  const std::vector<Mate> before = product->mates;
  if (const auto inferred = Infer(product, diagnostics, watch); !inferred) {
    return Unexpected(inferred.error());
  }
  std::vector<Mate> removed;
  const std::vector<std::string> keys = product->removed_mates;
  for (const std::string& key : keys) {
    const auto found = std::find_if(product->mates.begin(), product->mates.end(),
                                    [&key](const Mate& mate) { return mate.key == key; });
    if (found != product->mates.end()) {
      removed.push_back(*found);
      (void)RemoveMate(product, key);  // It is there.
    }
  }
  product->removed_mates = keys;
  for (const Mate& mate : before) {
    if (mate.origin != MateOrigin::kUser) {
      continue;
    }
    const auto found = std::find_if(product->mates.begin(), product->mates.end(),
                                    [&mate](const Mate& other) { return other.key == mate.key; });
    if (found != product->mates.end()) {
      found->origin = MateOrigin::kUser;
    } else {
      AddMate(product, RemakeMate(*product, mate));
    }
  }
  AssignStatedFits(product, watch);
  for (Mate& mate : product->mates) {
    const auto known = std::find_if(before.begin(), before.end(),
                                    [&mate](const Mate& other) { return other.key == mate.key; });
    if (known != before.end()) {
      mate.conditions = known->conditions;
      mate.fit = known->fit && !known->fit->is_proposed ? known->fit : mate.fit;
    }
  }
  product->box_W = {};
  for (const Occurrence& occurrence : product->occurrences) {
    for (const Vec3& vertex : product->part_of(occurrence.id).mesh.vertices) {
      product->box_W.Add(occurrence.X_WB * vertex);
    }
  }
  return removed;
}

/** Puts a product back to its drawn poses. */
Result<void> Restore(Product* product, WorkWatch* watch) {
  if (product->placement.drawn_poses.empty()) {
    return {};
  }
  for (Occurrence& occurrence : product->occurrences) {
    occurrence.X_WB = product->placement.drawn_poses[occurrence.id.index()];
  }
  product->placement = {};
  Diagnostics diagnostics;  // Those of the drawn poses have been reported when they were inferred.
  const auto inferred = InferAgain(product, &diagnostics, watch);
  return inferred ? Result<void>() : Unexpected(inferred.error());
}

/** The user's mates that the poses of a product do not fulfil. */
std::set<MateId> ListOpenMates(const Product& product) {
  std::set<MateId> open;
  for (const Mate& mate : product.mates) {
    if (mate.origin == MateOrigin::kUser && !IsMated(product, mate)) {
      open.insert(mate.id);
    }
  }
  return open;
}

std::string DescribeMate(const Product& product, const Mate& mate) {
  return fmt::format("{} ({} <- {})", mate.key, product.occurrences[mate.a.occurrence.index()].name,
                     product.occurrences[mate.b.occurrence.index()].name);
}

std::string DescribeError(const MateError& error) {
  return fmt::format("{:.3f} mm and {:.2f} deg", units::ToMm(error.distance),
                     units::ToDeg(error.angle));
}

std::vector<MateContradiction> Explain(const Product& drawn, const PlacedBodies& placed) {
  std::vector<MateContradiction> all;
  const auto mate_of = [&](std::size_t i) -> const Mate& {
    return drawn.mates[placed.bodies.ids[i].index()];
  };
  for (const RejectedMate& rejected : placed.rejected) {
    MateContradiction contradiction;
    contradiction.mate = mate_of(rejected.mate).key;
    std::vector<std::string> names;
    for (const std::size_t other : rejected.others) {
      contradiction.others.push_back(mate_of(other).key);
      names.push_back(DescribeMate(drawn, mate_of(other)));
    }
    contradiction.message =
        fmt::format("the mate {} contradicts {}: it is off by {} where they put the parts",
                    DescribeMate(drawn, mate_of(rejected.mate)),
                    names.empty() ? "the mates before it, too many to find out which"
                                  : fmt::format("{}", fmt::join(names, ", ")),
                    DescribeError(rejected.error));
    all.push_back(std::move(contradiction));
  }
  return all;
}

void ReportLimits(const Product& product, const PlacedBodies& placed, Diagnostics* diagnostics) {
  if (placed.is_given_up) {
    diagnostics->Warn("mate-limit", product.source,
                      "not all combinations of which end of which shaft goes in first were tried",
                      "add mates of planes, which decide it");
  }
  const std::vector<bool>& is_fixed = placed.bodies.problem.is_fixed;
  const auto moving = static_cast<std::size_t>(std::count(is_fixed.begin(), is_fixed.end(), false));
  if (moving > kMaxTogether) {
    diagnostics->Note("mate-limit", product.source,
                      fmt::format("mates place more than {} parts: what they leave free is found "
                                  "for each with the others fixed",
                                  kMaxTogether));
  }
}

void ReportFreedom(const Product& product, const PlacedBodies& placed, Diagnostics* diagnostics) {
  std::vector<BodyMate> used;
  for (std::size_t i = 0; i < placed.is_used.size(); ++i) {
    if (placed.is_used[i]) {
      used.push_back(placed.bodies.problem.mates[i]);
    }
  }
  const std::vector<BodyFreedom> freedoms =
      CalcBodyFreedoms(used, placed.bodies.problem.is_fixed, placed.X_WB);
  for (std::size_t body = 0; body < freedoms.size(); ++body) {
    std::vector<OccurrenceId> members;
    for (const Occurrence& occurrence : product.occurrences) {
      if (placed.bodies.body_of[occurrence.id.index()] == body) {
        members.push_back(occurrence.id);
      }
    }
    if (const auto message = ExplainFreedom(product, members, freedoms[body], placed.X_WB[body])) {
      diagnostics->Note("mate-freedom", product.occurrences[members.front().index()].path, *message,
                        "add mates for what should not be as drawn");
    }
  }
}

}  // namespace

Result<Placement> PlaceByMates(Product* product, WorkWatch* watch) {
  Product drawn = *product;
  if (const auto restored = Restore(&drawn, watch); !restored) {
    return Unexpected(restored.error());
  }
  const std::set<MateId> open = ListOpenMates(drawn);
  if (open.empty()) {
    if (!product->placement.drawn_poses.empty()) {
      *product = std::move(drawn);
    }
    return Placement{};
  }
  const PlacedBodies placed = PlaceParts(drawn, open, watch);
  if (!MayGoOn(watch)) {
    return Unexpected(watch->Explain("placing the parts by their mates", product->source));
  }
  Product assembled = drawn;
  std::size_t moved = 0;
  for (Occurrence& occurrence : assembled.occurrences) {
    assembled.placement.drawn_poses.push_back(occurrence.X_WB);
    const std::size_t body = placed.bodies.body_of[occurrence.id.index()];
    if (!placed.bodies.problem.is_fixed[body]) {
      occurrence.X_WB = placed.X_WB[body] * occurrence.X_WB;
      ++moved;
    }
  }
  Placement placement;
  placement.is_placed = true;
  Diagnostics* const diagnostics = &assembled.placement.diagnostics;
  auto removed = InferAgain(&assembled, diagnostics, watch);
  if (!removed) {
    return Unexpected(removed.error());
  }
  placement.removed = *std::move(removed);
  placement.contradictions = Explain(drawn, placed);
  diagnostics->Note("mate-placement", assembled.source,
                    fmt::format("{} of {} parts are assembled where the user's mates put them, "
                                "instead of where they are drawn",
                                moved, assembled.occurrences.size()));
  for (const MateContradiction& contradiction : placement.contradictions) {
    diagnostics->Warn("mate-contradiction", contradiction.mate, contradiction.message,
                      "remove or correct one of these mates");
  }
  ReportLimits(assembled, placed, diagnostics);
  ReportFreedom(assembled, placed, diagnostics);
  *product = std::move(assembled);
  return placement;
}

Result<MateId> AddMateAndPlace(Product* product, Mate mate) {
  Product changed = *product;
  const std::string key = mate.key;
  if (mate.id.index() < changed.mates.size()) {
    changed.mates[mate.id.index()].origin = MateOrigin::kUser;
  } else {
    AddMate(&changed, std::move(mate));
  }
  const auto placement = PlaceByMates(&changed);
  if (!placement) {
    return Unexpected(placement.error());
  }
  for (const MateContradiction& contradiction : placement->contradictions) {
    if (contradiction.mate == key) {
      return Fail(ErrorCode::kInvalid, contradiction.message, product->source,
                  "remove those mates first, or choose other surfaces");
    }
  }
  const auto id = FindMate(changed, key);
  if (id) {
    *product = std::move(changed);
  }
  return id;
}

Result<Mate> RemoveMateAndPlace(Product* product, std::string_view text) {
  Product changed = *product;
  auto removed = RemoveMate(&changed, text);
  if (!removed) {
    return removed;
  }
  if (const auto placement = PlaceByMates(&changed); !placement) {
    return Unexpected(placement.error());
  }
  *product = std::move(changed);
  return removed;
}

}  // namespace hvas::mates
