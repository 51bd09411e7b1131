#include "haptics/workspace.h"

#include <cmath>

#include <gtest/gtest.h>

#include "haptics/test/values.h"

namespace hvas::haptics {
namespace {

using device::DeviceState;
using spatial::Pose;
using testing::kDt;

DeviceState At(const Vec3& p, const Quat& q = Quat::Identity()) {
  DeviceState state;
  state.X_DH = Pose(q, p);
  return state;
}

WorkspaceOptions Box(double edge) {
  WorkspaceOptions options;
  options.mapping.X_WD = Pose(spatial::RotationFromVector(Vec3(0.1, -0.4, 0.7)), Vec3(1, 2, 3));
  options.mapping.scale = 2;
  options.box = Vec3::Constant(edge);
  return options;
}

TEST(WorkspaceTest, X5InsideTheBoxItIsTheMappingAlone) {
  const WorkspaceOptions options = Box(0.2);
  Workspace workspace(options);
  DeviceState state = At(Vec3(0.05, -0.07, 0.02), spatial::RotationFromVector(Vec3(0.2, 0, 0.1)));
  state.V_DH = {Vec3(0.1, 0.2, 0.3), Vec3(0.01, 0.02, -0.03)};
  const Hand hand = workspace.Update(state, kDt);
  const Hand expected = MapToScene(options.mapping, state);
  EXPECT_EQ(hand.X_WH.p(), expected.X_WH.p());
  EXPECT_EQ(hand.V_WH.v, expected.V_WH.v);
  EXPECT_FALSE(workspace.is_in_border());
  // And the inverse finds the handle again.
  const Pose X_DH = MapPoseToDevice(workspace.mapping(), hand.X_WH);
  EXPECT_LT((X_DH.p() - state.X_DH.p()).norm(), 1e-14);
  EXPECT_LT(spatial::RotationBetween(X_DH.q(), state.X_DH.q()).norm(), 1e-14);
}

TEST(WorkspaceTest, InTheBorderTheHandDriftsOnAndFeelsIt) {
  Workspace workspace(Box(0.2));
  const Quat q_WD = Box(0.2).mapping.X_WD.q();
  const DeviceState state = At(Vec3(0.09, 0, 0));  // half way into the border of 20 mm
  Vec3 before = workspace.Update(state, kDt).X_WH.p();
  for (int i = 0; i < 100; ++i) {
    const Hand hand = workspace.Update(state, kDt);
    const Vec3 step = hand.X_WH.p() - before;
    EXPECT_LT((step - q_WD * Vec3(0.25 * 0.4 * kDt, 0, 0)).norm(), 1e-12);
    EXPECT_LT((step / kDt - hand.V_WH.v).norm(), 1e-9);
    before = hand.X_WH.p();
  }
  EXPECT_NEAR(workspace.ToDevice({}).f.x(), -0.6, 1e-12);
  EXPECT_EQ(workspace.ToDevice({}).f.y(), 0);
  // Beyond the edge it is no faster and no stronger.
  (void)workspace.Update(At(Vec3(0, 0, -5)), kDt);
  EXPECT_NEAR(workspace.ToDevice({}).f.z(), 1.2, 1e-12);
}

TEST(WorkspaceTest, EverythingInTheSceneCanBeReached) {
  // A hand that pulls the handle towards where its target would be gets there.
  Workspace workspace(Box(0.1));
  const Pose X_WT(Quat::Identity(), Vec3(1.9, 1.2, 3.4));
  Vec3 p = Vec3::Zero();
  Hand hand;
  for (int i = 0; i < 20'000; ++i) {
    Vec3 wanted = MapPoseToDevice(workspace.mapping(), X_WT).p();
    wanted = wanted.cwiseMax(-0.05).cwiseMin(0.05);
    p += 0.01 * (wanted - p);
    hand = workspace.Update(At(p), kDt);
  }
  EXPECT_LT((hand.X_WH.p() - X_WT.p()).norm(), 1e-3);
}

TEST(WorkspaceTest, ClutchingMovesTheHandleAndNotTheHand) {
  Workspace workspace(Box(0.2));
  const Quat q = spatial::RotationFromVector(Vec3(0.3, 0.1, -0.2));
  const Hand before = workspace.Update(At(Vec3(0.06, 0, 0), q), kDt);
  DeviceState clutching = At(Vec3(-0.05, 0.03, 0.01), Quat::Identity());
  clutching.is_clutching = true;
  clutching.V_DH.v = Vec3(0.3, 0, 0);
  const Hand during = workspace.Update(clutching, kDt);
  EXPECT_EQ(during.X_WH.p(), before.X_WH.p());
  EXPECT_EQ(during.V_WH.v.norm(), 0);
  const Hand after = workspace.Update(At(clutching.X_DH.p(), clutching.X_DH.q()), kDt);
  EXPECT_LT((after.X_WH.p() - before.X_WH.p()).norm(), 1e-14);
  EXPECT_LT(spatial::RotationBetween(after.X_WH.q(), before.X_WH.q()).norm(), 1e-14);
  // From there a turn of the handle is a turn of the hand about the same axis.
  const Quat turn = spatial::RotationFromVector(Vec3(0, 0.2, 0));
  const Hand turned = workspace.Update(At(clutching.X_DH.p(), turn), kDt);
  const Quat q_WD = Box(0.2).mapping.X_WD.q();
  EXPECT_LT(
      (spatial::RotationBetween(after.X_WH.q(), turned.X_WH.q()) - q_WD * Vec3(0, 0.2, 0)).norm(),
      1e-12);
}

TEST(WorkspaceTest, AfterAGapTheHandGoesOnFromWhereItWas) {  // drift-free regrasp
  Workspace workspace(Box(0.2));
  const Hand before = workspace.Update(At(Vec3(0.02, 0, 0)), kDt);
  for (int i = 0; i < 50; ++i) {
    workspace.Lose();
    const Quat q = spatial::RotationFromVector(Vec3(0.1 * i, 0, 0));
    const Hand after = workspace.Update(At(Vec3(0.02, 0.001 * i, -0.03), q), kDt);
    EXPECT_LT((after.X_WH.p() - before.X_WH.p()).norm(), 1e-13) << i;
    EXPECT_LT(spatial::RotationBetween(after.X_WH.q(), before.X_WH.q()).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace hvas::haptics
