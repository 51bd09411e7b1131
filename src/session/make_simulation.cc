#include "session/make_simulation.h"

#include <utility>

#include "base/check.h"

namespace hvas::session {

std::unique_ptr<simulation::Simulation> MakeSimulation(
    std::shared_ptr<const simulation::Model> model,
    const std::vector<haptics::TickOptions>& hands) {
  HVAS_DEMAND(hands.size() == 1 || hands.size() == 2);
  return hands.size() == 1
             ? std::make_unique<simulation::Simulation>(std::move(model), hands[0])
             : std::make_unique<simulation::Simulation>(std::move(model), hands[0], hands[1]);
}

}  // namespace hvas::session
