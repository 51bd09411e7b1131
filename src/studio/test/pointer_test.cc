#include "studio/pointer.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/clock.h"

namespace hvas::studio {
namespace {

using spatial::Pose;

constexpr double kDt = 1e-3;
constexpr double kMaxSpeed = 0.8;  // [m/s]
constexpr double kMaxTurn = 6;     // [rad/s]

simulation::OperatorInput Tick(bool sees_part) {
  simulation::OperatorInput input;
  input.dt = kDt;
  input.sees_part = sees_part;
  return input;
}

Pose At(double x, double y = 0, double z = 0) {
  return Pose(Vec3(x, y, z));
}

Pose Turned(double angle, const Vec3& p = Vec3::Zero()) {
  return {spatial::RotationFromVector(Vec3(0, 0, angle)), p};
}

/** Stands still, ten seconds after its beginning. */
const Clock& TestClock() {
  static VirtualClock clock;
  static const bool has_begun = [] {
    clock.Advance(10 * kNsPerSecond);
    return true;
  }();
  (void)has_begun;
  return clock;
}

/** Arrived so long ago. */
PointerInput Input(const Pose& X_WH, std::int64_t age_ns = 0) {
  return {TestClock().NowNs() - age_ns, X_WH, true};
}

bool IsFinite(const device::DeviceState& state) {
  return spatial::IsFinite(state.X_DH) && state.V_DH.w.allFinite() && state.V_DH.v.allFinite();
}

TEST(PointerTest, EmptyHandIsWhereItIsWantedAtOnce) {
  PointerOperator pointer(At(0), TestClock());
  pointer.Move(Input(At(0.5, -0.2, 0.1)));
  const auto state = pointer.Step(Tick(false));
  EXPECT_EQ(state.X_DH.p(), Vec3(0.5, -0.2, 0.1));
  EXPECT_EQ(state.V_DH.v, Vec3::Zero());
  EXPECT_TRUE(state.is_gripping);
}

TEST(PointerTest, HandStaysAtItsStartUntilTheFirstInput) {
  PointerOperator pointer(At(0.1, 0.2, 0.3), TestClock());
  for (int i = 0; i < 500; ++i) {
    const auto state = pointer.Step(Tick(i % 2 == 0));
    EXPECT_LT((state.X_DH.p() - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
    EXPECT_FALSE(state.is_gripping);
    EXPECT_EQ(state.client_age_ns, 0);
  }
}

TEST(PointerTest, HoldingHandIsNoFasterThanAHand) {
  PointerOperator pointer(At(0), TestClock());
  Vec3 p_last = Vec3::Zero();
  Quat q_last = Quat::Identity();
  double fastest = 0;
  double fastest_turn = 0;
  for (int i = 0; i < 2000; ++i) {
    pointer.Move(Input(Turned(3, Vec3(1, 0, 0))));
    const auto state = pointer.Step(Tick(true));
    ASSERT_TRUE(IsFinite(state));
    fastest = std::max(fastest, (state.X_DH.p() - p_last).norm() / kDt);
    fastest_turn =
        std::max(fastest_turn, spatial::RotationBetween(q_last, state.X_DH.q()).norm() / kDt);
    EXPECT_LE(state.V_DH.v.norm(), kMaxSpeed * (1 + 1e-9));
    EXPECT_LE(state.V_DH.w.norm(), kMaxTurn * (1 + 1e-9));
    p_last = state.X_DH.p();
    q_last = state.X_DH.q();
  }
  EXPECT_LE(fastest, kMaxSpeed * (1 + 1e-6));
  EXPECT_LE(fastest_turn, kMaxTurn * (1 + 1e-6));
  EXPECT_GT(fastest, 0.9 * kMaxSpeed);  // it did hurry
  EXPECT_LT((p_last - Vec3(1, 0, 0)).norm(), 1e-6);
  EXPECT_LT(spatial::RotationBetween(q_last, Turned(3).q()).norm(), 1e-6);
}

/** Steps of a mouse, 60 a second along a line of 0.12 m/s, come out as a motion without steps. */
TEST(PointerTest, StepsOfTheInputAreSmoothed) {
  constexpr double kSpeed = 0.12;  // [m/s]
  constexpr int kEvery = 16;       // [ticks] between inputs
  PointerOperator pointer(At(0), TestClock());
  double x_last = 0;
  double slowest = 1;
  double fastest = 0;
  double hardest = 0;  // change of speed in a tick [m/s]
  double v_last = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x_wanted = kSpeed * kDt * (i / kEvery) * kEvery;
    pointer.Move(Input(At(x_wanted)));
    const auto state = pointer.Step(Tick(true));
    const double v = (state.X_DH.p().x() - x_last) / kDt;
    x_last = state.X_DH.p().x();
    if (i > 200) {
      slowest = std::min(slowest, v);
      fastest = std::max(fastest, v);
      hardest = std::max(hardest, std::abs(v - v_last));
    }
    v_last = v;
  }
  EXPECT_GT(slowest, 0.4 * kSpeed);  // without the stages it would stand still between inputs
  EXPECT_LT(fastest, 1.6 * kSpeed);
  EXPECT_LT(hardest, 0.25 * kSpeed);
  // It lags by the two stages of 12 ms, and not by more than an input on top.
  EXPECT_LT(kSpeed * 1.0 - x_last, kSpeed * (0.024 + 0.016 + 0.002));
}

TEST(PointerTest, VelocityIsThatOfThePose) {
  PointerOperator pointer(At(0), TestClock());
  Vec3 p_last = Vec3::Zero();
  for (int i = 0; i < 300; ++i) {
    pointer.Move(Input(At(0.001 * std::sin(0.02 * i), 2e-4 * i)));
    const auto state = pointer.Step(Tick(true));
    EXPECT_LT((state.V_DH.v - (state.X_DH.p() - p_last) / kDt).norm(), 1e-9);
    p_last = state.X_DH.p();
  }
}

TEST(PointerTest, HandStaysWhereItIsWhenNothingIsHeard) {  // N11: 250 ms without input
  PointerOperator pointer(At(0), TestClock());
  for (int i = 0; i < 100; ++i) {
    pointer.Move(Input(At(0.2)));
    (void)pointer.Step(Tick(true));
  }
  const Vec3 p_before = pointer.Step(Tick(true)).X_DH.p();
  ASSERT_GT((Vec3(0.2, 0, 0) - p_before).norm(), 0.1);  // on its way, far from the goal
  pointer.Move(Input(At(0.2), PointerOperator::kInputTimeoutNs + 1'000'000));
  Vec3 p_last = p_before;
  for (int i = 0; i < 1000; ++i) {
    const auto state = pointer.Step(Tick(true));
    ASSERT_TRUE(IsFinite(state));
    EXPECT_GE(state.client_age_ns, PointerOperator::kInputTimeoutNs);
    p_last = state.X_DH.p();
    // What the first stage was ahead by, 0.8 m/s for 12 ms, is shared between the two.
    EXPECT_LT((p_last - p_before).norm(), kMaxSpeed * 0.012);
  }
  EXPECT_LT(pointer.Step(Tick(true)).V_DH.v.norm(), 1e-6);
}

TEST(PointerTest, HandGoesOnWhenItIsHeardAgain) {
  PointerOperator pointer(At(0), TestClock());
  pointer.Move(Input(At(0.1), 2 * PointerOperator::kInputTimeoutNs));
  EXPECT_LT(pointer.Step(Tick(true)).X_DH.p().norm(), 1e-12);
  Vec3 p_last;
  for (int i = 0; i < 400; ++i) {
    pointer.Move(Input(At(0.1)));
    p_last = pointer.Step(Tick(true)).X_DH.p();
  }
  EXPECT_LT((p_last - Vec3(0.1, 0, 0)).norm(), 1e-6);
}

TEST(PointerTest, AgeIsToldWhileSomethingIsInTheHand) {
  PointerOperator pointer(At(0), TestClock());
  pointer.Move(Input(At(0), 100'000'000));
  const auto state = pointer.Step(Tick(true));
  EXPECT_EQ(state.client_age_ns, 100'000'000);
  EXPECT_EQ(pointer.Step(Tick(false)).client_age_ns, 0);  // nothing that could be left hanging
  pointer.Move(Input(At(0), -1'000'000'000));             // from the future
  EXPECT_EQ(pointer.Step(Tick(true)).client_age_ns, 0);
}

/** Whatever passes ReadClientFrames: every finite float, and turns of half a circle. */
TEST(PointerTest, NothingThatIsFiniteMakesItNot) {
  PointerOperator pointer(At(0), TestClock());
  const double huge = 3e38;
  for (const bool sees_part : {false, true, false}) {
    for (const Pose& X : {At(huge, -huge, huge), At(-huge), Turned(M_PI), Turned(-M_PI),
                          Turned(M_PI, Vec3(0, 0, huge)), At(0)}) {
      for (int i = 0; i < 20; ++i) {
        pointer.Move(Input(X));
        ASSERT_TRUE(IsFinite(pointer.Step(Tick(sees_part))));
      }
    }
  }
}

TEST(PointerTest, MotionIsInTheDevicesFrameAndScale) {
  PointerOperator pointer(At(0), TestClock());
  simulation::OperatorInput tick = Tick(false);
  tick.workspace.X_WD = {spatial::RotationFromVector(Vec3(0, 0, M_PI / 2)), Vec3(1, 0, 0)};
  tick.workspace.scale = 2;
  pointer.Move(Input(At(1, 4)));
  const auto state = pointer.Step(tick);
  EXPECT_LT((haptics::MapPoseToDevice(tick.workspace, At(1, 4)).p() - state.X_DH.p()).norm(),
            1e-12);
  EXPECT_LT((state.X_DH.p() - Vec3(2, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace hvas::studio
