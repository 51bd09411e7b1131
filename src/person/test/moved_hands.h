#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/device.h"
#include "person/test/session.h"
#include "simulation/simulation.h"
#include "simulation/test/small_models.h"

namespace hvas::person::testing {

inline constexpr double kHalf = 15e-3;  // [m] of each block's edges

/** Blocks with nothing to do with one another. */
inline std::shared_ptr<const simulation::Model> MakeBlocks(int count) {
  product::Product product;
  product.name = "blocks";
  const auto block = AddPart(&product, "block", contact::testing::Block(Vec3::Constant(kHalf)));
  for (int i = 0; i < count; ++i) {
    Place(&product, block, "block " + std::to_string(i), Pose(Vec3(0.1 * i, 0, 0)));
  }
  Complete(&product);
  Diagnostics diagnostics;
  return *simulation::Compile(std::make_shared<product::Product>(product), FastOptions(),
                              &diagnostics);
}

/** Hands that go from place to place at constant speed, turning nothing. */
class MovedHands {
 public:
  MovedHands(std::shared_ptr<const simulation::Model> model, std::size_t count)
      : simulation(std::move(model), std::vector<haptics::TickOptions>(count)),
        states(count),
        out(count),
        watches(count) {}

  /** @param v  Velocities, by hand; those that are missing are zero [m/s]. */
  void Run(double time, const std::vector<Vec3>& v = {}) {
    for (int i = 0, n = static_cast<int>(std::lround(1e3 * time)); i < n; ++i) {
      for (std::size_t hand = 0; hand < states.size(); ++hand) {
        device::DeviceState& state = states[hand];
        state.t_ns += 1'000'000;
        state.V_DH.v = hand < v.size() ? v[hand] : Vec3::Zero();
        state.X_DH = Pose(state.X_DH.q(), state.X_DH.p() + 1e-3 * state.V_DH.v);
        out[hand] = simulation.haptics().Tick(hand, state);
        watches[hand].OnTick(hand, state, out[hand]);
      }
      if (states[0].t_ns % simulation::Simulation::kPhysicsStepNs == 0) {
        simulation.physics().Step(&events);
      }
    }
  }

  [[nodiscard]] Vec3 CentreOf(OccurrenceId id) const {
    return simulation.physics().pose(id) * simulation.model().bodies[id.index()].mass.p_BoBcm_B;
  }

  /** Moves a hand to a place at once; only an empty one should. */
  void PutHand(std::size_t hand, const Vec3& p_W) { states[hand].X_DH = Pose(p_W); }

  void Take(std::size_t hand, OccurrenceId id) {
    PutHand(hand, CentreOf(id));
    Run(0.05);
    states[hand].is_gripping = true;
    Run(0.5);
  }

  /** Takes hold of what another hand has as well. */
  void Help(std::size_t hand, std::size_t other) {
    simulation.physics().PrepareHelp(other, hand);
    PutHand(hand, out[other].X_WD *
                      simulation.model().bodies[out[other].occurrence.index()].mass.p_BoBcm_B);
    Run(0.05);
    states[hand].is_gripping = true;
    Run(0.1);
  }

  simulation::Simulation simulation;
  std::vector<device::DeviceState> states;
  std::vector<haptics::TickOutput> out;
  std::vector<Watch> watches;
  Watch events;
};

}  // namespace hvas::person::testing
