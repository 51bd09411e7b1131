#include "assembly/assembly_setup.h"

#include <utility>

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
      simulation_(std::make_unique<simulation::Simulation>(std::move(model), ListTicks(hands_))) {}

simulation::TaskOperators RunSetup::ListMovers() const {
  simulation::TaskOperators movers{};
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    movers[i] = hands_[i].mover.get();
  }
  return movers;
}

simulation::Execution RunSetup::MakeExecution(double limit_s) {
  simulation::Operators operators{};
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    operators[i] = hands_[i].active();
  }
  return part_run().MakeExecution(operators, limit_s);
}

AssemblySetup::AssemblySetup(std::shared_ptr<const simulation::Model> model,
                             std::vector<Hand> hands, simulation::Sink* downstream)
    : RunSetup(std::move(model), std::move(hands)), run_(&simulation(), ListMovers(), downstream) {}

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
