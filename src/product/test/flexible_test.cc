#include "product/flexible.h"

#include <gtest/gtest.h>

#include "product/product.h"

namespace hvas::product {
namespace {

Part Named(const std::string& name, const Vec3& size, const std::string& material = "") {
  Part part;
  part.name = name;
  part.material.name = material;
  part.box_B = {Vec3::Zero(), size};
  return part;
}

TEST(FlexibleTest, NamesAndMaterialsTellWhatGives) {
  const Vec3 size(20e-3, 20e-3, 2e-3);
  const auto kind_of = [&size](const std::string& name, const std::string& material = "") {
    const auto part = ClassifyFlexible(Named(name, size, material));
    return part ? std::string(ToString(part->kind)) : std::string("rigid");
  };
  for (const char* name : {"O-Ring 16x2", "oring_2", "O RING", "OR-Ring 20"}) {
    EXPECT_EQ(kind_of(name), "O-ring") << name;
  }
  for (const char* name :
       {"Circlip 20", "DIN 471 - 20x1.2", "retaining_ring", "E-Clip 4", "Sicherungsring DIN 472"}) {
    EXPECT_EQ(kind_of(name), "retaining ring") << name;
  }
  for (const char* name : {"cable clip", "Snap cover", "snap hook"}) {
    EXPECT_EQ(kind_of(name), "rigid") << name;  // What of it bends is a matter of its form.
    EXPECT_EQ(FindFlexibleKind(name), FlexibleKind::kSnapHook) << name;
  }
  EXPECT_EQ(kind_of("clip holder"), "rigid");
  EXPECT_EQ(kind_of("Blind rivet 3.2x8"), "rivet");
  EXPECT_EQ(kind_of("rivet nut M4"), "rigid");
  EXPECT_EQ(kind_of("E-Ring 4"), "retaining ring");
  EXPECT_EQ(kind_of("Flachdichtung"), "gasket");
  EXPECT_EQ(kind_of("Compression Spring"), "spring");
  EXPECT_EQ(kind_of("GT2 belt"), "belt");
  EXPECT_EQ(kind_of("USB cable"), "cable");
  EXPECT_EQ(kind_of("foot", "NBR 70"), "rubber");
  EXPECT_EQ(kind_of("rubber foot"), "rubber");
  EXPECT_EQ(kind_of("Tyre 80"), "rubber");
  EXPECT_EQ(kind_of("grommet 8 mm"), "rubber");
  for (const char* name :
       {"monitoring unit", "eclipse", "belt pulley", "spring pin", "cable chain", "spring washer",
        "hose nipple", "housing", "hydraulic block", "latch plate"}) {
    EXPECT_EQ(kind_of(name), "rigid") << name;
  }
}

TEST(FlexibleTest, AllowanceFollowsTheKindAndTheSize) {
  // docs/algorithms/flexible.md: section of an O-ring; a tenth of a ring; half of a gasket.
  const auto allowance = [](const std::string& name, const Vec3& size) {
    return ClassifyFlexible(Named(name, size))->allowance;
  };
  EXPECT_DOUBLE_EQ(allowance("O-ring", Vec3(20e-3, 20e-3, 2e-3)), 2e-3);
  EXPECT_DOUBLE_EQ(allowance("O-ring", Vec3(6e-3, 6e-3, 1.5e-3)), 0.75e-3);
  EXPECT_DOUBLE_EQ(allowance("circlip", Vec3(23e-3, 23e-3, 1.2e-3)), 2.3e-3);
  EXPECT_DOUBLE_EQ(allowance("circlip", Vec3(2.5e-3, 2.5e-3, 0.3e-3)), 0.3e-3);
  EXPECT_DOUBLE_EQ(allowance("gasket", Vec3(40e-3, 30e-3, 1e-3)), 0.5e-3);
  EXPECT_DOUBLE_EQ(allowance("rubber tyre", Vec3(80e-3, 80e-3, 16e-3)), 12e-3);
  EXPECT_DOUBLE_EQ(allowance("rubber sheet", Vec3(80e-3, 80e-3, 2e-3)), 2e-3);
  EXPECT_DOUBLE_EQ(allowance("belt", Vec3(120e-3, 30e-3, 6e-3)), 5e-3);
}

TEST(FlexibleTest, FormComesBeforeNames) {
  Part ring = Named("gasket", Vec3(20e-3, 20e-3, 2e-3));
  EXPECT_EQ(ClassifyFlexible(ring)->kind, FlexibleKind::kGasket);
  ring.faces.emplace_back();
  ring.faces[0].surface.kind = SurfaceKind::kTorus;
  EXPECT_EQ(ClassifyFlexible(ring)->kind, FlexibleKind::kORing);
}

TEST(FlexibleTest, FormTellsARingOfRoundSectionAndAnOpenFlatRing) {
  Part ring = Named("part 7", Vec3(20e-3, 20e-3, 2e-3));
  ring.faces.emplace_back();
  ring.faces[0].surface.kind = SurfaceKind::kTorus;
  ASSERT_TRUE(ClassifyFlexible(ring).has_value());
  EXPECT_EQ(ClassifyFlexible(ring)->kind, FlexibleKind::kORing);
  ring.faces[0].surface.kind = SurfaceKind::kCylinder;
  EXPECT_FALSE(ClassifyFlexible(ring).has_value());
  for (const FeatureKind kind : {FeatureKind::kHole, FeatureKind::kShaft}) {
    Feature feature;
    feature.kind = kind;
    feature.radius = kind == FeatureKind::kHole ? 8e-3 : 10e-3;
    feature.coverage = 5.5;
    ring.features.push_back(feature);
  }
  EXPECT_EQ(ClassifyFlexible(ring)->kind, FlexibleKind::kRetainingRing);
  ring.features[0].coverage = 6.2832;  // Closed: a washer.
  EXPECT_FALSE(ClassifyFlexible(ring).has_value());
}

}  // namespace
}  // namespace hvas::product
