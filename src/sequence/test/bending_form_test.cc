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

  [[nodiscard]] bool IsFreeBehind(double x) const {
    return HasRoomToBend(product_, OccurrenceId(0), X_WP_ * Vec3(x, 0.3e-3, 0.2e-3),
                         X_WP_.q() * -Vec3::UnitX(), 0.5e-3);
  }

 private:
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

TEST_F(PlateTest, AWallNeedsRoomBehindIt) {
  EXPECT_TRUE(IsFreeBehind(2e-3));
  EXPECT_FALSE(IsFreeBehind(1.5e-3));  // It would come to the plate.
  EXPECT_FALSE(IsFreeBehind(0.5e-3));  // It lies in the plate by as much.
}

}  // namespace
}  // namespace hvas::sequence
