// What a wall would have to bear to bend aside.

#include "sequence/bending_form.h"

#include <gtest/gtest.h>

#include "sequence/test/small_products.h"

namespace hvas::sequence {
namespace {

using testing::OccurrenceId;
using testing::Pose;
using testing::Product;

/** A plate 20 mm long along z and 2 mm thick along x, in a frame that no axis of it lies in. */
class PlateTest : public ::testing::Test {
 protected:
  PlateTest() {
    product_.name = "plate";
    const auto part =
        testing::AddPart(&product_, "plate", contact::testing::Block(Vec3(1e-3, 8e-3, 10e-3)));
    testing::Place(&product_, part, "plate", X_WP_);
  }

  [[nodiscard]] std::optional<double> CalcStrain(const Vec3& p_P, const Vec3& inward_P,
                                                 const Vec3& way_P, double deflection) const {
    const auto bending = FindBending(product_, OccurrenceId(0), X_WP_ * p_P, X_WP_.q() * inward_P,
                                     X_WP_.q() * way_P, deflection);
    return bending ? std::optional(bending->strain) : std::nullopt;
  }

  /** What comes of it where a thick block pushes the plate by 0.5 mm towards a wall.
   @param gap  Between plate and wall [m]. */
  [[nodiscard]] BendingAnswer PushTowardsWall(double gap, bool is_wall_there) {
    const auto block =
        testing::AddPart(&product_, "block", contact::testing::Block(Vec3::Constant(5e-3)));
    const auto wall =
        testing::AddPart(&product_, "wall", contact::testing::Block(Vec3(5e-3, 8e-3, 10e-3)));
    testing::Place(&product_, block, "block", X_WP_ * Pose(Vec3(5.5e-3, 0, 5e-3)));
    testing::Place(&product_, wall, "wall", X_WP_ * Pose(Vec3(-6e-3 - gap, 0, 0)));
    const SideMeeting meeting{OccurrenceId(1),
                              OccurrenceId(0),
                              X_WP_ * Vec3(0.8e-3, 0.3e-3, 6e-3),
                              X_WP_.q() * Vec3::UnitX(),
                              X_WP_.q() * Vec3::UnitZ(),
                              0,
                              0.5e-3};
    return FindWhatBends(product_, meeting, {true, false, is_wall_there});
  }

  Pose X_WP_{Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), Vec3(0.1, -0.2, 0.3)};
  Product product_;
};

TEST_F(PlateTest, StrainIsThatOfACantilever) {
  // Bayer: y = 0.67 strain l^2 / h.
  const auto strain = CalcStrain(Vec3(1e-3, 0.3e-3, 9e-3), -Vec3::UnitX(), Vec3::UnitZ(), 0.5e-3);
  ASSERT_TRUE(strain);
  EXPECT_NEAR(0.67 * *strain * 20e-3 * 20e-3 / 2e-3, 0.5e-3, 1e-9);
}

TEST_F(PlateTest, APointInTheMaterialIsAsGoodAsOneOnIt) {
  const auto on_it = CalcStrain(Vec3(1e-3, 0.3e-3, 9e-3), -Vec3::UnitX(), Vec3::UnitZ(), 0.5e-3);
  const auto in_it = CalcStrain(Vec3(0.8e-3, 0.3e-3, 9e-3), -Vec3::UnitX(), Vec3::UnitZ(), 0.5e-3);
  ASSERT_TRUE(on_it && in_it);
  EXPECT_NEAR(*on_it, *in_it, 1e-9);
}

TEST_F(PlateTest, WhatIsThickerThanAThirdOfItsLengthDoesNotBend) {
  EXPECT_FALSE(CalcStrain(Vec3(0, 8e-3, 9e-3), -Vec3::UnitY(), Vec3::UnitZ(), 0.5e-3));
  EXPECT_FALSE(CalcStrain(Vec3(1e-3, 0, 0), -Vec3::UnitX(), Vec3::UnitX(), 0.1e-3));
}

TEST_F(PlateTest, AWallBendsWithOneAndAHalfTimesTheRoomBehindIt) {
  const BendingAnswer answer = PushTowardsWall(0.8e-3, true);
  ASSERT_TRUE(answer.bends);
  EXPECT_EQ(answer.bends->part, OccurrenceId(0));
  EXPECT_EQ(answer.bends->inward_sign, -1);
  EXPECT_FALSE(answer.no_room);
}

TEST_F(PlateTest, AWallWithLessRoomBehindItNamesWhatItWouldComeTo) {
  const BendingAnswer answer = PushTowardsWall(0.3e-3, true);
  EXPECT_FALSE(answer.bends);
  ASSERT_TRUE(answer.no_room);
  EXPECT_EQ(answer.no_room->part, OccurrenceId(0));
  EXPECT_EQ(answer.no_room->against, OccurrenceId(2));
  EXPECT_NEAR(answer.no_room->needed, 0.5e-3, 1e-9);
  EXPECT_NEAR(answer.no_room->free, 0.3e-3, 1e-9);
}

TEST_F(PlateTest, WhatIsNotThereYetLeavesRoom) {
  EXPECT_TRUE(PushTowardsWall(0.3e-3, false).bends);
}

TEST_F(PlateTest, AWallOfAMetalBearsNoMoreThanItsYieldStrain) {
  // 0.5 mm of 20 mm at 2 mm thickness: 0.37 %; S235JR yields at 0.11 %.
  product_.parts[0].material.is_standard_assumed = false;
  EXPECT_FALSE(PushTowardsWall(0.8e-3, true).bends);
}

}  // namespace
}  // namespace hvas::sequence
