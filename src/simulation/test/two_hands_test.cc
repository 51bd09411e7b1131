// Two hands in one scene: X3, X4, X7, N8.

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "device/emulation/emulator.h"
#include "simulation/device_session.h"
#include "simulation/executors.h"
#include "simulation/test/session.h"
#include "simulation/test/small_products.h"

namespace hvas::simulation {
namespace {

using device::DeviceState;
using testing::OccurrenceId;
using testing::Pose;
using testing::Watch;

static_assert(noexcept(std::declval<Simulation&>().HapticTick(1,
                                                              std::declval<const DeviceState&>())));
static_assert(noexcept(std::declval<haptics::HapticTick&>().ShareSceneWith(nullptr, true)));

constexpr double kHalf = 15e-3;  // [m] of each block's edges
const OccurrenceId kFirst(0);
const OccurrenceId kSecond(1);
const OccurrenceId kThird(2);

/** Three blocks with nothing to do with one another. */
const std::shared_ptr<const Model>& Blocks() {
  static const std::shared_ptr<const Model> model = [] {
    product::Product product;
    product.name = "blocks";
    const auto block =
        testing::AddPart(&product, "block", contact::testing::Block(Vec3::Constant(kHalf)));
    for (int i = 0; i < 3; ++i) {
      testing::Place(&product, block, "block " + std::to_string(i), Pose(Vec3(0.1 * i, 0, 0)));
    }
    testing::Complete(&product);
    Diagnostics diagnostics;
    return *Compile(std::make_shared<product::Product>(product), testing::FastOptions(),
                    &diagnostics);
  }();
  return model;
}

/** Two hands that go from place to place at constant speed, turning nothing. */
class TwoHands {
 public:
  explicit TwoHands(std::shared_ptr<const Model> model)
      : simulation(std::move(model), std::vector<haptics::TickOptions>(2)) {}

  void Run(double time, const Vec3& v_0 = Vec3::Zero(), const Vec3& v_1 = Vec3::Zero()) {
    const std::array v{v_0, v_1};
    for (int i = 0, n = static_cast<int>(std::lround(1e3 * time)); i < n; ++i) {
      for (std::size_t hand = 0; hand < 2; ++hand) {
        DeviceState& state = states[hand];
        state.t_ns += 1'000'000;
        state.V_DH.v = v[hand];
        state.X_DH = Pose(state.X_DH.q(), state.X_DH.p() + 1e-3 * v[hand]);
        out[hand] = simulation.HapticTick(hand, state);
        watches[hand].OnTick(hand, state, out[hand]);
      }
      if (states[0].t_ns % Simulation::kPhysicsStepNs == 0) {
        simulation.PhysicsStep(&events);
      }
    }
  }

  [[nodiscard]] Vec3 CentreOf(OccurrenceId id) const {
    return simulation.pose(id) * simulation.model().bodies[id.index()].mass.p_BoBcm_B;
  }

  /** Moves a hand to a place at once; only an empty one should. */
  void PutHand(std::size_t hand, const Vec3& p_W) { states[hand].X_DH = Pose(p_W); }

  void Take(std::size_t hand, OccurrenceId id) {
    PutHand(hand, CentreOf(id));
    Run(0.05);
    states[hand].is_gripping = true;
    Run(0.5);
  }

  /** With a block in each hand, face to face along x, 5 mm apart, 10 cm over where they lay. */
  void TakeBlocksUp() {
    Take(0, kFirst);
    Take(1, kSecond);
    ASSERT_EQ(simulation.placement(kFirst), Placement::kHeld);
    ASSERT_EQ(simulation.placement(kSecond), Placement::kHeld);
    const Vec3 up(0, 0, 0.1);
    Run(1.0, up, up);
    const Vec3 p_beside = states[0].X_DH.p() + Vec3(2 * kHalf + 5e-3, 0, 0);
    Run(1.0, Vec3::Zero(), p_beside - states[1].X_DH.p());
    Run(0.3);
  }

  Simulation simulation;
  std::array<DeviceState, 2> states;
  std::array<haptics::TickOutput, 2> out;
  std::array<Watch, 2> watches;
  Watch events;
};

TEST(TwoHandsTest, PartsPushAgainstEachOtherWithOneForce) {  // X7
  TwoHands hands(Blocks());
  hands.TakeBlocksUp();
  for (const haptics::TickOutput& out : hands.out) {
    EXPECT_EQ(out.contact_count, 0);
  }
  hands.Run(0.1, Vec3(0.1, 0, 0));
  for (int k = 0; k < 10; ++k) {
    hands.Run(0.1);
    std::printf(
        "x %.3f %.3f  y %.3f %.3f z %.3f %.3f deep %.1f %.1f n %d %d t %.4f %.4f\n",
        hands.out[0].F_felt_W.f.x(), hands.out[1].F_felt_W.f.x(), hands.out[0].F_felt_W.f.y(),
        hands.out[1].F_felt_W.f.y(), hands.out[0].F_felt_W.f.z(), hands.out[1].F_felt_W.f.z(),
        1e6 * hands.out[0].deepest, 1e6 * hands.out[1].deepest, hands.out[0].contact_count,
        hands.out[1].contact_count, hands.out[0].F_felt_W.t.norm(), hands.out[1].F_felt_W.t.norm());
  }
  // On the way together at 50 mm/s.
  for (const double v : {0.05, -0.05, 0.2, -0.2}) {
    std::printf("v %g\n", v);
    for (int k = 0; k < 5; ++k) {
      hands.Run(0.1, Vec3(v, 0, 0), Vec3(v, 0, 0));
      std::printf("x %.3f %.3f deep %.1f %.1f n %d %d jump %g %g\n", hands.out[0].F_felt_W.f.x(),
                  hands.out[1].F_felt_W.f.x(), 1e6 * hands.out[0].deepest,
                  1e6 * hands.out[1].deepest, hands.out[0].contact_count,
                  hands.out[1].contact_count, hands.watches[0].largest_jump,
                  hands.watches[1].largest_jump);
    }
  }
}

}  // namespace
}  // namespace hvas::simulation
