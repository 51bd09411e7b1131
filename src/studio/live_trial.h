#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/result.h"
#include "record/recorder.h"
#include "session/session_recorder.h"
#include "study/protocol.h"
#include "study/trial_watch.h"

namespace hvas::studio {

/** One trial of a study as a live run has it: what is on, who keeps account, and the record. */
class LiveTrial final : public simulation::Sink {
 public:
  struct Plan {
    study::Condition condition;
    std::string part;              ///< That is put in its place.
    double mating_window{3};       ///< [s]
    std::filesystem::path record;  ///< Empty: none.
    bool has_person{false};        ///< The simulated person works.
  };

  /** @param step  Of the model's sequence: the part's. Errors: the recorder's. */
  [[nodiscard]] static Result<std::shared_ptr<LiveTrial>> Make(const Plan& plan,
                                                               const simulation::Model& model,
                                                               std::size_t step, double period_s);

  /** What is on in this condition. @param has_device  Then contact is felt no stiffer than it
   bears. */
  void Adjust(bool has_device, haptics::TickOptions* tick) const;

  /** Before the loops run. */
  void Begin(simulation::Simulation* simulation);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** Once the loops have ended: closes the record. Errors: the disk's. */
  [[nodiscard]] Result<void> Finish();

  [[nodiscard]] const study::TrialWatch& watch() const { return *watch_; }

  [[nodiscard]] const Plan& plan() const { return plan_; }

 private:
  explicit LiveTrial(const Plan& plan) : plan_(plan) {}

  Plan plan_;
  std::unique_ptr<record::Recorder> recorder_;
  std::optional<session::SessionRecorder> recording_;
  std::optional<study::TrialWatch> watch_;
};

}  // namespace hvas::studio
