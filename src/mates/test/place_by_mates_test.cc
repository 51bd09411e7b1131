#include "mates/place_by_mates.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/random.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"
#include "mates/user_mate.h"

namespace hvas::mates {
namespace {

using product::FaceId;
using product::FeatureId;
using product::FeatureKind;
using product::Mate;
using product::OccurrenceId;
using product::Part;
using product::Product;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;

constexpr double kTiny = 1e-9;  // [m], and [rad]

/** Features: 0 hole of 10 mm at the origin, 1 top, 2 hole of 10 mm at x = 60 mm. */
void AddGroundPlate(Product* product) {
  Part* plate = AddPart(product, "plate");
  AddCylinder(plate, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -10e-3, 0);
  AddRectangle(plate, Vec3::Zero(), Vec3::UnitZ(), 100e-3, 30e-3);
  AddCylinder(plate, FeatureKind::kHole, Vec3(60e-3, 0, 0), Vec3::UnitZ(), 5e-3, -10e-3, 0);
  plate->mass.volume = 1e-3;
}

/** Features: 0 shaft below the shoulder, 1 shoulder at z = 0, 2 end at z = -8 mm. */
void AddGroundPin(Product* product) {
  Part* pin = AddPart(product, "pin");
  AddCylinder(pin, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -8e-3, 0);
  AddRectangle(pin, Vec3::Zero(), -Vec3::UnitZ(), 9e-3, 9e-3);
  AddRectangle(pin, Vec3(0, 0, -8e-3), -Vec3::UnitZ(), 4e-3, 4e-3);
  pin->mass.volume = 1e-5;
}

Pose DrawPose(Random* random) {
  const Vec3 turn(random->Uniform(-2, 2), random->Uniform(-2, 2), random->Uniform(-2, 2));
  const Vec3 p(random->Uniform(-1, 1), random->Uniform(-1, 1), random->Uniform(-1, 1));
  return {spatial::RotationFromVector(turn), p};
}

Product MakeDrawn(const Pose& X_WPlate, const std::vector<Pose>& X_WPin) {
  Product product;
  AddGroundPlate(&product);
  AddGroundPin(&product);
  AddOccurrence(&product, product::PartId(0), X_WPlate);
  for (const Pose& X : X_WPin) {
    AddOccurrence(&product, product::PartId(1), X);
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

Pick PickOf(std::size_t occurrence, std::size_t feature) {
  return {OccurrenceId(occurrence), FaceId(), FeatureId(feature)};
}

Result<product::MateId> Join(Product* product, const Pick& a, const Pick& b) {
  auto mate = MakeMate(*product, a, b);
  return mate ? AddMateAndPlace(product, *std::move(mate)) : Unexpected(mate.error());
}

/** As a side file does: all are there before any is looked at. */
Placement JoinAll(Product* product, const std::vector<std::pair<Pick, Pick>>& pairs) {
  for (const auto& [a, b] : pairs) {
    auto mate = MakeMate(*product, a, b);
    EXPECT_TRUE(mate.has_value()) << mate.error().ToString();
    AddMate(product, *std::move(mate));
  }
  auto placement = PlaceByMates(product);
  EXPECT_TRUE(placement.has_value());
  return *std::move(placement);
}

const Pose& PoseOf(const Product& product, std::size_t occurrence) {
  return product.occurrences[occurrence].X_WB;
}

void ExpectSamePose(const Pose& x, const Pose& y) {
  EXPECT_TRUE(x.p() == y.p());
  EXPECT_TRUE(x.q().coeffs() == y.q().coeffs());
}

std::string MessageOf(const Product& product, const std::string& code) {
  for (const Diagnostic& item : product.placement.diagnostics.items()) {
    if (item.code == code) {
      return item.message;
    }
  }
  return "";
}

// The pin's place in closed form: its frame's origin and z axis are those of the hole, and the turn
// about them is the one that is nearest to the drawn pose.
TEST(PlaceByMates, X12PartsInAnyPosesGoWhereAnAxisAndAPlaneSay) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose X_WPlate = DrawPose(&random);
    const Pose X_drawn = DrawPose(&random);
    Product product = MakeDrawn(X_WPlate, {X_drawn});
    ASSERT_TRUE(product.mates.empty());
    const Placement placement =
        JoinAll(&product, {{PickOf(0, 0), PickOf(1, 0)}, {PickOf(0, 1), PickOf(1, 1)}});
    EXPECT_TRUE(placement.is_placed);
    EXPECT_TRUE(placement.contradictions.empty());
    ExpectSamePose(PoseOf(product, 0), X_WPlate);
    const Pose X_PB = X_WPlate.Inverse() * PoseOf(product, 1);
    EXPECT_LT(X_PB.p().norm(), kTiny);
    EXPECT_LT((X_PB.R().col(2) - Vec3::UnitZ()).norm(), kTiny);
    const auto angle_at = [&](double turn) {
      const Pose turned =
          X_WPlate * Pose(spatial::RotationFromVector(Vec3(0, 0, turn)), Vec3::Zero()) * X_PB;
      return spatial::RotationBetween(turned.q(), X_drawn.q()).norm();
    };
    EXPECT_LE(angle_at(0), angle_at(1e-3));
    EXPECT_LE(angle_at(0), angle_at(-1e-3));
    // What touches there is inferred there: nothing but the two mates.
    EXPECT_EQ(product.mates.size(), 2U);
    EXPECT_EQ(product.joints.size(), 1U);
    EXPECT_NEAR(product.mates.front().overlap, 8e-3, kTiny);
  }
}

TEST(PlaceByMates, X12TheOrderOfAddingMakesNoDifference) {
  Random random(2);
  const Pose X_WPlate = DrawPose(&random);
  const Pose X_drawn = DrawPose(&random);
  Product forth = MakeDrawn(X_WPlate, {X_drawn});
  ASSERT_TRUE(Join(&forth, PickOf(0, 0), PickOf(1, 0)));
  ASSERT_TRUE(Join(&forth, PickOf(0, 1), PickOf(1, 1)));
  Product back = MakeDrawn(X_WPlate, {X_drawn});
  ASSERT_TRUE(Join(&back, PickOf(1, 1), PickOf(0, 1)));
  ASSERT_TRUE(Join(&back, PickOf(1, 0), PickOf(0, 0)));
  EXPECT_LT((PoseOf(forth, 1).p() - PoseOf(back, 1).p()).norm(), kTiny);
  EXPECT_LT(spatial::RotationBetween(PoseOf(forth, 1).q(), PoseOf(back, 1).q()).norm(), 1e-7);
}

TEST(PlaceByMates, X12MatesThatTheDrawnPosesFulfilChangeNothing) {
  Product product = MakeDrawn(Pose(), {Pose()});
  const Product before = product;
  ASSERT_EQ(before.mates.size(), 2U);
  auto mate = MakeMate(product, PickOf(0, 0), PickOf(1, 0));
  ASSERT_TRUE(mate.has_value());
  ASSERT_TRUE(AddMateAndPlace(&product, *mate));
  ExpectSamePose(PoseOf(product, 1), PoseOf(before, 1));
  EXPECT_EQ(product.mates.size(), 2U);
  EXPECT_TRUE(product.placement.drawn_poses.empty());
  EXPECT_TRUE(product.placement.diagnostics.items().empty());
}

TEST(PlaceByMates, X12RemovingTheMatesLeadsBackToTheDrawnPose) {
  Random random(3);
  const Product before = MakeDrawn(Pose(), {DrawPose(&random)});
  Product product = before;
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  ASSERT_TRUE(Join(&product, PickOf(0, 1), PickOf(1, 1)));
  EXPECT_GT((PoseOf(product, 1).p() - PoseOf(before, 1).p()).norm(), 1e-3);
  while (!product.mates.empty()) {
    ASSERT_TRUE(RemoveMateAndPlace(&product, "m0"));
  }
  ExpectSamePose(PoseOf(product, 1), PoseOf(before, 1));
  EXPECT_TRUE(product.placement.drawn_poses.empty());
}

// The drawn turn is nearer to the wrong end of the shaft; the plane decides.
TEST(PlaceByMates, X12TheEndOfAShaftFollowsFromTheOtherMates) {
  const Pose X_drawn(spatial::RotationFromVector(Vec3(2.8, 0, 0)), Vec3(0.2, 0.1, 0.3));
  Product product = MakeDrawn(Pose(), {X_drawn});
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  EXPECT_NEAR(PoseOf(product, 1).R().col(2).z(), -1, kTiny) << "by the nearer end";
  ASSERT_TRUE(Join(&product, PickOf(0, 1), PickOf(1, 1)));
  EXPECT_NEAR(PoseOf(product, 1).R().col(2).z(), 1, kTiny) << "as the shoulder asks";
  EXPECT_LT(PoseOf(product, 1).p().norm(), kTiny);
}

TEST(PlaceByMates, X12AShaftWithAnAxisAloneEngagesAndItsFreedomIsTold) {
  Product product = MakeDrawn(Pose(), {Pose(Vec3(0.2, 0.1, 0.3))});
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  // The middles of hole (-5 mm) and shaft (-4 mm) are together.
  EXPECT_LT((PoseOf(product, 1).p() - Vec3(0, 0, -1e-3)).norm(), kTiny);
  const std::string free = MessageOf(product, "mate-freedom");
  EXPECT_NE(free.find("shifted along (0.00, 0.00, 1.00)"), std::string::npos) << free;
  EXPECT_NE(free.find("turned about (0.00, 0.00, 1.00) through (0.0, 0.0,"), std::string::npos)
      << free;
}

TEST(PlaceByMates, X12AnAxisAndAPlaneLeaveTheTurn) {
  Product product = MakeDrawn(Pose(), {Pose(Vec3(0.2, 0.1, 0.3))});
  JoinAll(&product, {{PickOf(0, 0), PickOf(1, 0)}, {PickOf(0, 1), PickOf(1, 1)}});
  const std::string free = MessageOf(product, "mate-freedom");
  EXPECT_NE(free.find("free to be turned about (0.00, 0.00, 1.00)"), std::string::npos) << free;
  EXPECT_EQ(free.find("shifted"), std::string::npos) << free;
}

// Two planes of one part on one plane of the other, 8 mm apart: off by 8 mm.
TEST(PlaceByMates, X12AContradictionNamesTheMatesAndTheDistance) {
  Product product = MakeDrawn(Pose(), {Pose(Vec3(0.2, 0.1, 0.3))});
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  ASSERT_TRUE(Join(&product, PickOf(0, 1), PickOf(1, 1)));
  const Product before = product;
  const auto refused = Join(&product, PickOf(0, 1), PickOf(1, 2));
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("contradicts"), std::string::npos);
  ExpectSamePose(PoseOf(product, 1), PoseOf(before, 1));
  // All at once, as from a file: the last one does not count.
  Product all = MakeDrawn(Pose(), {Pose(Vec3(0.2, 0.1, 0.3))});
  for (const auto& [a, b] :
       {std::pair(PickOf(0, 1), PickOf(1, 1)), std::pair(PickOf(0, 0), PickOf(1, 0))}) {
    AddMate(&all, *MakeMate(all, a, b));
  }
  Product bare = all;
  bare.mates.clear();
  AddMate(&all, *MakeMate(bare, PickOf(0, 1), PickOf(1, 2)));
  const auto placement = PlaceByMates(&all);
  ASSERT_TRUE(placement.has_value());
  ASSERT_EQ(placement->contradictions.size(), 1U);
  const MateContradiction& found = placement->contradictions.front();
  EXPECT_EQ(found.others.size(), 1U) << found.message;
  EXPECT_NE(found.message.find("off by 8.000 mm and 0.00 deg"), std::string::npos) << found.message;
  EXPECT_EQ(MessageOf(all, "mate-contradiction"), found.message);
  EXPECT_LT(PoseOf(all, 1).p().norm(), kTiny);
}

/** A bar with a hole at its origin and a pin at `length` along x; features 0 and 1. */
void AddBar(Product* product, double length) {
  Part* bar = AddPart(product, "bar");
  AddCylinder(bar, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 3e-3, -5e-3, 5e-3);
  AddCylinder(bar, FeatureKind::kShaft, Vec3(length, 0, 0), Vec3::UnitZ(), 3e-3, -5e-3, 5e-3);
  bar->mass.volume = length;
}

/** Four bars in a ring; the first is the longest and stays. */
Product MakeRing(const std::array<double, 4>& lengths, Random* random, Placement* placement) {
  Product product;
  for (std::size_t i = 0; i < 4; ++i) {
    AddBar(&product, lengths[i]);
    AddOccurrence(&product, product::PartId(i), DrawPose(random));
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  std::vector<std::pair<Pick, Pick>> pairs;
  for (std::size_t i = 0; i < 4; ++i) {
    pairs.emplace_back(PickOf((i + 1) % 4, 0), PickOf(i, 1));
  }
  *placement = JoinAll(&product, pairs);
  return product;
}

// A bar linkage closes: no bar alone can be placed so that the next ones fit.
TEST(PlaceByMates, X12AClosedRingOfFourBarsCloses) {
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    Placement placement;
    const Product product = MakeRing({70e-3, 40e-3, 50e-3, 30e-3}, &random, &placement);
    EXPECT_TRUE(placement.contradictions.empty()) << placement.contradictions.front().message;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      const Pose& X_WA = PoseOf(product, next);
      const Pose& X_WB = PoseOf(product, k);
      const Vec3 pin_W = X_WB * product.parts[k].features[1].origin_B;
      const Vec3 axis_W = X_WA.R().col(2);
      EXPECT_LT(axis_W.cross(X_WB.R().col(2)).norm(), 2e-3);
      EXPECT_LT(axis_W.cross(pin_W - X_WA.p()).norm(), 20e-6);
    }
  }
}

// 30 + 20 + 10 mm do not reach 90 mm: 30 mm are missing.
TEST(PlaceByMates, X12ARingThatCannotCloseIsOffByWhatIsMissing) {
  Random random(6);
  Placement placement;
  (void)MakeRing({90e-3, 30e-3, 20e-3, 10e-3}, &random, &placement);
  ASSERT_EQ(placement.contradictions.size(), 1U);
  EXPECT_EQ(placement.contradictions.front().others.size(), 3U);
  EXPECT_NE(placement.contradictions.front().message.find("off by 30.000 mm"), std::string::npos)
      << placement.contradictions.front().message;
}

// Pin 1 is drawn standing on the plate beside its hole; that contact gives way.
TEST(PlaceByMates, X12AContactThatIsDrawnByAccidentGivesWay) {
  Product product = MakeDrawn(Pose(), {Pose(Vec3(30e-3, 5e-3, 8e-3))});
  ASSERT_EQ(product.mates.size(), 1U);  // Its end on the plate.
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  ASSERT_TRUE(Join(&product, PickOf(0, 1), PickOf(1, 1)));
  EXPECT_LT(PoseOf(product, 1).p().norm(), kTiny);
  EXPECT_EQ(product.mates.size(), 2U);
}

// A bush is drawn on pin 1, far from the plate: it goes along.
TEST(PlaceByMates, X12WhatIsDrawnInItsPlaceOnAPartGoesAlong) {
  Random random(7);
  const Pose X_WPin = DrawPose(&random);
  Product product;
  AddGroundPlate(&product);
  AddGroundPin(&product);
  Part* bush = AddPart(&product, "bush");
  AddCylinder(bush, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -3e-3, 0);
  AddRectangle(bush, Vec3::Zero(), Vec3::UnitZ(), 8e-3, 8e-3);
  bush->mass.volume = 1e-6;
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), X_WPin);
  AddOccurrence(&product, product::PartId(2), X_WPin);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.joints.size(), 1U);
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  ASSERT_TRUE(Join(&product, PickOf(0, 1), PickOf(1, 2)));
  const Pose X_PinBush = PoseOf(product, 1).Inverse() * PoseOf(product, 2);
  EXPECT_LT(X_PinBush.p().norm(), kTiny);
  EXPECT_LT(spatial::RotationVector(X_PinBush.q()).norm(), kTiny);
  EXPECT_GT((PoseOf(product, 2).p() - X_WPin.p()).norm(), 1e-3);
}

TEST(PlaceByMates, X12WhatIsRemovedDoesNotComeBackInTheAssembledPoses) {
  Product product = MakeDrawn(Pose(), {Pose(Vec3(0.2, 0.1, 0.3)), Pose(Vec3(60e-3, 0, 0))});
  ASSERT_EQ(product.mates.size(), 2U);
  const std::string removed = product.mates[1].key;
  ASSERT_TRUE(RemoveMateAndPlace(&product, removed));
  ASSERT_TRUE(Join(&product, PickOf(0, 0), PickOf(1, 0)));
  EXPECT_TRUE(std::none_of(product.mates.begin(), product.mates.end(),
                           [&removed](const Mate& mate) { return mate.key == removed; }));
}

}  // namespace
}  // namespace hvas::mates
