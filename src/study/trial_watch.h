#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "simulation/simulation.h"
#include "study/trial_result.h"

namespace hvas::study {

/** Measures one trial while it runs, as a sink that passes everything on to another one. Measuring
 ends with the tick in which the part is seated. */
class TrialWatch final : public simulation::Sink {
 public:
  /** @param part  Part whose seating ends the trial.
   @param extraction_W  Direction of extraction in W; unit vector.
   @param window_s  Time before the end for which wrenches are kept [s].
   @param period_s  Period of the ticks [s].
   @param downstream  Sink that everything is passed on to; may be null. */
  TrialWatch(product::OccurrenceId part, const Vec3& extraction_W, double window_s, double period_s,
             simulation::Sink* downstream);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** Time since the trial's first tick [s]. Any thread may call it. */
  [[nodiscard]] double elapsed_s() const {
    return 1e-9 * static_cast<double>(elapsed_ns_.load(std::memory_order_relaxed));
  }

  /** Whether the part is seated. For the haptic thread, or once the loops have ended. */
  [[nodiscard]] bool is_seated() const { return is_seated_; }

  /** Makes the result; its outcome is kDone or kNotDone. @pre the loops have ended. */
  [[nodiscard]] TrialResult MakeResult() const;

 private:
  static constexpr int kKeepEvery = 10;  ///< Decimation of the wrenches that are kept [ticks].

  struct Kept {
    std::int64_t t_ns{0};
    Vec3 f{Vec3::Zero()};
    Vec3 torque{Vec3::Zero()};
  };

  void Keep(std::int64_t t_ns, const haptics::TickOutput& out) noexcept;

  product::OccurrenceId part_;
  Quat q_AW_;  ///< Rotation into the frame A whose z axis is the direction of extraction.
  simulation::Sink* downstream_;
  bool has_begun_{false};
  bool is_seated_{false};
  std::int64_t first_ns_{0};
  std::int64_t last_ns_{0};
  std::atomic<std::int64_t> elapsed_ns_{0};
  std::int64_t contact_ns_;
  TrialResult sums_;
  std::vector<Kept> kept_;  ///< Ring buffer of fixed size.
  std::size_t next_{0};
  std::uint64_t kept_count_{0};
  std::uint64_t ticks_{0};
};

}  // namespace hvas::study
