#include "mates/stated_fits.h"

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Fit;
using product::FitKind;
using product::Product;

product::Dimension MakeDimension(const std::string& fit, const std::string& entity) {
  product::Dimension dimension;
  dimension.kind = product::DimensionKind::kDiameter;
  dimension.nominal = 0.02;
  dimension.fit = fit;
  dimension.faces = {product::FaceId(0)};
  dimension.entity = entity;
  return dimension;
}

/** A bush with a hole of 20 mm on a pin of 20 mm, which state what is given. */
Fit FindFit(const std::optional<std::string>& on_hole, const std::optional<std::string>& on_shaft) {
  Product product;
  testing::AddPart(&product, "bush");
  testing::AddPart(&product, "pin");
  testing::AddCylinder(&product.parts[0], FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 0.01, 0,
                       0.03);
  testing::AddCylinder(&product.parts[1], FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 0.01, 0,
                       0.03);
  if (on_hole) {
    product.parts[0].dimensions.push_back(MakeDimension(*on_hole, "#12"));
  }
  if (on_shaft) {
    product.parts[1].dimensions.push_back(MakeDimension(*on_shaft, "#34"));
  }
  for (const auto& part : {product::PartId(0), product::PartId(1)}) {
    testing::AddOccurrence(&product, part, spatial::Pose());
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_EQ(product.mates.size(), 1u);
  const Fit proposed = *product.mates.at(0).fit;
  EXPECT_TRUE(proposed.is_proposed);
  const int count = AssignStatedFits(&product);
  EXPECT_EQ(count, product.mates[0].fit->is_proposed ? 0 : 1);
  return *product.mates[0].fit;
}

TEST(StatedFits, AClassOnEachSideMakesTheFit) {
  const Fit fit = FindFit("H7", "p6");
  EXPECT_FALSE(fit.is_proposed);
  EXPECT_EQ(fit.code, "H7/p6");
  EXPECT_EQ(fit.kind, FitKind::kInterference);
  EXPECT_DOUBLE_EQ(fit.nominal_diameter, 0.02);
  EXPECT_EQ(fit.reason, "stated in the file (#12, #34)");
}

TEST(StatedFits, AWholeFitOnEitherSideIsEnough) {
  EXPECT_EQ(FindFit("H7/k6", std::nullopt).code, "H7/k6");
  const Fit fit = FindFit(std::nullopt, "H7/k6");
  EXPECT_EQ(fit.kind, FitKind::kTransition);
  EXPECT_EQ(fit.reason, "stated in the file (#34)");
}

TEST(StatedFits, HalfAFitOrOneOnTheWrongSideLeavesTheProposal) {
  EXPECT_TRUE(FindFit("G6", std::nullopt).is_proposed);
  EXPECT_TRUE(FindFit("g6", "H7").is_proposed);
  EXPECT_TRUE(FindFit("QQ7", "g6").is_proposed);
  EXPECT_TRUE(FindFit(std::nullopt, std::nullopt).is_proposed);
}

}  // namespace
}  // namespace hvas::mates
