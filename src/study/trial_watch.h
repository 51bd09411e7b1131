#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "simulation/simulation.h"
#include "study/trial_result.h"

namespace hvas::study {

/** Keeps account of one trial while it runs: stands between the loops and whoever else is told. It
 ends for good with the tick in which the part is in its place. */
class TrialWatch final : public simulation::Sink {
 public:
  /** @param part  Whose coming into its place ends the trial.
   @param extraction_W  Unit; the way out.
   @param window_s  Of the forces that are kept [s].
   @param period_s  Of the ticks [s].
   @param downstream  Gets everything too; may be null. */
  TrialWatch(product::OccurrenceId part, const Vec3& extraction_W, double window_s, double period_s,
             simulation::Sink* downstream);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** Since the first tick [s]. Any thread. */
  [[nodiscard]] double elapsed_s() const {
    return 1e-9 * static_cast<double>(elapsed_ns_.load(std::memory_order_relaxed));
  }

  /** Haptic thread, or once the loops have ended. */
  [[nodiscard]] bool is_seated() const { return is_seated_; }

  /** Once the loops have ended. The outcome is kDone, or kNotDone. */
  [[nodiscard]] TrialResult MakeResult() const;

 private:
  static constexpr int kKeepEvery = 10;  ///< Ticks.

  struct Kept {
    std::int64_t t_ns{0};
    Vec3 f{Vec3::Zero()};
    Vec3 torque{Vec3::Zero()};
  };

  void Keep(std::int64_t t_ns, const haptics::TickOutput& out) noexcept;

  product::OccurrenceId part_;
  Quat q_AW_;  ///< Into the frame whose z axis is the way out.
  simulation::Sink* downstream_;
  bool has_begun_{false};
  bool is_seated_{false};
  std::int64_t first_ns_{0};
  std::int64_t last_ns_{0};
  std::atomic<std::int64_t> elapsed_ns_{0};
  std::int64_t contact_ns_;
  TrialResult sums_;
  std::vector<Kept> kept_;  ///< Round and round, of one size.
  std::size_t next_{0};
  std::uint64_t kept_count_{0};
  std::uint64_t ticks_{0};
};

}  // namespace hvas::study
