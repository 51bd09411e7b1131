// The space of tools, against closed forms, and orders that leave room for them.

#include "orders/tool_space.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "contact/test/parts.h"
#include "orders/order_search.h"
#include "simulation/test/small_models.h"

namespace hvas::orders {
namespace {

using product::DriveForm;
using product::DriveKind;
using spatial::Pose;

/** A hexagon of 5 mm across flats, 3 mm deep, whose counterpart comes along -Z of the part. */
DriveForm MakeHexagon(bool is_recess) {
  DriveForm drive;
  drive.is_recess = is_recess;
  drive.axis_B = -Vec3::UnitZ();
  drive.width = 5e-3;
  drive.depth = 3e-3;
  return drive;
}

/** A block of 20 mm whose face towards the axis is `distance` from it, around a height. */
product::Part MakeBlock(double distance, double height) {
  product::Product product;
  const product::PartId id = sequence::testing::AddPart(
      &product, "block", contact::testing::Block(Vec3(10e-3, 10e-3, 10e-3)));
  product::Part part = product.parts[id.index()];
  spatial::Box box;
  for (const Vec3& p : part.mesh.vertices) {
    box.Add(p);
  }
  for (Vec3& p : part.mesh.vertices) {
    p += Vec3(distance - box.low.x(), -box.centre().y(), height - box.centre().z());
  }
  part.box_B = spatial::Box();
  for (const Vec3& p : part.mesh.vertices) {
    part.box_B.Add(p);
  }
  return part;
}

// In frames turned and moved: what is true does not depend on them.
std::vector<Pose> ListFrames() {
  return {Pose(), Pose(spatial::RotationFromVector(Vec3(0.4, -1.1, 2.0)), Vec3(0.3, -0.2, 0.1))};
}

TEST(ToolSpaceTest, AKeySweepsItsLongArmAndTheCircleOfItsShortArm) {
  const double corner = 5e-3 / std::numbers::sqrt3;
  for (const Pose& X_WB : ListFrames()) {
    const Vec3 out_W = X_WB.q() * Vec3::UnitZ();
    const ToolSpace space = MakeToolSpace(MakeHexagon(true), X_WB, out_W, 0);
    EXPECT_EQ(space.tool, "hexagon key 5 mm");
    // ISO 2936: the arms of a key of 5 mm are 85 mm and 33 mm long.
    EXPECT_FALSE(IsInToolSpace(space, MakeBlock(corner, 30e-3), X_WB)) << "beside the long arm";
    EXPECT_TRUE(IsInToolSpace(space, MakeBlock(corner - 0.2e-3, 30e-3), X_WB));
    EXPECT_FALSE(IsInToolSpace(space, MakeBlock(33.1e-3, 85e-3), X_WB)) << "beside the short arm";
    EXPECT_TRUE(IsInToolSpace(space, MakeBlock(32.9e-3, 85e-3), X_WB));
    EXPECT_FALSE(IsInToolSpace(space, MakeBlock(-10e-3, 95.1e-3), X_WB)) << "above the key";
    EXPECT_TRUE(IsInToolSpace(space, MakeBlock(-10e-3, 94.9e-3), X_WB));
    EXPECT_FALSE(IsInToolSpace(space, MakeBlock(-10e-3, -10e-3), X_WB)) << "below the head";
  }
}

TEST(ToolSpaceTest, TheToolMovesWithTheScrew) {
  const ToolSpace space = MakeToolSpace(MakeHexagon(true), Pose(), Vec3::UnitZ(), 10e-3);
  EXPECT_TRUE(IsInToolSpace(space, MakeBlock(-10e-3, 95.1e-3), Pose()));
  EXPECT_FALSE(IsInToolSpace(space, MakeBlock(-10e-3, 105.1e-3), Pose()));
}

TEST(ToolSpaceTest, ASocketGoesOverTheFlatsFromWhereTheNutCame) {
  const double outer = 0.5 * (1.25 * 5e-3 + 3e-3);
  for (const double side : {1.0, -1.0}) {
    const ToolSpace space = MakeToolSpace(MakeHexagon(false), Pose(), side * Vec3::UnitZ(), 0);
    EXPECT_EQ(space.tool, "socket 5 mm");
    const double height = side > 0 ? 20e-3 : -23e-3;
    EXPECT_TRUE(IsInToolSpace(space, MakeBlock(outer - 0.2e-3, height), Pose())) << side;
    EXPECT_FALSE(IsInToolSpace(space, MakeBlock(outer, height), Pose())) << side;
    EXPECT_FALSE(IsInToolSpace(space, MakeBlock(-10e-3, -height - 3e-3), Pose())) << side;
  }
}

TEST(ToolSpaceTest, AFastenerComesBeforeWhatStandsWhereItsToolTurns) {
  OrderRules rules;
  for (std::size_t m = 0; m < 3; ++m) {
    FreeMove& move = rules.moves.emplace_back();
    move.parts = {product::OccurrenceId(m + 1)};
    move.is_held_by_base = true;
    OrderedWay& way = move.ways.emplace_back();
    way.step.occurrence = product::OccurrenceId(m + 1);
    way.step.extraction_W = Vec3::UnitZ();
  }
  FreeMove& screw = rules.moves[2];  // It was planned last, when the others are there.
  screw.tool = "hexagon key 5 mm";
  screw.in_tool_space = {product::OccurrenceId(0), product::OccurrenceId(2)};
  screw.moves_in_tool_space = {1};
  const OrderSearch search = FindOrders(rules, {});
  EXPECT_EQ(search.planned.counts.cramped, 1);
  ASSERT_FALSE(search.orders.empty());
  const FoundOrder& best = search.orders.front();
  EXPECT_EQ(best.counts.cramped, 0);
  const auto at = std::find(best.moves.begin(), best.moves.end(), std::size_t{2});
  EXPECT_LT(at, std::find(best.moves.begin(), best.moves.end(), std::size_t{1}));
  // The base stands there in every order.
  EXPECT_EQ(ListInToolSpace(rules, best, static_cast<std::size_t>(at - best.moves.begin())),
            std::vector{product::OccurrenceId(0)});
  EXPECT_EQ(ListInToolSpace(rules, search.planned, 2).size(), 2U);
}

}  // namespace
}  // namespace hvas::orders
