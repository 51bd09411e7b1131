// Products whose parts seat on cones and spheres assemble like others: X2, X9, N10.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using contact::testing::CylinderZ;
using contact::testing::PlaneAt;
using product::MateKind;
using product::Product;
using spatial::Pose;
using spatial::Surface;
using spatial::SurfaceKind;
using testing::Session;

constexpr double kSeatTime = 120;  // [s]
constexpr int kSeatSegments = 64;

/** A round plate with a hole of 3.4 mm that opens in a countersink of 90 degrees, and a screw whose
 head sits on it, 0.2 mm below the rim. */
Product CountersunkScrew() {
  Product product;
  product.name = "rig";
  static constexpr double kApex = 2.6e-3;  // Both cones are r = z - kApex.
  const auto cone = [](double outward) {
    return Surface{
        SurfaceKind::kCone, Vec3(0, 0, kApex), Vec3::UnitZ(), 0, std::numbers::pi / 4, outward};
  };
  const auto plate = sequence::testing::AddPart(
      &product, "plate",
      contact::testing::Lathe({{{{1.7e-3, 0}, {12e-3, 0}}, PlaneAt(0, -1)},
                               {{{12e-3, 0}, {12e-3, 6e-3}}, CylinderZ(12e-3, 1)},
                               {{{12e-3, 6e-3}, {3.4e-3, 6e-3}}, PlaneAt(6e-3, 1)},
                               {{{3.4e-3, 6e-3}, {1.7e-3, 4.3e-3}}, cone(-1)},
                               {{{1.7e-3, 4.3e-3}, {1.7e-3, 0}}, CylinderZ(1.7e-3, -1)}},
                              kSeatSegments));
  const auto screw = sequence::testing::AddPart(
      &product, "countersunk screw",
      contact::testing::Lathe({{{{0, -6e-3}, {1.5e-3, -6e-3}}, PlaneAt(-6e-3, -1)},
                               {{{1.5e-3, -6e-3}, {1.5e-3, 4.1e-3}}, CylinderZ(1.5e-3, 1)},
                               {{{1.5e-3, 4.1e-3}, {3.2e-3, 5.8e-3}}, cone(1)},
                               {{{3.2e-3, 5.8e-3}, {0, 5.8e-3}}, PlaneAt(5.8e-3, 1)}},
                              kSeatSegments));
  sequence::testing::Place(&product, plate, "plate");
  sequence::testing::Place(&product, screw, "screw");
  sequence::testing::Complete(&product);
  return product;
}

/** A block with half a sphere for a socket, and a ball with 20 um of play in it. */
Product BallInSocket() {
  Product product;
  product.name = "rig";
  constexpr double kRadius = 8e-3;
  constexpr double kCentre = 12e-3;
  auto arc =
      contact::testing::Arc(0, kCentre, kRadius, 0, -std::numbers::pi / 2, /*deviation=*/20e-6);
  arc.back().x() = 0;
  const Surface socket{SurfaceKind::kSphere, Vec3(0, 0, kCentre), Vec3::UnitZ(), kRadius, 0, -1};
  const auto base = sequence::testing::AddPart(
      &product, "base",
      contact::testing::Lathe({{{{0, 0}, {12e-3, 0}}, PlaneAt(0, -1)},
                               {{{12e-3, 0}, {12e-3, kCentre}}, CylinderZ(12e-3, 1)},
                               {{{12e-3, kCentre}, {kRadius, kCentre}}, PlaneAt(kCentre, 1)},
                               {arc, socket}},
                              kSeatSegments));
  const auto ball =
      sequence::testing::AddPart(&product, "ball", contact::testing::Ball(kRadius - 20e-6, 20e-6));
  sequence::testing::Place(&product, base, "base");
  sequence::testing::Place(&product, ball, "ball", Pose(Vec3(0, 0, kCentre)));
  sequence::testing::Complete(&product);
  return product;
}

std::vector<MateKind> KindsOf(const Product& product) {
  std::vector<MateKind> kinds;
  for (const product::Mate& mate : product.mates) {
    kinds.push_back(mate.kind);
  }
  return kinds;
}

/** A frame on a floor, and a block in its window with this clearance between opposite walls. */
Product BlockInWindow(double clearance) {
  Product product;
  product.name = "rig";
  const auto frame =
      sequence::testing::AddPart(&product, "frame",
                                 sequence::testing::SortByFace(contact::testing::Frame(
                                     Vec3(20e-3, 15e-3, 10e-3), {8e-3, 5e-3})));
  const auto floor = sequence::testing::AddPart(&product, "floor",
                                                contact::testing::Block(Vec3(15e-3, 12e-3, 2e-3)));
  const double play = 0.5 * clearance;
  const auto block = sequence::testing::AddPart(
      &product, "block", contact::testing::Block(Vec3(8e-3 - play, 5e-3 - play, 12e-3)));
  sequence::testing::Place(&product, frame, "frame");
  sequence::testing::Place(&product, floor, "floor", Pose(Vec3(0, 0, -12e-3)));
  sequence::testing::Place(&product, block, "block", Pose(Vec3(0, 0, 2e-3)));
  sequence::testing::Complete(&product);
  return product;
}

void ExpectAssembles(Product product) {
  const std::size_t count = product.occurrences.size();
  Diagnostics diagnostics;
  const auto model = simulation::Compile(std::make_shared<const Product>(std::move(product)),
                                         simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value());
  for (const std::uint64_t seed : {1, 2}) {
    Session session(*model, seed);
    (void)simulation::RunLockstep(session.MakeExecution(kSeatTime));
    ASSERT_TRUE(session.run.is_done());
    ASSERT_EQ(session.run.results().size(), count);
    for (const simulation::PartResult& part : session.run.results()) {
      EXPECT_TRUE(part.is_seated) << "seed " << seed << ": " << part.reason;
      EXPECT_LT(part.pose_error, 1e-6);
    }
    EXPECT_TRUE(session.watch.is_finite);
    EXPECT_LE(session.watch.largest_jump, 0.5);
    EXPECT_LE(session.watch.deepest, 60e-6);
  }
}

TEST(SeatsTest, ACountersunkScrewGoesIntoItsHoleAndOntoItsSeat) {
  Product product = CountersunkScrew();
  ASSERT_EQ(KindsOf(product), (std::vector<MateKind>{MateKind::kAxisHole, MateKind::kConeSeat}));
  ExpectAssembles(std::move(product));
}

TEST(SeatsTest, ABallGoesIntoItsSocket) {
  Product product = BallInSocket();
  ASSERT_EQ(KindsOf(product), (std::vector<MateKind>{MateKind::kSphereSeat}));
  ExpectAssembles(std::move(product));
}

TEST(SeatsTest, X8BlockGoesIntoItsWindowHoweverTheClearanceIsDrawn) {
  for (const double clearance : {0.0, 50e-6, 0.2e-3, -40e-6}) {
    SCOPED_TRACE(clearance);
    Product product = BlockInWindow(clearance);
    EXPECT_EQ(KindsOf(product).size(), 4U) << "floor to frame, floor to block, and two widths";
    ExpectAssembles(std::move(product));
  }
}

/** A pole of 0.4 m, 4.6 mm above the floor of a hole that is 25 mm deep, with 0.2 mm of play:
 nothing ends its way in where it is drawn, and it leans by millimetres at its upper end. */
Product PoleInHole() {
  Product product;
  product.name = "rig";
  const auto base = sequence::testing::AddPart(&product, "base",
                                               contact::testing::Cup(4.1e-3, 40e-3, 5e-3, 35e-3));
  const auto pole =
      sequence::testing::AddPart(&product, "pole", contact::testing::Shaft(4e-3, 0.4));
  sequence::testing::Place(&product, base, "base");
  sequence::testing::Place(&product, pole, "pole", Pose(Vec3(0, 0, 9.6e-3)));
  sequence::testing::Complete(&product);
  return product;
}

TEST(SeatsTest, ALongPoleIsHomeWhereItIsInItsHole) {
  ExpectAssembles(PoleInHole());
}

/** A part with a groove along x, and what is in it with this clearance of its widths. */
struct Groove {
  const char* name;
  std::vector<Eigen::Vector2d> (*outer)();
  std::vector<Eigen::Vector2d> (*inner)(double clearance);
  std::size_t widths;
};

constexpr double kFlank = 4.6188e-3;  // Overhang of a flank of 60 degrees over 8 mm [m].

const Groove kGrooves[] = {
    {"tongue and slot",
     [] {
       return std::vector<Eigen::Vector2d>{{-15e-3, -4e-3}, {15e-3, -4e-3}, {15e-3, 8e-3},
                                           {5e-3, 8e-3},    {5e-3, 0},      {-5e-3, 0},
                                           {-5e-3, 8e-3},   {-15e-3, 8e-3}};
     },
     [](double c) {
       const double y = 5e-3 - 0.5 * c;
       return std::vector<Eigen::Vector2d>{{-y, 0}, {y, 0}, {y, 16e-3}, {-y, 16e-3}};
     },
     1},
    {"fork over a plate",
     [] {
       return std::vector<Eigen::Vector2d>{{-6e-3, -5e-3}, {6e-3, -5e-3}, {6e-3, 25e-3},
                                           {2e-3, 25e-3},  {2e-3, 0},     {-2e-3, 0},
                                           {-2e-3, 25e-3}, {-6e-3, 25e-3}};
     },
     [](double c) {
       const double y = 2e-3 - 0.5 * c;
       return std::vector<Eigen::Vector2d>{{-y, 0}, {y, 0}, {y, 50e-3}, {-y, 50e-3}};
     },
     1},
    {"T slot",
     [] {
       return std::vector<Eigen::Vector2d>{{-15e-3, -4e-3}, {15e-3, -4e-3}, {15e-3, 12e-3},
                                           {5e-3, 12e-3},   {5e-3, 6e-3},   {10e-3, 6e-3},
                                           {10e-3, 0},      {-10e-3, 0},    {-10e-3, 6e-3},
                                           {-5e-3, 6e-3},   {-5e-3, 12e-3}, {-15e-3, 12e-3}};
     },
     [](double c) {
       const double neck = 5e-3 - 0.5 * c;
       const double head = 10e-3 - 0.5 * c;
       const double top = 6e-3 - c;
       return std::vector<Eigen::Vector2d>{{-head, 0},   {head, 0},     {head, top},
                                           {neck, top},  {neck, 20e-3}, {-neck, 20e-3},
                                           {-neck, top}, {-head, top}};
     },
     3},
    {"dovetail",
     [] {
       return std::vector<Eigen::Vector2d>{{-25e-3, -4e-3},        {25e-3, -4e-3}, {25e-3, 8e-3},
                                           {15e-3 - kFlank, 8e-3}, {15e-3, 0},     {-15e-3, 0},
                                           {kFlank - 15e-3, 8e-3}, {-25e-3, 8e-3}};
     },
     [](double c) {
       const double y = 15e-3 - 0.5 * c;
       return std::vector<Eigen::Vector2d>{{-y, 0}, {y, 0}, {y - kFlank, 8e-3}, {kFlank - y, 8e-3}};
     },
     1}};

Product MakeGroove(const Groove& groove, double clearance) {
  Product product;
  product.name = "rig";
  constexpr double kHalfLength = 15e-3;
  const auto outer = sequence::testing::AddPart(
      &product, "outer", contact::testing::Prism(groove.outer(), kHalfLength));
  const auto inner = sequence::testing::AddPart(
      &product, "inner", contact::testing::Prism(groove.inner(clearance), kHalfLength));
  sequence::testing::Place(&product, outer, "outer");
  sequence::testing::Place(&product, inner, "inner");
  sequence::testing::Complete(&product);
  return product;
}

TEST(SeatsTest, X8WhatIsBetweenWallsGoesInHoweverTheClearanceIsDrawn) {
  for (const Groove& groove : kGrooves) {
    for (const double clearance : {0.0, 0.2e-3, -40e-6}) {
      SCOPED_TRACE(std::string(groove.name) + " " + std::to_string(1e6 * clearance));
      Product product = MakeGroove(groove, clearance);
      const std::vector<MateKind> kinds = KindsOf(product);
      EXPECT_EQ(std::count(kinds.begin(), kinds.end(), MateKind::kPrismatic), groove.widths);
      ExpectAssembles(std::move(product));
    }
  }
}

TEST(SeatsTest, X2PlanesThatHoldNothingBetweenThemHaveToTouch) {
  Product product = BlockInWindow(1e-3);
  EXPECT_EQ(KindsOf(product).size(), 2U) << "the floor's";
}

}  // namespace
}  // namespace hvas::person
