#pragma once

#include <memory>

#include "record/recorder.h"
#include "simulation/simulation.h"

namespace hvas::app {

/** Puts what the loops produce into a record. Ticks are those of the first hand only: the record
 has no column for the hand yet. */
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

}  // namespace hvas::app
