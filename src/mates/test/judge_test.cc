#include "mates/judge.h"

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Mate;
using product::Part;
using product::PartId;
using product::Product;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;

struct Drawn {
  double hole{5e-3}, shaft{5e-3};  // Radii [m].
  double engaged{10e-3};
  double offset{0};  // Of the axes [m].
  const char* hole_part{"block"};
  const char* shaft_part{"pin"};
  double hole_length{40e-3};
};

Mate MakePinned(const Drawn& drawn) {
  Product product;
  AddPart(&product, drawn.hole_part);
  AddCylinder(&product.parts[0], FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), drawn.hole,
              -drawn.hole_length, 0);
  AddPart(&product, drawn.shaft_part);
  AddCylinder(&product.parts[1], FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), drawn.shaft,
              -drawn.engaged, 30e-3);
  AddOccurrence(&product, PartId(0), Pose());
  AddOccurrence(&product, PartId(1), Pose(Vec3(drawn.offset, 0, 0)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_EQ(product.mates.size(), 1U);
  return product.mates.at(0);
}

TEST(Judge, AnExactLongEngagementIsCertain) {
  EXPECT_DOUBLE_EQ(MakePinned({}).confidence, 1);
}

TEST(Judge, EvidenceNamesTheNumbers) {
  EXPECT_EQ(MakePinned({5e-3, 4.99e-3, 10e-3, 3e-6}).evidence,
            "radii 5.000/4.990 mm, engaged 10.00 mm, axes 3.00 um apart");
}

// The rule of docs/algorithms/mates.md, worked out by hand.
TEST(Judge, PlayShortnessOffsetAndNamesLowerTheConfidenceByTheStatedFactors) {
  // Half of the largest play of max(0.6 mm, 0.3 r) = 1.35 mm at r = 4.5 mm... 0.675 mm.
  EXPECT_NEAR(MakePinned({5.175e-3, 4.5e-3}).confidence, 0.75, 1e-9);
  // A quarter of a diameter engaged.
  EXPECT_NEAR(MakePinned({5e-3, 5e-3, 2.5e-3}).confidence, 0.625, 1e-9);
  // All of a ring a quarter of a diameter long.
  EXPECT_NEAR(MakePinned({5e-3, 5e-3, 2.5e-3, 0, "block", "pin", 2.5e-3}).confidence, 1, 1e-9);
  // Half of the largest offset of 20 um.
  EXPECT_NEAR(MakePinned({5e-3, 5e-3, 10e-3, 10e-6}).confidence, 0.9, 1e-6);
  // A pin inside a screw.
  const Mate odd = MakePinned({5e-3, 5e-3, 10e-3, 0, "M20 bolt"});
  EXPECT_NEAR(odd.confidence, 0.6, 1e-9);
  EXPECT_NE(odd.evidence.find("contradicts the names"), std::string::npos);
  // Screws have play: it does not tell against them.
  EXPECT_NEAR(MakePinned({5.175e-3, 4.5e-3, 10e-3, 0, "plate", "M9 bolt"}).confidence, 0.9, 1e-9);
}

TEST(Judge, AFaceIsMoreCertainTheMoreOfItTouchesAndTheNearer) {
  const auto confidence = [](double shift, double gap) {
    Product product;
    AddPart(&product, "table");
    AddRectangle(&product.parts[0], Vec3::Zero(), Vec3::UnitZ(), 20e-3, 20e-3);
    AddPart(&product, "box");
    AddRectangle(&product.parts[1], Vec3::Zero(), -Vec3::UnitZ(), 20e-3, 20e-3);
    AddOccurrence(&product, PartId(0), Pose());
    AddOccurrence(&product, PartId(1), Pose(Vec3(shift, 0, gap)));
    Diagnostics diagnostics;
    Infer(&product, &diagnostics);
    EXPECT_EQ(product.mates.size(), 1U);
    return product.mates.at(0).confidence;
  };
  EXPECT_NEAR(confidence(0, 0), 1, 1e-12);
  EXPECT_NEAR(confidence(20e-3, 0), 1, 1e-12);   // Half of it.
  EXPECT_NEAR(confidence(36e-3, 0), 0.7, 1e-9);  // A tenth.
  EXPECT_NEAR(confidence(0, 5e-6), 0.85, 1e-9);  // Half of the largest gap.
}

}  // namespace
}  // namespace hvas::mates
