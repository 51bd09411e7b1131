#pragma once

#include <memory>
#include <vector>

#include "haptics/options.h"
#include "simulation/simulation.h"

namespace hvas::session {

/** A simulation with as many hands as there are options of their ticks. @pre one or two. */
[[nodiscard]] std::unique_ptr<simulation::Simulation> MakeSimulation(
    std::shared_ptr<const simulation::Model> model, const std::vector<haptics::TickOptions>& hands);

}  // namespace hvas::session
