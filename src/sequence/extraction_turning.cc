// Ways of several pieces, and ways that turn: docs/algorithms/planning.md.

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/mate_kind.h"
#include "paths/check_way.h"
#include "paths/way.h"
#include "product/flexible.h"
#include "sequence/extraction.h"
#include "sequence/face_reliefs.h"
#include "sequence/gap_proof.h"
#include "sequence/turning_way.h"

namespace hvas::sequence {
namespace {

using product::MateKind;
using product::OccurrenceId;

// Looks of the brief searches. Of our pairs with ways that turn, two in three are found by the
// first, all but three by the second.
constexpr std::array<std::uint64_t, 2> kLooks = {10'000, 60'000};

}  // namespace

bool Extraction::IsHeldFirmly(OccurrenceId id) const {
  const std::vector<MateView>& views = mates_of_[id.index()];
  return std::any_of(views.begin(), views.end(), [&](const MateView& view) {
    const bool has_fit = mates::HasFit(view.mate->kind) && IsMated(view.other);
    return has_fit && view.mate->fit && view.mate->fit->kind != product::FitKind::kClearance &&
           view.mate->fit->kind != product::FitKind::kPassage &&
           view.mate->fit->kind != product::FitKind::kThread;
  });
}

paths::WayProblem Extraction::MakeWayProblem(OccurrenceId id) const {
  paths::WayProblem problem;
  problem.scene = input_.scene;
  problem.part = input_.shapes[id.index()];
  problem.self = contact::BodyId(id.index());
  problem.X_WB_start = product_.occurrences[id.index()].X_WB;
  problem.allowances = allowances_[id.index()];
  problem.tolerance = kDepthTolerance;
  return problem;
}

bool Extraction::IsWayFree(OccurrenceId id, const paths::Path& way) const {
  const paths::WayProblem problem = MakeWayProblem(id);
  return paths::CheckWay(problem, way, paths::CheckStepOf(problem.tolerance)).is_free;
}

std::optional<SequenceStep> Extraction::FindTurningWay(OccurrenceId id, std::uint64_t budget) {
  Search& search = searches_[id.index()];
  search.is_present = is_present_;
  search.looks = budget;
  search.is_proven = IsProvenStuck(id, budget > kLooks.back());
  if (search.is_proven) {
    return std::nullopt;
  }
  paths::WayProblem problem = MakeWayProblem(id);
  problem.directions_W = ListDirections({id});
  for (const MateView& view : mates_of_[id.index()]) {
    if (view.mate->kind == MateKind::kAxisHole && IsMated(view.other)) {
      const product::Connector& hole = view.mate->a;
      const spatial::Pose X_WM = product_.occurrences[hole.occurrence.index()].X_WB * hole.X_BM;
      problem.axes.push_back({X_WM.p(), view.axis_W, 0});
    }
  }
  paths::WayOptions options;
  options.budget = budget;
  options.point_budget = SearchBudget::kPointsOfQuery * budget_.left();
  options.stop = input_.stop;
  const auto found = paths::FindWay(problem, options);
  if (!found) {
    looks_ += 1;
    return std::nullopt;  // It lies in others as drawn, deeper than a way may.
  }
  looks_ += found->queries;
  budget_.Spend(found->queries, found->points);
  if (!found->way) {
    search.gone =
        found->farthest.empty() ? 0 : (found->farthest.back().p() - problem.X_WB_start.p()).norm();
    search.to_go = found->distance_to_go;
    search.stopped_by =
        found->stops.empty() ? OccurrenceId() : OccurrenceId(found->stops[0].body.index());
    return std::nullopt;
  }
  if (found->way->method == paths::WayMethod::kFreeMotion) {
    if (auto pair = FindScrewPair(id, found->way->screw)) {
      screws_.push_back(std::move(*pair));
    }
  }
  std::vector<spatial::Box> others;
  for (const product::Occurrence& other : product_.occurrences) {
    if (is_present_[other.id.index()] && other.id != id) {
      others.push_back(boxes_[other.id.index()]);
    }
  }
  return MakeTurningStep(id, found->way->path, problem.part->box_B(), others);
}

bool Extraction::HasChangedNearby(OccurrenceId id) const {
  const Search& before = searches_[id.index()];
  if (before.is_present.empty()) {
    return true;
  }
  // It has turned in all directions, and has gone so far.
  const Vec3 centre = boxes_[id.index()].centre();
  const Vec3 reach = Vec3::Constant(boxes_[id.index()].size().norm() + before.gone);
  const spatial::Box around{centre - reach, centre + reach};
  for (std::size_t i = 0; i < is_present_.size(); ++i) {
    if (is_present_[i] != before.is_present[i] && around.Overlaps(boxes_[i])) {
      return true;
    }
  }
  return false;
}

bool Extraction::IsWorthSearching(OccurrenceId id, std::uint64_t budget) const {
  const Search& before = searches_[id.index()];
  return HasChangedNearby(id) || (before.looks < budget && !before.is_proven);
}

bool Extraction::IsProvenStuck(OccurrenceId id, bool is_long) const {
  if (!allowances_[id.index()].empty()) {
    return false;  // The proofs know of no faces that let others pass.
  }
  if (IsHeldByContacts(product_, *input_.scene, id, {})) {
    return true;
  }
  Unit others;
  for (const product::Occurrence& other : product_.occurrences) {
    if (is_long && is_present_[other.id.index()] && other.id != id) {
      others.push_back(other.id);
    }
  }
  return is_long && FindCage(product_, id, others, kDepthTolerance).is_closed;
}

std::optional<SequenceStep> Extraction::TryRemoveTurning(OccurrenceId id, std::uint64_t budget,
                                                         Unit* rest) {
  std::optional<SequenceStep> step = FindTurningWay(id, budget);
  if (step) {
    SetPresent({id}, false);
    std::erase(*rest, id);
  }
  return step;
}

std::optional<SequenceStep> Extraction::TryRemoveTurning(
    Unit* rest, const Unit& deferred, std::uint64_t budget,
    const std::function<bool(OccurrenceId)>& is_tried) {
  for (const bool is_deferred : {false, true}) {
    for (std::size_t i = 0; i + 1 < rest->size(); ++i) {
      const OccurrenceId id = (*rest)[i];
      if (std::binary_search(deferred.begin(), deferred.end(), id) != is_deferred ||
          IsHeldFirmly(id) || budget_.is_over() || input_.stop.stop_requested() || !is_tried(id)) {
        continue;
      }
      if (auto step = TryRemoveTurning(id, std::min(budget, budget_.left()), rest)) {
        return step;
      }
    }
  }
  return std::nullopt;
}

std::optional<SequenceStep> Extraction::TryRemoveTurningLong(Unit* rest, const Unit& deferred) {
  Unit tried;
  // What only lacks the room to bend is known to be stuck: it is not searched for long.
  std::copy_if(rest->begin(), rest->end() - 1, std::back_inserter(tried),
               [this](OccurrenceId id) { return !IsHeldFirmly(id) && ExplainBending(id).empty(); });
  const auto rank = [&](OccurrenceId id) {
    return std::pair(std::binary_search(deferred.begin(), deferred.end(), id),
                     searches_[id.index()].to_go);
  };
  std::stable_sort(tried.begin(), tried.end(),
                   [&](OccurrenceId x, OccurrenceId y) { return rank(x) < rank(y); });
  for (std::size_t i = 0; i < tried.size() && !input_.stop.stop_requested(); ++i) {
    const std::uint64_t share = std::min(input_.way_looks, budget_.left() / (tried.size() - i));
    if (share > kLooks.back() && IsWorthSearching(tried[i], share)) {
      if (auto step = TryRemoveTurning(tried[i], share, rest)) {
        return step;
      }
    }
  }
  return std::nullopt;
}

std::optional<SequenceStep> Extraction::TryRemoveTurning(Unit* rest, const Unit& deferred,
                                                         TurningEffort effort) {
  if (input_.shapes.empty() || input_.way_looks == 0) {
    return std::nullopt;
  }
  if (effort == TurningEffort::kLong) {
    return TryRemoveTurningLong(rest, deferred);
  }
  // Most ways are found soon: all parts are looked at briefly before one is looked at for long.
  for (const std::uint64_t most : kLooks) {
    const std::uint64_t budget = std::min(most, input_.way_looks);
    const auto is_worth = [&](OccurrenceId id) { return IsWorthSearching(id, budget); };
    if (auto step = TryRemoveTurning(rest, deferred, budget, is_worth)) {
      return step;
    }
  }
  return std::nullopt;
}

std::optional<SequenceStep> Extraction::TryRemoveRing(Unit* rest, const Unit& deferred) {
  if (input_.shapes.empty() || input_.way_looks == 0) {
    return std::nullopt;
  }
  const auto is_ring = [&](OccurrenceId id) {
    const product::FlexiblePart* flexible = product::FindFlexible(product_, id);
    return searches_[id.index()].looks == 0 && flexible != nullptr && flexible->allowance > 0 &&
           flexible->kind == product::FlexibleKind::kORing &&
           !product::IsRubber(product_.part_of(id).material);
  };
  return TryRemoveTurning(rest, deferred, std::min(kLooks.front(), input_.way_looks), is_ring);
}

std::optional<SequenceStep> Extraction::FindRigidWay(OccurrenceId id) {
  const std::uint64_t budget = std::min({kLooks.front(), input_.way_looks, budget_.left()});
  SetPresent({id}, true);
  std::optional<SequenceStep> step;
  if (!input_.shapes.empty() && budget > 0 && IsWorthSearching(id, budget) && !IsHeldFirmly(id)) {
    step = FindTurningWay(id, budget);
  }
  SetPresent({id}, false);
  return step;
}

std::string Extraction::ExplainTurning(OccurrenceId id) const {
  const Search& search = searches_[id.index()];
  if (search.looks == 0) {
    return {};
  }
  if (search.is_proven) {
    return "; what is around it holds it: it has no way that turns, either";
  }
  const std::string by =
      search.stopped_by.is_valid() ? ", where " + Describe(search.stopped_by) + " stops it" : "";
  return fmt::format("; no way that turns was found with {} looks: the farthest goes {:.1f} mm{}{}",
                     search.looks, units::ToMm(search.gone), by,
                     budget_.is_over() ? "; the search was ended" : "");
}

}  // namespace hvas::sequence
