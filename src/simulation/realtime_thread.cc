#include "simulation/realtime_thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

namespace hvas::simulation {
namespace {

constexpr int kPriority = 80;         // above ordinary threads, below the kernel's own
constexpr int kPhysicsPriority = 70;  // The haptic thread goes first.
constexpr const char* kIsolatedCores = "/sys/devices/system/cpu/isolated";

int PinToIsolatedCore() {
  std::ifstream file(kIsolatedCores);
  std::string list;
  std::getline(file, list);
  const int core = FirstCoreOf(list);
  if (core < 0) {
    return -1;
  }
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<std::size_t>(core), &cores);
  return ::pthread_setaffinity_np(::pthread_self(), sizeof(cores), &cores) == 0 ? core : -1;
}

}  // namespace

std::string RealtimeGrant::ToString() const {
  std::string text = is_fifo
                         ? fmt::format("SCHED_FIFO {}", kPriority)
                         : fmt::format("normal priority (SCHED_FIFO refused: {})", fifo_refusal);
  text += is_memory_locked ? ", memory locked"
                           : fmt::format(", memory not locked ({})", memory_refusal);
  return text + (core >= 0 ? fmt::format(", core {} to itself", core) : ", no core to itself");
}

int FirstCoreOf(const std::string& list) {
  int core = -1;
  const auto [end, error] = std::from_chars(list.data(), list.data() + list.size(), core);
  return error == std::errc() && end != list.data() && core < CPU_SETSIZE ? core : -1;
}

RealtimeGrant RequestRealtime() {
  RealtimeGrant grant;
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  grant.is_fifo = error == 0;
  grant.fifo_refusal = error == 0 ? "" : std::strerror(error);
  grant.is_memory_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  grant.memory_refusal = grant.is_memory_locked ? "" : std::strerror(errno);
  grant.core = PinToIsolatedCore();
  return grant;
}

PhysicsPriority::PhysicsPriority() noexcept {
  sched_param parameters{};
  ::pthread_getschedparam(::pthread_self(), &policy_before_, &parameters);
  priority_before_ = parameters.sched_priority;
  parameters.sched_priority = kPhysicsPriority;
  (void)::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

PhysicsPriority::~PhysicsPriority() {
  sched_param parameters{};
  parameters.sched_priority = priority_before_;
  (void)::pthread_setschedparam(::pthread_self(), policy_before_, &parameters);
}

void ReleaseRealtime() {
  ::munlockall();
}

Pacer::Pacer(std::int64_t period_ns, LoopClock* clock) noexcept
    : clock_(clock), period_ns_(period_ns), next_ns_(clock->NowNs()) {}

std::int64_t Pacer::Wait() noexcept {
  static const std::function<bool()> kNever = [] { return false; };
  return Wait(kNever);
}

std::int64_t Pacer::Wait(const std::function<bool()>& is_over) noexcept {
  next_ns_ += period_ns_;
  clock_->WaitUntil(next_ns_, is_over);
  const std::int64_t late_ns = std::max<std::int64_t>(0, clock_->NowNs() - next_ns_);
  if (late_ns > period_ns_) {
    const std::int64_t periods = late_ns / period_ns_;
    missed_ += static_cast<std::uint64_t>(periods);
    next_ns_ += periods * period_ns_;
  }
  return late_ns;
}

}  // namespace hvas::simulation
