#include "simulation/assembly_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "sequence/extraction.h"
#include "simulation/table_subassembly.h"

namespace hvas::simulation {

using product::OccurrenceId;

namespace {

/** Whether a part hangs together with the base, or with a fixture, through neighbours. */
bool IsConnectedWithBase(const Model& model, OccurrenceId id) {
  std::vector<OccurrenceId> all;
  for (const Body& body : model.bodies) {
    all.push_back(body.occurrence);
  }
  const auto connected = sequence::ListConnected(id, all, model.sequence.neighbours);
  const OccurrenceId base = sequence::FindBase(model.sequence);
  return std::any_of(connected.begin(), connected.end(), [&](OccurrenceId other) {
    return other == base || model.bodies[other.index()].role == BodyRole::kFixture;
  });
}

bool IsSinglePart(const sequence::SequenceStep& step) {
  return step.kind == sequence::SequenceStep::Kind::kInsert && step.members.empty();
}

}  // namespace

AssemblyRun::AssemblyRun(Simulation* simulation, const TaskOperators& movers, Sink* downstream)
    : PartRun(simulation, downstream), passages_(simulation->model()) {
  for (std::size_t hand = 0; hand < movers.size(); ++hand) {
    if (movers[hand] != nullptr) {
      workers_.push_back({movers[hand], hand, nullptr, 0});
    }
  }
  if (workers_.empty()) {
    workers_.emplace_back();
  }
  last_worker_ = workers_.size() - 1;
  turns_.resize(model().sequence.steps.size());
}

void AssemblyRun::OnDropped(const SimulationEvent& dropped) {
  if (dropped.was_seated || physics().placement(dropped.occurrence) == Placement::kParked) {
    return;
  }
  // What was put together on the table comes out together.
  const std::vector<OccurrenceId> out = ListTogether(physics().parts(), dropped.occurrence);
  const auto& steps = model().sequence.steps;
  const std::size_t next = next_step();
  for (std::size_t i = next; i-- > 0;) {
    if (IsSinglePart(steps[i]) &&
        std::find(out.begin(), out.end(), steps[i].occurrence) != out.end() &&
        physics().placement(steps[i].occurrence) != Placement::kPlaced) {
      turns_[i].is_finished = false;
      is_done_ = false;
      next_step_ = i;
      workers_.front().step = nullptr;  // real hands take parts out, and are the only worker
    }
  }
}

OccurrenceId AssemblyRun::LeaderOf(OccurrenceId id) const {
  return physics().parts()[id.index()].leader;
}

const std::optional<SimulationEvent>& AssemblyRun::DropOf(OccurrenceId id) const {
  const OccurrenceId leader = LeaderOf(id);
  return dropped_[leader.is_valid() ? leader.index() : id.index()];
}

std::string AssemblyRun::DescribeWhere(const SimulationEvent& dropped) {
  const Vec3 p_mm = units::ToMm(1.0) * dropped.X_WB.p();
  std::string text = fmt::format(" at {:.2f} {:.2f} {:.2f} mm", p_mm.x(), p_mm.y(), p_mm.z());
  const PassageWatch::Touch touch = passages_.FindTouch(
      physics(), dropped.occurrence, dropped.X_WB,
      dropped.metrics.hardest.is_valid() ? OccurrenceId(dropped.metrics.hardest.index())
                                         : OccurrenceId());
  if (touch.other.is_valid() && touch.own_face != contact::kNoFace &&
      touch.other_face != contact::kNoFace) {
    text += fmt::format(", its face {} at face {} of {}", touch.own_face, touch.other_face,
                        PathOf(touch.other));
  }
  return text;
}

std::string AssemblyRun::ExplainFailure(const sequence::SequenceStep& step, const Worker& worker) {
  const TaskOperator* mover = worker.mover;
  const std::optional<SimulationEvent>& dropped = DropOf(step.occurrence);
  if (!dropped && mover == nullptr) {
    return "was not taken up";
  }
  if (const OccurrenceId missing = physics().FindMissingPartner(step); missing.is_valid()) {
    return fmt::format("{}, which it goes to, is not in its place", PathOf(missing));
  }
  if (!dropped) {
    return "could not be taken up";
  }
  const HoldMetrics& metrics = dropped->metrics;
  const std::string depth = metrics.insertion > 0 ? fmt::format(", {:.2f} mm into its hole at most",
                                                                units::ToMm(metrics.insertion))
                                                  : std::string();
  const std::string tries =
      mover != nullptr ? mover->DescribeEffort() : std::string("was let go elsewhere");
  const char* crossed = metrics.is_thread_crossed ? ", with its thread crossed" : "";
  return fmt::format("{}{}{}{}; {}", tries, mover != nullptr ? DescribeWhere(*dropped) : "", depth,
                     crossed, DescribeHardest(metrics));
}

std::size_t AssemblyRun::IndexOf(const sequence::SequenceStep& step) const {
  return static_cast<std::size_t>(&step - model().sequence.steps.data());
}

std::string AssemblyRun::FinishTurn(const sequence::SequenceStep& step, const Worker& worker,
                                    bool was_seated) {
  Turn& turn = turns_[IndexOf(step)];
  turn.is_finished = true;
  if (was_seated) {
    const bool is_unit =
        !step.members.empty() && step.kind == sequence::SequenceStep::Kind::kInsert;
    const std::size_t leader = step.occurrence.index();
    has_touched_[leader] = is_unit ? CountNeighboursInPlace(step) > 0 : has_touched_[leader];
    return {};
  }
  if (turn.tries <= 1) {
    return ExplainFailure(step, worker);
  }
  return fmt::format("{}; tried {} times", turn.reason, turn.tries);
}

std::string AssemblyRun::ExplainUntouched(OccurrenceId id) const {
  if (model().sequence.neighbours[id.index()].empty()) {
    return CountParts(model()) > 1 ? "touches no other part as drawn" : "";
  }
  if (has_touched_[id.index()] || physics().placement(id) != Placement::kPlaced) {
    return {};
  }
  return IsConnectedWithBase(model(), id)
             ? "nothing that it touches was in its place when it was put in"
             : "it is not connected with the base as drawn, nor is what it touches";
}

std::string AssemblyRun::ExplainPassage(const PartResult& result) const {
  constexpr double kTold = 0.2e-3;  // [m]; less is what clearances and stretched contacts leave
  const Passage& passage = result.passage;
  double given = 0;
  for (const PartAllowance& allowance : result.allowances) {
    const bool is_met = allowance.own == passage.through || allowance.other == passage.through;
    given = is_met && allowance.kind == PartAllowance::Kind::kGive ? allowance.depth : given;
  }
  return passage.depth > given + kTold
             ? fmt::format("went through {}, {:.2f} mm deeper than drawn", PathOf(passage.through),
                           units::ToMm(passage.depth))
             : std::string();
}

std::string AssemblyRun::DescribeAside(OccurrenceId id) const {
  const sequence::SequenceStep* aside = sequence::FindAside(model().sequence, id);
  if (aside == nullptr || physics().placement(id) != Placement::kPlaced) {
    return {};
  }
  const std::string& moved = PathOf(aside->occurrence);
  return aside->way.empty() ? fmt::format("goes in while {} is moved aside by {:.1f} mm", moved,
                                          units::ToMm(aside->engage_distance))
                            : fmt::format("goes in while {} is turned aside", moved);
}

std::string AssemblyRun::DescribePress(const PartResult& result) {
  return result.needs_press()
             ? fmt::format("needs a press: {:.3g} N, more than the {:.0f} N of a hand",
                           result.fit_true, kMostHandForce)
             : std::string();
}

std::string AssemblyRun::MakeNote(const PartResult& result) const {
  std::string note;
  for (const std::string& item : {DescribePress(result), DescribeAllowances(result.allowances),
                                  DescribePresses(result.presses), DescribeAside(result.occurrence),
                                  ExplainUntouched(result.occurrence), ExplainPassage(result)}) {
    note += (note.empty() || item.empty() ? "" : "; ") + item;
  }
  return note;
}

bool AssemblyRun::TryAgain(const sequence::SequenceStep& step, Worker* worker) {
  Turn& turn = turns_[IndexOf(step)];
  const std::optional<SimulationEvent>& dropped = DropOf(step.occurrence);
  const bool has_failed =
      step.kind == sequence::SequenceStep::Kind::kInsert && dropped && !dropped->was_seated;
  if (!has_failed || worker->mover == nullptr || turn.tries >= worker->mover->most_tries()) {
    return false;
  }
  turn.reason = turn.tries == 1 ? ExplainFailure(step, *worker) : turn.reason;
  ResultOf(step.occurrence).reason = turn.reason;  // In case that the run ends within its turn.
  AddHold(step.occurrence);
  return Begin(step, worker);
}

void AssemblyRun::AssumeStep(const sequence::SequenceStep& step) {
  for (const OccurrenceId id : sequence::UnitOf(step)) {
    Assume(id);
    Update(id);
  }
}

void AssemblyRun::FinishStep(const sequence::SequenceStep& step, const Worker& worker) {
  const Model& model = this->model();
  PartResult& result = ResultOf(step.occurrence);
  const std::optional<SimulationEvent>& dropped = DropOf(step.occurrence);
  const bool was_seated = dropped && dropped->was_seated;
  AddHold(step.occurrence);
  const std::string reason = FinishTurn(step, worker, was_seated);
  result.reason = reason;
  if (step.kind != sequence::SequenceStep::Kind::kAside) {
    result.allowances = was_seated ? ListPartAllowances(step) : std::vector<PartAllowance>();
    result.presses = was_seated ? ListPresses(step) : std::vector<PressedPair>();
  }
  result.passage = passages_.passage(step.occurrence);
  result.note = MakeNote(result);
  int mates = 0;
  for (const product::MateId id : model.mates_of[step.occurrence.index()]) {
    const product::Mate& mate = model.product->mates[id.index()];
    const OccurrenceId other =
        mate.a.occurrence == step.occurrence ? mate.b.occurrence : mate.a.occurrence;
    mates += physics().placement(other) == Placement::kPlaced ? 1 : 0;
  }
  result.mates = IsSinglePart(step) ? mates : result.mates;
  for (const OccurrenceId member : step.members) {
    PartResult& other = ResultOf(member);
    other.reason = reason.empty() ? other.reason : "its subassembly " + reason;
  }
  if (!was_seated && worker.mover != nullptr &&
      step.kind == sequence::SequenceStep::Kind::kInsert) {
    AssumeStep(step);
  }
  Update(step.occurrence);
  TellPart(step.occurrence, dropped ? dropped->t_ns : 0);
}

void AssemblyRun::TellPart(OccurrenceId id, std::int64_t t_ns) {
  if (on_part) {
    const auto seated = std::count_if(results_.begin(), results_.end(),
                                      [](const PartResult& part) { return part.is_seated; });
    on_part({results_.size(), static_cast<std::size_t>(seated), CountParts(model()), t_ns},
            ResultOf(id));
  }
}

bool AssemblyRun::HasFinished(const Worker& worker) const {
  if (worker.mover != nullptr) {
    return worker.mover->finished_count() != worker.finished_before;
  }
  // Real ones do as they like: a part may be in its place before its turn comes.
  const OccurrenceId id = worker.step->occurrence;
  if (sequence::IsWithinProduct(worker.step->kind)) {
    return IsInVain(*worker.step);
  }
  const std::optional<SimulationEvent>& dropped = dropped_[id.index()];
  return (dropped && dropped->was_seated) ||
         (IsSinglePart(*worker.step) && physics().placement(id) == Placement::kPlaced);
}

bool AssemblyRun::IsDoneByAnother(const sequence::SequenceStep& step, const Worker& worker) const {
  const std::optional<SimulationEvent>& dropped = dropped_[step.occurrence.index()];
  return worker.mover != nullptr && IsSinglePart(step) && dropped && dropped->was_seated &&
         dropped->hand != worker.hand;
}

bool AssemblyRun::IsInPlaceAlready(const sequence::SequenceStep& step) const {
  return IsSinglePart(step) && !dropped_[step.occurrence.index()] &&
         physics().placement(step.occurrence) == Placement::kPlaced;
}

bool AssemblyRun::IsInVain(const sequence::SequenceStep& step) const {
  // The order has the part that passes after each one that goes aside.
  return HasNothingToMove(step) ||
         (step.kind == sequence::SequenceStep::Kind::kAside &&
          physics().placement((&step + 1)->occurrence) == Placement::kPlaced);
}

spatial::Box AssemblyRun::WayIn(const sequence::SequenceStep& step) const {
  constexpr double kRoom = 5e-3;  // [m] to each side, for searching and for error
  const Body& body = model().bodies[step.occurrence.index()];
  const spatial::Box place = spatial::Transform(body.X_WB_goal, body.shape->box_B());
  const Vec3 way = step.engage_distance * step.extraction_W;
  spatial::Box box = place;
  box.Add(spatial::Box{place.low + way, place.high + way});
  for (const spatial::Pose& X_WB : step.way) {
    box.Add(spatial::Transform(X_WB, body.shape->box_B()));
  }
  return box.Expanded(kRoom);
}

bool AssemblyRun::CanGoOnBeside(const sequence::SequenceStep& step, const Worker& busy) const {
  const bool is_past_carrying = states_[busy.hand] >= haptics::HoldState::kCaptured;
  return is_past_carrying && IsSinglePart(step) && IsSinglePart(*busy.step) &&
         !WayIn(step).Overlaps(WayIn(*busy.step));
}

AssemblyRun::Worker* AssemblyRun::FindWorkerFor(const sequence::SequenceStep& step) {
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

bool AssemblyRun::Begin(const sequence::SequenceStep& step, Worker* worker) {
  // Of a subassembly only that moves which has got into it.
  sequence::SequenceStep possible = step;
  std::erase_if(possible.members,
                [this](OccurrenceId id) { return physics().placement(id) == Placement::kLoose; });
  if (IsSinglePart(step) && LeaderOf(step.occurrence).is_valid()) {
    possible = MakeTableStep(model(), physics().parts(), step.occurrence, TakeExtent::kWhole);
  }
  for (std::size_t hand = 0; hand < hand_count(); ++hand) {
    if (worker->mover == nullptr || hand == worker->hand) {
      physics().Prepare(possible, hand);
    }
  }
  if (worker->mover != nullptr) {
    dropped_[possible.occurrence.index()].reset();
    worker->finished_before = worker->mover->finished_count();
    if (!worker->mover->Assign(MakeTask(possible))) {
      return false;
    }
  }
  Turn& turn = turns_[IndexOf(step)];
  turn.is_finished = false;
  turn.tries += worker->mover != nullptr ? 1 : 0;
  worker->step = &step;
  last_worker_ = static_cast<std::size_t>(worker - workers_.data());
  return true;
}

std::size_t AssemblyRun::next_step() const {
  std::size_t next = next_step_;
  for (const Worker& worker : workers_) {
    if (worker.step != nullptr) {
      next = std::min(next, IndexOf(*worker.step));
    }
  }
  return next;
}

void AssemblyRun::FinishAll() {
  for (const sequence::SequenceGap& gap : model().sequence.gaps) {
    ResultOf(gap.occurrence).reason = gap.reason;
  }
  for (const Body& body : model().bodies) {
    if (body.role == BodyRole::kPart) {
      Update(body.occurrence);
    }
  }
  is_done_ = true;
}

bool AssemblyRun::DoNext(const sequence::SequenceStep& step) {
  if (turns_[next_step_].is_finished || IsInPlaceAlready(step)) {
    return true;
  }
  Worker* worker = FindWorkerFor(step);
  if (worker == nullptr) {
    return false;
  }
  if (IsInVain(step)) {
    return true;
  }
  if (step.kind == sequence::SequenceStep::Kind::kAssume) {
    ResultOf(step.occurrence).reason = sequence::FindGapReason(model().sequence, step.occurrence);
    AssumeStep(step);
    return true;
  }
  if (step.kind == sequence::SequenceStep::Kind::kBase || next_step_ < first_step_) {
    physics().PlaceInFixture(step.occurrence);
    has_touched_[step.occurrence.index()] = true;
    Update(step.occurrence);
    ResultOf(step.occurrence).note = MakeNote(ResultOf(step.occurrence));
    return true;
  }
  const bool is_refused = worker->mover != nullptr &&
                          step.kind == sequence::SequenceStep::Kind::kInsert &&
                          physics().FindMissingPartner(step).is_valid();
  if (is_refused || IsDoneByAnother(step, *worker)) {
    FinishStep(step, *worker);
    return true;
  }
  return Begin(step, worker);
}

void AssemblyRun::Advance() {
  if (is_done_) {
    return;
  }
  for (std::size_t hand = 0; hand < hand_count(); ++hand) {
    passages_.Look(physics(), hand);
  }
  for (Worker& worker : workers_) {
    if (worker.step != nullptr && HasFinished(worker) && !TryAgain(*worker.step, &worker)) {
      FinishStep(*std::exchange(worker.step, nullptr), worker);
    }
  }
  const auto& steps = model().sequence.steps;
  for (; next_step_ < std::min(end_step_, steps.size()); ++next_step_) {
    if (!DoNext(steps[next_step_])) {
      return;
    }
  }
  const bool is_idle = std::all_of(workers_.begin(), workers_.end(),
                                   [](const Worker& worker) { return worker.step == nullptr; });
  if (is_idle) {
    FinishAll();
  }
}

}  // namespace hvas::simulation
