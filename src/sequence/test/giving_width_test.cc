// How far parts have to give sideways to pass one another.

#include "sequence/giving_width.h"

#include <gtest/gtest.h>

#include "sequence/test/small_products.h"

namespace hvas::sequence {
namespace {

using testing::OccurrenceId;
using testing::Pose;
using testing::Product;

constexpr double kLimit = 2e-3;        // [m]
constexpr double kCell = kLimit / 10;  // [m]
const Vec3 kUp = Vec3::UnitZ();

/** The width that the second of two parts has to give to go out past the first. */
double CalcWidth(const contact::ShapeSource& other, const contact::ShapeSource& moving,
                 const Pose& X_OM, const Vec3& way_O, double limit = kLimit) {
  // In a frame that no axis of the grid lies in.
  const Pose X_WO(Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), Vec3(0.1, -0.2, 0.3));
  Product product;
  product.name = "pair";
  const auto first = testing::AddPart(&product, "other", other);
  const auto second = testing::AddPart(&product, "moving", moving);
  testing::Place(&product, first, "other", X_WO);
  testing::Place(&product, second, "moving", X_WO * X_OM);
  return CalcGivingWidth(product, OccurrenceId(1), OccurrenceId(0), X_WO.q() * way_O, limit);
}

TEST(GivingWidthTest, ARingHasToOpenByWhatTheLandIsWider) {
  const double bore = 9.4e-3;
  for (const double land : {9.4e-3, 10e-3, 10.6e-3, 12e-3}) {
    EXPECT_NEAR(CalcWidth(contact::testing::Shaft(land, 40e-3, 10e-6),
                          contact::testing::Bushing(bore, 16e-3, 1e-3, 10e-6),
                          Pose(Vec3(0, 0, 10e-3)), kUp),
                land - bore, 2 * kCell)
        << land;
  }
}

TEST(GivingWidthTest, WhatIsBehindIsNoMatter) {
  const auto flange = contact::testing::Shaft(20e-3, 5e-3, 10e-6);
  const auto ring = contact::testing::Bushing(9e-3, 16e-3, 1e-3, 10e-6);
  const Pose above(Vec3(0, 0, 5e-3));
  EXPECT_EQ(CalcWidth(flange, ring, above, kUp), 0);
  EXPECT_NEAR(CalcWidth(flange, ring, above, -kUp, 7e-3), 7e-3, 1.4e-3);
}

TEST(GivingWidthTest, ABoardThatWouldHaveToGoThroughALidBlocksItsWholeOutline) {
  // However thin the lid is: contact alone would find a way out of it half a millimetre away.
  const auto lid = contact::testing::Block(Vec3(30e-3, 20e-3, 0.5e-3));
  const auto board = contact::testing::Block(Vec3(26e-3, 16e-3, 0.8e-3));
  EXPECT_NEAR(CalcWidth(lid, board, Pose(Vec3(0, 0, -10e-3)), kUp), 32e-3, 0.08 * 32e-3);
  EXPECT_EQ(CalcWidth(lid, board, Pose(Vec3(0, 0, 10e-3)), kUp), 0);
}

TEST(GivingWidthTest, AHookBlocksAStripAsWideAsItsUndercut) {
  const auto wall = contact::testing::Block(Vec3(2e-3, 30e-3, 10e-3));
  const auto hook = contact::testing::Block(Vec3(1e-3, 4e-3, 1e-3));
  for (const double undercut : {0.4e-3, 1e-3, 1.6e-3}) {
    const Pose X_WallHook(Vec3(2e-3 + 1e-3 - undercut, 0, -11e-3));
    EXPECT_NEAR(CalcWidth(wall, hook, X_WallHook, kUp), undercut, 2 * kCell) << undercut;
  }
}

TEST(GivingWidthTest, PartsThatPassSideBySideNeedNone) {
  const auto block = contact::testing::Block(Vec3(5e-3, 5e-3, 5e-3));
  EXPECT_EQ(CalcWidth(block, block, Pose(Vec3(10e-3, 0, -20e-3)), kUp), 0);
  EXPECT_EQ(CalcWidth(block, block, Pose(Vec3(30e-3, 0, -20e-3)), kUp), 0);
}

}  // namespace
}  // namespace hvas::sequence
