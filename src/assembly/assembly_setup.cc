#include "assembly/assembly_setup.h"

#include <utility>

#include "session/make_simulation.h"
#include "session/recorded_model.h"

namespace hvas::assembly {
namespace {

std::vector<haptics::TickOptions> ListTicks(const std::vector<Hand>& hands) {
  std::vector<haptics::TickOptions> ticks;
  for (const Hand& hand : hands) {
    ticks.push_back(hand.tick);
  }
  return ticks;
}

std::vector<Hand> ListOf(Hand hand) {
  std::vector<Hand> hands;
  hands.push_back(std::move(hand));
  return hands;
}

}  // namespace

RunSetup::RunSetup(std::shared_ptr<const simulation::Model> model, std::vector<Hand> hands)
    : hands_(std::move(hands)),
      simulation_(session::MakeSimulation(std::move(model), ListTicks(hands_))) {}

simulation::Persons RunSetup::ListPersons() const {
  return {hands_.front().person.get(), hands_.size() == 1 ? nullptr : hands_.back().person.get()};
}

simulation::Execution RunSetup::MakeExecution(double limit_s) {
  return part_run().MakeExecution(hands_.front().active(), limit_s,
                                  hands_.size() == 1 ? nullptr : hands_.back().active());
}

AssemblySetup::AssemblySetup(std::shared_ptr<const simulation::Model> model,
                             std::vector<Hand> hands, simulation::Sink* downstream)
    : RunSetup(std::move(model), std::move(hands)),
      run_(&simulation(), ListPersons(), downstream) {}

AssemblySetup::AssemblySetup(std::shared_ptr<const simulation::Model> model, Hand hand,
                             simulation::Sink* downstream)
    : AssemblySetup(std::move(model), ListOf(std::move(hand)), downstream) {}

Result<std::unique_ptr<record::Recorder>> MakeRecorder(const simulation::Model& model,
                                                       const record::RecorderOptions& options,
                                                       const record::Meta& further) {
  record::Meta meta = session::MakeModelMeta(model);
  for (const auto& [key, value] : further) {
    meta[key] = value;
  }
  return record::Recorder::Create(options, meta);
}

}  // namespace hvas::assembly
