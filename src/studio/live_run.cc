#include "studio/live_run.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/clock.h"

namespace hvas::studio {
namespace {

using simulation::Placement;

constexpr std::int64_t kFrameNs = 16'666'667;  // what screens show
constexpr double kForEver = 1e9;               // [s]

}  // namespace

haptics::TickOptions MakePointerOptions(double rate_hz) {
  constexpr double kModelHold = 0.2;  // [s]; as with a device
  haptics::TickOptions options;
  options.dt = 1 / rate_hz;
  options.device.name = "pointer";
  options.limits = haptics::MakeSafetyLimits(options.device);
  // There are no motors to be kept cool, and no handle that could kick or be torn away.
  options.limits->has_detectors = false;
  options.limits->continuous_force = haptics::SafetyLimits::kNever;
  options.limits->continuous_torque = haptics::SafetyLimits::kNever;
  options.limits->fade_speed = haptics::SafetyLimits::kNever;
  options.limits->cut_speed = haptics::SafetyLimits::kNever;
  options.limits->model_hold = kModelHold;
  options.limits->client_hold = 1e-9 * static_cast<double>(PointerOperator::kSilentNs);
  options.limits->client_fade = 0.25;
  return options;
}

LiveRun::LiveRun(std::shared_ptr<const simulation::Model> model, const LiveState& start,
                 const LiveOptions& options, LiveListeners listeners)
    : listeners_(std::move(listeners)),
      simulation_(std::move(model), MakePointerOptions(options.rate_hz)),
      pointer_(options.X_WH),
      person_(options.has_person ? std::make_unique<simulation::SimulatedPerson>(
                                       simulation::PersonOptions(), options.seed, options.X_WH)
                                 : nullptr),
      assembly_(&simulation_, person_.get(), this) {
  if (!start.parts.empty()) {
    simulation_.Restore(start.parts);
  }
  assembly_.Resume(start.next_step);
  observed_ = {simulation_.parts(), start.next_step};
  thread_ = std::thread([this, options] { Run(options); });
}

LiveRun::~LiveRun() {
  is_stopping_ = true;
  thread_.join();
}

void LiveRun::Run(const LiveOptions& options) {
  simulation::Operator* hand = person_ != nullptr
                                   ? static_cast<simulation::Operator*>(person_.get())
                                   : static_cast<simulation::Operator*>(&pointer_);
  simulation::FlightRecorder flight(options.rate_hz);
  simulation::Execution execution = assembly_.MakeExecution(hand, kForEver);
  execution.advance = [this] { Advance(); };
  execution.is_done = [this] { return is_stopping_.load(); };
  execution.flight = &flight;
  execution.frame_ns = kFrameNs;
  execution.status = &status_;
  execution.on_frame = [this](const simulation::Frame& frame) {
    listeners_.on_frame(frame, peak_felt_.exchange(0));
  };
  (void)simulation::RunRealtime(execution);
}

void LiveRun::Take(const simulation::SequenceStep& step, const spatial::Pose& X_WH) {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back([this, step, X_WH] {
    simulation_.Prepare(step);
    pointer_.Move({MonotonicNs(), X_WH, true});
  });
}

void LiveRun::Move(const spatial::Pose& X_WH, bool is_gripping) {
  const std::lock_guard lock(mutex_);
  pointer_.Move({MonotonicNs(), X_WH, is_gripping});
}

LiveState LiveRun::state() const {
  const std::lock_guard lock(mutex_);
  return observed_;
}

bool LiveRun::is_holding() const {
  const std::lock_guard lock(mutex_);
  return is_holding_;
}

std::optional<simulation::LoopStatus> LiveRun::TakeStatus() {
  return status_.Update() ? std::optional(status_.value()) : std::nullopt;
}

void LiveRun::OnTick(std::size_t hand, const device::DeviceState& device,
                     const haptics::TickOutput& out) noexcept {
  (void)hand;
  (void)device;
  const double felt = out.F_H_W.f.norm();
  if (felt > peak_felt_.load(std::memory_order_relaxed)) {
    peak_felt_.store(felt, std::memory_order_relaxed);
  }
}

void LiveRun::OnEvent(const simulation::SimulationEvent& event) {
  listeners_.on_event(event);
}

void LiveRun::Advance() {
  {
    const std::lock_guard lock(mutex_);
    for (const auto& task : tasks_) {
      task();
    }
    tasks_.clear();
  }
  assembly_.Advance();
  Observe();
}

void LiveRun::Observe() {
  LiveState now{simulation_.parts(), assembly_.next_step()};
  LiveState before;
  {
    const std::lock_guard lock(mutex_);
    before = std::exchange(observed_, now);
    is_holding_ = std::any_of(now.parts.begin(), now.parts.end(),
                              [](const auto& part) { return part.placement == Placement::kHeld; });
  }
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    if (before.parts[i].placement != now.parts[i].placement) {
      listeners_.on_placement(product::OccurrenceId(i), now.parts[i].placement);
    }
  }
  if (before.next_step != now.next_step) {
    listeners_.on_step(now.next_step);
  }
}

}  // namespace hvas::studio
