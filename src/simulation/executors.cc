#include "simulation/executors.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "base/clock.h"

namespace hvas::simulation {
namespace {

/** Session time of a tick [ns]. */
std::int64_t PeriodOf(const Simulation& simulation) {
  return std::llround(1e9 * simulation.options().dt);
}

/** A tick after which the last second is worth keeping. */
bool IsFault(const device::DeviceState& before, std::uint32_t actions_before,
             const device::DeviceState& device, const haptics::TickOutput& out) noexcept {
  constexpr std::uint32_t kFaults = haptics::kGateNotFinite | haptics::kGateLateModel |
                                    haptics::kGateLostClient | haptics::kGateNoDevice |
                                    haptics::kGateStopped | haptics::kGateBuzz | haptics::kGateKick;
  const std::uint32_t begun = out.gate_actions & ~actions_before;
  return (begun & kFaults) != 0 ||
         (device.condition != before.condition && device::IsFault(device.condition));
}

/** The haptic loop's body, the same in both executors. */
class HapticLoop {
 public:
  HapticLoop(const Execution& execution, ExecutionReport* report)
      : execution_(execution),
        report_(report),
        period_ns_(PeriodOf(*execution.simulation)),
        shedder_(period_ns_) {
    last_.workspace = execution.simulation->options().workspace.mapping;
    last_.X_WH = last_.workspace.X_WD;
  }

  /** @param wake_up_ns  How late the tick begins; 0 in virtual time. */
  void Tick(std::int64_t wake_up_ns) noexcept {
    OperatorInput input;
    input.t_ns = t_ns_;
    input.dt = 1e-9 * static_cast<double>(period_ns_);
    input.F_H_D = last_.F_H_D;
    input.hears_seated = last_.state == haptics::HoldState::kSeated;
    input.hears_capture = last_.state == haptics::HoldState::kCaptured &&
                          state_before_ != haptics::HoldState::kCaptured;
    input.sees_part = last_.occurrence.is_valid();
    input.X_WD = last_.X_WD;
    input.X_WH = last_.X_WH;
    input.workspace = last_.workspace;
    state_before_ = last_.state;
    device::DeviceState device = execution_.hand->Step(input);
    device.t_ns = t_ns_;  // session time; the device's own is in sample_ns
    const std::int64_t start_ns = ThreadCpuNs();
    last_ = execution_.simulation->HapticTick(device);
    const std::int64_t compute_ns = ThreadCpuNs() - start_ns;
    execution_.hand->Apply(last_.F_H_D);
    Measure(compute_ns);
    KeepFlight({device, last_, wake_up_ns, compute_ns, shedder_.level()});
    if (execution_.sink != nullptr) {
      execution_.sink->OnTick(device, last_);
    }
    if (execution_.sheds_load) {
      ++report_->ticks_at_level[static_cast<std::size_t>(shedder_.level())];
      execution_.simulation->SetEffortLevel(shedder_.Update(compute_ns));
    }
    ++report_->ticks;
    t_ns_ += period_ns_;
  }

  [[nodiscard]] std::int64_t t_ns() const noexcept { return t_ns_; }

 private:
  void Measure(std::int64_t compute_ns) noexcept {
    report_->compute.Add(compute_ns);
    report_->slowest.Add({t_ns_, compute_ns, last_.occurrence, last_.state, last_.points_tested,
                          last_.contact_count});
    report_->overruns += compute_ns > period_ns_ ? 1 : 0;
    if (execution_.log != nullptr) {
      execution_.log->SetComputeOfLast(compute_ns);
    }
  }

  void KeepFlight(FlightTick tick) noexcept {
    const bool is_fault = IsFault(device_before_, actions_before_, tick.device, tick.out);
    device_before_ = tick.device;
    actions_before_ = tick.out.gate_actions;
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
  ExecutionReport* report_;
  std::int64_t period_ns_;
  LoadShedder shedder_;
  haptics::TickOutput last_;
  device::DeviceState device_before_;
  std::uint32_t actions_before_{0};
  haptics::HoldState state_before_{haptics::HoldState::kEmpty};
  std::int64_t t_ns_{0};
};

void StepPhysics(const Execution& execution) {
  execution.simulation->PhysicsStep(execution.sink);
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
      loop.Tick(0);
    }
    if (!execution.is_physics_late || !execution.is_physics_late(loop.t_ns())) {
      StepPhysics(execution);
    }
  }
  FinishFlight(execution);
  report.wall_ns = MonotonicNs() - start_ns;
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
    Pacer pacer(period_ns);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      const std::int64_t late_ns = pacer.Wait();
      report.wake_up.Add(late_ns);
      report.late_wake_ups += late_ns > period_ns ? 1 : 0;
      loop.Tick(late_ns);
      t_ns.store(loop.t_ns(), std::memory_order_relaxed);
    }
    report.missed_periods = pacer.missed();
  });
  std::thread publish([&] {
    Pacer pacer(Simulation::kFrameNs);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      (void)pacer.Wait();
      const Frame& frame = execution.simulation->Publish();
      report.frame_age.Add(t_ns.load(std::memory_order_relaxed) - frame.t_ns);
      if (execution.on_frame) {
        execution.on_frame(frame);
      }
    }
  });
  Pacer pacer(Simulation::kPhysicsStepNs);
  while (!execution.is_done() && t_ns.load(std::memory_order_relaxed) < execution.limit_ns) {
    (void)pacer.Wait();
    StepPhysics(execution);
  }
  is_stopping = true;
  haptic.join();
  publish.join();
  ReleaseRealtime();
  FinishFlight(execution);
  report.scheduling = report.grant.ToString();
  report.wall_ns = MonotonicNs() - start_ns;
  report.session_ns = t_ns;
  return report;
}

}  // namespace hvas::simulation
