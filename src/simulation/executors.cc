#include "simulation/executors.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "base/clock.h"

namespace hvas::simulation {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;

/** The haptic loop's body, the same in both executors. */
class HapticLoop {
 public:
  HapticLoop(const Execution& execution, ExecutionReport* report)
      : execution_(execution), report_(report) {}

  void Tick() noexcept {
    OperatorInput input;
    input.t_ns = t_ns_;
    input.F_H_D = last_.F_H_D;
    input.hears_seated = last_.state == haptics::HoldState::kSeated;
    input.hears_capture = last_.state == haptics::HoldState::kCaptured &&
                          state_before_ != haptics::HoldState::kCaptured;
    input.sees_part = last_.occurrence.is_valid();
    input.X_WD = last_.X_WD;
    state_before_ = last_.state;
    const device::DeviceState device = execution_.hand->Step(input);
    const std::int64_t start_ns = ThreadCpuNs();
    last_ = execution_.simulation->HapticTick(device);
    const std::int64_t compute_ns = ThreadCpuNs() - start_ns;
    report_->compute.Add(compute_ns);
    report_->slowest.Add({t_ns_, compute_ns, last_.occurrence, last_.state, last_.points_tested,
                          last_.contact_count});
    report_->overruns += compute_ns > kTickNs ? 1 : 0;
    if (execution_.sink != nullptr) {
      execution_.sink->OnTick(device, last_);
    }
    ++report_->ticks;
    t_ns_ += kTickNs;
  }

  [[nodiscard]] std::int64_t t_ns() const noexcept { return t_ns_; }

 private:
  const Execution& execution_;
  ExecutionReport* report_;
  haptics::TickOutput last_;
  haptics::HoldState state_before_{haptics::HoldState::kEmpty};
  std::int64_t t_ns_{0};
};

void StepPhysics(const Execution& execution) {
  execution.simulation->PhysicsStep(execution.sink);
  if (execution.advance) {
    execution.advance();
  }
}

/** Absolute deadlines: no drift, and no burst after a stall. */
class Pacer {
 public:
  explicit Pacer(std::int64_t period_ns) : period_ns_(period_ns), next_ns_(MonotonicNs()) {}

  /** Sleeps until the next deadline; returns how late it woke up [ns]. */
  std::int64_t Wait() noexcept {
    next_ns_ += period_ns_;
    const timespec deadline{next_ns_ / kNsPerSecond, next_ns_ % kNsPerSecond};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
    }
    const std::int64_t late_ns = MonotonicNs() - next_ns_;
    if (late_ns > period_ns_) {
      next_ns_ += late_ns / period_ns_ * period_ns_;
    }
    return late_ns;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_;
};

std::string RaisePriority() {
  std::string granted;
  sched_param parameters{};
  parameters.sched_priority = 80;
  const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  granted = error == 0
                ? "SCHED_FIFO 80"
                : fmt::format("normal priority (SCHED_FIFO refused: {})", std::strerror(error));
  granted += ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? ", memory locked" : ", memory not locked";
  return granted;
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

ExecutionReport RunLockstep(const Execution& execution) {
  ExecutionReport report;
  HapticLoop loop(execution, &report);
  const std::int64_t start_ns = MonotonicNs();
  const std::int64_t start_cpu_ns = ThreadCpuNs();
  StepPhysics(execution);
  while (!execution.is_done() && loop.t_ns() < execution.limit_ns) {
    for (int i = 0; i < Simulation::kTicksPerPhysics; ++i) {
      loop.Tick();
    }
    StepPhysics(execution);
  }
  report.wall_ns = MonotonicNs() - start_ns;
  report.cpu_ns = ThreadCpuNs() - start_cpu_ns;
  report.session_ns = loop.t_ns();
  report.scheduling = "virtual time";
  return report;
}

ExecutionReport RunRealtime(const Execution& execution) {
  ExecutionReport report;
  std::atomic<bool> is_stopping{false};
  std::atomic<std::int64_t> t_ns{0};
  const std::int64_t start_ns = MonotonicNs();
  StepPhysics(execution);  // Puts the base in its fixture: before any other thread runs.
  std::thread haptic([&] {
    report.scheduling = RaisePriority();
    HapticLoop loop(execution, &report);
    Pacer pacer(kTickNs);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      const std::int64_t late_ns = pacer.Wait();
      report.wake_up.Add(late_ns);
      report.late_wake_ups += late_ns > kTickNs ? 1 : 0;
      loop.Tick();
      t_ns.store(loop.t_ns(), std::memory_order_relaxed);
    }
  });
  std::thread publish([&] {
    Pacer pacer(Simulation::kTicksPerFrame * kTickNs);
    while (!is_stopping.load(std::memory_order_relaxed)) {
      (void)pacer.Wait();
      (void)execution.simulation->Publish();
    }
  });
  Pacer pacer(Simulation::kTicksPerPhysics * kTickNs);
  while (!execution.is_done() && t_ns.load(std::memory_order_relaxed) < execution.limit_ns) {
    (void)pacer.Wait();
    StepPhysics(execution);
  }
  is_stopping = true;
  haptic.join();
  publish.join();
  ::munlockall();
  report.wall_ns = MonotonicNs() - start_ns;
  report.session_ns = t_ns;
  return report;
}

}  // namespace hvas::simulation
