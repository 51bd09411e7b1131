// Parts that are moved a part of their way, to let another one pass: docs/algorithms/sequence.md.

#include <algorithm>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "mates/mate_kind.h"
#include "paths/path.h"
#include "sequence/extraction.h"
#include "sequence/way_directions.h"

namespace hvas::sequence {
namespace {

using product::MateKind;
using product::OccurrenceId;

// Places along the way of the part that is moved: the next one can pass it where it is free over a
// sixteenth of that way. A choice.
constexpr std::size_t kPlaces = 16;
constexpr double kLeastTravel = 1e-3;  // [m]; what has less has its play. A choice.
constexpr double kWayStep = 0.5e-3;    // [m] between poses of a way that turns: a choice.
constexpr double kEnd = 1e-6;          // [m]; a way of a grip ends with a straight piece.

/** The step back into its place of a part that was moved along a way. */
SequenceStep MakeReturn(OccurrenceId id, const paths::Path& way, bool does_turn,
                        const spatial::Box& box_B) {
  SequenceStep step;
  step.kind = SequenceStep::Kind::kReturn;
  step.occurrence = id;
  const Vec3 gone = way.back() * box_B.centre() - way.front() * box_B.centre();
  step.engage_distance = paths::CalcLength(way, box_B.centre());
  step.extraction_W = gone.norm() > kEnd ? Vec3(gone.normalized() + Vec3::Zero()) : Vec3::UnitZ();
  if (does_turn) {
    step.way = paths::Resample(way, box_B, kWayStep);
  }
  return step;
}

/** The step aside of a part that returns so. */
SequenceStep MakeAside(const SequenceStep& back, const paths::Path& way) {
  SequenceStep step = back;
  step.kind = SequenceStep::Kind::kAside;
  // Without signs of zeros, as a plan that was written to a file has them.
  step.extraction_W = Vec3::Zero() - back.extraction_W;
  step.offset_W = way.back().p() - way.front().p() + Vec3::Zero();
  std::reverse(step.way.begin(), step.way.end());
  return step;
}

/** Ends the way of a step with a straight piece that is never gone. */
void EndStraight(SequenceStep* step) {
  if (!step->way.empty()) {
    const spatial::Pose last = step->way.back();
    step->way.emplace_back(last.q(), last.p() + kEnd * step->extraction_W);
  }
}

}  // namespace

void Extraction::MoveAside(OccurrenceId id, const spatial::Pose& X_WB) {
  is_aside_[id.index()] = true;
  boxes_[id.index()] = spatial::Transform(X_WB, product_.part_of(id).box_B);
  input_.scene->SetPose(contact::BodyId(id.index()), X_WB);
}

void Extraction::MoveBack(OccurrenceId id) {
  MoveAside(id, product_.occurrences[id.index()].X_WB);
  is_aside_[id.index()] = false;
}

bool Extraction::MayStandInTheWay(OccurrenceId id, OccurrenceId of) const {
  const std::vector<Attempt>& attempts = memories_[of.index()].attempts;
  const std::vector<MateView>& views = mates_of_[of.index()];
  return std::any_of(attempts.begin(), attempts.end(),
                     [id](const Attempt& attempt) {
                       return attempt.blocker && attempt.blocker->occurrence == id;
                     }) ||
         std::any_of(views.begin(), views.end(),
                     [id](const MateView& view) { return view.other == id; });
}

paths::Path Extraction::FindFreeWay(OccurrenceId id, const InnerMotion& motion) {
  SetUnit({id}, true);
  const std::vector<Member> members = ListMembers({id}, motion.direction);
  const contact::QueryOptions query = MakeQuery(members.front(), kDepthTolerance);
  const contact::Shape& shape = input_.scene->shape(query.self);
  const double length = (motion.way.back().p() - motion.way.front().p()).norm();
  paths::Path way = paths::Resample(motion.way, shape.box_B(), CalcStep({id}, length));
  const auto met = std::find_if(way.begin(), way.end(), [&](const spatial::Pose& X_WB) {
    const bool is_free = input_.scene->IsFree(shape, X_WB, kDepthTolerance, query, &workspace_);
    CountQuery();
    return !is_free;
  });
  way.erase(met, way.end());
  SetUnit({id}, false);
  return way;
}

std::vector<Extraction::InnerMotion> Extraction::ListInnerMotions(OccurrenceId id) {
  const product::Pose& X_WB = product_.occurrences[id.index()].X_WB;
  std::vector<InnerMotion> motions;
  SetUnit({id}, true);
  for (const Vec3& direction : CollectDirections({id})) {
    if (MatesAllow({id}, direction)) {
      const double length = CalcExitDistance({id}, direction);
      motions.push_back({paths::MakeTranslation(X_WB, length * direction), direction});
    }
  }
  for (const MateView& view : mates_of_[id.index()]) {
    if (view.mate->kind == MateKind::kAxisHole && IsMated(view.other) && MayTurn(id, view.axis_W)) {
      const product::Connector& hole = view.mate->a;
      const spatial::Pose X_WM = product_.occurrences[hole.occurrence.index()].X_WB * hole.X_BM;
      for (const double angle : {std::numbers::pi, -std::numbers::pi}) {
        motions.push_back({paths::MakeRotation(X_WB, X_WM.p(), view.axis_W, angle), Vec3::Zero()});
      }
      break;  // Others have the same axis, or leave no turn.
    }
  }
  SetUnit({id}, false);
  return motions;
}

bool Extraction::MayTurn(OccurrenceId id, const Vec3& axis_W) const {
  const std::vector<MateView>& views = mates_of_[id.index()];
  return std::all_of(views.begin(), views.end(), [&](const MateView& view) {
    const MateKind kind = view.mate->kind;
    const bool turns_about_it = kind == MateKind::kAxisHole || kind == MateKind::kPrismatic;
    return !IsMated(view.other) || kind == MateKind::kFaceFace ||
           (turns_about_it && std::abs(view.axis_W.dot(axis_W)) > 1 - kParallel);
  });
}

std::optional<SequenceStep> Extraction::FindWayPast(OccurrenceId id) {
  Memory memory;  // What is known of its ways holds with all parts in their places.
  std::optional<SequenceStep> step = TryRemove({id}, &memory);
  if (step) {
    SetPresent({id}, true);
  }
  return step;
}

std::optional<Extraction::Passing> Extraction::FindPassing(OccurrenceId moved,
                                                           const paths::Path& way,
                                                           const Unit& blocked) {
  for (const OccurrenceId id : blocked) {
    // The middle of the first range of places from which the part can go has most room both ways.
    std::vector<Passing> range;
    for (std::size_t place = 1; place <= kPlaces && !IsPassingOver(); ++place) {
      const std::size_t last = (way.size() - 1) * place / kPlaces;
      const std::uint64_t before = budget_.spent();
      MoveAside(moved, way[last]);
      std::optional<SequenceStep> step = FindWayPast(id);
      MoveBack(moved);
      passing_spent_ += budget_.spent() - before;
      const bool is_same_way =
          step && (range.empty() || step->extraction_W == range.front().step.extraction_W);
      if (!is_same_way && !range.empty()) {
        break;
      }
      if (step) {
        range.push_back({std::move(*step), last});
      }
    }
    if (!range.empty()) {
      return range[range.size() / 2];
    }
  }
  return std::nullopt;
}

std::vector<SequenceStep> Extraction::TryRemovePast(OccurrenceId moved, const Unit& blocked) {
  const spatial::Box& box_B = product_.part_of(moved).box_B;
  for (const InnerMotion& motion : ListInnerMotions(moved)) {
    if (IsPassingOver() || input_.stop.stop_requested()) {
      break;
    }
    const std::uint64_t before = budget_.spent();
    paths::Path way = FindFreeWay(moved, motion);
    passing_spent_ += budget_.spent() - before;
    if (way.size() < 2 || paths::CalcLargestMove(way.front(), way.back(), box_B) < kLeastTravel) {
      continue;
    }
    std::optional<Passing> passing = FindPassing(moved, way, blocked);
    if (!passing) {
      continue;
    }
    way.resize(passing->place + 1);
    SequenceStep back = MakeReturn(moved, way, motion.direction == Vec3::Zero(), box_B);
    SequenceStep aside = MakeAside(back, way);
    EndStraight(&back);
    EndStraight(&aside);
    SetPresent({passing->step.occurrence}, false);
    return {std::move(aside), std::move(passing->step), std::move(back)};
  }
  return {};
}

std::vector<SequenceStep> Extraction::TryRemovePast(Unit* rest, const Unit& deferred) {
  Unit tried(rest->begin(), rest->end() - 1);  // The base stays.
  std::stable_partition(tried.begin(), tried.end(), [&deferred](OccurrenceId id) {
    return !std::binary_search(deferred.begin(), deferred.end(), id);
  });
  for (const OccurrenceId moved : tried) {
    Unit blocked;
    std::copy_if(tried.begin(), tried.end(), std::back_inserter(blocked),
                 [&](OccurrenceId id) { return id != moved && MayStandInTheWay(moved, id); });
    if (blocked.empty() || IsHeldFirmly(moved)) {
      continue;
    }
    std::vector<SequenceStep> steps = TryRemovePast(moved, blocked);
    if (!steps.empty()) {
      std::erase(*rest, steps[1].occurrence);
      return steps;
    }
  }
  return {};
}

std::string Extraction::ExplainPassing() const {
  return IsPassingOver() ? "; the search for a part that can be moved aside was ended"
                         : std::string();
}

}  // namespace hvas::sequence
