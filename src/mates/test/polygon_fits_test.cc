#include "mates/polygon_fits.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"
#include "product/features.h"
#include "product/test/flat_face.h"
#include "product/test/round_face.h"

namespace hvas::mates {
namespace {

using product::Part;
using product::Product;
using product::testing::AddFlatFace;
using product::testing::AddRoundFace;

/** The walls of a regular polygon about z, outside of the material or of a bore. */
void AddPolygonWalls(int sides, double across, bool is_recess, double low, double high,
                     Part* part) {
  constexpr double kPi = std::numbers::pi;
  const double reach = 0.5 * across / std::cos(kPi / sides);
  for (int i = 0; i < sides; ++i) {
    const double from = 2 * kPi * (is_recess ? i + 1 : i) / sides;
    const double to = 2 * kPi * (is_recess ? i : i + 1) / sides;
    const auto at = [reach](double angle, double z) {
      return Vec3(reach * std::cos(angle), reach * std::sin(angle), z);
    };
    AddFlatFace({at(from, low), at(to, low), at(to, high), at(from, high)}, part);
  }
}

/** A ring with a bore of flats and, unless its width is 0, a bar with flats in it. */
Product MakeBarInRing(int sides, double bore, double bar, const Vec3& offset) {
  Product product;
  testing::AddPart(&product, "ring");
  AddPolygonWalls(sides, bore, true, 0, 10e-3, &product.parts[0]);
  AddRoundFace(&product.parts[0], 0, 0.8 * bore, 1, 0, 2 * std::numbers::pi, 0, 10e-3);
  product::BuildFeatures(&product.parts[0]);
  testing::AddOccurrence(&product, product::PartId(0), spatial::Pose());
  if (bar > 0) {
    testing::AddPart(&product, "bar");
    AddPolygonWalls(sides, bar, false, -20e-3, 30e-3, &product.parts[1]);
    product::BuildFeatures(&product.parts[1]);
    testing::AddOccurrence(&product, product::PartId(1), spatial::Pose(offset));
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

TEST(PolygonFits, ABarOfAnyNumberOfSidesIsInTheBoreWithItsMates) {
  const char* const names[] = {"square bore", "hexagonal bore", "octagonal bore"};
  for (const int sides : {4, 6, 8}) {
    for (const double bore : {5e-3, 12.7e-3, 30e-3}) {
      SCOPED_TRACE(sides);
      const auto fits = FindPolygonFits(MakeBarInRing(sides, bore, bore - 0.05e-3, Vec3::Zero()));
      ASSERT_EQ(fits.size(), 1U);
      EXPECT_EQ(DescribePolygon(fits[0].form), names[sides / 2 - 2]);
      ASSERT_TRUE(fits[0].inner.has_value());
      EXPECT_EQ(fits[0].inner->index(), 1U);
      EXPECT_NEAR(fits[0].form.width - fits[0].inner_width, 0.05e-3, 1e-9);
      EXPECT_NEAR(fits[0].engaged, 10e-3, 1e-9);
      EXPECT_EQ(fits[0].mates.size(), static_cast<std::size_t>(sides) / 2);
    }
  }
}

TEST(PolygonFits, ABoreThatNoPartIsInIsListedAloneAndABarElsewhereIsNotInIt) {
  for (const double bar : {0.0, 11.9e-3}) {
    const auto fits = FindPolygonFits(MakeBarInRing(6, 12e-3, bar, Vec3(0, 0, 40e-3)));
    ASSERT_EQ(fits.size(), 1U);
    EXPECT_FALSE(fits[0].inner.has_value());
    EXPECT_TRUE(fits[0].mates.empty());
  }
}

TEST(PolygonFits, ABarThatIsWiderThanTheBoreOrFarOffItsAxisIsNotInIt) {
  for (const auto& [bar, x] : {std::pair(13e-3, 0.0), std::pair(11.9e-3, 2e-3)}) {
    const auto fits = FindPolygonFits(MakeBarInRing(6, 12e-3, bar, Vec3(x, 0, 0)));
    ASSERT_EQ(fits.size(), 1U);
    EXPECT_FALSE(fits[0].inner.has_value()) << bar;
  }
}

}  // namespace
}  // namespace hvas::mates
