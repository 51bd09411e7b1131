#include "simulation/assembly_run.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {

using product::OccurrenceId;

AssemblyRun::AssemblyRun(Simulation* simulation, SimulatedPerson* person, Sink* downstream)
    : simulation_(simulation), person_(person), downstream_(downstream) {
  const Model& model = simulation_->model();
  total_ = model.sequence.steps.size() + model.sequence.gaps.size();
  for (const Body& body : model.bodies) {
    lift_height_ = std::max(lift_height_, 1.2 * body.shape->box_B().size().norm());
  }
}

void AssemblyRun::OnTick(const device::DeviceState& device,
                         const haptics::TickOutput& out) noexcept {
  if (downstream_ != nullptr) {
    downstream_->OnTick(device, out);
  }
}

void AssemblyRun::OnEvent(const SimulationEvent& event) {
  if (event.kind == SimulationEvent::Kind::kDropped) {
    has_dropped_ = true;
    dropped_ = event;
  }
  if (downstream_ != nullptr) {
    downstream_->OnEvent(event);
  }
}

PersonTask AssemblyRun::MakeTask(const SequenceStep& step) const {
  const Model& model = simulation_->model();
  const Body& body = model.bodies[step.occurrence.index()];
  const spatial::Pose X_BG(body.mass.p_BoBcm_B);
  PersonTask task;
  task.occurrence = step.occurrence;
  task.X_WG_start = simulation_->pose(step.occurrence) * X_BG;
  task.X_WG_goal = body.X_WB_goal * X_BG;
  task.extraction_W = step.extraction_W;
  task.engage_distance = step.engage_distance;
  task.centre_W = model.centre_W;
  task.transfer_radius = model.transfer_radius;
  task.lift_height = lift_height_;
  return task;
}

void AssemblyRun::Finish(PartResult result) {
  results_.push_back(std::move(result));
  if (on_part) {
    on_part(results_.size(), total_, results_.back());
  }
}

std::string AssemblyRun::DescribeOverlaps(OccurrenceId id) const {
  const Model& model = simulation_->model();
  const DrawnOverlap* deepest = nullptr;
  int count = 0;
  for (const DrawnOverlap& overlap : model.sequence.overlaps) {
    if (overlap.a == id || overlap.b == id) {
      ++count;
      deepest = deepest == nullptr || overlap.depth > deepest->depth ? &overlap : deepest;
    }
  }
  if (deepest == nullptr) {
    return {};
  }
  const OccurrenceId other = deepest->a == id ? deepest->b : deepest->a;
  return fmt::format("overlaps {}{} as drawn, by {:.3f} mm: contact between them is left out",
                     model.product->occurrences[other.index()].path,
                     count > 1 ? fmt::format(" and {} more", count - 1) : "",
                     units::ToMm(deepest->depth));
}

void AssemblyRun::Advance() {
  const Model& model = simulation_->model();
  const auto& steps = model.sequence.steps;
  if (is_assigned_) {
    if (person_->finished_count() == finished_before_) {
      return;
    }
    is_assigned_ = false;
    const SequenceStep& step = steps[next_step_++];
    PartResult result;
    result.occurrence = step.occurrence;
    result.is_seated = simulation_->placement(step.occurrence) == Placement::kPlaced;
    for (const product::MateId id : model.mates_of[step.occurrence.index()]) {
      const product::Mate& mate = model.product->mates[id.index()];
      const OccurrenceId other =
          mate.a.occurrence == step.occurrence ? mate.b.occurrence : mate.a.occurrence;
      result.mates += simulation_->placement(other) == Placement::kPlaced ? 1 : 0;
    }
    if (has_dropped_) {
      const HoldMetrics& metrics = dropped_.metrics;
      result.time = 1e-9 * static_cast<double>(dropped_.t_ns - metrics.t_taken_ns);
      result.path = metrics.path;
      result.peak_true = metrics.peak_true;
      result.peak_felt = metrics.peak_felt;
      result.deepest = metrics.deepest;
      if (!result.is_seated) {
        result.reason =
            metrics.hardest.is_valid()
                ? fmt::format("gave up after {} searches; {} stood in the way with up to {:.1f} N",
                              person_->searches(),
                              model.product->occurrences[metrics.hardest.index()].path,
                              metrics.hardest_force)
                : fmt::format("gave up after {} searches; nothing was met", person_->searches());
      }
    } else {
      result.reason = "could not be taken up from the table";
    }
    result.note = DescribeOverlaps(step.occurrence);
    const spatial::Pose& X_WB = simulation_->pose(step.occurrence);
    const spatial::Pose& X_goal = model.bodies[step.occurrence.index()].X_WB_goal;
    result.pose_error = (X_WB.p() - X_goal.p()).norm();
    result.pose_error_angle = spatial::RotationBetween(X_goal.q(), X_WB.q()).norm();
    Finish(result);
  }
  while (next_step_ < steps.size() && steps[next_step_].is_base) {
    simulation_->PlaceInFixture(steps[next_step_].occurrence);
    PartResult result;
    result.occurrence = steps[next_step_].occurrence;
    result.is_seated = true;
    Finish(result);
    ++next_step_;
  }
  if (next_step_ == steps.size()) {
    if (!is_done_) {
      for (const SequenceGap& gap : model.sequence.gaps) {
        PartResult result;
        result.occurrence = gap.occurrence;
        result.reason = gap.reason;
        Finish(result);
      }
    }
    is_done_ = true;
    return;
  }
  has_dropped_ = false;
  finished_before_ = person_->finished_count();
  is_assigned_ = person_->Assign(MakeTask(steps[next_step_]));
}

spatial::Pose StartOfHand(const Model& model) {
  return spatial::Pose(model.centre_W + Vec3(0, 0, 1.1 * model.transfer_radius));
}

}  // namespace hvas::simulation
