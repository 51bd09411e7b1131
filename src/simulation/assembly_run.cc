#include "simulation/assembly_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {

using product::OccurrenceId;

namespace {

bool IsSinglePart(const SequenceStep& step) {
  return step.kind == SequenceStep::Kind::kInsert && step.members.empty();
}

}  // namespace

AssemblyRun::AssemblyRun(Simulation* simulation, const Persons& persons, Sink* downstream)
    : simulation_(simulation), physics_(simulation->physics()), downstream_(downstream) {
  for (std::size_t hand = 0; hand < persons.size(); ++hand) {
    if (persons[hand] != nullptr) {
      workers_.push_back({persons[hand], hand, nullptr, 0});
    }
  }
  if (workers_.empty()) {
    workers_.emplace_back();
  }
  last_worker_ = workers_.size() - 1;
  const Model& model = simulation_->model();
  total_ = model.bodies.size();
  dropped_.resize(total_);
  is_finished_.resize(model.sequence.steps.size());
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
    GoBackTo(event);
  }
  states_[event.hand] = event.state;
  if (downstream_ != nullptr) {
    downstream_->OnEvent(event);
  }
}

void AssemblyRun::GoBackTo(const SimulationEvent& dropped) {
  const auto& steps = simulation_->model().sequence.steps;
  const std::size_t next = next_step();
  for (std::size_t i = 0; !dropped.was_seated && i < next; ++i) {
    if (IsSinglePart(steps[i]) && steps[i].occurrence == dropped.occurrence) {
      is_finished_[i] = false;
      is_done_ = false;
      next_step_ = i;
      workers_.front().step = nullptr;  // real hands take parts out, and are the only worker
      return;
    }
  }
}

PersonTask AssemblyRun::MakeTask(const SequenceStep& step) const {
  const Model& model = simulation_->model();
  const Body& body = model.bodies[step.occurrence.index()];
  const spatial::Pose X_BG(CombineMass(model, step).p_BoBcm_B);
  PersonTask task;
  task.occurrence = step.occurrence;
  task.p_BG = X_BG.p();
  task.X_WG_start = physics_.pose(step.occurrence) * X_BG;
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

std::string AssemblyRun::ExplainFailure(const SequenceStep& step, const Worker& worker) const {
  const SimulatedPerson* person = worker.person;
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  if (!dropped) {
    return person != nullptr ? "could not be taken up" : "was not taken up";
  }
  if (const OccurrenceId missing = physics_.FindMissingPartner(step); missing.is_valid()) {
    return fmt::format("{}, which it goes to, is not in its place",
                       simulation_->model().product->occurrences[missing.index()].path);
  }
  const HoldMetrics& metrics = dropped->metrics;
  const std::string depth = metrics.insertion > 0 ? fmt::format(", {:.2f} mm into its hole at most",
                                                                units::ToMm(metrics.insertion))
                                                  : std::string();
  const std::string tries = person != nullptr
                                ? fmt::format("gave up after {} searches", person->searches())
                                : std::string("was let go elsewhere");
  if (!metrics.hardest.is_valid()) {
    return fmt::format("{}{}; nothing was met", tries, depth);
  }
  return fmt::format("{}{}; {} stood in the way with up to {:.1f} N", tries, depth,
                     simulation_->model().product->occurrences[metrics.hardest.index()].path,
                     metrics.hardest_force);
}

void AssemblyRun::FinishStep(const SequenceStep& step, const Worker& worker) {
  const Model& model = simulation_->model();
  PartResult& result = ResultOf(step.occurrence);
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  const bool was_seated = dropped && dropped->was_seated;
  if (dropped) {
    const HoldMetrics& metrics = dropped->metrics;
    result.hand = dropped->hand;
    result.time += 1e-9 * static_cast<double>(dropped->t_ns - metrics.t_taken_ns);
    result.path += metrics.path;
    result.peak_true = std::max(result.peak_true, metrics.peak_true);
    result.peak_felt = std::max(result.peak_felt, metrics.peak_felt);
    result.fit_true = std::max(result.fit_true, metrics.fit_true);
    result.fit_felt = std::max(result.fit_felt, metrics.fit_felt);
    result.deepest = std::max(result.deepest, metrics.deepest);
    result.insertion = std::max(result.insertion, metrics.insertion);
    result.arrival = metrics.arrival;
    result.arrival_angle = metrics.arrival_angle;
  }
  const std::string reason = was_seated ? std::string() : ExplainFailure(step, worker);
  result.reason = reason;
  result.note = DescribeOverlaps(step.occurrence);
  for (const product::MateId id : model.mates_of[step.occurrence.index()]) {
    const product::Mate& mate = model.product->mates[id.index()];
    const OccurrenceId other =
        mate.a.occurrence == step.occurrence ? mate.b.occurrence : mate.a.occurrence;
    const bool is_new = step.kind == SequenceStep::Kind::kInsert && step.members.empty();
    result.mates += is_new && physics_.placement(other) == Placement::kPlaced ? 1 : 0;
  }
  for (const OccurrenceId member : step.members) {
    PartResult& other = ResultOf(member);
    other.reason = reason.empty() ? other.reason : "its subassembly " + reason;
  }
  Update(step.occurrence);
  is_finished_[static_cast<std::size_t>(&step - model.sequence.steps.data())] = true;
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
  result.is_seated = physics_.placement(id) == Placement::kPlaced;
  const spatial::Pose& X_WB = physics_.pose(id);
  const spatial::Pose& X_goal = simulation_->model().bodies[id.index()].X_WB_goal;
  result.pose_error = (X_WB.p() - X_goal.p()).norm();
  result.pose_error_angle = spatial::RotationBetween(X_goal.q(), X_WB.q()).norm();
}

bool AssemblyRun::HasFinished(const Worker& worker) const {
  if (worker.person != nullptr) {
    return worker.person->finished_count() != worker.finished_before;
  }
  // Real ones do as they like: a part may be in its place before its turn comes.
  const OccurrenceId id = worker.step->occurrence;
  const std::optional<SimulationEvent>& dropped = dropped_[id.index()];
  return (dropped && dropped->was_seated) ||
         (IsSinglePart(*worker.step) && physics_.placement(id) == Placement::kPlaced);
}

bool AssemblyRun::IsDoneByAnother(const SequenceStep& step, const Worker& worker) const {
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  return worker.person != nullptr && IsSinglePart(step) && dropped && dropped->was_seated &&
         dropped->hand != worker.hand;
}

bool AssemblyRun::IsInPlaceAlready(const SequenceStep& step) const {
  return IsSinglePart(step) && !dropped_[step.occurrence.index()] &&
         physics_.placement(step.occurrence) == Placement::kPlaced;
}

spatial::Box AssemblyRun::WayIn(const SequenceStep& step) const {
  constexpr double kRoom = 5e-3;  // [m] to each side, for searching and for error
  const Body& body = simulation_->model().bodies[step.occurrence.index()];
  const spatial::Box place = spatial::Transform(body.X_WB_goal, body.shape->box_B());
  const Vec3 way = step.engage_distance * step.extraction_W;
  spatial::Box box = place;
  box.Add(spatial::Box{place.low + way, place.high + way});
  return box.Expanded(kRoom);
}

bool AssemblyRun::CanGoOnBeside(const SequenceStep& step, const Worker& busy) const {
  const bool is_past_carrying = states_[busy.hand] >= haptics::HoldState::kCaptured;
  return is_past_carrying && IsSinglePart(step) && IsSinglePart(*busy.step) &&
         !WayIn(step).Overlaps(WayIn(*busy.step));
}

AssemblyRun::Worker* AssemblyRun::FindWorkerFor(const SequenceStep& step) {
  Worker* free = nullptr;
  for (std::size_t i = 1; i <= workers_.size(); ++i) {
    Worker& worker = workers_[(last_worker_ + i) % workers_.size()];
    if (worker.step == nullptr) {
      free = free == nullptr ? &worker : free;
    } else if (!CanGoOnBeside(step, worker)) {
      return nullptr;
    }
  }
  return free;
}

bool AssemblyRun::Begin(const SequenceStep& step, Worker* worker) {
  // Of a subassembly only that moves which has got into it.
  SequenceStep possible = step;
  std::erase_if(possible.members,
                [this](OccurrenceId id) { return physics_.placement(id) == Placement::kLoose; });
  for (std::size_t hand = 0; hand < simulation_->hand_count(); ++hand) {
    if (worker->person == nullptr || hand == worker->hand) {
      physics_.Prepare(possible, hand);
    }
  }
  if (worker->person != nullptr) {
    dropped_[step.occurrence.index()].reset();
    worker->finished_before = worker->person->finished_count();
    if (!worker->person->Assign(MakeTask(possible))) {
      return false;
    }
  }
  worker->step = &step;
  last_worker_ = static_cast<std::size_t>(worker - workers_.data());
  return true;
}

std::size_t AssemblyRun::next_step() const {
  std::size_t next = next_step_;
  for (const Worker& worker : workers_) {
    if (worker.step != nullptr) {
      const auto& steps = simulation_->model().sequence.steps;
      next = std::min(next, static_cast<std::size_t>(worker.step - steps.data()));
    }
  }
  return next;
}

void AssemblyRun::FinishAll() {
  for (const SequenceGap& gap : simulation_->model().sequence.gaps) {
    ResultOf(gap.occurrence).reason = gap.reason;
  }
  for (const product::Occurrence& occurrence : simulation_->model().product->occurrences) {
    Update(occurrence.id);
  }
  is_done_ = true;
}

void AssemblyRun::Advance() {
  if (is_done_) {
    return;
  }
  for (Worker& worker : workers_) {
    if (worker.step != nullptr && HasFinished(worker)) {
      FinishStep(*std::exchange(worker.step, nullptr), worker);
    }
  }
  const auto& steps = simulation_->model().sequence.steps;
  for (; next_step_ < std::min(end_step_, steps.size()); ++next_step_) {
    const SequenceStep& step = steps[next_step_];
    if (is_finished_[next_step_] || IsInPlaceAlready(step)) {
      continue;
    }
    Worker* worker = FindWorkerFor(step);
    if (worker == nullptr) {
      return;
    }
    if (step.kind == SequenceStep::Kind::kBase || next_step_ < first_step_) {
      physics_.PlaceInFixture(step.occurrence);
      Update(step.occurrence);
      ResultOf(step.occurrence).note = DescribeOverlaps(step.occurrence);
    } else if (IsDoneByAnother(step, *worker)) {
      FinishStep(step, *worker);
    } else if (!Begin(step, worker)) {
      return;
    }
  }
  const bool is_idle = std::all_of(workers_.begin(), workers_.end(),
                                   [](const Worker& worker) { return worker.step == nullptr; });
  if (is_idle) {
    FinishAll();
  }
}

spatial::Pose StartOfHand(const Model& model) {
  return spatial::Pose(model.centre_W + Vec3(0, 0, 1.1 * model.transfer_radius));
}

}  // namespace hvas::simulation
