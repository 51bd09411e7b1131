#include "studio/live_run.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/clock.h"
#include "base/clock_place.h"
#include "studio/next_step.h"

namespace hvas::studio {
namespace {

using simulation::Placement;

constexpr std::int64_t kFrameNs = 16'666'667;  // frame period of displays at 60 Hz
constexpr double kForEver = 1e9;               // [s], thirty years.

std::vector<std::unique_ptr<LiveHand>> MakeHands(const LiveOptions& options,
                                                 const simulation::Model& model) {
  std::vector<std::unique_ptr<LiveHand>> hands;
  for (const HandSetup& setup : options.hands) {
    const HandPurpose purpose{options.has_person,
                              person::SeedOfHand(options.seed, hands.size()),
                              simulation::StartOfHand(model),
                              options.rate_hz,
                              options.trial.get(),
                              options.guidance,
                              options.clock};
    hands.push_back(std::make_unique<LiveHand>(setup, purpose, model));
  }
  return hands;
}

std::vector<haptics::TickOptions> TicksOf(const std::vector<std::unique_ptr<LiveHand>>& hands) {
  std::vector<haptics::TickOptions> ticks;
  ticks.reserve(hands.size());
  for (const auto& hand : hands) {
    ticks.push_back(hand->tick_options());
  }
  return ticks;
}

simulation::TaskOperators MoversOf(const std::vector<std::unique_ptr<LiveHand>>& hands) {
  simulation::TaskOperators persons{};
  for (std::size_t i = 0; i < hands.size(); ++i) {
    persons[i] = hands[i]->person();
  }
  return persons;
}

simulation::Operators OperatorsOf(const std::vector<std::unique_ptr<LiveHand>>& hands) {
  simulation::Operators operators{};
  for (std::size_t i = 0; i < hands.size(); ++i) {
    operators[i] = hands[i]->active();
  }
  return operators;
}

PeakForces TakePeaks(std::array<std::atomic<double>, haptics::kMaxHands>* peaks) {
  PeakForces taken;
  std::transform(peaks->begin(), peaks->end(), taken.begin(),
                 [](std::atomic<double>& peak) { return peak.exchange(0); });
  return taken;
}

bool IsHeld(const simulation::PartState& part) {
  return part.placement == Placement::kHeld;
}

}  // namespace

LiveState MakeStart(const simulation::Model& model) {
  LiveState state;
  for (const simulation::Body& body : model.bodies) {
    const Placement placement = simulation::BeginningOf(body.role);
    state.parts.push_back(
        {placement, placement == Placement::kPlaced ? body.X_WB_goal : body.X_WB_start});
  }
  return state;
}

LiveRun::LiveRun(std::shared_ptr<const simulation::Model> model, const LiveState& start,
                 const LiveOptions& options, LiveListeners listeners)
    : clock_(options.clock),
      listeners_(std::move(listeners)),
      recording_(options.recording),
      trial_(options.trial),
      hands_(MakeHands(options, *model)),
      simulation_(std::make_unique<simulation::Simulation>(std::move(model), TicksOf(hands_))),
      assembly_(simulation_.get(), MoversOf(hands_), this),
      plan_(options.disassembly),
      begin_ns_(MonotonicNs()) {
  if (!start.parts.empty()) {
    simulation_->Restore(start.parts);
  }
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (trial_ == nullptr && !options.has_person) {
      simulation_->physics().AllowJoining(i);
    }
    if (!hands_[i]->follows_pointer()) {
      simulation_->physics().AwaitOpenGrip(i);
      if (trial_ == nullptr) {
        simulation_->physics().AllowTakingOut(i);
      }
    }
  }
  if (recording_ != nullptr) {
    recording_->Begin(simulation_.get());
  }
  if (trial_ != nullptr) {
    trial_->Begin(simulation_.get());
  }
  simulation_->StopForces(options.forces_off);
  assembly_.Resume(start.next_step);
  if (plan_ != nullptr) {
    simulation::Sink* const downstream = this;
    disassembly_.emplace(simulation_.get(), plan_.get(), hands_.front()->person(), downstream);
    disassembly_->on_part = [this](const simulation::AssemblyProgress& progress,
                                   const simulation::PartResult& /*part*/) {
      listeners_.on_removal(progress.tried == progress.total);
    };
  }
  observed_ = {simulation_->physics().parts(), start.next_step};
  clock_->Enter();  // here: its time may not pass before the thread has begun
  thread_ = std::thread([this, options] {
    const ClockPlace place(clock_);
    Run(options);
  });
}

LiveRun::~LiveRun() {
  is_stopping_ = true;
  clock_->WakeAll();
  thread_.join();
}

void LiveRun::Run(const LiveOptions& options) {
  simulation::FlightRecorder flight(options.rate_hz, hands_.size());
  simulation::Execution execution = part_run().MakeExecution(OperatorsOf(hands_), kForEver);
  execution.advance = [this] { Advance(); };
  execution.is_done = [this] { return is_stopping_.load(); };
  execution.flight = &flight;
  execution.clock = clock_;
  execution.frame_ns = kFrameNs;
  execution.status = &status_;
  execution.on_frame = [this](const simulation::Frame& frame) {
    listeners_.on_frame(frame, begin_ns_.load(std::memory_order_relaxed) + frame.t_ns,
                        TakePeaks(&peak_felt_));
  };
  (void)simulation::RunRealtime(execution);
}

void LiveRun::Take(std::size_t hand, const sequence::SequenceStep& step,
                   const spatial::Pose& X_WH) {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this, hand, step, X_WH] {
    simulation_->physics().Prepare(step, hand);
    MovePointer(hand, X_WH, true);
  });
}

void LiveRun::Help(std::size_t hand, std::size_t other, const spatial::Pose& X_WH) {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this, hand, other, X_WH] {
    simulation_->physics().PrepareHelp(other, hand);
    MovePointer(hand, X_WH, true);
  });
}

void LiveRun::Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping) {
  const std::lock_guard lock(mutex_);
  if (tasks_.empty()) {
    MovePointer(hand, X_WH, is_gripping);
    return;
  }
  // The hand closes only after the take is prepared; it would take another part, or none.
  tasks_.emplace_back([this, hand, X_WH, is_gripping] { MovePointer(hand, X_WH, is_gripping); });
}

void LiveRun::MovePointer(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping) {
  const std::int64_t now_ns = clock_->NowNs();
  moved_ns_[hand] = now_ns;
  hands_[hand]->pointer().Move({now_ns, X_WH, is_gripping});
}

std::optional<std::int64_t> LiveRun::FindOldestInput() const {
  std::optional<std::int64_t> oldest;
  for (std::size_t hand = 0; hand < hands_.size(); ++hand) {
    if (hands_[hand]->follows_pointer() && is_holding(hand)) {
      oldest = std::min(oldest.value_or(moved_ns_[hand]), moved_ns_[hand].load());
    }
  }
  return oldest;
}

void LiveRun::HandOver(std::size_t from, std::size_t to, product::OccurrenceId id) {
  constexpr std::int64_t kPatienceNs = 500'000'000;  // To let go takes two physics steps: a choice.
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this, from, to, id] {
    MovePointer(from, spatial::Pose(), false);
    passing_ = Passing{to, id, clock_->NowNs() + kPatienceNs};
  });
}

void LiveRun::Catch() {
  if (!passing_) {
    return;
  }
  const simulation::PartState& part = observed_.parts[passing_->id.index()];
  if (part.placement == Placement::kHeld && clock_->NowNs() < passing_->give_up_ns) {
    return;
  }
  if (part.placement == Placement::kLoose) {
    const sequence::SequenceStep step =
        FindStep(model(), observed_, passing_->id, simulation::TakeExtent::kWhole);
    const Vec3 p_BoBcm_B = simulation::CombineMass(model(), step).p_BoBcm_B;
    simulation_->physics().Prepare(step, passing_->to);
    MovePointer(passing_->to, spatial::Pose(part.X_WB * p_BoBcm_B), true);
  }
  passing_.reset();
}

LiveState LiveRun::state() const {
  const std::lock_guard lock(mutex_);
  return observed_;
}

bool LiveRun::is_holding(std::size_t hand) const {
  const std::lock_guard lock(mutex_);
  return is_holding_[hand];
}

LiveState LiveRun::state_before_take() const {
  const std::lock_guard lock(mutex_);
  return before_take_;
}

std::optional<simulation::LoopStatus> LiveRun::TakeStatus() {
  return status_.Update() ? std::optional(status_.value()) : std::nullopt;
}

void LiveRun::OnTick(std::size_t hand, const device::DeviceState& device,
                     const haptics::TickOutput& out) noexcept {
  if (recording_ != nullptr) {
    recording_->OnTick(hand, device, out);
  }
  if (trial_ != nullptr) {
    trial_->OnTick(hand, device, out);
  }
  begin_ns_.store(MonotonicNs() - device.t_ns, std::memory_order_relaxed);
  const double felt = out.F_H_W.f.norm();
  if (felt > peak_felt_[hand].load(std::memory_order_relaxed)) {
    peak_felt_[hand].store(felt, std::memory_order_relaxed);
  }
}

void LiveRun::OnEvent(const simulation::SimulationEvent& event) {
  if (recording_ != nullptr) {
    recording_->OnEvent(event);
  }
  if (trial_ != nullptr) {
    trial_->OnEvent(event);
  }
  listeners_.on_event(event);
}

void LiveRun::OnFlight(const std::vector<simulation::FlightTick>& ticks) {
  if (recording_ != nullptr) {
    recording_->OnFlight(ticks);
  }
  if (trial_ != nullptr) {
    trial_->OnFlight(ticks);
  }
}

void LiveRun::Advance() {
  {
    const std::lock_guard lock(mutex_);
    for (const auto& task : tasks_) {
      task();
    }
    tasks_.clear();
  }
  part_run().Advance();
  Observe();
  Catch();
}

simulation::PartRun& LiveRun::part_run() {
  return disassembly_ ? static_cast<simulation::PartRun&>(*disassembly_) : assembly_;
}

std::size_t LiveRun::FindNextStep(const std::vector<simulation::PartState>& parts) const {
  if (!disassembly_) {
    return assembly_.next_step();
  }
  using Kind = sequence::SequenceStep::Kind;
  const auto& steps = model().sequence.steps;
  const auto open = std::find_if(steps.begin(), steps.end(), [&parts](const auto& step) {
    return (step.kind == Kind::kBase || step.kind == Kind::kInsert) &&
           parts[step.occurrence.index()].placement != Placement::kPlaced;
  });
  return static_cast<std::size_t>(open - steps.begin());
}

void LiveRun::Observe() {
  LiveState now{simulation_->physics().parts(), 0};
  now.next_step = FindNextStep(now.parts);
  LiveState before;
  {
    const std::lock_guard lock(mutex_);
    before = std::exchange(observed_, now);
    for (std::size_t hand = 0; hand < hands_.size(); ++hand) {
      is_holding_[hand] = simulation_->physics().is_holding(hand);
    }
    const bool has_closed =
        !std::equal(now.parts.begin(), now.parts.end(), before.parts.begin(),
                    [](const auto& a, const auto& b) { return !IsHeld(a) || IsHeld(b); });
    before_take_ = has_closed ? before : before_take_;
  }
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    if (before.parts[i].placement != now.parts[i].placement ||
        before.parts[i].leader != now.parts[i].leader) {
      listeners_.on_placement(product::OccurrenceId(i), now.parts[i]);
    }
  }
  if (before.next_step != now.next_step) {
    listeners_.on_step(now.next_step);
  }
}

}  // namespace hvas::studio
