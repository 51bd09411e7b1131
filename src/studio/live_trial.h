#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/result.h"
#include "record/recorder.h"
#include "session/session_recorder.h"
#include "study/protocol.h"
#include "study/trial_result.h"
#include "study/trial_watch.h"

namespace hvas::studio {

/** One trial of a study in a live run: its condition, the measurement of it, and its record. */
class LiveTrial final : public simulation::Sink {
 public:
  struct Plan {
    study::Condition condition;
    std::string part;              ///< Part that the participant assembles.
    double mating_window{3};       ///< See study::Protocol [s].
    std::uint64_t pair_seed{1};    ///< Draws the pair of parts (study::DrawPair).
    std::filesystem::path record;  ///< File of the record; empty: none.
    bool has_person{false};        ///< The simulated person does the trial.
  };

  /** @param step  Index of the part's step in the model's sequence.
   @param period_s  Period of the ticks [s].
   Errors: those of record::Recorder::Create. */
  [[nodiscard]] static Result<std::shared_ptr<LiveTrial>> Make(const Plan& plan,
                                                               const simulation::Model& model,
                                                               std::size_t step, double period_s);

  /** Applies the condition to the options of a tick. @param has_device  Whether a device renders
   the forces: the coupling then is no stiffer than that device can render. */
  void Adjust(bool has_device, haptics::TickOptions* tick) const;

  /** Begins the trial. @pre the loops do not run yet. */
  void Begin(simulation::Simulation* simulation);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** Closes the record. @pre the loops have ended. Errors: those of writing it. */
  [[nodiscard]] Result<void> Finish();

  [[nodiscard]] const study::TrialWatch& watch() const { return *watch_; }

  [[nodiscard]] const Plan& plan() const { return plan_; }

  /** The pair of parts of the trial; nothing where no mate of the part has a fit. */
  [[nodiscard]] const std::optional<study::TrialPair>& pair() const { return pair_; }

 private:
  explicit LiveTrial(const Plan& plan) : plan_(plan) {}

  Plan plan_;
  std::optional<study::TrialPair> pair_;
  std::unique_ptr<record::Recorder> recorder_;
  std::optional<session::SessionRecorder> recording_;
  std::optional<study::TrialWatch> watch_;
};

}  // namespace hvas::studio
