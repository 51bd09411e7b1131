#include "cad/step/material.h"

#include <gtest/gtest.h>

namespace hvas::cad {
namespace {

TEST(NormaliseDensity, ReadsSteelInEveryUnitThatFilesUse) {
  for (const double value : {7850.0, 7.85, 7.85e-3, 7.85e-6}) {
    ASSERT_TRUE(NormaliseDensity(value).has_value()) << value;
    EXPECT_NEAR(*NormaliseDensity(value), 7850, 1e-9);
  }
}

TEST(NormaliseDensity, ReadsTheLightestAndHeaviestMaterials) {
  EXPECT_NEAR(NormaliseDensity(0.45).value_or(0), 450, 1e-9);
  EXPECT_NEAR(NormaliseDensity(22.59).value_or(0), 22590, 1e-9);
}

TEST(NormaliseDensity, RejectsWhatNoUnitExplains) {
  for (const double value : {0.0, -7.85, 235.0, 1e6, 0.1}) {
    EXPECT_FALSE(NormaliseDensity(value).has_value()) << value;
  }
}

TEST(MakeMaterial, GoesByTheNameAndKeepsTheDensityOfTheFile) {
  Diagnostics diagnostics;
  const auto material = MakeMaterial(StatedMaterial{"Aluminum 6061-T6", 0.0027}, "a", &diagnostics);
  EXPECT_EQ(material.name, "Aluminum 6061-T6");
  EXPECT_EQ(material.standard, "AW-6061 T6");
  EXPECT_FALSE(material.is_standard_assumed);
  EXPECT_FALSE(material.is_assumed);
  EXPECT_NEAR(material.density, 2700, 1e-9);
  EXPECT_NEAR(material.youngs_modulus, 68.9e9, 1);
  EXPECT_TRUE(diagnostics.items().empty());
}

TEST(MakeMaterial, GivesANamedPlasticWithoutDensityItsOwn) {
  Diagnostics diagnostics;
  const auto material = MakeMaterial(StatedMaterial{"Delrin", 0}, "a", &diagnostics);
  EXPECT_EQ(material.standard, "POM-C");
  EXPECT_EQ(material.density, 1410);
  EXPECT_TRUE(material.is_assumed);
  EXPECT_FALSE(material.is_standard_assumed);
  ASSERT_EQ(diagnostics.items().size(), 1u);
  EXPECT_EQ(diagnostics.items()[0].code, "assumed-density");
}

TEST(MakeMaterial, GoesByTheDensityWhereTheNameSaysNothing) {
  Diagnostics diagnostics;
  const auto material = MakeMaterial(StatedMaterial{"Material1", 2.71}, "a", &diagnostics);
  EXPECT_EQ(material.standard, "AW-6061 T6");
  EXPECT_TRUE(material.is_standard_assumed);
  EXPECT_FALSE(material.is_assumed);
  EXPECT_NEAR(material.density, 2710, 1e-9);
}

TEST(MakeMaterial, AssumesSteelWhereNothingIsKnown) {
  Diagnostics diagnostics;
  for (const auto& stated :
       {std::optional<StatedMaterial>(), std::optional(StatedMaterial{"Document", 235.0})}) {
    const auto material = MakeMaterial(stated, "a", &diagnostics);
    EXPECT_EQ(material.standard, "S235JR");
    EXPECT_EQ(material.density, 7850);
    EXPECT_TRUE(material.is_assumed);
    EXPECT_TRUE(material.is_standard_assumed);
  }
}

}  // namespace
}  // namespace hvas::cad
