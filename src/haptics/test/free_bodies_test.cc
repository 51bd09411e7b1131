// Parts that move by themselves near the hand: X3, X7, X11.

#include "haptics/free_bodies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "haptics/test/rig.h"
#include "haptics/test/table.h"

namespace hvas::haptics {
namespace {

using contact::testing::Block;
using contact::testing::Build;
using contact::testing::Bushing;
using contact::testing::Shaft;
using spatial::Pose;
using testing::BoxInertia;
using testing::ScriptedHand;
using testing::Table;

/** How far any corner of a box of these half sizes is from where it was [m]. */
double CalcShift(const Pose& X, const Pose& Y, const Vec3& half) {
  double most = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p((i & 1) != 0 ? half.x() : -half.x(), (i & 2) != 0 ? half.y() : -half.y(),
                 (i & 4) != 0 ? half.z() : -half.z());
    most = std::max(most, (X * p - Y * p).norm());
  }
  return most;
}

// N2: a block dropped on its corner lies flat half a second later, within the compliance of its
// contacts, and in ten seconds of being solved not one of its corners moves by 1 um.
TEST(FreeBodies, DroppedBlockComesToRestAndStays) {
  const Vec3 half(0.03, 0.02, 0.01);
  Table table(0.3, 100);  // It does not fall asleep.
  const auto shape = Build(Block(half));
  const Pose X_start(Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, 0.5).normalized())),
                     Vec3(0.01, 0.02, 0.06));
  const auto id = table.AddLoose(shape, X_start, 0.2, BoxInertia(0.2, half));
  table.Drop(id, shape, 0.2, BoxInertia(0.2, half));
  table.Wait(0.5);
  const Pose X_rest = table.scene.pose(id);
  EXPECT_NEAR(X_rest.p().z(), 0.01, 5e-6);
  EXPECT_NEAR((X_rest.q() * Vec3::UnitZ()).z(), 1, 1e-7);
  double most = 0;
  for (int i = 0; i < 100; ++i) {
    table.Wait(0.1);
    most = std::max(most, CalcShift(table.scene.pose(id), X_rest, half));
  }
  EXPECT_LT(most, 1e-6);
  EXPECT_EQ(table.tick->awake().size(), 1);
}

/** How deep a block of 2 kg rests in a fixed one, whose contact has this compliance [m]. */
double CalcRestDepth(std::optional<double> compliance) {
  Table table(0.3, 100);
  const Vec3 half(0.03, 0.02, 0.01);
  const auto base = table.AddFixed(Build(Block(Vec3(0.05, 0.05, 0.01))), Pose(Vec3(0, 0, 0.01)));
  const auto shape = Build(Block(half));
  const auto id = table.AddLoose(shape, Pose(Vec3(0, 0, 0.031)), 2, BoxInertia(2, half));
  table.tick->SetPair({id, base, compliance, std::nullopt});
  table.Drop(id, shape, 2, BoxInertia(2, half));
  table.Wait(1);
  return 0.03 - table.scene.pose(id).p().z();
}

TEST(FreeBodies, X11StatedComplianceOfAPairDecidesHowDeepItRests) {
  const double usual = CalcRestDepth(std::nullopt);
  EXPECT_GT(usual, 0.1e-6);
  EXPECT_EQ(CalcRestDepth(5e-7), usual) << "that of all contacts";
  EXPECT_NEAR(CalcRestDepth(2e-6) / usual, 4, 0.4);
}

/** How far a block slides in a second down a fixed slope of 20 degrees [m]. */
double CalcSlide(std::optional<double> friction) {
  Table table(0.3, 100);
  const Vec3 half(0.03, 0.02, 0.01);
  const Quat slope(Eigen::AngleAxisd(20 * std::numbers::pi / 180, Vec3::UnitY()));
  const auto base =
      table.AddFixed(Build(Block(Vec3(0.2, 0.1, 0.01))), Pose(slope, Vec3(0, 0, 0.2)));
  const auto shape = Build(Block(half));
  const Pose X_start(slope, Vec3(0, 0, 0.2) + slope * Vec3(-0.1, 0, 0.0201));
  const auto id = table.AddLoose(shape, X_start, 0.2, BoxInertia(0.2, half));
  table.tick->SetPair({base, id, std::nullopt, friction});
  table.Drop(id, shape, 0.2, BoxInertia(0.2, half));
  table.Wait(0.5);
  return (table.scene.pose(id).p() - X_start.p()).norm();
}

TEST(FreeBodies, X11StatedFrictionOfAPairDecidesWhetherItSlides) {
  EXPECT_GT(CalcSlide(std::nullopt), 0.02) << "0.3 is less than tan 20 deg";
  EXPECT_LT(CalcSlide(0.6), 1e-3);
}

TEST(ContactPairs, FindEitherOrderAndTheLastOneStated) {
  const contact::BodyId a(1);
  const contact::BodyId b(2);
  ContactPairs pairs;
  EXPECT_EQ(pairs.Find(a, b), nullptr);
  pairs.Set({b, a, 1e-6, std::nullopt});
  pairs.Set({a, contact::BodyId(3), 3e-6, std::nullopt});
  ASSERT_NE(pairs.Find(a, b), nullptr);
  EXPECT_EQ(pairs.Find(a, b)->compliance, 1e-6);
  pairs.Set({a, b, 2e-6, 0.4});
  EXPECT_EQ(pairs.Find(b, a)->compliance, 2e-6);
  EXPECT_EQ(pairs.Find(b, contact::BodyId(3)), nullptr);
}

// A hull would come to lie on top of the pin. Down there, around it, it does not creep either.
TEST(FreeBodies, BushingDroppedOverAPinGoesDown) {
  Table table(0.3, 100);  // It does not fall asleep.
  const auto pin = Build(Shaft(5e-3, 40e-3));
  const auto bush = Build(Bushing(5.1e-3, 12e-3, 20e-3));
  (void)table.AddFixed(pin, Pose());
  const double m = 0.05;
  const Mat3 inertia = Vec3(4e-6, 4e-6, 5e-6).asDiagonal();
  const auto id = table.AddLoose(bush, Pose(Vec3(0.05e-3, 0, 41e-3)), m, inertia);
  table.Drop(id, bush, m, inertia);
  table.Wait(0.05);
  EXPECT_LT(table.scene.pose(id).p().z(), 39e-3);  // It falls, and is not put there.
  EXPECT_GT(table.scene.pose(id).p().z(), 20e-3);
  table.Wait(0.6);
  const Pose& X = table.scene.pose(id);
  EXPECT_NEAR(X.p().z(), 0, 5e-6);
  EXPECT_LT(X.p().head<2>().norm(), 0.1e-3 + 5e-6);  // Within the clearance.
  const Pose X_rest = X;
  table.Wait(5);
  EXPECT_EQ(table.tick->awake().size(), 1);
  EXPECT_LT(CalcShift(table.scene.pose(id), X_rest, Vec3(12e-3, 12e-3, 20e-3)), 1e-6);
}

// X11: the hand feels mu m g, within 5 %, of a part of 1 kg that it pushes over the table, and
// nothing of it before they touch.
TEST(FreeBodies, PushedPartPushesBack) {
  Table table(0.3);
  const Vec3 half(0.03, 0.02, 0.02);
  const auto id =
      table.AddLoose(Build(Block(half)), Pose(Vec3(0, 0, 0.02)), 1, BoxInertia(1, half));
  const Vec3 finger_half(0.005, 0.01, 0.01);
  table.part.shape = Build(Block(finger_half));
  table.part.X_WB_start = Pose(Vec3(-0.040, 0, 0.02));
  table.part.body = table.scene.Add(table.part.shape, table.part.X_WB_start);
  table.part.mass = 0.05;
  table.part.I_BBcm_B = BoxInertia(0.05, finger_half);
  table.part.X_WB_goal = Pose(Vec3(1, 1, 1));
  ScriptedHand hand(table.tick.get(), table.part.X_WB_start);
  table.tick->Take(&table.part);
  hand.MoveEvenly(Vec3(0.1, 0, 0), 4);
  for (std::size_t i = 0; i < hand.samples.size(); ++i) {
    const Vec3 f = hand.samples[i].out.F_felt_W.f;
    if (hand.samples[i].out.X_WD.p().x() < -0.0351) {
      EXPECT_LT(std::abs(f.x()), 0.25);  // The coupling's damper while it sets off.
    } else if (i > 1000) {
      EXPECT_NEAR(-f.x(), 0.3 * 1 * 9.81, 0.05 * 0.3 * 9.81);
    }
  }
  EXPECT_NEAR(table.scene.pose(id).p().x(), hand.last().X_WD.p().x() + 0.035, 20e-6);
}

// A plate that falls on so many feet wakes as many as may move beside it; the last one bears it as
// if it were fixed.
TEST(FreeBodies, OneMoreThanMayMoveIsReportedInTheTick) {
  constexpr double kHeight = 10e-3;
  const Vec3 half_foot(5e-3, 5e-3, 0.5 * kHeight);
  const Vec3 half_plate(80e-3, 5e-3, 3e-3);
  const auto foot = Build(Block(half_foot));
  const auto plate = Build(Block(half_plate));
  for (const std::size_t feet : {FreeBodies::kMaxAwake - 1, FreeBodies::kMaxAwake}) {
    SCOPED_TRACE(feet);
    Table table(0.3, 100);  // It does not fall asleep.
    for (std::size_t i = 0; i < feet; ++i) {
      const double x = -70e-3 + 20e-3 * static_cast<double>(i);
      (void)table.AddLoose(foot, Pose(Vec3(x, 0, 0.5 * kHeight)), 0.01,
                           BoxInertia(0.01, half_foot));
    }
    const Pose X_WB(Vec3(0, 0, kHeight + half_plate.z() + 0.5e-3));
    const auto id = table.AddLoose(plate, X_WB, 0.2, BoxInertia(0.2, half_plate));
    table.Drop(id, plate, 0.2, BoxInertia(0.2, half_plate));
    ScriptedHand hand(table.tick.get(), Pose(Vec3(1, 0, 1)));
    hand.Wait(0.1);
    EXPECT_EQ(table.tick->awake().size(), FreeBodies::kMaxAwake);
    EXPECT_EQ(std::any_of(hand.samples.begin(), hand.samples.end(),
                          [](const testing::Sample& sample) { return sample.out.is_crowded; }),
              feet == FreeBodies::kMaxAwake);
  }
}

}  // namespace
}  // namespace hvas::haptics
