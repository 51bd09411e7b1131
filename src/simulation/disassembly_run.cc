#include "simulation/disassembly_run.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {

using product::OccurrenceId;

void PutAllInPlace(Simulation* simulation) {
  std::vector<PartState> parts;
  for (const Body& body : simulation->model().bodies) {
    parts.push_back(body.role == BodyRole::kTool ? PartState{Placement::kLoose, body.X_WB_start}
                                                 : PartState{Placement::kPlaced, body.X_WB_goal});
  }
  simulation->Restore(parts);
}

DisassemblyRun::DisassemblyRun(Simulation* simulation, const DisassemblyPlan* plan,
                               TaskOperator* mover, Sink* downstream)
    : PartRun(simulation, downstream), plan_(*plan), mover_(mover) {
  if (mover_ == nullptr) {
    simulation->physics().AllowTakingOut(0);
  }
}

bool DisassemblyRun::IsOut(const Removal& removal) const {
  const Placement placement = physics().placement(removal.step.occurrence);
  if (sequence::IsWithinProduct(removal.step.kind)) {
    return placement == PlacementAfter(removal.step.kind);
  }
  const std::optional<SimulationEvent>& dropped = dropped_[removal.step.occurrence.index()];
  return dropped && !dropped->was_seated && dropped->to_place >= removal.step.engage_distance;
}

OccurrenceId DisassemblyRun::FindWall(const Removal& removal) const {
  for (const sequence::Obstacle& obstacle : removal.waits_for) {
    if (physics().placement(obstacle.occurrence) == Placement::kPlaced) {
      return obstacle.occurrence;
    }
  }
  return {};
}

bool DisassemblyRun::Begin(const Removal& removal) {
  physics().Prepare(removal.step);
  if (mover_ == nullptr) {
    return true;
  }
  finished_before_ = mover_->finished_count();
  return mover_->Assign(MakeTask(removal.step));
}

bool DisassemblyRun::HasFinished(const Removal& removal) const {
  return mover_ != nullptr ? mover_->finished_count() != finished_before_ : IsOut(removal);
}

std::string DisassemblyRun::ExplainFailure(const Removal& removal) const {
  const std::optional<SimulationEvent>& dropped = dropped_[removal.step.occurrence.index()];
  if (!dropped) {
    return "could not be taken up";
  }
  return fmt::format("came {:.2f} mm out of its place; {}", units::ToMm(dropped->to_place),
                     DescribeHardest(dropped->metrics));
}

void DisassemblyRun::Finish(const Removal& removal, const std::string& reason) {
  const OccurrenceId id = removal.step.occurrence;
  AddHold(id);
  Update(id);
  ResultOf(id).reason = reason;
  const std::string allowed = DescribeAllowances(ListPartAllowances(removal.step));
  const std::string pressed = DescribePresses(ListPresses(removal.step));
  ResultOf(id).note = allowed + (allowed.empty() || pressed.empty() ? "" : "; ") + pressed;
  for (const OccurrenceId member : removal.step.members) {
    Update(member);
    ResultOf(member).reason = reason.empty() ? reason : "its subassembly " + reason;
    ResultOf(member).note = fmt::format("came out with {} as one body", PathOf(id));
  }
  ++next_;
  if (on_part) {
    const auto is_out = [](const PartResult& part) { return part.reason.empty(); };
    const auto done = std::count_if(results_.begin(), results_.end(), is_out);
    const std::optional<SimulationEvent>& dropped = dropped_[id.index()];
    on_part(
        {next_, static_cast<std::size_t>(done), plan_.removals.size(), dropped ? dropped->t_ns : 0},
        ResultOf(id));
  }
}

void DisassemblyRun::FinishAll() {
  for (const sequence::SequenceGap& stuck : plan_.stuck) {
    Update(stuck.occurrence);
    ResultOf(stuck.occurrence).reason = stuck.reason;
  }
  is_done_ = true;
}

void DisassemblyRun::Advance() {
  while (!is_done_) {
    if (next_ == plan_.removals.size()) {
      FinishAll();
      return;
    }
    const Removal& removal = plan_.removals[next_];
    if (!is_busy_ && HasNothingToMove(removal.step)) {
      ++next_;
      continue;
    }
    if (is_busy_) {
      if (!HasFinished(removal)) {
        return;
      }
      is_busy_ = false;
      Finish(removal, IsOut(removal) ? std::string() : ExplainFailure(removal));
    } else if (const OccurrenceId wall = FindWall(removal); wall.is_valid() && mover_ != nullptr) {
      Finish(removal,
             fmt::format("{}, which has to come out first, is in its place", PathOf(wall)));
    } else {
      is_busy_ = Begin(removal);
      return;
    }
  }
}

}  // namespace hvas::simulation
