#include "simulation/simulation.h"

#include <utility>

namespace hvas::simulation {
namespace {

Frame MakeFirstFrame(const Model& model, std::size_t hands) {
  Frame frame;
  frame.ticks.resize(hands);
  frame.members.resize(hands);
  for (const Body& body : model.bodies) {
    frame.X_WB.push_back(body.X_WB_start);
  }
  return frame;
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions& options)
    : Simulation(std::move(model), std::vector{options}) {}

Simulation::Simulation(std::shared_ptr<const Model> model,
                       const std::vector<haptics::TickOptions>& hands)
    : model_(std::move(model)),
      handover_(model_->bodies.size(), hands.size()),
      frames_(MakeFirstFrame(*model_, hands.size())),
      haptics_(*model_, hands, &handover_),
      physics_(model_, hands, &handover_, &frames_) {}

const Frame& Simulation::Publish() {
  frames_.Update();
  return frames_.value();
}

void Simulation::KeepLog(TickLog* log) {
  haptics_.KeepLog(log);
  physics_.KeepLog(log);
}

void Simulation::Restore(const std::vector<PartState>& parts) {
  physics_.Restore(parts);
  haptics_.Restore(physics_.parts(), physics_.ListLooseGroups());
}

void Simulation::ReplayCommand(const GivenCommand& given, std::int64_t t_ns) {
  std::shared_ptr<const haptics::HeldPart> held_before;
  haptics_.Apply(physics_.RemakeCommand(given, &held_before), t_ns);
}

}  // namespace hvas::simulation
