#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "device/device.h"
#include "haptics/tick_output.h"
#include "haptics/write_pace.h"
#include "simulation/executors.h"
#include "simulation/load_shedder.h"
#include "simulation/operator.h"
#include "simulation/simulation.h"

namespace hvas::simulation {

/** Session time of a tick [ns]. */
[[nodiscard]] std::int64_t CalcPeriod(const Simulation& simulation);

/** The haptic loop's body, the same in both executors: the operator's sample, the tick, and what
 becomes of its results. */
class HapticLoop {
 public:
  /** @param execution,report  Outlive this object. */
  HapticLoop(const Execution& execution, ExecutionReport* report);

  /** Every hand once; returns how long they computed [ns]. RT-safe as far as the operators are.
   @param wake_up_ns  How late the tick begins; 0 in virtual time. */
  std::int64_t Tick(std::int64_t wake_up_ns) noexcept;

  [[nodiscard]] int effort_level() const noexcept { return shedder_.level(); }

  [[nodiscard]] std::int64_t t_ns() const noexcept { return t_ns_; }

 private:
  /** What the loop remembers of one hand from tick to tick. */
  struct Hand {
    Operator* person{nullptr};
    haptics::WritePace pace;
    haptics::TickOutput last;
    haptics::HoldState state_before{haptics::HoldState::kEmpty};
    device::DeviceState device_before;
    std::uint32_t actions_before{0};
  };

  [[nodiscard]] static OperatorInput MakeInput(Hand* hand, std::int64_t t_ns,
                                               std::int64_t period_ns) noexcept;

  /** Time of the clock by which writes are late: the machine's or a steered one; virtual time. */
  [[nodiscard]] std::int64_t NowNs() const noexcept {
    return execution_.is_live ? execution_.clock->NowNs() : t_ns_;
  }

  /** Returns its compute time [ns]. */
  std::int64_t TickHand(std::size_t i, std::int64_t wake_up_ns) noexcept;
  void KeepFlight(Hand* hand, FlightTick tick) noexcept;

  const Execution& execution_;
  HapticSide& haptics_;
  ExecutionReport* report_;
  std::int64_t period_ns_;
  LoadShedder shedder_;
  std::array<Hand, haptics::kMaxHands> hands_;
  std::size_t hand_count_{0};  ///< Those with an operator; the others do not tick.
  std::int64_t t_ns_{0};
};

}  // namespace hvas::simulation
