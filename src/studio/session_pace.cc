#include "studio/session_pace.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "base/loop_clock.h"

namespace hvas::studio {

void SessionPace::operator()(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kLook(2);  // between looks for an input: a choice
  while (AwaitsInput() && !stop.stop_requested()) {
    std::this_thread::sleep_for(kLook);
  }
  if (live_->is_demo()) {
    return;
  }
  const std::int64_t now_ns = MonotonicNs();
  next_ns_ = std::max(next_ns_ + ClockDriver::kStepNs, now_ns);
  std::this_thread::sleep_for(std::chrono::nanoseconds(next_ns_ - now_ns));
}

bool SessionPace::AwaitsInput() {
  const auto input_ns = live_->FindOldestInput();
  if (!input_ns || live_->clock().NowNs() - *input_ns < kLeadNs) {
    return false;
  }
  const std::int64_t now_ns = MonotonicNs();
  if (*input_ns != awaited_ns_) {
    awaited_ns_ = *input_ns;
    since_ns_ = now_ns;
  }
  return now_ns - since_ns_ < kPatienceNs;
}

}  // namespace hvas::studio
