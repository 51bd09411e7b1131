#include "simulation/executors.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "spatial/rounding.h"

namespace hvas::simulation {
namespace {

/** Session time of a tick [ns]. */
std::int64_t PeriodOf(const Simulation& simulation) {
  return std::llround(1e9 * simulation.options().dt);
}

/** A tick after which the last second is worth keeping. */
bool IsFault(const device::DeviceState& before, std::uint32_t actions_before,
             const device::DeviceState& device, const haptics::TickOutput& out) noexcept {
  // What the flight recorder is for.
  constexpr std::uint32_t kFaults = haptics::kGateNotFinite | haptics::kGateLateModel |
                                    haptics::kGateLostClient | haptics::kGateNoDevice |
                                    haptics::kGateStopped | haptics::kGateBuzz | haptics::kGateKick;
  const std::uint32_t begun = out.gate_actions & ~actions_before;
  return (begun & kFaults) != 0 ||
         (device.condition != before.condition && device::IsFault(device.condition));
}

/** What the loop remembers of one hand from tick to tick. */
struct HandInLoop {
  Operator* person{nullptr};
  haptics::TickOutput last;
  haptics::HoldState state_before{haptics::HoldState::kEmpty};
  device::DeviceState device_before;
  std::uint32_t actions_before{0};
};

OperatorInput MakeInput(HandInLoop* hand, std::int64_t t_ns, std::int64_t period_ns) noexcept {
  const haptics::TickOutput& last = hand->last;
  OperatorInput input;
  input.t_ns = t_ns;
  input.dt = 1e-9 * static_cast<double>(period_ns);
  input.F_H_D = last.F_H_D;
  input.hears_seated = last.state == haptics::HoldState::kSeated;
  input.hears_capture = last.state == haptics::HoldState::kCaptured &&
                        hand->state_before != haptics::HoldState::kCaptured;
  input.sees_part = last.occurrence.is_valid();
  input.X_WD = last.X_WD;
  input.X_WH = last.X_WH;
  input.workspace = last.workspace;
  hand->state_before = last.state;
  return input;
}

/** The haptic loop's body, the same in both executors. */
class HapticLoop {
 public:
  HapticLoop(const Execution& execution, ExecutionReport* report)
      : execution_(execution),
        haptics_(execution.simulation->haptics()),
        report_(report),
        period_ns_(PeriodOf(*execution.simulation)),
        shedder_(period_ns_) {
    hands_[0].person = execution.hand;
    hands_[1].person = execution.second_hand;
    for (std::size_t i = 0; i < hand_count(); ++i) {
      haptics::TickOutput& last = hands_[i].last;
      last.workspace = haptics_.options(i).workspace.mapping;
      last.X_WH = last.workspace.X_WD;
    }
  }

  /** Every hand once; returns how long they computed [ns].
   @param wake_up_ns  How late the tick begins; 0 in virtual time. */
  std::int64_t Tick(std::int64_t wake_up_ns) noexcept {
    std::int64_t compute_ns = 0;
    for (std::size_t i = 0; i < hand_count(); ++i) {
      compute_ns += TickHand(i, wake_up_ns);
    }
    report_->compute.Add(compute_ns);
    report_->overruns += compute_ns > period_ns_ ? 1 : 0;
    if (execution_.sheds_load) {
      ++report_->ticks_at_level[static_cast<std::size_t>(shedder_.level())];
      haptics_.SetEffortLevel(shedder_.Update(compute_ns));
    }
    ++report_->ticks;
    t_ns_ += period_ns_;
    return compute_ns;
  }

  [[nodiscard]] int effort_level() const noexcept { return shedder_.level(); }

  [[nodiscard]] std::int64_t t_ns() const noexcept { return t_ns_; }

 private:
  [[nodiscard]] std::size_t hand_count() const noexcept {
    return hands_[1].person != nullptr ? 2 : 1;
  }

  /** Returns its compute time [ns]. */
  std::int64_t TickHand(std::size_t i, std::int64_t wake_up_ns) noexcept {
    HandInLoop& hand = hands_[i];
    device::DeviceState device = hand.person->Step(MakeInput(&hand, t_ns_, period_ns_));
    device.t_ns = t_ns_;
    device.X_DH = spatial::Rounded(device.X_DH);
    device.V_DH = spatial::Rounded(device.V_DH);
    const std::int64_t start_ns = ThreadCpuNs();
    hand.last = haptics_.Tick(i, device);
    const std::int64_t compute_ns = ThreadCpuNs() - start_ns;
    hand.person->Apply(hand.last.F_H_D);
    report_->slowest.Add({t_ns_, i, compute_ns, hand.last.occurrence, hand.last.state,
                          hand.last.points_tested, hand.last.contact_count});
    report_->contact_limits.Add(hand.last);
    if (execution_.log != nullptr) {
      execution_.log->SetComputeOfLast(compute_ns);
    }
    KeepFlight(&hand, {device, hand.last, wake_up_ns, compute_ns, shedder_.level(), i});
    if (execution_.sink != nullptr) {
      execution_.sink->OnTick(i, device, hand.last);
    }
    return compute_ns;
  }

  void KeepFlight(HandInLoop* hand, FlightTick tick) noexcept {
    const bool is_fault = IsFault(hand->device_before, hand->actions_before, tick.device, tick.out);
    hand->device_before = tick.device;
    hand->actions_before = tick.out.gate_actions;
    if (execution_.flight == nullptr) {
      return;
    }
    if (!execution_.is_live) {  // the same bytes every time
      tick.wake_up_ns = 0;
      tick.compute_ns = 0;
    }
    execution_.flight->Keep(tick);
    if (is_fault) {
      execution_.flight->Trigger();
    }
  }

  const Execution& execution_;
  HapticSide& haptics_;
  ExecutionReport* report_;
  std::int64_t period_ns_;
  LoadShedder shedder_;
  std::array<HandInLoop, 2> hands_;
  std::int64_t t_ns_{0};
};

/** Tells of the last second of a loop, once a second. RT-safe. */
class StatusTeller {
 public:
  StatusTeller(TripleBuffer<LoopStatus>* status, const RealtimeGrant& grant, std::int64_t period_ns)
      : status_(status), ticks_per_second_(std::max<std::int64_t>(1, 1'000'000'000 / period_ns)) {
    now_.is_fifo = grant.is_fifo;
    now_.is_memory_locked = grant.is_memory_locked;
  }

  void Tell(const ExecutionReport& report, const Simulation& simulation, std::int64_t late_ns,
            std::int64_t compute_ns, int effort_level) noexcept {
    if (status_ == nullptr) {
      return;
    }
    now_.wake_up.Add(late_ns);
    now_.compute.Add(compute_ns);
    if (++ticks_ < ticks_per_second_) {
      return;
    }
    now_.ticks = report.ticks;
    now_.late_wake_ups = report.late_wake_ups;
    now_.overruns = report.overruns;
    now_.lost_events = simulation.lost_events();
    now_.contact_limits = report.contact_limits;
    now_.effort_level = effort_level;
    status_->Write(now_);
    now_.wake_up = {};
    now_.compute = {};
    ticks_ = 0;
  }

 private:
  TripleBuffer<LoopStatus>* status_;
  std::int64_t ticks_per_second_;
  std::int64_t ticks_{0};
  LoopStatus now_;
};

void StepPhysics(const Execution& execution) {
  execution.simulation->physics().Step(execution.sink);
  if (execution.advance) {
    execution.advance();
  }
  if (execution.flight != nullptr && execution.sink != nullptr) {
    if (const std::vector<FlightTick> ticks = execution.flight->Take(); !ticks.empty()) {
      execution.sink->OnFlight(ticks);
    }
  }
}

void FinishFlight(const Execution& execution) {
  if (execution.flight != nullptr) {
    execution.flight->Finish();
    StepPhysics(execution);
  }
}

}  // namespace

void SlowTicks::Add(const SlowTick& tick) noexcept {
  if (count_ == ticks_.size() && tick.compute_ns <= ticks_.back().compute_ns) {
    return;
  }
  count_ = std::min(count_ + 1, ticks_.size());
  std::size_t i = count_ - 1;
  for (; i > 0 && ticks_[i - 1].compute_ns < tick.compute_ns; --i) {
    ticks_[i] = ticks_[i - 1];
  }
  ticks_[i] = tick;
}

ExecutionReport RunLockstep(const Execution& given) {
  ExecutionReport report;
  Execution execution = given;
  execution.is_live = false;
  execution.sheds_load = false;  // what is left out would depend on the machine
  HapticLoop loop(execution, &report);
  const std::int64_t ticks_per_physics =
      std::max<std::int64_t>(1, Simulation::kPhysicsStepNs / PeriodOf(*execution.simulation));
  const std::int64_t start_ns = MonotonicNs();
  const std::int64_t start_cpu_ns = ThreadCpuNs();
  StepPhysics(execution);
  while (!execution.is_done() && loop.t_ns() < execution.limit_ns) {
    for (std::int64_t i = 0; i < ticks_per_physics; ++i) {
      (void)loop.Tick(0);
    }
    if (!execution.is_physics_late || !execution.is_physics_late(loop.t_ns())) {
      StepPhysics(execution);
    }
  }
  FinishFlight(execution);
  report.wall_ns = MonotonicNs() - start_ns;
  report.lost_events = execution.simulation->lost_events();
  report.cpu_ns = ThreadCpuNs() - start_cpu_ns;
  report.session_ns = loop.t_ns();
  report.scheduling = "virtual time";
  return report;
}

ExecutionReport RunRealtime(const Execution& given) {
  ExecutionReport report;
  Execution execution = given;
  execution.is_live = true;
  std::atomic<bool> is_stopping{false};
  std::atomic<std::int64_t> t_ns{0};
  const std::int64_t start_ns = MonotonicNs();
  StepPhysics(execution);  // Puts the base in its fixture: before any other thread runs.
  std::thread haptic([&] {
    report.grant = RequestRealtime();
    HapticLoop loop(execution, &report);
    const std::int64_t period_ns = PeriodOf(*execution.simulation);
    StatusTeller status(execution.status, report.grant, period_ns);
    Pacer pacer(period_ns);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      const std::int64_t late_ns = pacer.Wait();
      report.wake_up.Add(late_ns);
      report.late_wake_ups += late_ns > period_ns ? 1 : 0;
      status.Tell(report, *execution.simulation, late_ns, loop.Tick(late_ns), loop.effort_level());
      t_ns.store(loop.t_ns(), std::memory_order_relaxed);
    }
    report.missed_periods = pacer.missed();
  });
  std::thread publish([&] {
    Pacer pacer(execution.frame_ns);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      (void)pacer.Wait();
      const Frame& frame = execution.simulation->Publish();
      report.frame_age.Add(t_ns.load(std::memory_order_relaxed) - frame.t_ns);
      if (execution.on_frame) {
        execution.on_frame(frame);
      }
    }
  });
  {
    const PhysicsPriority priority;  // after the threads began, which would inherit it
    Pacer pacer(Simulation::kPhysicsStepNs);
    while (!execution.is_done() && t_ns.load(std::memory_order_relaxed) < execution.limit_ns) {
      (void)pacer.Wait();
      StepPhysics(execution);
    }
  }
  is_stopping = true;
  haptic.join();
  publish.join();
  ReleaseRealtime();
  FinishFlight(execution);
  report.scheduling = report.grant.ToString();
  report.wall_ns = MonotonicNs() - start_ns;
  report.lost_events = execution.simulation->lost_events();
  report.session_ns = t_ns;
  return report;
}

}  // namespace hvas::simulation
