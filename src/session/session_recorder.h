#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "record/recorder.h"
#include "simulation/simulation.h"

namespace hvas::session {

// Bits of TickRecord::status, above the gate's (docs/record.md).
inline constexpr std::uint32_t kTruncatedStatus = 1u << 16;  ///< ContactAccount::is_truncated.
inline constexpr std::uint32_t kStoppedStatus = 1u << 17;    ///< TickContext::is_stopped.
inline constexpr std::uint32_t kCrowdedStatus = 1u << 18;    ///< ContactAccount::is_crowded.

/** Puts a session into a record, so that it can be run again from the file alone: a model, one or
 more stretches of it (simulations that follow one another in session time), and what the loops of
 each produce. */
class SessionRecorder final : public simulation::Sink {
 public:
  /** Puts the model, of which all stretches are, into the record. */
  SessionRecorder(record::Recorder* recorder, const simulation::Model& model);

  /** A stretch begins, where the one before has ended. To be called before the loops of
   `simulation` run, and after it was restored; it is told of nothing any more once they have ended.
 */
  void Begin(simulation::Simulation* simulation);

  /** Session time of the next tick. Any thread. */
  [[nodiscard]] std::int64_t t_ns() const noexcept { return t_ns_.load(std::memory_order_relaxed); }

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

 private:
  void OnCommand(const simulation::GivenCommand& given);

  record::Recorder* recorder_;
  const simulation::HapticSide* haptics_{nullptr};  ///< This stretch's.
  std::int64_t start_ns_{0};                        ///< Beginning of this stretch, in session time.
  std::int64_t period_ns_{0};
  std::atomic<std::int64_t> t_ns_{0};
  std::vector<simulation::PartState> told_;  ///< What the last command had. Physics thread.
};

/** A tick as it is recorded, at the time of its sample. RT-safe.
 @param commands  Obeyed before it. */
[[nodiscard]] record::TickRecord MakeTickRecord(std::size_t hand, const device::DeviceState& device,
                                                const haptics::TickOutput& out,
                                                std::uint32_t commands) noexcept;

/** The sample that went into a recorded tick, for the tick to be run again. Of schema 1 without
 what those records do not have: when it was taken, and how the device was. */
[[nodiscard]] device::DeviceState MakeDeviceState(const record::TickRecord& tick);

/** The rest of what went into it. */
[[nodiscard]] haptics::TickContext MakeTickContext(const record::TickRecord& tick);

}  // namespace hvas::session
