#include "mates/unit_doubt.h"

#include <gtest/gtest.h>

#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

/** A screw and a nut whose threads are drawn with these diameters. */
product::Product MakePair(const std::string& screw_name, double screw, const std::string& nut_name,
                          double nut) {
  product::Product product;
  for (const auto& [name, diameter] : {std::pair(screw_name, screw), std::pair(nut_name, nut)}) {
    product::Part* part = testing::AddPart(&product, name);
    testing::AddCylinder(part, product::FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(),
                         0.5 * diameter, 0, 3 * diameter);
    part->features.back().thread = product::ThreadKind::kNominal;
  }
  return product;
}

std::vector<Diagnostic> Report(const product::Product& product) {
  Diagnostics diagnostics;
  ReportDoubtfulUnit(product, &diagnostics);
  return diagnostics.items();
}

TEST(UnitDoubt, FastenersThatOneFactorMakesUsualAreAskedAbout) {
  for (const double factor : {25.4, 1e3, 1e-3, 1 / 25.4}) {
    const auto unnamed = Report(MakePair("bolt", 10e-3 * factor, "nut", 10e-3 * factor));
    // 1/25.4 of 10 mm is no thread, and 25.4 times it is one again.
    ASSERT_EQ(unnamed.size(), 1U) << factor;
    EXPECT_EQ(unnamed[0].code, "unit-doubtful");
    EXPECT_NE(unnamed[0].remedy.find("--unit"), std::string::npos) << unnamed[0].remedy;
    const auto named = Report(MakePair("M5x20", 5e-3 * factor, "nut M5", 4.2e-3 * factor));
    ASSERT_EQ(named.size(), 1U) << factor;
  }
}

TEST(UnitDoubt, UsualOnesAndOddOnesAreNot) {
  EXPECT_TRUE(Report(MakePair("bolt", 10e-3, "nut", 10e-3)).empty());
  EXPECT_TRUE(Report(MakePair("M5x20", 5e-3, "nut M5", 4.2e-3)).empty());
  EXPECT_TRUE(Report(MakePair("M5x20", 0.127, "nut", 10e-3)).empty());  // No factor fits both.
  product::Product no_threads = MakePair("rail", 254e-3, "plate", 254e-3);
  for (product::Part& part : no_threads.parts) {
    part.features[0].thread = product::ThreadKind::kNone;
  }
  EXPECT_TRUE(Report(no_threads).empty());
}

}  // namespace
}  // namespace hvas::mates
