// Rings in grooves and belts: form and place say that they give, no name.

#include "product/yielding_forms.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "product/test/mesh_mass.h"
#include "product/test/ring_mesh.h"

namespace hvas::product {
namespace {

Product MakeProduct(std::vector<Part> parts) {
  Product product;
  for (Part& part : parts) {
    part.id = PartId(product.parts.size());
    Occurrence occurrence;
    occurrence.id = OccurrenceId(product.occurrences.size());
    occurrence.part = part.id;
    product.occurrences.push_back(occurrence);
    product.parts.push_back(std::move(part));
  }
  return product;
}

/** A body with a groove about z whose middle is at 1 mm. @param depth  [m] */
Part MakeGrooved(double floor_diameter, double depth) {
  Part part;
  part.box_B = {Vec3(-50e-3, -50e-3, -20e-3), Vec3(50e-3, 50e-3, 20e-3)};
  Form groove;
  groove.kind = FormKind::kGroove;
  groove.origin_B = Vec3(0, 0, 1.05e-3);
  groove.axis_B = -Vec3::UnitZ();
  groove.diameter = floor_diameter;
  groove.depth = depth;
  part.forms.push_back(groove);
  return part;
}

TEST(YieldingFormsTest, AClosedRingInAGrooveGivesByTheLandThatItPasses) {
  const Part ring = testing::MakeRingPart({37e-3, 40e-3, 2e-3, 0});
  const auto on_shaft = ListYieldingInPlace(MakeProduct({MakeGrooved(73e-3, 2e-3), ring}), nullptr);
  ASSERT_EQ(on_shaft.size(), 1U);
  EXPECT_EQ(on_shaft[0].occurrence, OccurrenceId(1));
  EXPECT_EQ(on_shaft[0].kind, FlexibleKind::kGrooveRing);
  EXPECT_NEAR(on_shaft[0].allowance, 1.3 * 1.5e-3, 1e-6);
  const auto in_bore = ListYieldingInPlace(MakeProduct({MakeGrooved(81e-3, 2e-3), ring}), nullptr);
  ASSERT_EQ(in_bore.size(), 1U);
  EXPECT_NEAR(in_bore[0].allowance, 1.3 * 1.5e-3, 1e-6);
}

TEST(YieldingFormsTest, ARingBesideAGrooveOrLooseInItDoesNotGive) {
  const auto list = [](const Part& grooved, const testing::RingMesh& ring, double z) {
    Product product = MakeProduct({grooved, testing::MakeRingPart(ring)});
    product.occurrences[1].X_WB = Pose(Vec3(0, 0, z));
    return ListYieldingInPlace(product, nullptr).size();
  };
  const Part grooved = MakeGrooved(73e-3, 2e-3);
  EXPECT_EQ(list(grooved, {37e-3, 40e-3, 2e-3, 0}, 0), 1U);
  EXPECT_EQ(list(grooved, {37e-3, 40e-3, 2e-3, 0}, 5e-3), 0U);  // Beside it.
  EXPECT_EQ(list(grooved, {38.6e-3, 40e-3, 2e-3, 0}, 0), 0U);   // It goes over the land.
  EXPECT_EQ(list(grooved, {37e-3, 60e-3, 2e-3, 0}, 0), 0U);     // A disc that does not stretch.
  EXPECT_EQ(list(MakeGrooved(73e-3, 12e-3), {37e-3, 40e-3, 2e-3, 0}, 0), 0U);  // By more than 25 %.
}

/** A band about z round two axes 50 mm apart, and as thick and as wide as stated [m]. */
Part MakeBand(double thickness, double width) {
  constexpr double kRadius = 10e-3;
  constexpr double kHalf = 25e-3;
  constexpr int kPieces = 48;  // Of half a turn.
  Part part;
  const int count = 2 * (kPieces + 1);
  for (int i = 0; i < count; ++i) {
    const bool is_right = i <= kPieces;
    const double angle = std::numbers::pi * ((is_right ? i : i - 1) / double{kPieces} - 0.5);
    for (const auto& [out, z] :
         {std::pair(0.0, 0.0), {thickness, 0.0}, {thickness, width}, {0.0, width}}) {
      part.mesh.vertices.emplace_back(
          (is_right ? kHalf : -kHalf) + (kRadius + out) * std::cos(angle),
          (kRadius + out) * std::sin(angle), z);
    }
  }
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 4; ++k) {
      const auto corner = [count](int at, int side) {
        return static_cast<std::uint32_t>(4 * (at % count) + side % 4);
      };
      part.mesh.triangles.push_back({corner(i, k), corner(i + 1, k), corner(i + 1, k + 1)});
      part.mesh.triangles.push_back({corner(i, k), corner(i + 1, k + 1), corner(i, k + 1)});
    }
  }
  part.mass = testing::CalcMass(part.mesh, 1);
  part.mass.volume = std::abs(part.mass.volume);
  for (const double x : {-kHalf, kHalf}) {
    Face face;
    face.surface = {SurfaceKind::kCylinder, Vec3(x, 0, 0), Vec3::UnitZ(), kRadius, 0, -1};
    face.area = std::numbers::pi * kRadius * width;
    part.faces.push_back(face);
  }
  for (const Vec3& p : part.mesh.vertices) {
    part.box_B.Add(p);
  }
  return part;
}

Part MakePulley() {
  Part part;
  part.box_B = {Vec3(-10e-3, -10e-3, -5e-3), Vec3(10e-3, 10e-3, 15e-3)};
  Feature shaft;
  shaft.kind = FeatureKind::kShaft;
  shaft.radius = 10e-3;
  part.features.push_back(shaft);
  return part;
}

TEST(YieldingFormsTest, ABandRoundTwoShaftsIsABelt) {
  const auto band = FindBandShape(MakeBand(1.5e-3, 6e-3));
  ASSERT_TRUE(band);
  EXPECT_EQ(band->arcs_B.size(), 2U);
  EXPECT_NEAR(band->thickness, 1.5e-3, 0.05e-3);
  EXPECT_NEAR(band->length, 2 * std::numbers::pi * 10.75e-3 + 100e-3, 1e-3);
  Product product = MakeProduct({MakePulley(), MakePulley(), MakeBand(1.5e-3, 6e-3)});
  product.occurrences[0].X_WB = Pose(Vec3(25e-3, 0, 0));
  product.occurrences[1].X_WB = Pose(Vec3(-25e-3, 0, 0));
  const auto yielding = ListYieldingInPlace(product, nullptr);
  ASSERT_EQ(yielding.size(), 1U);
  EXPECT_EQ(yielding[0].occurrence, OccurrenceId(2));
  EXPECT_EQ(yielding[0].kind, FlexibleKind::kBelt);
  EXPECT_DOUBLE_EQ(yielding[0].allowance, 5e-3);
  product.occurrences[1].X_WB = Pose(Vec3(-20e-3, 0, 0));  // It goes round one shaft alone.
  EXPECT_TRUE(ListYieldingInPlace(product, nullptr).empty());
}

TEST(YieldingFormsTest, AThickLinkAndARoundRingAreNoBands) {
  EXPECT_FALSE(FindBandShape(MakeBand(10e-3, 6e-3)));    // The link of a chain.
  EXPECT_FALSE(FindBandShape(MakeBand(1.5e-3, 90e-3)));  // The wall of a case.
  Part ring = MakeBand(1.5e-3, 6e-3);
  ring.faces.pop_back();
  EXPECT_FALSE(FindBandShape(ring));
}

}  // namespace
}  // namespace hvas::product
