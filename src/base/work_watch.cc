#include "base/work_watch.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/check.h"
#include "base/clock.h"
#include "base/descriptor.h"

namespace hvas {
namespace {

// Looks at time and memory are this far apart, as each reads a file of /proc: a choice.
constexpr std::int64_t kBetweenLooksNs = 5'000'000;
constexpr double kLongest = 1e6;  // [s]

/** Memory of this process that is in use [bytes]; 0 where the system does not tell. */
std::uint64_t ReadMemoryInUse() {
  const Descriptor file(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC));
  char text[128] = {};
  const ssize_t size = ::read(file.value(), text, sizeof(text) - 1);
  unsigned long all = 0;
  unsigned long resident = 0;
  const bool is_read = size > 0 && std::sscanf(text, "%lu %lu", &all, &resident) == 2;
  return is_read ? std::uint64_t{resident} * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE))
                 : 0;
}

}  // namespace

std::uint64_t DefaultMemoryLimit() {
  const auto pages = static_cast<std::uint64_t>(std::max(::sysconf(_SC_PHYS_PAGES), 0L));
  const std::uint64_t machine = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min(std::uint64_t{4} << 30U, machine / 4 * 3);
}

WorkWatch::WorkWatch(const WorkLimits& limits, std::stop_token stop)
    : limits_(limits), stop_(std::move(stop)), memory_before_(ReadMemoryInUse()) {
  if (limits_.begin_ns == 0) {
    limits_.begin_ns = MonotonicNs();
  }
  deadline_ns_ = limits_.begin_ns + std::llround(1e9 * std::clamp(limits.time, 0.0, kLongest));
  if (limits_.memory == 0) {
    limits_.memory = DefaultMemoryLimit();
  }
}

bool WorkWatch::MayGoOn() {
  if (reason_ != Reason::kNone) {
    return false;
  }
  const std::int64_t now_ns = MonotonicNs();
  if (now_ns > deadline_ns_) {
    reason_ = Reason::kTime;
  } else if (now_ns >= next_look_ns_) {
    next_look_ns_ = now_ns + kBetweenLooksNs;
    if (stop_.stop_requested()) {
      reason_ = Reason::kStop;
    } else if (ReadMemoryInUse() > memory_before_ + limits_.memory) {
      reason_ = Reason::kMemory;
    }
  }
  return reason_ == Reason::kNone;
}

bool WorkWatch::MayVisitPair() {
  if (reason_ == Reason::kNone && ++pairs_ > limits_.pairs) {
    reason_ = Reason::kPairs;
  }
  constexpr std::uint64_t kBetweenClocks = 8;  // Pairs: most take less than the clock. A choice.
  return pairs_ % kBetweenClocks != 0 ? reason_ == Reason::kNone : MayGoOn();
}

Error WorkWatch::Explain(std::string_view work, std::string where) const {
  HVAS_DEMAND(reason_ != Reason::kNone);
  switch (reason_) {
    case Reason::kStop:
      return {ErrorCode::kCancelled, fmt::format("{} was stopped", work), std::move(where), ""};
    case Reason::kMemory:
      return {ErrorCode::kOutOfResource,
              fmt::format("{} needed more than {:.3g} GiB of memory, which is the limit", work,
                          static_cast<double>(limits_.memory) / (1U << 30U)),
              std::move(where), "raise --memory-limit, or export the product in parts"};
    case Reason::kPairs:
      return {ErrorCode::kOutOfResource,
              fmt::format("{} had more than {} pairs of parts to look at, which is the limit", work,
                          limits_.pairs),
              std::move(where), "export the product in parts"};
    case Reason::kTime:
    case Reason::kNone:
      break;
  }
  return {ErrorCode::kOutOfResource,
          fmt::format("{} took longer than {:g} s, which is the limit", work, limits_.time),
          std::move(where), "raise --time-limit, or export the product in parts"};
}

}  // namespace hvas
