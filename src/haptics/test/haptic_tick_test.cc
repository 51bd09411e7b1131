// What the hand feels without a mate: weight, contact, friction, and nothing where it must not.

#include "haptics/haptic_tick.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "haptics/force_map.h"
#include "haptics/test/rig.h"
#include "haptics/test/values.h"

namespace hvas::haptics {
namespace {

using contact::testing::Ball;
using contact::testing::Block;
using contact::testing::Build;
using spatial::Pose;
using testing::BlockRig;
using testing::CalcDeepest;
using testing::CalcLargestJump;
using testing::kDt;
using testing::kInf;
using testing::kNan;
using testing::Sample;
using testing::ScriptedHand;

constexpr double kBallRadius = 20e-3;

const std::shared_ptr<const contact::Shape>& BallShape() {
  static const auto shape = Build(Ball(kBallRadius, 20e-6));
  return shape;
}

const std::shared_ptr<const contact::Shape>& CubeShape() {
  static const auto shape = Build(Block(Vec3(20e-3, 20e-3, 20e-3)));
  return shape;
}

/** A device that can give what the test asks for. */
TickOptions Strong() {
  TickOptions options;
  options.device.max_force = 25;
  options.device.max_torque = 2;
  return options;
}

TEST(HapticTick, EmptyHandFeelsNothing) {
  contact::Scene scene;
  HapticTick tick({}, &scene);
  ScriptedHand hand(&tick, Pose(Vec3(0.1, 0.2, 0.3)));
  hand.MoveSoftly(Vec3(0.2, 0, 0), 0.2, Vec3(0, 1, 0));
  for (const Sample& s : hand.samples) {
    EXPECT_EQ(s.out.F_H_W.f, Vec3::Zero());
    EXPECT_EQ(s.out.F_H_W.t, Vec3::Zero());
    EXPECT_EQ(s.out.state, HoldState::kEmpty);
    EXPECT_EQ(s.out.X_WD.p(), s.hand.X_DH.p());
  }
}

// X5, X11: the weight is felt, through the one map of all forces (N4).
TEST(HapticTick, X11WeightIsFeltThroughTheMap) {
  const TickOptions options;
  const ForceMap map = MakeForceMap(options.device);
  for (const double mass : {0.01, 0.2, 0.94, 20.0}) {
    BlockRig rig(BallShape(), mass, Pose(Vec3(0, 0, 0.5)));
    rig.hand->Wait(4);
    const TickOutput& out = rig.hand->last();
    const double weight = 9.81 * mass;
    EXPECT_NEAR((out.F_felt_W.f - Vec3(0, 0, -map.Felt(weight))).norm(), 0, 1e-6) << mass;
    EXPECT_NEAR((out.F_true_W.f - Vec3(0, 0, -weight)).norm(), 0, 1e-6) << mass;
    EXPECT_EQ(out.F_H_W.f, out.F_felt_W.f);
    EXPECT_LT(CalcLargestJump(rig.hand->samples), 0.1);
    EXPECT_EQ(out.state, HoldState::kFree);
  }
}

// X11: a part that is held beside its centre of mass turns the hand, on the far side too.
TEST(HapticTick, X11WeightBesideTheGripIsATorque) {
  for (const double lever : {-30e-3, 50e-3}) {
    BlockRig rig(BallShape(), 0.26, Pose(Vec3(0, 0, 0.5)));
    ScriptedHand hand(rig.tick.get(), Pose(Vec3(-lever, 0, 0.5)));
    hand.Wait(3);
    const TickOutput& out = hand.last();
    EXPECT_NEAR(out.F_H_W.t.y(), -lever * out.F_H_W.f.z(), 1e-6);
    EXPECT_GT(std::abs(out.F_H_W.t.y()), 0.035);
    EXPECT_NEAR(out.F_H_W.t.x(), 0, 1e-6);
  }
}

// In free space the displayed part follows the hand, in turning too.
TEST(HapticTick, DisplayedPartFollowsTheHand) {
  BlockRig rig(BallShape(), 0.02, Pose(Vec3(0, 0, 0.3)));
  rig.hand->MoveSoftly(Vec3(0.2, 0.1, 0), 1, Vec3(0.4, 0, 1));
  rig.hand->Wait(1);
  const TickOutput& out = rig.hand->last();
  EXPECT_LT((out.X_WT.p() - out.X_WD.p()).norm(), 0.3e-3);  // The weight on the coupling.
  EXPECT_LT(spatial::RotationBetween(out.X_WT.q(), out.X_WD.q()).norm(), 1e-6);
  EXPECT_NEAR((out.X_WT.p() - Vec3(0.2, 0.1, 0.3)).norm(), 0, 1e-8);
}

// A device without a pose, or a driver gone wrong, gets a force that decays, never a stale one.
TEST(HapticTick, BrokenPosesGiveADecayingForce) {
  const Vec3 far(kInf, 0, 0);
  const Pose bad_poses[] = {Pose(Vec3(kNan, 0, 0)), Pose(far),
                            Pose(Quat(kNan, 0, 0, 0), Vec3::Zero())};
  for (int kind = 0; kind < 5; ++kind) {
    BlockRig rig(BallShape(), 0.26, Pose(Vec3(0, 0, 0.5)));
    rig.hand->Wait(2);
    const double start = rig.hand->last().F_H_W.f.norm();
    ASSERT_GT(start, 1);
    device::DeviceState state = rig.hand->samples.back().hand;
    device::DeviceState broken = state;
    if (kind < 3) {
      broken.X_DH = bad_poses[kind];
    } else if (kind == 3) {
      broken.V_DH.w.z() = kNan;
    } else {
      broken.is_valid = false;
    }
    double before = start;
    for (int i = 0; i < 50; ++i) {
      const TickOutput out = rig.tick->Tick(broken);
      ASSERT_TRUE(out.F_H_W.f.allFinite() && out.F_H_W.t.allFinite());
      ASSERT_TRUE(spatial::IsFinite(out.X_WD) && spatial::IsFinite(out.X_WT));
      const double now = out.F_H_W.f.norm();
      EXPECT_NEAR(now, std::max(0.0, before - 0.4), 1e-9) << kind;
      before = now;
    }
    EXPECT_EQ(before, 0);
    // And it comes back softly when the pose does.
    for (int i = 0; i < 500; ++i) {
      const double now = rig.tick->Tick(state).F_H_W.f.norm();
      EXPECT_LT(std::abs(now - before), 0.4 + 1e-9);
      before = now;
    }
    EXPECT_NEAR(before, start, 0.05);
  }
}

// Finite nonsense must not break what comes after.
TEST(HapticTick, AbsurdButFinitePosesAreSurvived) {
  for (const double size : {1e3, 1e30, 1e200, 1e308}) {
    BlockRig rig(BallShape(), 0.26, Pose(Vec3(0, 0, 0.05)));
    rig.hand->Wait(0.1);
    device::DeviceState state = rig.hand->samples.back().hand;
    device::DeviceState absurd = state;
    absurd.X_DH = Pose(Vec3(size, -size, size));
    absurd.V_DH = {Vec3(size, 0, 0), Vec3(0, size, 0)};
    for (int i = 0; i < 20; ++i) {
      const TickOutput out = rig.tick->Tick(absurd);
      ASSERT_TRUE(out.F_H_W.f.allFinite() && out.F_H_W.t.allFinite()) << size;
      ASSERT_TRUE(spatial::IsFinite(out.X_WD)) << size;
    }
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(spatial::IsFinite(rig.tick->Tick(state).X_WD)) << size;
    }
  }
}

// Force honesty (X7, X11): what presses on the block is what the hand gives and the weight, and the
// part sinks in by the contact's compliance.
TEST(HapticTick, PressIsBalanced) {
  for (const double press : {0.5, 3.0, 10.0, 15.0}) {
    BlockRig rig(BallShape(), 0.26, Pose(Vec3(0, 0, kBallRadius + 1e-3)), Strong());
    rig.hand->Wait(0.5);
    const double stretch = press / rig.options.coupling.k_lin;
    rig.hand->MoveSoftly(Vec3(0, 0, -1e-3 - stretch), 0.5);
    rig.hand->Wait(2);
    const TickOutput& out = rig.hand->last();
    ASSERT_EQ(out.contact_count, 1);
    // On the part: the coupling (the hand feels its opposite), the weight as felt, the contact.
    const ForceMap map = MakeForceMap(rig.options.device);
    const Vec3 weight(0, 0, -map.Felt(9.81 * 0.26));
    const Vec3 sum = out.f_C_W + weight - out.F_felt_W.f;
    EXPECT_LT(sum.norm(), 0.01 * out.f_C_W.norm()) << press;
    EXPECT_NEAR(out.F_felt_W.f.z(), press, 0.05 + 0.01 * press);
    EXPECT_NEAR(-out.deepest, rig.options.contact.compliance * out.f_C_W.norm(), 0.5e-6);
    EXPECT_NEAR((out.p_WC - Vec3(0, 0, 0)).norm(), 0, 0.2e-3);
    EXPECT_LT(CalcLargestJump(rig.hand->samples), 0.5);
  }
}

Pose Standing(double height) {
  return Pose(Vec3(0, 0, height));
}

/** A cube on its corner or edge. */
Pose On(const Vec3& lowest, double height) {
  const Quat q = spatial::RotationTaking(lowest.normalized(), -Vec3::UnitZ());
  return {q, Vec3(0, 0, height)};
}

// X7: pressed with 10 N, slowly or with a knock, the displayed part goes no deeper than 50 um.
TEST(HapticTick, DisplayedPartStaysWithinFiftyMicrometres) {
  struct Case {
    const char* name;
    std::shared_ptr<const contact::Shape> shape;
    Pose X_WB;
    double gap;
  };

  const double side = 20e-3;
  const Case cases[] = {
      {"ball", BallShape(), Standing(kBallRadius + 20e-3), 20e-3},
      {"face", CubeShape(), Standing(side + 20e-3), 20e-3},
      {"edge", CubeShape(), On(Vec3(1, 1, 0), side * std::sqrt(2.0) + 20e-3), 20e-3},
      {"corner", CubeShape(), On(Vec3(1, 1, 1), side * std::sqrt(3.0) + 20e-3), 20e-3},
  };
  double worst = 0;
  for (const Case& c : cases) {
    for (const double speed : {0.02, 0.1}) {
      BlockRig rig(c.shape, 0.26, c.X_WB, Strong());
      rig.hand->Wait(0.5);
      const double way = c.gap + 10.0 / rig.options.coupling.k_lin;
      rig.hand->MoveEvenly(Vec3(0, 0, -way), way / speed);
      rig.hand->Wait(0.7);
      const double deepest = CalcDeepest(rig.hand->samples);
      worst = std::max(worst, deepest);
      EXPECT_LT(deepest, 50e-6) << c.name << " at " << speed;
      EXPECT_GT(rig.hand->last().F_felt_W.f.z(), 8) << c.name << " at " << speed;
    }
  }
  RecordProperty("deepest_um", std::to_string(1e6 * worst));
}

// X11: friction when sliding along a face is mu times what presses, against the motion.
TEST(HapticTick, X11SlidingAlongAFaceIsResistedByFriction) {
  for (const Vec3& direction :
       {Vec3(1, 0, 0), Vec3(-0.6, 0.8, 0), Vec3(std::sqrt(0.5), std::sqrt(0.5), 0)}) {
    BlockRig rig(CubeShape(), 0.26, Standing(20.5e-3), Strong());
    rig.hand->Wait(0.5);
    rig.hand->MoveSoftly(Vec3(0, 0, -4e-3), 0.5);
    rig.hand->Wait(0.3);
    rig.hand->MoveEvenly(30e-3 * direction, 1.5);
    const TickOutput& out = rig.hand->last();
    const ForceMap map = MakeForceMap(rig.options.device);
    const double normal = out.F_felt_W.f.z() + map.Felt(9.81 * 0.26);
    const Vec3 along = out.F_felt_W.f - out.F_felt_W.f.z() * Vec3::UnitZ();
    EXPECT_NEAR(along.norm(), rig.options.contact.friction.kinetic_coefficient * normal,
                0.05 * along.norm());
    EXPECT_LT(along.normalized().dot(direction), -0.99);
    EXPECT_LT(CalcDeepest(rig.hand->samples), 50e-6);
  }
}

// N6: rubbing to and fro on a face takes energy from the hand and gives none.
TEST(HapticTick, ContactIsPassiveOverAClosedLoop) {
  BlockRig rig(CubeShape(), 0.26, Standing(22e-3), Strong());
  rig.hand->Wait(3);
  const std::size_t start = rig.hand->samples.size();
  rig.hand->MoveSoftly(Vec3(0, 0, -6e-3), 0.5);
  rig.hand->MoveSoftly(Vec3(20e-3, 0, 0), 0.5);
  rig.hand->MoveSoftly(Vec3(-20e-3, 0, 0), 0.5);
  rig.hand->MoveSoftly(Vec3(0, 0, 6e-3), 0.5);
  rig.hand->Wait(3);
  double energy = 0;
  for (std::size_t i = start; i < rig.hand->samples.size(); ++i) {
    const Sample& s = rig.hand->samples[i];
    energy += kDt * (s.out.F_H_W.f.dot(s.hand.V_DH.v) + s.out.F_H_W.t.dot(s.hand.V_DH.w));
  }
  EXPECT_LT(energy, 0);
  EXPECT_GT(energy, -0.1);
}

// Letting go returns the part where it is shown, and the force fades by the gate.
TEST(HapticTick, DropLeavesThePartWhereItIs) {
  BlockRig rig(BallShape(), 0.26, Pose(Vec3(0, 0, 0.3)));
  rig.hand->MoveSoftly(Vec3(0.05, 0, 0), 2);
  const TickOutput held = rig.hand->last();
  const Pose X_WB = rig.tick->Drop().X_WB;
  EXPECT_EQ(X_WB.p(), held.X_WD.p());
  double before = held.F_H_W.f.norm();
  ASSERT_GT(before, 1);
  for (int i = 0; i < 20; ++i) {
    rig.hand->Wait(kDt);
    const TickOutput& out = rig.hand->last();
    EXPECT_EQ(out.state, HoldState::kEmpty);
    EXPECT_NEAR(out.F_H_W.f.norm(), std::max(0.0, before - 0.4), 1e-9);
    before = out.F_H_W.f.norm();
  }
  EXPECT_EQ(before, 0);
}

// A part may be taken anywhere and any way round: it does not jump into the hand.
TEST(HapticTick, TakingAPartMovesNothing) {
  BlockRig rig(BallShape(), 0.26, On(Vec3(1, 2, 3), 0.2));
  ScriptedHand hand(rig.tick.get(),
                    Pose(spatial::RotationFromVector(Vec3(0, 1, 2)), Vec3(0.03, -0.02, 0.21)));
  hand.Wait(kDt);
  EXPECT_LT((hand.last().X_WD.p() - rig.part.X_WB_start.p()).norm(), 1e-6);
  EXPECT_LT(hand.last().F_H_W.f.norm(), 0.02);
  hand.Wait(0.5);
  EXPECT_LT(CalcLargestJump(hand.samples), 0.1);
}

}  // namespace
}  // namespace hvas::haptics
