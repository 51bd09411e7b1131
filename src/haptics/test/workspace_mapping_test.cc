#include "haptics/workspace_mapping.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::haptics {
namespace {

WorkspaceMapping MakeMapping() {
  return {{spatial::RotationFromVector({0.3, -0.8, 1.1}), {0.2, -0.1, 0.5}}, 2.5};
}

// X5: device motion is mapped to the scene.
TEST(WorkspaceMapping, ScalesLengthsAndKeepsAngles) {
  const WorkspaceMapping mapping = MakeMapping();
  device::DeviceState a;
  device::DeviceState b;
  b.X_DH = {spatial::RotationFromVector({0, 0.4, 0}), {0.01, 0.02, -0.03}};
  const Hand hand_a = MapToScene(mapping, a);
  const Hand hand_b = MapToScene(mapping, b);
  EXPECT_NEAR((hand_b.X_WH.p() - hand_a.X_WH.p()).norm(), 2.5 * b.X_DH.p().norm(), 1e-15);
  EXPECT_NEAR(spatial::RotationBetween(hand_a.X_WH.q(), hand_b.X_WH.q()).norm(), 0.4, 1e-12);
}

TEST(WorkspaceMapping, VelocityIsTheDerivativeOfThePose) {
  const WorkspaceMapping mapping = MakeMapping();
  constexpr double kStep = 1e-6;
  device::DeviceState now;
  now.X_DH = {spatial::RotationFromVector({0.5, 0.1, -0.2}), {0.05, -0.02, 0.01}};
  now.V_DH = {{0.7, -0.3, 0.2}, {0.1, 0.4, -0.2}};
  device::DeviceState later = now;
  later.X_DH = spatial::Integrate(now.X_DH, now.V_DH, kStep);
  const Hand hand = MapToScene(mapping, now);
  const Hand hand_later = MapToScene(mapping, later);
  EXPECT_LT(((hand_later.X_WH.p() - hand.X_WH.p()) / kStep - hand.V_WH.v).norm(), 1e-8);
  EXPECT_LT(
      (spatial::RotationBetween(hand.X_WH.q(), hand_later.X_WH.q()) / kStep - hand.V_WH.w).norm(),
      1e-6);
}

// Without scaling, the power that the scene gives to the hand is the power that the device gives.
TEST(WorkspaceMapping, UnscaledMappingKeepsPower) {
  WorkspaceMapping mapping = MakeMapping();
  mapping.scale = 1;
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    device::DeviceState state;
    spatial::Wrench F_W;
    for (int k = 0; k < 3; ++k) {
      state.V_DH.v[k] = random.Normal();
      state.V_DH.w[k] = random.Normal();
      F_W.f[k] = random.Normal();
      F_W.t[k] = random.Normal();
    }
    const Hand hand = MapToScene(mapping, state);
    const spatial::Wrench F_D = MapToDevice(mapping, F_W);
    EXPECT_NEAR(F_W.f.dot(hand.V_WH.v) + F_W.t.dot(hand.V_WH.w),
                F_D.f.dot(state.V_DH.v) + F_D.t.dot(state.V_DH.w), 1e-12);
  }
}

}  // namespace
}  // namespace hvas::haptics
