#include "mates/drawn_volumes.h"

#include <numbers>

#include <gtest/gtest.h>

#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::OccurrenceId;
using product::Product;
using spatial::Pose;

/** Adds a closed box as a part, and places it. */
void AddBox(Product* product, const Vec3& half, const Pose& X_WB) {
  product::Part part;
  part.id = product::PartId(product->parts.size());
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      // FrameFromZ turns x and y with the normal: equal half widths in both avoid the question.
      testing::AddRectangle(&part, sign * half[k] * Vec3::Unit(k), sign * Vec3::Unit(k),
                            half[(k + 1) % 3], half[(k + 2) % 3]);
    }
  }
  product::Occurrence occurrence;
  occurrence.id = OccurrenceId(product->occurrences.size());
  occurrence.part = part.id;
  occurrence.X_WB = X_WB;
  product->parts.push_back(std::move(part));
  product->occurrences.push_back(occurrence);
}

TEST(DrawnVolumesTest, CubeSunkIntoACubeHasTheVolumeAndDepthOfTheDrawing) {
  for (const double depth : {0.1e-3, 1e-3, 3e-3}) {
    Product product;
    AddBox(&product, Vec3::Constant(10e-3), Pose());
    AddBox(&product, Vec3::Constant(4e-3), Pose(Vec3(1e-3, 2e-3, 14e-3 - depth)));
    const auto list = ListSharedVolumes(product);
    ASSERT_EQ(list.size(), 1U) << depth;
    EXPECT_NEAR(list[0].volume, 64e-6 * depth, 0.02 * 64e-6 * depth);
    EXPECT_NEAR(list[0].depth, depth, 1e-9);
    EXPECT_EQ(list[0].cause, SharedVolume::Cause::kOverlap);
  }
}

TEST(DrawnVolumesTest, TurnedCubesGiveTheSame) {  // An invariant of the common pose.
  const Pose X_WP(spatial::RotationFromVector(Vec3(0.4, -0.2, 1.1)), Vec3(0.1, 0, -0.05));
  Product product;
  AddBox(&product, Vec3::Constant(10e-3), X_WP);
  AddBox(&product, Vec3::Constant(4e-3), X_WP * Pose(Vec3(1e-3, 2e-3, 13e-3)));
  const SharedVolume shared = MeasureSharedVolume(product, OccurrenceId(0), OccurrenceId(1));
  EXPECT_NEAR(shared.volume, 64e-9, 0.1 * 64e-9);
  EXPECT_NEAR(shared.depth, 1e-3, 0.1e-3);
}

TEST(DrawnVolumesTest, CubesThatTouchShareNothing) {
  Product product;
  AddBox(&product, Vec3::Constant(10e-3), Pose());
  AddBox(&product, Vec3::Constant(4e-3), Pose(Vec3(1e-3, 2e-3, 14e-3)));
  EXPECT_TRUE(ListSharedVolumes(product).empty());
  EXPECT_EQ(MeasureSharedVolume(product, OccurrenceId(0), OccurrenceId(1)).volume, 0);
}

TEST(DrawnVolumesTest, MateWithAnInterferenceExplainsItsOverlap) {
  Product product;
  AddBox(&product, Vec3::Constant(10e-3), Pose());
  AddBox(&product, Vec3::Constant(4e-3), Pose(Vec3(0, 0, 13.96e-3)));
  product::Mate mate;
  mate.id = product::MateId(0);
  mate.kind = product::MateKind::kAxisHole;
  mate.a.occurrence = OccurrenceId(0);
  mate.b.occurrence = OccurrenceId(1);
  mate.hole_radius = 1.45e-3;
  mate.shaft_radius = 1.5e-3;
  mate.fit = product::Fit{product::FitKind::kInterference, "H7/p6", 2.9e-3, true, ""};
  product.mates.push_back(mate);
  auto list = ListSharedVolumes(product);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].cause, SharedVolume::Cause::kPressFit);
  EXPECT_EQ(list[0].mate, mate.id);
  product.mates[0].fit->kind = product::FitKind::kThread;
  EXPECT_EQ(ListSharedVolumes(product)[0].cause, SharedVolume::Cause::kThread);
  product.mates[0].shaft_radius = product.mates[0].hole_radius;
  EXPECT_TRUE(ListSharedVolumes(product).empty());  // 40 um deep: faces that touch.
}

}  // namespace
}  // namespace hvas::mates
