#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "device/device.h"
#include "haptics/haptic_tick.h"

namespace hvas::simulation {

/** A tick as the flight recorder keeps it: all that went in and came out, and how it ran. */
struct FlightTick {
  device::DeviceState device;
  haptics::TickOutput out;
  std::int64_t wake_up_ns{0};  ///< How late it began; 0 in virtual time.
  std::int64_t compute_ns{0};  ///< Processor time; 0 in virtual time.
  int effort_level{0};
  std::size_t hand{0};
};

/** Always keeps the last second of ticks. On a fault these are set aside, with what follows for a
 tenth of a second, for another thread to write down (N6). Keep() and Trigger() belong to the haptic
 thread and are RT-safe; the rest to one other thread. */
class FlightRecorder {
 public:
  /** @param rate_hz  Of each hand's ticks. */
  explicit FlightRecorder(double rate_hz, std::size_t hands = 1);

  void Keep(const FlightTick& tick) noexcept;

  /** Something went wrong in the tick that was kept last. While a recording is being made or waits
   to be taken, a further one is only counted. */
  void Trigger() noexcept;

  /** The haptic thread has ended: what is being recorded is complete. */
  void Finish() noexcept;

  /** The recording that waits, in the order of time; empty when there is none. Allocates. */
  [[nodiscard]] std::vector<FlightTick> Take();

  /** Faults that found the recorder busy. */
  [[nodiscard]] std::uint64_t unrecorded() const noexcept {
    return unrecorded_.load(std::memory_order_relaxed);
  }

 private:
  struct Tape {
    std::unique_ptr<FlightTick[]> ticks;
    std::size_t next{0};
    std::size_t count{0};
  };

  static constexpr int kNone = -1;  ///< No tape.

  void HandOver() noexcept;

  std::size_t capacity_;
  std::size_t after_ticks_;
  std::array<Tape, 2> tapes_;
  int running_{0};                   // The haptic thread's tape.
  std::size_t ticks_to_go_{0};       // Until a triggered recording is complete; 0: none.
  std::atomic<int> waiting_{kNone};  // Index of the tape that is to be taken.
  std::atomic<std::uint64_t> unrecorded_{0};
};

}  // namespace hvas::simulation
