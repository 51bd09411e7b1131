#include "mates/prismatic_fits.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"
#include "spatial/test/random_pose.h"

namespace hvas::mates {
namespace {

using product::Product;

/** A slot along x, 10 mm wide across y, and a tongue in it. */
Product MakeTongueInSlot(double tongue_width, double shift, const Pose& X_WA) {
  Product product;
  product::Part* slot = testing::AddPart(&product, "slot");
  testing::AddRectangle(slot, Vec3(0, -5e-3, 0), Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddRectangle(slot, Vec3(0, 5e-3, 0), -Vec3::UnitY(), 4e-3, 20e-3);
  product::Part* tongue = testing::AddPart(&product, "tongue");
  const double half = 0.5 * tongue_width;
  testing::AddRectangle(tongue, Vec3(0, -half, 0), -Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddRectangle(tongue, Vec3(0, half, 0), Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddOccurrence(&product, product::PartId(0), X_WA);
  testing::AddOccurrence(&product, product::PartId(1), X_WA * Pose(Vec3(0, shift, 0)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

TEST(PrismaticFits, TongueInSlotHasWidthClearanceAndFitInAnyFrame) {
  Random random(5);
  for (const double width : {10e-3, 9.98e-3, 9.9e-3}) {
    for (const double shift : {0.0, 0.5 * (10e-3 - width)}) {
      const Pose X_WA = spatial::RandomPose(&random, 1);
      const auto fits = FindPrismaticFits(MakeTongueInSlot(width, shift, X_WA));
      ASSERT_EQ(fits.size(), 1U) << width << " " << shift;
      EXPECT_EQ(fits[0].outer, product::OccurrenceId(0));
      EXPECT_EQ(fits[0].inner, product::OccurrenceId(1));
      EXPECT_NEAR(fits[0].outer_width, 10e-3, 1e-9);
      EXPECT_NEAR(fits[0].clearance(), 10e-3 - width, 1e-9);
      EXPECT_NEAR(fits[0].engaged, 8e-3 * 40e-3, 1e-9);
      EXPECT_NEAR(std::abs(fits[0].across_W.dot(X_WA.q() * Vec3::UnitY())), 1, 1e-9);
      EXPECT_EQ(fits[0].fit.kind, product::FitKind::kClearance);
      EXPECT_EQ(fits[0].fit.code.empty(), false);
      EXPECT_NEAR(fits[0].fit.nominal_diameter, 10e-3, 1e-9);
    }
  }
}

TEST(PrismaticFits, ATongueThatIsDrawnLargerIsAPressFit) {
  const auto fits = FindPrismaticFits(MakeTongueInSlot(10.016e-3, 0, Pose()));
  ASSERT_EQ(fits.size(), 1U);
  EXPECT_NEAR(fits[0].clearance(), -16e-6, 1e-9);
  EXPECT_EQ(fits[0].fit.kind, product::FitKind::kInterference);
}

TEST(PrismaticFits, TwoBlocksOnEachOtherAreNone) {
  Product product;
  for (const char* name : {"lower", "upper"}) {
    product::Part* part = testing::AddPart(&product, name);
    testing::AddRectangle(part, Vec3(0, 0, -2e-3), -Vec3::UnitZ(), 4e-3, 4e-3);
    testing::AddRectangle(part, Vec3(0, 0, 2e-3), Vec3::UnitZ(), 4e-3, 4e-3);
  }
  testing::AddOccurrence(&product, product::PartId(0), Pose());
  testing::AddOccurrence(&product, product::PartId(1), Pose(Vec3(0, 0, 4e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_TRUE(FindPrismaticFits(product).empty());
}

}  // namespace
}  // namespace hvas::mates
