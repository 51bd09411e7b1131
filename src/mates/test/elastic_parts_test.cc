#include "mates/elastic_parts.h"

#include <numbers>

#include <gtest/gtest.h>

#include "fits/elastic_parts.h"

namespace hvas::mates {
namespace {

using product::ElasticKind;
using product::OccurrenceId;
using product::Product;

/** A housing and a gasket of 80 x 40 x 2 mm without holes. */
Product GasketOnHousing() {
  Product product;
  for (const char* name : {"housing", "gasket"}) {
    product::Part part;
    part.id = product::PartId(product.parts.size());
    part.name = name;
    part.box_B = {Vec3::Zero(), Vec3(80e-3, 40e-3, 2e-3)};
    part.mass.volume = 80e-3 * 40e-3 * 2e-3;
    const auto add = [&part](const Vec3& normal, double area) {
      product::Face face;
      face.surface.kind = product::SurfaceKind::kPlane;
      face.surface.axis = normal;
      face.area = area;
      part.faces.push_back(face);
    };
    add(Vec3::UnitZ(), 80e-3 * 40e-3);
    add(-Vec3::UnitZ(), 80e-3 * 40e-3);
    add(Vec3::UnitX(), 2 * 40e-3 * 2e-3);
    add(Vec3::UnitY(), 2 * 80e-3 * 2e-3);
    product::Occurrence occurrence;
    occurrence.id = OccurrenceId(product.occurrences.size());
    occurrence.part = part.id;
    occurrence.name = name;
    occurrence.path = std::string("rig/") + name;
    product.occurrences.push_back(occurrence);
    product.parts.push_back(part);
  }
  return product;
}

StatedElastic Stated(const std::string& part) {
  StatedElastic stated;
  stated.part = part;
  stated.where = "here";
  return stated;
}

TEST(ElasticPartsTest, WhatIsRecognisedPushesBackUnlessItIsRigid) {
  Product product = GasketOnHousing();
  ASSERT_TRUE(SetElasticParts({}, &product));
  ASSERT_EQ(product.elastic.size(), 1U);
  EXPECT_EQ(product.elastic[0].occurrence, OccurrenceId(1));
  EXPECT_EQ(product.elastic[0].kind, ElasticKind::kGasket);
  EXPECT_EQ(CalcCompression(product.elastic[0]), 0);
  product.flexible.push_back({OccurrenceId(1), product::FlexibleKind::kStated, 0, "stated"});
  ASSERT_TRUE(SetElasticParts({}, &product));
  EXPECT_TRUE(product.elastic.empty());
}

TEST(ElasticPartsTest, StatedSizesHoldOverMeasuredOnes) {
  Product product = GasketOnHousing();
  StatedElastic stated = Stated("gasket");
  stated.free_size = 2.5e-3;
  stated.modulus = 8e6;
  ASSERT_TRUE(SetElasticParts({stated}, &product));
  ASSERT_EQ(product.elastic.size(), 1U);
  const product::ElasticPart& gasket = product.elastic[0];
  EXPECT_EQ(gasket.modulus, 8e6);
  EXPECT_NEAR(CalcCompression(gasket), 0.5e-3, 1e-12);
  EXPECT_EQ(gasket.reason, "the side file");
  const auto law = MakePressedPart(gasket);
  ASSERT_TRUE(law);
  EXPECT_NEAR(std::get<fits::FlatGasket>(*law).thickness, 2.5e-3, 1e-12);
  EXPECT_NE(DescribeElastic(gasket).find("pressed together by 0.5 mm in its place"),
            std::string::npos)
      << DescribeElastic(gasket);
}

TEST(ElasticPartsTest, AStatedStiffnessTakesThePlaceOfAFormula) {
  Product product = GasketOnHousing();
  StatedElastic stated = Stated("housing");
  stated.kind = ElasticKind::kCoilSpring;
  stated.stiffness = 12e3;
  stated.free_size = 5e-3;
  ASSERT_TRUE(SetElasticParts({stated}, &product));
  ASSERT_EQ(product.elastic.size(), 2U);
  const auto law = MakePressedPart(product.elastic[0]);
  ASSERT_TRUE(law);
  EXPECT_DOUBLE_EQ(fits::CalcPressForce(*law, 1e-3), 12);
}

TEST(ElasticPartsTest, WhatIsMissingOrUnknownIsAnErrorThatNamesIt) {
  Product product = GasketOnHousing();
  const auto unknown = SetElasticParts({Stated("spring")}, &product);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::kNotFound);
  const auto unkind = SetElasticParts({Stated("housing")}, &product);
  ASSERT_FALSE(unkind);
  EXPECT_EQ(unkind.error().remedy, "state its \"kind\"");
  StatedElastic coil = Stated("housing");
  coil.kind = ElasticKind::kCoilSpring;
  coil.outer = 20e-3;
  coil.thickness = 2e-3;
  const auto missing = SetElasticParts({coil}, &product);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("number of active coils is not known"), std::string::npos)
      << missing.error().message;
  coil.coils = 6;
  ASSERT_TRUE(SetElasticParts({coil}, &product));
  const auto law = MakePressedPart(product.elastic[0]);
  ASSERT_TRUE(law);
  EXPECT_NEAR(std::get<fits::CoilSpring>(*law).diameter, 18e-3, 1e-12);
  EXPECT_NEAR(std::get<fits::CoilSpring>(*law).shear_modulus, 206e9 / 2.6, 1);
}

TEST(ElasticPartsTest, TheSideFileStatesThem) {
  const auto file = ParseSideFile(R"({"format": "hvas-assignments-2", "elastic": [
    {"part": "spring", "kind": "coil_spring", "thickness_mm": 2, "outer_diameter_mm": 16,
     "active_coils": 6.5, "free_length_mm": 30, "note": "from the catalogue"},
    {"part": "gasket", "modulus_mpa": 8, "stiffness_n_per_mm": 1200}]})",
                                  "a.hvas.json");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->elastic.size(), 2U);
  EXPECT_EQ(file->elastic[0].kind, ElasticKind::kCoilSpring);
  EXPECT_NEAR(*file->elastic[0].thickness, 2e-3, 1e-12);
  EXPECT_NEAR(*file->elastic[0].free_size, 30e-3, 1e-12);
  EXPECT_NEAR(*file->elastic[0].coils, 6.5, 1e-12);
  EXPECT_FALSE(file->elastic[1].kind);
  EXPECT_NEAR(*file->elastic[1].modulus, 8e6, 1e-3);
  EXPECT_NEAR(*file->elastic[1].stiffness, 1.2e6, 1e-3);
  const auto both = ParseSideFile(R"({"format": "hvas-assignments-2", "elastic": [
    {"part": "pin", "free_length_mm": 2, "free_diameter_mm": 3}]})",
                                  "a.hvas.json");
  EXPECT_FALSE(both);
  const auto kind = ParseSideFile(R"({"format": "hvas-assignments-2", "elastic": [
    {"part": "pin", "kind": "hook"}]})",
                                  "a.hvas.json");
  EXPECT_FALSE(kind);
}

TEST(ElasticPartsTest, OneSectionOfTheSideFileStatesWhatGivesAndWhatPushesBack) {
  const auto file = ParseSideFile(R"({"format": "hvas-assignments-2", "compliant": [
    {"part": "cover", "allowance_mm": 0.6},
    {"part": "spring", "kind": "coil_spring", "free_length_mm": 30},
    {"part": "seal", "allowance_mm": 0.4, "modulus_mpa": 8},
    {"part": "washer"}]})",
                                  "a.hvas.json");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->flexible.size(), 2U);
  EXPECT_EQ(file->flexible[0].part, "cover");
  EXPECT_NEAR(file->flexible[0].allowance, 0.6e-3, 1e-12);
  EXPECT_EQ(file->flexible[1].part, "seal");
  ASSERT_EQ(file->elastic.size(), 3U);
  EXPECT_EQ(file->elastic[0].part, "spring");
  EXPECT_EQ(file->elastic[1].part, "seal");
  EXPECT_NEAR(*file->elastic[1].modulus, 8e6, 1e-3);
  EXPECT_EQ(file->elastic[2].part, "washer");
  const auto unknown = ParseSideFile(
      R"({"format": "hvas-assignments-2", "compliant": [{"part": "a", "give_mm": 1}]})",
      "a.hvas.json");
  ASSERT_FALSE(unknown);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "give_mm", unknown.error().message);
}

TEST(ElasticPartsTest, ALipHasAForceOnceItsLengthAndThicknessAreKnown) {
  product::ElasticPart seal;
  seal.kind = ElasticKind::kLipSeal;
  seal.free_size = 19.2e-3;
  seal.modulus = 5e6;
  EXPECT_EQ(
      DescribeElastic(seal),
      "19.2 mm wide when free, 5 MPa; no force, as its lip's length or thickness is not known");
  seal.thickness = 1e-3;
  seal.lip_root = -3e-3;
  EXPECT_EQ(FindMissingSize(seal), "");
  EXPECT_NEAR(CalcLipStiffness(seal), fits::CalcLipStiffness({9.6e-3, 3e-3, 1e-3, 5e6}), 1e-9);
  EXPECT_NE(DescribeElastic(seal).find("lip 3 mm long, 1 mm thick, 19.2 mm wide when free"),
            std::string::npos)
      << DescribeElastic(seal);
  seal.stiffness = 4e3;
  EXPECT_EQ(CalcLipStiffness(seal), 4e3);
}

TEST(ElasticPartsTest, TheLengthOfALipIsStatedFromItsEdge) {
  Product product = GasketOnHousing();
  product.parts[1].name = "oil seal";
  product.occurrences[1].path = "rig/oil seal";
  product.occurrences[1].name = "oil seal";
  StatedElastic stated = Stated("oil seal");
  stated.kind = ElasticKind::kLipSeal;
  stated.thickness = 1e-3;
  stated.free_size = 19e-3;
  EXPECT_FALSE(SetElasticParts({stated}, &product));
  stated.lip_length = 4e-3;
  const auto set = SetElasticParts({stated}, &product);
  ASSERT_TRUE(set) << set.error().message;
  ASSERT_EQ(product.elastic.size(), 1U);
  EXPECT_NEAR(product.elastic[0].lip_length(), 4e-3, 1e-12);
  EXPECT_EQ(product.elastic[0].free_size, 19e-3);
}

}  // namespace
}  // namespace hvas::mates
