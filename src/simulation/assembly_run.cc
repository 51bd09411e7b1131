#include "simulation/assembly_run.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {

using product::OccurrenceId;

AssemblyRun::AssemblyRun(Simulation* simulation, SimulatedPerson* person, Sink* downstream)
    : simulation_(simulation), person_(person), downstream_(downstream) {
  const Model& model = simulation_->model();
  total_ = model.bodies.size();
  dropped_.resize(total_);
  for (const Body& body : model.bodies) {
    lift_height_ = std::max(lift_height_, 1.2 * body.shape->box_B().size().norm());
  }
}

Execution AssemblyRun::MakeExecution(Operator* hand, double limit_s, Operator* second_hand) {
  Execution execution;
  execution.simulation = simulation_;
  execution.hand = hand;
  execution.second_hand = second_hand;
  execution.sink = this;
  execution.advance = [this] { Advance(); };
  execution.is_done = [this] { return is_done_; };
  execution.limit_ns = std::llround(1e9 * limit_s);
  return execution;
}

void AssemblyRun::OnTick(std::size_t hand, const device::DeviceState& device,
                         const haptics::TickOutput& out) noexcept {
  if (downstream_ != nullptr) {
    downstream_->OnTick(hand, device, out);
  }
}

void AssemblyRun::OnFlight(const std::vector<FlightTick>& ticks) {
  if (downstream_ != nullptr) {
    downstream_->OnFlight(ticks);
  }
}

void AssemblyRun::OnEvent(const SimulationEvent& event) {
  if (event.kind == SimulationEvent::Kind::kDropped) {
    dropped_[event.occurrence.index()] = event;
  }
  if (downstream_ != nullptr) {
    downstream_->OnEvent(event);
  }
}

PersonTask AssemblyRun::MakeTask(const SequenceStep& step) const {
  const Model& model = simulation_->model();
  const Body& body = model.bodies[step.occurrence.index()];
  const spatial::Pose X_BG(CombineMass(model, step).p_BoBcm_B);
  PersonTask task;
  task.occurrence = step.occurrence;
  task.p_BG = X_BG.p();
  task.X_WG_start = simulation_->pose(step.occurrence) * X_BG;
  task.X_WG_goal = body.X_WB_goal * X_BG;
  task.X_WG_goal = {task.X_WG_goal.q(), task.X_WG_goal.p() + step.offset_W};
  task.extraction_W = step.extraction_W;
  task.engage_distance = step.engage_distance;
  task.centre_W = model.centre_W;
  task.transfer_radius = model.transfer_radius;
  task.lift_height = lift_height_;
  return task;
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

PartResult& AssemblyRun::ResultOf(OccurrenceId id) {
  for (PartResult& result : results_) {
    if (result.occurrence == id) {
      return result;
    }
  }
  results_.emplace_back();
  results_.back().occurrence = id;
  return results_.back();
}

std::string AssemblyRun::ExplainFailure(const SequenceStep& step) const {
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  if (!dropped) {
    return person_ != nullptr ? "could not be taken up" : "was not taken up";
  }
  if (const OccurrenceId missing = simulation_->FindMissingPartner(step); missing.is_valid()) {
    return fmt::format("{}, which it goes to, is not in its place",
                       simulation_->model().product->occurrences[missing.index()].path);
  }
  const HoldMetrics& metrics = dropped->metrics;
  const std::string depth = metrics.insertion > 0 ? fmt::format(", {:.2f} mm into its hole at most",
                                                                units::ToMm(metrics.insertion))
                                                  : std::string();
  const std::string tries = person_ != nullptr
                                ? fmt::format("gave up after {} searches", person_->searches())
                                : std::string("was let go elsewhere");
  if (!metrics.hardest.is_valid()) {
    return fmt::format("{}{}; nothing was met", tries, depth);
  }
  return fmt::format("{}{}; {} stood in the way with up to {:.1f} N", tries, depth,
                     simulation_->model().product->occurrences[metrics.hardest.index()].path,
                     metrics.hardest_force);
}

void AssemblyRun::FinishStep(const SequenceStep& step) {
  const Model& model = simulation_->model();
  PartResult& result = ResultOf(step.occurrence);
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  const bool was_seated = dropped && dropped->was_seated;
  if (dropped) {
    const HoldMetrics& metrics = dropped->metrics;
    result.time += 1e-9 * static_cast<double>(dropped->t_ns - metrics.t_taken_ns);
    result.path += metrics.path;
    result.peak_true = std::max(result.peak_true, metrics.peak_true);
    result.peak_felt = std::max(result.peak_felt, metrics.peak_felt);
    result.fit_true = std::max(result.fit_true, metrics.fit_true);
    result.fit_felt = std::max(result.fit_felt, metrics.fit_felt);
    result.deepest = std::max(result.deepest, metrics.deepest);
    result.insertion = std::max(result.insertion, metrics.insertion);
  }
  const std::string reason = was_seated ? std::string() : ExplainFailure(step);
  result.reason = reason;
  result.note = DescribeOverlaps(step.occurrence);
  for (const product::MateId id : model.mates_of[step.occurrence.index()]) {
    const product::Mate& mate = model.product->mates[id.index()];
    const OccurrenceId other =
        mate.a.occurrence == step.occurrence ? mate.b.occurrence : mate.a.occurrence;
    const bool is_new = step.kind == SequenceStep::Kind::kInsert && step.members.empty();
    result.mates += is_new && simulation_->placement(other) == Placement::kPlaced ? 1 : 0;
  }
  for (const OccurrenceId member : step.members) {
    PartResult& other = ResultOf(member);
    other.reason = reason.empty() ? other.reason : "its subassembly " + reason;
  }
  Update(step.occurrence);
  if (on_part) {
    const auto seated = std::count_if(results_.begin(), results_.end(),
                                      [](const PartResult& part) { return part.is_seated; });
    on_part(
        {results_.size(), static_cast<std::size_t>(seated), total_, dropped ? dropped->t_ns : 0},
        ResultOf(step.occurrence));
  }
}

void AssemblyRun::Update(OccurrenceId id) {
  PartResult& result = ResultOf(id);
  result.is_seated = simulation_->placement(id) == Placement::kPlaced;
  const spatial::Pose& X_WB = simulation_->pose(id);
  const spatial::Pose& X_goal = simulation_->model().bodies[id.index()].X_WB_goal;
  result.pose_error = (X_WB.p() - X_goal.p()).norm();
  result.pose_error_angle = spatial::RotationBetween(X_goal.q(), X_WB.q()).norm();
}

bool AssemblyRun::HasFinished(const SequenceStep& step) const {
  if (person_ != nullptr) {
    return person_->finished_count() != finished_before_;
  }
  // Real ones do as they like: a part may be in its place before its turn comes.
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  const bool is_plain = step.kind == SequenceStep::Kind::kInsert && step.members.empty();
  return (dropped && dropped->was_seated) ||
         (is_plain && simulation_->placement(step.occurrence) == Placement::kPlaced);
}

void AssemblyRun::Advance() {
  const Model& model = simulation_->model();
  const auto& steps = model.sequence.steps;
  if (is_assigned_) {
    if (!HasFinished(steps[next_step_])) {
      return;
    }
    is_assigned_ = false;
    FinishStep(steps[next_step_++]);
  }
  for (; next_step_ < std::min(end_step_, steps.size()); ++next_step_) {
    const SequenceStep& step = steps[next_step_];
    if (step.kind == SequenceStep::Kind::kBase || next_step_ < first_step_) {
      simulation_->PlaceInFixture(step.occurrence);
      Update(step.occurrence);
      ResultOf(step.occurrence).note = DescribeOverlaps(step.occurrence);
      continue;
    }
    // Of a subassembly only that moves which has got into it.
    SequenceStep possible = step;
    std::erase_if(possible.members, [this](OccurrenceId id) {
      return simulation_->placement(id) == Placement::kLoose;
    });
    simulation_->Prepare(possible);
    if (person_ != nullptr) {
      dropped_[step.occurrence.index()].reset();
      finished_before_ = person_->finished_count();
      is_assigned_ = person_->Assign(MakeTask(possible));
    } else {
      is_assigned_ = true;
    }
    return;
  }
  if (!is_done_) {
    for (const SequenceGap& gap : model.sequence.gaps) {
      ResultOf(gap.occurrence).reason = gap.reason;
    }
    for (const product::Occurrence& occurrence : model.product->occurrences) {
      Update(occurrence.id);
    }
  }
  is_done_ = true;
}

spatial::Pose StartOfHand(const Model& model) {
  return spatial::Pose(model.centre_W + Vec3(0, 0, 1.1 * model.transfer_radius));
}

}  // namespace hvas::simulation
