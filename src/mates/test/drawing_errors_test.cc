// Overlaps as drawn that no joint explains, and those that one does.

#include "mates/drawing_errors.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fits/iso286.h"
#include "mates/assignments.h"
#include "mates/infer.h"
#include "mates/stated_fits.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::DrawingError;
using product::FaceId;
using product::FeatureKind;
using product::FitKind;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Product;
using spatial::Pose;
using ::testing::IsSubstring;

constexpr int kSegments = 96;  // Chords of a circle of 30 mm: 8 um.

/** Adds the triangles of a ring face between two circles about z. */
FaceId AddBand(Part* part, double r_low, double z_low, double r_high, double z_high) {
  const FaceId id = testing::AddFace(part);
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSegments;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    part->mesh.vertices.push_back(r_low * out + z_low * Vec3::UnitZ());
    part->mesh.vertices.push_back(r_high * out + z_high * Vec3::UnitZ());
  }
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const std::uint32_t a = first + 2 * i;
    const std::uint32_t b = first + 2 * ((i + 1) % kSegments);
    part->mesh.triangles.push_back({a, b, a + 1});
    part->mesh.triangles.push_back({b, b + 1, a + 1});
  }
  product::Face& face = part->faces[id.index()];
  face.triangle_count = 2 * kSegments;
  const double r = std::max(r_low, r_high);
  face.box_B = {Vec3(-r, -r, std::min(z_low, z_high)), Vec3(r, r, std::max(z_low, z_high))};
  part->box_B.Add(face.box_B);
  return id;
}

void AddRound(Part* part, FeatureKind kind, double radius, double height) {
  const bool is_hole = kind == FeatureKind::kHole;
  const FaceId id =
      is_hole ? AddBand(part, radius, height, radius, 0) : AddBand(part, radius, 0, radius, height);
  part->faces[id.index()].surface = {product::SurfaceKind::kCylinder,
                                     Vec3::Zero(),
                                     Vec3::UnitZ(),
                                     radius,
                                     0,
                                     is_hole ? -1.0 : 1.0};
  product::Feature feature;
  feature.kind = kind;
  feature.faces = {id};
  feature.radius = radius;
  feature.span_high = height;
  feature.coverage = testing::kFullTurn;
  feature.area = testing::kFullTurn * radius * height;
  part->features.push_back(feature);
}

void AddEnd(Part* part, double r_in, double r_out, double z, double up) {
  const FaceId id = up > 0 ? AddBand(part, r_out, z, r_in, z) : AddBand(part, r_in, z, r_out, z);
  part->faces[id.index()].surface = {
      product::SurfaceKind::kPlane, Vec3(0, 0, z), Vec3(0, 0, up), 0, 0, 1};
  product::Feature feature;
  feature.faces = {id};
  feature.origin_B = Vec3(0, 0, z);
  feature.axis_B = Vec3(0, 0, up);
  feature.area = std::numbers::pi * (r_out * r_out - r_in * r_in);
  part->features.push_back(feature);
}

/** Adds a ring about z from 0 to its height; a rod where its bore is 0. */
OccurrenceId AddRing(Product* product, const std::string& name, double bore, double diameter,
                     double height, const Pose& X_WB = Pose()) {
  Part* part = testing::AddPart(product, name);
  AddRound(part, FeatureKind::kShaft, 0.5 * diameter, height);
  if (bore > 0) {
    AddRound(part, FeatureKind::kHole, 0.5 * bore, height);
  }
  AddEnd(part, 0.5 * bore, 0.5 * diameter, 0, -1);
  AddEnd(part, 0.5 * bore, 0.5 * diameter, height, 1);
  testing::AddOccurrence(product, part->id, X_WB);
  return product->occurrences.back().id;
}

/** A rod in a ring that is as high as it. */
Product RodInRing(double shaft, double hole, const std::string& rod = "rod",
                  const std::string& ring = "ring") {
  Product product;
  AddRing(&product, ring, hole, 3 * hole, 10e-3);
  AddRing(&product, rod, 0, shaft, 10e-3);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  product.drawing_errors = ListDrawingErrors(product);
  return product;
}

bool HasFitOf(const Product& product, FitKind kind) {
  return std::any_of(product.mates.begin(), product.mates.end(), [kind](const product::Mate& mate) {
    return mate.fit && mate.fit->kind == kind;
  });
}

TEST(DrawingErrors, ShaftThatNoPressFitHasIsNamedWithBothDiametersAndHasNoMate) {
  for (const auto& [shaft, hole] : {std::pair(28.575e-3, 25.4e-3), std::pair(22e-3, 19e-3),
                                    std::pair(60e-3, 55e-3), std::pair(16e-3, 12e-3)}) {
    const Product product = RodInRing(shaft, hole);
    EXPECT_TRUE(product.mates.empty() || !HasFitOf(product, FitKind::kInterference)) << shaft;
    ASSERT_EQ(product.drawing_errors.size(), 1U) << shaft;
    const DrawingError& error = product.drawing_errors[0];
    EXPECT_TRUE(error.is_in_hole);
    EXPECT_NEAR(error.depth, 0.5 * (shaft - hole), 1e-12);
    const double volume = std::numbers::pi / 4 * (shaft * shaft - hole * hole) * 10e-3;
    EXPECT_NEAR(error.volume, volume, 0.05 * volume);
    EXPECT_NEAR(error.largest, 0.5 * fits::CalcLargestPress(hole), 1e-12);
    Diagnostics diagnostics;
    ReportDrawingErrors(product, &diagnostics);
    ASSERT_EQ(diagnostics.items().size(), 1U);
    EXPECT_EQ(diagnostics.items()[0].code, "drawing-error");
  }
  EXPECT_PRED_FORMAT2(IsSubstring, "28.575 mm in a hole of 25.4 mm",
                      DescribeDrawingError(RodInRing(28.575e-3, 25.4e-3),
                                           RodInRing(28.575e-3, 25.4e-3).drawing_errors[0]));
}

TEST(DrawingErrors, PressFitsOfMetalAndOfPlasticsAreNone) {
  for (const auto& [shaft, hole] :
       {std::pair(25.45e-3, 25.4e-3), std::pair(20.3e-3, 20e-3), std::pair(3.1e-3, 3e-3),
        std::pair(101e-3, 100e-3), std::pair(25.4e-3, 25.4e-3)}) {
    const Product product = RodInRing(shaft, hole);
    EXPECT_TRUE(product.drawing_errors.empty()) << shaft;
    EXPECT_EQ(HasFitOf(product, FitKind::kInterference), shaft > hole) << shaft;
  }
}

TEST(DrawingErrors, ThreadsAndInsertsHaveTheirOwnBounds) {
  // An M8 in its core, a tapping screw, and a screw in a hole that no thread of its size has.
  EXPECT_TRUE(RodInRing(8e-3, 6.647e-3, "screw M8x10").drawing_errors.empty());
  EXPECT_TRUE(RodInRing(4.2e-3, 3.1e-3, "tapping screw 4.2").drawing_errors.empty());
  EXPECT_EQ(RodInRing(8e-3, 4e-3, "screw M8x10").drawing_errors.size(), 1U);
  EXPECT_FALSE(HasFitOf(RodInRing(8e-3, 4e-3, "screw M8x10"), FitKind::kThread));
}

TEST(DrawingErrors, PartThatGivesMayLieAsDeepAsItGives) {
  Product product = RodInRing(24e-3, 20e-3, "rod", "sleeve");
  ASSERT_EQ(product.drawing_errors.size(), 1U);
  for (const auto& [allowance, errors] : {std::pair(2.5e-3, 0U), std::pair(1.5e-3, 1U)}) {
    product.flexible = {{OccurrenceId(0), product::FlexibleKind::kRubber, allowance, "stated"}};
    EXPECT_EQ(ListDrawingErrors(product).size(), errors) << allowance;
  }
}

TEST(DrawingErrors, EqualPairsHaveEqualErrorsAndOneWarning) {
  Product product;
  for (int i = 0; i < 5; ++i) {
    const Pose X_WP(Quat(Eigen::AngleAxisd(0.7 * i, Vec3(1, 2, i).normalized())),
                    Vec3(0.2 * i, 0.05 * i, 0));
    if (i == 0) {
      AddRing(&product, "hub", 20e-3, 40e-3, 10e-3, X_WP);
      AddRing(&product, "pin", 0, 24e-3, 10e-3, X_WP);
    } else {
      testing::AddOccurrence(&product, PartId(0), X_WP);
      testing::AddOccurrence(&product, PartId(1), X_WP);
    }
  }
  const std::vector<DrawingError> errors = ListDrawingErrors(product);
  ASSERT_EQ(errors.size(), 5U);
  for (const DrawingError& error : errors) {
    EXPECT_EQ(DescribeDrawingError(product, error).substr(0, 24),
              DescribeDrawingError(product, errors[0]).substr(0, 24));
    EXPECT_NEAR(error.depth, errors[0].depth, 1e-12);
    EXPECT_NEAR(error.volume, errors[0].volume, 1e-3 * errors[0].volume);
    EXPECT_EQ(error.face_a, errors[0].face_a);
    EXPECT_EQ(error.face_b, errors[0].face_b);
  }
  product.drawing_errors = errors;
  Diagnostics diagnostics;
  ReportDrawingErrors(product, &diagnostics);
  ASSERT_EQ(diagnostics.items().size(), 1U);
  EXPECT_PRED_FORMAT2(IsSubstring, "4 more pairs", diagnostics.items()[0].message);
}

TEST(DrawingErrors, PartsThatCrossOrLieWhollyInsideAreFoundTheLargestFirst) {
  Product product;
  AddRing(&product, "block", 0, 60e-3, 60e-3);
  AddRing(&product, "ball", 0, 10e-3, 10e-3, Pose(Vec3(5e-3, 0, 25e-3)));  // Wholly inside.
  const Quat across(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()));
  AddRing(&product, "bar", 0, 20e-3, 100e-3, Pose(across, Vec3(-50e-3, 0, 45e-3)));
  const std::vector<DrawingError> errors = ListDrawingErrors(product);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].b, OccurrenceId(2));
  EXPECT_NEAR(errors[0].volume, std::numbers::pi * 1e-4 * 58.2e-3, 1.5e-6);
  EXPECT_EQ(errors[1].b, OccurrenceId(1));
  EXPECT_NEAR(errors[1].volume, std::numbers::pi * 25e-6 * 10e-3, 0.02e-6);
  EXPECT_NEAR(errors[1].depth, 30e-3, 6e-3);  // Its far side from the block's.
}

TEST(DrawingErrors, FitThatIsStatedForSuchAnOverlapIsRefused) {
  Product product = RodInRing(8e-3, 6.647e-3, "screw M8x10");
  ASSERT_TRUE(HasFitOf(product, FitKind::kThread));
  const auto refused = AssignFit(&product, "m0=H7/p6");
  ASSERT_FALSE(refused.has_value());
  EXPECT_PRED_FORMAT2(IsSubstring, "8 mm is drawn in a hole of 6.647 mm", refused.error().message);
  EXPECT_TRUE(AssignFit(&product, "m0=thread").has_value());
  Product press = RodInRing(25.45e-3, 25.4e-3);
  EXPECT_TRUE(AssignFit(&press, "m0=H7/p6").has_value());
}

}  // namespace
}  // namespace hvas::mates
