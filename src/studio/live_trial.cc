#include "studio/live_trial.h"

#include <utility>

#include "assembly/assembly_setup.h"
#include "study/simulated_participant.h"
#include "study/trial_pair.h"

namespace hvas::studio {

Result<std::shared_ptr<LiveTrial>> LiveTrial::Make(const Plan& plan, const simulation::Model& model,
                                                   std::size_t step, double period_s) {
  std::shared_ptr<LiveTrial> trial(new LiveTrial(plan));
  if (!plan.record.empty()) {
    record::RecorderOptions options;
    options.path = plan.record;
    options.replaces = true;  // replaces the record of an aborted trial
    options.is_threaded = true;
    auto recorder = assembly::MakeRecorder(model, options, {{"condition", plan.condition.id}});
    if (!recorder) {
      return Unexpected(recorder.error());
    }
    trial->recorder_ = std::move(*recorder);
    trial->recording_.emplace(trial->recorder_.get(), model);
  }
  trial->pair_ = study::DescribePair(model, step);
  const sequence::SequenceStep& own = model.sequence.steps[step];
  trial->watch_.emplace(own.occurrence, own.extraction_W, plan.mating_window, period_s,
                        trial->recording_ ? &*trial->recording_ : nullptr);
  return trial;
}

void LiveTrial::Adjust(bool has_device, haptics::TickOptions* tick) const {
  const double borne = tick->coupling.k_lin;
  study::ApplyCondition(plan_.condition, tick);
  if (has_device) {
    tick->coupling.k_lin = std::min(borne, tick->coupling.k_lin);
  }
}

void LiveTrial::Begin(simulation::Simulation* simulation) {
  if (recording_) {
    recording_->Begin(simulation);
  }
}

void LiveTrial::OnTick(std::size_t hand, const device::DeviceState& device,
                       const haptics::TickOutput& out) noexcept {
  watch_->OnTick(hand, device, out);
}

void LiveTrial::OnEvent(const simulation::SimulationEvent& event) {
  watch_->OnEvent(event);
}

void LiveTrial::OnFlight(const std::vector<simulation::FlightTick>& ticks) {
  watch_->OnFlight(ticks);
}

Result<void> LiveTrial::Finish() {
  return recorder_ != nullptr ? recorder_->Finish() : Result<void>();
}

}  // namespace hvas::studio
