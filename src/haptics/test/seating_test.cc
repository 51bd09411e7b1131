// Being in place: however far the hand pushes on, and when a part is let go of beside its place.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::Above;
using testing::HeldRig;
using testing::kDt;
using testing::MakeFit;
using testing::Rig;

constexpr double kThickness = 2e-3;
constexpr double kHalfWidth = 40e-3;

/** A flat gasket over the block on which it is put: its lower side on the block's top, and a hole
 of it over a hole of the block, in which there is no bolt yet. */
struct GasketRig : HeldRig {
  explicit GasketRig(const Vec3& p_above, TickOptions the_options = {})
      : HeldRig(std::move(the_options)) {
    static const auto block =
        contact::testing::Build(contact::testing::Block(Vec3(0.1, 0.1, 0.02)));
    static const auto gasket = contact::testing::Build(
        contact::testing::Block(Vec3(kHalfWidth, 0.75 * kHalfWidth, 0.5 * kThickness)));
    const contact::BodyId base = scene.Add(block, Pose(Vec3(0, 0, -0.02)));
    Place(gasket, Pose(place() + p_above));
    part.X_WB_goal = Pose(place());
    part.mass = 1e-4;  // it hangs where it is held
    part.I_BBcm_B = 5e-8 * Mat3::Identity();
    HeldMate face;
    face.id = product::MateId(0);
    face.capture = {product::MateKind::kFaceFace, 0, 0, 0, 0, 0};
    face.capture.reach = 0.5 * kHalfWidth;
    face.X_BN = {Quat(0, 1, 0, 0), Vec3(0, 0, -0.5 * kThickness)};
    face.is_stop = true;
    face.body = base;
    face.held_faces = face.placed_faces = testing::Faces({}, {});
    part.mates = {face};
    for (const double side : {-1, 1}) {
      HeldMate hole = face;
      hole.id = product::MateId(part.mates.size());
      hole.capture = {
          product::MateKind::kAxisHole, -10e-3, 0, -0.5 * kThickness, 0.5 * kThickness, 0};
      hole.X_WM = Pose(Vec3(0.7 * side * kHalfWidth, 0, 0));
      hole.X_BN = hole.X_WM;
      hole.radius = 3e-3;
      hole.is_stop = false;
      part.mates.push_back(hole);
    }
    Take();
  }

  static Vec3 place() { return {0, 0, 0.5 * kThickness}; }
};

// A hand that leads a part far beyond its place, quickly or slowly, straight or from the side, has
// it in its place all the same.
TEST(Seating, TakesThePartHoweverFarTheHandGoesOn) {
  for (const double beyond : {0.0, 2e-3, 8e-3, 15e-3, 30e-3, 60e-3}) {
    for (const double aside : {-0.2, 0.0, 0.2}) {  // of the way beyond
      for (const double time : {0.05, 0.2, 1.0}) {
        const Vec3 p_above(1e-3, -1e-3, 20e-3);
        GasketRig rig(p_above);
        rig.hand->Wait(0.5);
        const Vec3 way = beyond * Vec3(0, aside, -1);
        rig.hand->MoveSoftly(way - p_above, time);
        rig.hand->Wait(2);
        const std::string what = std::to_string(1e3 * beyond) + " mm beyond, " +
                                 std::to_string(aside) + " of it aside, in " +
                                 std::to_string(time) + " s";
        EXPECT_EQ(rig.hand->last().state, HoldState::kSeated) << what;
        const LetGo let_go = rig.tick->Drop();
        EXPECT_TRUE(let_go.is_in_place) << what;
        EXPECT_EQ(let_go.to_place, 0) << what;
        EXPECT_EQ(let_go.X_WB.p(), rig.part.X_WB_goal.p()) << what;
      }
    }
  }
}

/** Holds the gasket beside its place until it hangs there, and lets go of it. */
LetGo LetGoBeside(const Vec3& beside, double finish_distance, bool is_blocked = false) {
  TickOptions options;
  options.guidance.finish_distance = finish_distance;
  options.condition = Condition::kCollision;  // nothing draws it away from where it is held
  options.guidance.match_distance = 0;
  GasketRig rig(beside, options);
  if (is_blocked) {
    static const auto pin =
        contact::testing::Build(contact::testing::Block(Vec3(2e-3, 2e-3, 8e-3)));
    const double gap = 0.25e-3;  // between the pin and the gasket that hangs beside it
    rig.scene.Add(pin,
                  Pose(Vec3(GasketRig::place().x() + beside.x() - kHalfWidth - 2e-3 - gap, 0, 0)));
  }
  rig.hand->Wait(0.5);
  return rig.tick->Drop();
}

TEST(Seating, IsFinishedByLettingGoCloseToThePlace) {
  for (const double height : {0.2e-3, 1e-3, 2e-3}) {
    for (const double aside : {0.0, 1e-3, -1.5e-3}) {
      const Vec3 beside(aside, 0.5 * aside, height);
      const LetGo close = LetGoBeside(beside, 3e-3);
      EXPECT_TRUE(close.is_in_place) << beside.transpose();
      EXPECT_EQ(close.X_WB.p(), GasketRig::place()) << beside.transpose();
      EXPECT_EQ(close.to_place, 0);
      // Where nothing is to be finished, it is said how far it is from there.
      const LetGo left = LetGoBeside(beside, 0);
      EXPECT_FALSE(left.is_in_place);
      EXPECT_NEAR(left.to_place, beside.norm(), 0.3e-3) << beside.transpose();
    }
  }
}

TEST(Seating, IsNotFinishedFromAfarOrThroughWhatStandsThere) {
  EXPECT_FALSE(LetGoBeside(Vec3(0, 0, 5e-3), 3e-3).is_in_place);
  EXPECT_FALSE(LetGoBeside(Vec3(4e-3, 0, 1e-3), 3e-3).is_in_place);
  const LetGo blocked = LetGoBeside(Vec3(2e-3, 0, 0.5e-3), 3e-3, true);
  EXPECT_FALSE(blocked.is_in_place);
  EXPECT_NEAR(blocked.to_place, std::hypot(2e-3, 0.5e-3), 0.3e-3);
  EXPECT_TRUE(LetGoBeside(Vec3(2e-3, 0, 0.5e-3), 3e-3, false).is_in_place);
}

// A press fit gives way to a hand that pushes, not to one that lets go.
TEST(Seating, IsNotFinishedWhereTheFitHoldsThePart) {
  TickOptions options;
  options.guidance.finish_distance = 3e-3;
  Rig rig(MakeFit("H7/p6"), Above(10e-3), options);
  rig.hand->Wait(0.3);
  rig.hand->MoveSoftly(Vec3(0, 0, -10e-3), 0.5);
  for (int i = 0; i < 20'000 && rig.hand->last().X_WD.p().z() > 1e-3; ++i) {
    rig.hand->MoveEvenly(Vec3(0, 0, -0.02e-3), kDt);
  }
  ASSERT_LT(rig.hand->last().X_WD.p().z(), 1.1e-3);
  ASSERT_NE(rig.hand->last().state, HoldState::kSeated);
  const LetGo let_go = rig.tick->Drop();
  EXPECT_FALSE(let_go.is_in_place);
  EXPECT_NEAR(let_go.to_place, rig.hand->last().X_WD.p().z(), 0.05e-3);
}

/** A block without a mate on a table, 20 mm above its place; what is left out does not draw it. */
struct LooseRig : HeldRig {
  static constexpr double kHalf = 10e-3;

  explicit LooseRig(TickOptions the_options = {}) : HeldRig(std::move(the_options)) {
    static const auto table =
        contact::testing::Build(contact::testing::Block(Vec3(0.1, 0.1, 0.02)));
    static const auto block =
        contact::testing::Build(contact::testing::Block(Vec3::Constant(kHalf)));
    scene.Add(table, Pose(Vec3(0, 0, -0.02)));
    Place(block, Pose(Vec3(0, 0, kHalf + 20e-3)));
    part.mass = 0.06;
    part.I_BBcm_B = 4e-6 * Mat3::Identity();
    part.X_WB_goal = Pose(Vec3(0, 0, kHalf));
  }

  /** First tick that is matched, and first that is seated; -1: none. */
  [[nodiscard]] std::pair<int, int> FindEvents() const {
    int matched = -1;
    int seated = -1;
    for (std::size_t i = 0; i < hand->samples.size(); ++i) {
      const TickOutput& out = hand->samples[i].out;
      matched = matched < 0 && out.is_matched ? static_cast<int>(i) : matched;
      seated = seated < 0 && out.state == HoldState::kSeated ? static_cast<int>(i) : seated;
    }
    return {matched, seated};
  }

  [[nodiscard]] double CalcDistance(int i) const {
    return (hand->samples[static_cast<std::size_t>(i)].out.X_WD.p() - part.X_WB_goal.p()).norm();
  }
};

// In all conditions: what is not led by an axis is matched 3 mm from its place, and seated in it.
TEST(Seating, W7PartIsMatchedThreeMillimetresFromItsPlaceAndSeatedByItsPose) {
  for (const Condition condition : {Condition::kHybrid, Condition::kCollision}) {
    for (const double smallest : {std::numeric_limits<double>::infinity(), 0.6e-3}) {
      for (const double aside : {-2e-3, 0.5e-3, 2.5e-3}) {
        TickOptions options;
        options.condition = condition;
        LooseRig rig(options);
        rig.part.smallest_guide = smallest;
        rig.Take();
        rig.hand->MoveSoftly(Vec3(aside, 0, -20e-3), 1);
        rig.hand->Wait(1.5);
        const auto [matched, seated] = rig.FindEvents();
        ASSERT_GE(matched, 0) << aside;
        ASSERT_GT(seated, matched) << aside;
        EXPECT_NEAR(rig.CalcDistance(matched), 3e-3, 0.1e-3);
        EXPECT_LE(rig.CalcDistance(seated), std::min(0.15e-3, 0.1 * smallest) + 1e-6) << aside;
        EXPECT_EQ(rig.tick->Drop().X_WB.p(), rig.part.X_WB_goal.p());
      }
    }
  }
}

TEST(Seating, PartIsNotMatchedWhereSomethingIsInBetweenNorSeatedBesideIt) {
  LooseRig rig;
  static const auto step =
      contact::testing::Build(contact::testing::Block(Vec3(5e-3, 5e-3, 0.5e-3)));
  rig.scene.Add(step, Pose(Vec3(0, 0, 0.5e-3)));  // 1 mm high, where the part belongs.
  rig.Take();
  rig.hand->MoveSoftly(Vec3(0, 0, -21e-3), 1);
  rig.hand->Wait(1);
  EXPECT_EQ(rig.FindEvents(), std::pair(-1, -1));
  EXPECT_FALSE(rig.tick->Drop().is_in_place);
}

// Nothing but the hand brings a part past what gives: it feels that force, or the part is not in.
TEST(Seating, PartThatGivesIsSeatedOnlyOnceTheHandHasFeltItsForce) {
  for (const double beyond : {0.0, 60e-3}) {
    LooseRig rig;
    auto curve = std::make_shared<GivingCurve>();
    curve->stiffness = 40e3;
    curve->friction = 0.3;
    curve->spacing = 0.1e-3;
    for (int i = 0; i <= 25; ++i) {  // A bead of 1 mm, the last 2.5 mm before its place.
      curve->given.push_back(1e-3 * std::sin(std::numbers::pi * i / 25));
    }
    rig.part.gives = {{curve, 1e-3}};
    const double peak = CalcGivingPeak(*curve).in;
    ASSERT_GT(peak, 20);
    rig.Take();
    rig.hand->MoveSoftly(Vec3(0, 0, -17.5e-3), 1);  // To where the bead begins, and is matched.
    rig.hand->Wait(0.5);
    EXPECT_GE(rig.FindEvents().first, 0);
    EXPECT_LT(rig.FindEvents().second, 0) << "a hand that does not push does not bring it in";
    rig.hand->MoveSoftly(Vec3(0, 0, -beyond), 1);
    rig.hand->Wait(0.5);
    double felt = 0;
    for (const testing::Sample& sample : rig.hand->samples) {
      felt = std::max(felt, sample.out.axial_true);
    }
    if (rig.FindEvents().second >= 0) {
      EXPECT_GT(felt, 0.8 * peak);
    }
    EXPECT_EQ(rig.FindEvents().second >= 0, beyond > 0);
  }
}

}  // namespace
}  // namespace hvas::haptics
