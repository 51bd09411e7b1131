// Ways of several pieces, and ways that turn: docs/algorithms/planning.md.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/mate_kind.h"
#include "planning/check_way.h"
#include "planning/way.h"
#include "product/flexible.h"
#include "simulation/extraction.h"
#include "simulation/turning_way.h"

namespace hvas::simulation {
namespace {

using product::MateKind;
using product::OccurrenceId;

constexpr std::uint64_t kBriefLooks = 10'000;  // Some seconds: a choice.

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

planning::WayProblem Extraction::MakeWayProblem(OccurrenceId id) const {
  planning::WayProblem problem;
  problem.scene = input_.scene;
  problem.part = input_.shapes[id.index()];
  problem.self = contact::BodyId(id.index());
  problem.X_WB_start = product_.occurrences[id.index()].X_WB;
  problem.allowances = allowances_[id.index()];
  problem.tolerance = kDepthTolerance;
  return problem;
}

bool Extraction::IsWayFree(OccurrenceId id, const sweep::Path& way) const {
  const planning::WayProblem problem = MakeWayProblem(id);
  return planning::CheckWay(problem, way, planning::CheckStepOf(problem.tolerance)).is_free;
}

std::optional<SequenceStep> Extraction::FindTurningWay(OccurrenceId id, std::uint64_t budget) {
  planning::WayProblem problem = MakeWayProblem(id);
  problem.directions_W = ListDirections({id});
  for (const MateView& view : mates_of_[id.index()]) {
    if (view.mate->kind == MateKind::kAxisHole && IsMated(view.other)) {
      const product::Connector& hole = view.mate->a;
      const spatial::Pose X_WM = product_.occurrences[hole.occurrence.index()].X_WB * hole.X_BM;
      problem.axes.push_back({X_WM.p(), view.axis_W, 0});
    }
  }
  planning::WayOptions options;
  options.budget = budget;
  options.point_budget = std::min(kMostPointsOfOne, kMostPoints - points_looked_at_);
  options.stop = input_.stop;
  const auto found = planning::FindWay(problem, options);
  Search& search = searches_[id.index()];
  search.is_present = is_present_;
  search.looks = budget;
  if (!found) {
    looks_ += 1;
    return std::nullopt;  // It lies in others as drawn, deeper than a way may.
  }
  looks_ += found->queries;
  points_looked_at_ += found->points;
  if (!found->way) {
    search.gone =
        found->farthest.empty() ? 0 : (found->farthest.back().p() - problem.X_WB_start.p()).norm();
    search.stopped_by =
        found->stops.empty() ? OccurrenceId() : OccurrenceId(found->stops[0].body.index());
    return std::nullopt;
  }
  if (found->way->method == planning::WayMethod::kFreeMotion) {
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

std::optional<SequenceStep> Extraction::TryRemoveTurning(
    Unit* rest, const Unit& deferred, std::uint64_t budget,
    const std::function<bool(OccurrenceId, const Search&)>& is_tried) {
  for (const bool is_deferred : {false, true}) {
    for (std::size_t i = 0; i + 1 < rest->size(); ++i) {
      const OccurrenceId id = (*rest)[i];
      if (std::binary_search(deferred.begin(), deferred.end(), id) != is_deferred ||
          !is_tried(id, searches_[id.index()]) || IsHeldFirmly(id) || IsSearchOver() ||
          input_.stop.stop_requested()) {
        continue;
      }
      if (auto step = FindTurningWay(id, std::min(budget, kMostLooks - looks_))) {
        SetPresent({id}, false);
        rest->erase(rest->begin() + static_cast<std::ptrdiff_t>(i));
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
  // Most ways are found soon: all parts are looked at briefly before one is looked at for long. Of
  // our pairs with ways that turn, two in three are found by the first, all but three by the
  // second.
  const std::vector<std::uint64_t> tries = effort == TurningEffort::kBrief
                                               ? std::vector{kBriefLooks, std::uint64_t{60'000}}
                                               : std::vector{kWayLooks};
  for (const std::uint64_t most : tries) {
    const std::uint64_t budget = std::min(most, input_.way_looks);
    // What only lacks the room to bend is known to be stuck: it is not looked at for long.
    const auto is_new = [&](OccurrenceId id, const Search& before) {
      return (before.looks < budget || before.is_present != is_present_) &&
             (effort == TurningEffort::kBrief || ExplainBending(id).empty());
    };
    if (auto step = TryRemoveTurning(rest, deferred, budget, is_new)) {
      return step;
    }
  }
  return std::nullopt;
}

std::optional<SequenceStep> Extraction::TryRemoveRing(Unit* rest, const Unit& deferred) {
  if (input_.shapes.empty() || input_.way_looks == 0) {
    return std::nullopt;
  }
  const auto is_ring = [&](OccurrenceId id, const Search& before) {
    const product::FlexiblePart* flexible = product::FindFlexible(product_, id);
    return before.looks == 0 && flexible != nullptr && flexible->allowance > 0 &&
           flexible->kind == product::FlexibleKind::kORing &&
           !product::IsRubber(product_.part_of(id).material);
  };
  return TryRemoveTurning(rest, deferred, std::min(kBriefLooks, input_.way_looks), is_ring);
}

std::optional<SequenceStep> Extraction::FindRigidWay(OccurrenceId id) {
  const std::uint64_t budget = std::min(kBriefLooks, input_.way_looks);
  SetPresent({id}, true);
  const Search& before = searches_[id.index()];
  const bool is_new = before.looks < budget || before.is_present != is_present_;
  std::optional<SequenceStep> step;
  if (!input_.shapes.empty() && budget > 0 && is_new && !IsHeldFirmly(id) && !IsSearchOver()) {
    step = FindTurningWay(id, std::min(budget, kMostLooks - looks_));
  }
  SetPresent({id}, false);
  return step;
}

std::string Extraction::ExplainTurning(OccurrenceId id) const {
  const Search& search = searches_[id.index()];
  if (search.looks == 0) {
    return {};
  }
  const std::string by =
      search.stopped_by.is_valid() ? ", where " + Describe(search.stopped_by) + " stops it" : "";
  return fmt::format("; no way that turns was found with {} looks: the farthest goes {:.1f} mm{}{}",
                     search.looks, units::ToMm(search.gone), by,
                     IsSearchOver() ? "; the search was ended" : "");
}

}  // namespace hvas::simulation
