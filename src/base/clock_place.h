#pragma once

#include "base/loop_clock.h"

namespace hvas {

/** Place of a thread by a clock for which LoopClock::Enter() has been called, by whoever started
 the thread: time does not pass before it has begun. It is left at the end. */
class ClockPlace {
 public:
  explicit ClockPlace(LoopClock* clock) noexcept : clock_(clock) {}

  ~ClockPlace() { clock_->Leave(); }

  ClockPlace(const ClockPlace&) = delete;
  ClockPlace& operator=(const ClockPlace&) = delete;

 private:
  LoopClock* clock_;
};

}  // namespace hvas
