#include "simulation/flight_recorder.h"

#include <algorithm>
#include <cmath>

namespace hvas::simulation {

FlightRecorder::FlightRecorder(double rate_hz, std::size_t hands)
    : capacity_(hands * static_cast<std::size_t>(std::lround(1.1 * rate_hz))),
      after_ticks_(hands * static_cast<std::size_t>(std::lround(0.1 * rate_hz))) {
  for (Tape& tape : tapes_) {
    tape.ticks = std::make_unique<FlightTick[]>(capacity_);
  }
}

void FlightRecorder::Keep(const FlightTick& tick) noexcept {
  Tape& tape = tapes_[static_cast<std::size_t>(running_)];
  tape.ticks[tape.next] = tick;
  tape.next = tape.next + 1 == capacity_ ? 0 : tape.next + 1;
  tape.count = std::min(tape.count + 1, capacity_);
  if (ticks_to_go_ > 0 && --ticks_to_go_ == 0) {
    HandOver();
  }
}

void FlightRecorder::Finish() noexcept {
  if (ticks_to_go_ > 0) {
    ticks_to_go_ = 0;
    HandOver();
  }
}

void FlightRecorder::HandOver() noexcept {
  // The other tape is free: nothing waited when this recording was triggered.
  waiting_.store(running_, std::memory_order_release);
  running_ = 1 - running_;
  Tape& fresh = tapes_[static_cast<std::size_t>(running_)];
  fresh.next = 0;
  fresh.count = 0;
}

void FlightRecorder::Trigger() noexcept {
  if (ticks_to_go_ > 0 || waiting_.load(std::memory_order_acquire) != kNone) {
    unrecorded_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  ticks_to_go_ = after_ticks_;
}

std::vector<FlightTick> FlightRecorder::Take() {
  const int index = waiting_.load(std::memory_order_acquire);
  if (index == kNone) {
    return {};
  }
  const Tape& tape = tapes_[static_cast<std::size_t>(index)];
  std::vector<FlightTick> ticks;
  ticks.reserve(tape.count);
  const std::size_t first = (tape.next + capacity_ - tape.count) % capacity_;
  for (std::size_t i = 0; i < tape.count; ++i) {
    ticks.push_back(tape.ticks[(first + i) % capacity_]);
  }
  waiting_.store(kNone, std::memory_order_release);
  return ticks;
}

}  // namespace hvas::simulation
