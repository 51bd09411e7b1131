#include "simulation/executors.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/clock_place.h"
#include "simulation/haptic_loop.h"

namespace hvas::simulation {
namespace {

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

/** Ticks from one step of physics to the next. */
std::int64_t CountTicksPerPhysics(const Simulation& simulation) {
  return std::max<std::int64_t>(1, Simulation::kPhysicsStepNs / CalcPeriod(simulation));
}

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

struct Lockstep::State {
  explicit State(const Execution& given) : execution(given), loop(execution, &report) {}

  Execution execution;
  ExecutionReport report;
  HapticLoop loop;
  std::int64_t ticks_per_physics{0};
  std::int64_t ticks{0};
  std::int64_t start_ns{MonotonicNs()};
  std::int64_t start_cpu_ns{ThreadCpuNs()};
};

Lockstep::Lockstep(const Execution& given) {
  Execution execution = given;
  execution.is_live = false;
  execution.sheds_load = false;  // what is left out would depend on the machine
  state_ = std::make_unique<State>(execution);
  state_->ticks_per_physics = CountTicksPerPhysics(*execution.simulation);
  StepPhysics(state_->execution);
}

Lockstep::~Lockstep() = default;

bool Lockstep::is_over() const {
  const Execution& execution = state_->execution;
  return (execution.is_done && execution.is_done()) || state_->loop.t_ns() >= execution.limit_ns;
}

std::int64_t Lockstep::t_ns() const {
  return state_->loop.t_ns();
}

void Lockstep::Tick() {
  const Execution& execution = state_->execution;
  (void)state_->loop.Tick(0);
  if (++state_->ticks % state_->ticks_per_physics == 0 &&
      (!execution.is_physics_late || !execution.is_physics_late(state_->loop.t_ns()))) {
    StepPhysics(execution);
  }
}

ExecutionReport Lockstep::Finish() {
  FinishFlight(state_->execution);
  ExecutionReport& report = state_->report;
  report.wall_ns = MonotonicNs() - state_->start_ns;
  report.lost_events = state_->execution.simulation->lost_events();
  report.cpu_ns = ThreadCpuNs() - state_->start_cpu_ns;
  report.session_ns = state_->loop.t_ns();
  report.scheduling = "virtual time";
  return report;
}

ExecutionReport RunLockstep(const Execution& execution) {
  Lockstep lockstep(execution);
  const std::int64_t ticks_per_physics = CountTicksPerPhysics(*execution.simulation);
  while (!lockstep.is_over()) {
    for (std::int64_t i = 0; i < ticks_per_physics; ++i) {
      lockstep.Tick();
    }
  }
  return lockstep.Finish();
}

ExecutionReport RunRealtime(const Execution& given) {
  ExecutionReport report;
  Execution execution = given;
  execution.is_live = true;
  LoopClock* clock = execution.clock;
  execution.sheds_load = execution.sheds_load && !clock->is_steered();
  std::atomic<bool> is_stopping{false};
  const std::function<bool()> has_stopped = [&is_stopping] { return is_stopping.load(); };
  std::atomic<std::int64_t> t_ns{0};
  const std::int64_t start_ns = MonotonicNs();
  StepPhysics(execution);  // Puts the base in its fixture: before any other thread runs.
  for (int thread = 0; thread < 2; ++thread) {
    clock->Enter();  // before the first of them waits, and lets time pass
  }
  std::thread haptic([&] {
    const ClockPlace place(clock);
    report.grant = RequestRealtime();
    HapticLoop loop(execution, &report);
    const std::int64_t period_ns = CalcPeriod(*execution.simulation);
    StatusTeller status(execution.status, report.grant, period_ns);
    Pacer pacer(period_ns, clock);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      const std::int64_t late_ns = pacer.Wait(has_stopped);
      report.wake_up.Add(late_ns);
      report.late_wake_ups += late_ns > period_ns ? 1 : 0;
      status.Tell(report, *execution.simulation, late_ns, loop.Tick(late_ns), loop.effort_level());
      t_ns.store(loop.t_ns(), std::memory_order_relaxed);
    }
    report.missed_periods = pacer.missed();
  });
  std::thread publish([&] {
    const ClockPlace place(clock);
    Pacer pacer(execution.frame_ns, clock);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      (void)pacer.Wait(has_stopped);
      const Frame& frame = execution.simulation->Publish();
      report.frame_age.Add(t_ns.load(std::memory_order_relaxed) - frame.t_ns);
      if (execution.on_frame) {
        execution.on_frame(frame);
      }
    }
  });
  {
    const PhysicsPriority priority;  // after the threads began, which would inherit it
    Pacer pacer(Simulation::kPhysicsStepNs, clock);
    while (!execution.is_done() && t_ns.load(std::memory_order_relaxed) < execution.limit_ns) {
      (void)pacer.Wait(execution.is_done);
      StepPhysics(execution);
    }
    is_stopping = true;
    clock->WakeAll();
  }
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
