#pragma once

#include <memory>

#include "record/recorder.h"
#include "simulation/simulation.h"

namespace hvas::app {

/** Puts what the loops produce into a record. */
class SessionRecorder final : public simulation::Sink {
 public:
  explicit SessionRecorder(record::Recorder* recorder) : recorder_(recorder) {}

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

 private:
  record::Recorder* recorder_;
};

/** The sample that went into a recorded tick, for the tick to be run again. Of schema 1 without
 what those records do not have: when it was taken, and how the device was. */
[[nodiscard]] device::DeviceState MakeDeviceState(const record::TickRecord& tick);

/** The rest of what went into it. */
[[nodiscard]] haptics::TickContext MakeTickContext(const record::TickRecord& tick);

}  // namespace hvas::app
