#include "cad/step/tolerances.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/test/temporary_folder.h"
#include "cad/process/read_cad.h"
#include "cad/step/step_text.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using product::Dimension;
using product::DimensionKind;
using product::GeometricToleranceKind;
using product::Part;
using product::Product;
using spatial::SurfaceKind;

/** Dimensions and tolerances on the faces #1 (a cylinder) and #2 (a plane), in units #91 and #92.
 Both spellings of most things: in one record, and complex. */
constexpr const char* kEntities = R"(
#90=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#91=(CONVERSION_BASED_UNIT('INCH',#93)LENGTH_UNIT()NAMED_UNIT(#94));
#92=(CONVERSION_BASED_UNIT('DEGREE',#95)NAMED_UNIT(#94)PLANE_ANGLE_UNIT());
#93=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.54E+01),#90);
#95=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925199433),#96);
#96=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
/* not here: #99=DIMENSIONAL_SIZE(#10,'it''s no size'); */
#10=SHAPE_ASPECT('bore; #11=(','',#80,.T.);
#11=(COMPOSITE_SHAPE_ASPECT()SHAPE_ASPECT('both','',#80,.T.));
#12=SHAPE_ASPECT('top','',#80,.T.);
#13=SHAPE_ASPECT_RELATIONSHIP('','',#11,#10);
#14=SHAPE_ASPECT_RELATIONSHIP('','',#11,#12);
#15=SHAPE_ASPECT_RELATIONSHIP('','',#12,#11);
#16=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#10,#81,#1);
#17=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#12,#81,#2);
#20=DIMENSIONAL_SIZE(#10,'diameter');
#21=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#20,#22);
#22=SHAPE_DIMENSION_REPRESENTATION('',(#23),#82);
#23=(LENGTH_MEASURE_WITH_UNIT()MEASURE_REPRESENTATION_ITEM()MEASURE_WITH_UNIT(
 POSITIVE_LENGTH_MEASURE(10.),#90)QUALIFIED_REPRESENTATION_ITEM((#83))
 REPRESENTATION_ITEM('nominal value'));
#24=LIMITS_AND_FITS('G6','hole','','');
#25=PLUS_MINUS_TOLERANCE(#24,#20);
#30=(DIMENSIONAL_LOCATION()DIRECTED_DIMENSIONAL_LOCATION()
 SHAPE_ASPECT_RELATIONSHIP('linear distance',$,#12,#10));
#31=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#30,#32);
#32=SHAPE_DIMENSION_REPRESENTATION('',(#33),#82);
#33=MEASURE_REPRESENTATION_ITEM('nominal value',LENGTH_MEASURE(0.25),#91);
#34=PLUS_MINUS_TOLERANCE(#35,#30);
#35=TOLERANCE_VALUE(#36,#37);
#36=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.),#91);
#37=MEASURE_WITH_UNIT(LENGTH_MEASURE(3.E-03),#91);
#40=ANGULAR_LOCATION('',$,#10,#12);
#41=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#40,#42);
#42=SHAPE_DIMENSION_REPRESENTATION('',(#43,#44),#82);
#43=MEASURE_REPRESENTATION_ITEM('upper limit',PLANE_ANGLE_MEASURE(91.),#92);
#44=MEASURE_REPRESENTATION_ITEM('lower limit',PLANE_ANGLE_MEASURE(89.5),#92);
#50=(GEOMETRIC_TOLERANCE('Position.1','',#51,#20)
 GEOMETRIC_TOLERANCE_WITH_DATUM_REFERENCE((#52))POSITION_TOLERANCE());
#51=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.15),#90);
#52=DATUM_SYSTEM('',$,#80,.F.,(#53,#54));
#53=DATUM_REFERENCE_COMPARTMENT('',$,#80,.F.,#55,$);
#54=DATUM_REFERENCE_COMPARTMENT('',$,#80,.F.,COMMON_DATUM_LIST((#57,#58)),$);
#55=DATUM('',$,#80,.F.,'A');
#56=DATUM('',$,#80,.F.,'B');
#57=DATUM_REFERENCE_ELEMENT('',$,#80,.F.,#56,$);
#58=DATUM_REFERENCE_ELEMENT('',$,#80,.F.,#59,$);
#59=DATUM('',$,#80,.F.,'C');
#60=FLATNESS_TOLERANCE('Flatness.1','',#51,#11);
)";

std::string MakeText(const std::string& entities = kEntities) {
  return "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n" + entities + "ENDSEC;\nEND-ISO-10303-21;\n";
}

/** A part with a cylinder of 10 mm (#1) and a plane (#2). */
Product MakeProduct() {
  Product product;
  product.source = "made.stp";
  Part part;
  part.name = "block";
  part.faces.resize(2);
  part.faces[0].surface.kind = SurfaceKind::kPlane;
  part.faces[0].entity = 2;
  part.faces[1].surface.kind = SurfaceKind::kCylinder;
  part.faces[1].surface.radius = 0.005;
  part.faces[1].entity = 1;
  product.parts.push_back(part);
  return product;
}

const product::FaceId kPlaneFace(0);
const product::FaceId kCylinderFace(1);

Part ReadPart(const std::string& text, Diagnostics* diagnostics) {
  Product product = MakeProduct();
  ReadTolerances(StepText(text), &product, diagnostics);
  return product.parts[0];
}

std::string WithReplaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

TEST(StepText, ReadsStringsCommentsListsAndComplexInstances) {
  const StepText text(
      MakeText("#1=A('it''s; #9=B()',(1,-2.5E-1,$,*),.T.,LENGTH_MEASURE(+3.),#2);/* #7=C(); */\n"
               "#2 = ( X() Y('y') );\n#1=TWICE();\n#99999999999999999999999=HUGE();\n#3=CUT('"));
  ASSERT_EQ(text.statements().size(), 2u);
  const StepEntity first = text.Find(1);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].name, "A");
  ASSERT_EQ(first[0].values.size(), 5u);
  EXPECT_EQ(first[0].values[0].text, "it's; #9=B()");
  ASSERT_EQ(first[0].values[1].items.size(), 4u);
  EXPECT_EQ(first[0].values[1].items[1].number, -0.25);
  EXPECT_EQ(first[0].values[2].text, "T");
  EXPECT_EQ(first[0].values[3].items.at(0).number, 3);
  EXPECT_EQ(first[0].values[4].reference, 2u);
  const StepEntity second = text.Find(2);
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second[1].values.at(0).text, "y");
  EXPECT_TRUE(text.Find(3).empty());
  EXPECT_TRUE(text.Find(7).empty());
}

TEST(StepText, RefusesListsNestedWithoutEnd) {
  EXPECT_TRUE(ParseStepEntity("A" + std::string(100000, '(') + std::string(100000, ')')).empty());
  EXPECT_FALSE(ParseStepEntity("A" + std::string(9, '(') + std::string(9, ')')).empty());
}

TEST(FitCode, EverySpellingBecomesOne) {
  EXPECT_EQ(NormaliseFitCode("G6"), "G6");
  EXPECT_EQ(NormaliseFitCode(" js 7 "), "js7");
  EXPECT_EQ(NormaliseFitCode("H7/g6"), "H7/g6");
  EXPECT_EQ(NormaliseFitCode("g6/H7"), "H7/g6");
  EXPECT_EQ(NormaliseFitCode("H7 - g6"), "H7/g6");
  for (const char* text :
       {"", "6", "H", "H7/", "H7/G6", "Hg6", "ABC6", "H700", "2 PLACES", "M10x1"}) {
    EXPECT_EQ(NormaliseFitCode(text), std::nullopt) << text;
  }
}

TEST(Tolerances, AreReadInSiWithTheirFaces) {
  Diagnostics diagnostics;
  const Part part = ReadPart(MakeText(), &diagnostics);
  EXPECT_TRUE(diagnostics.items().empty());
  ASSERT_EQ(part.dimensions.size(), 3u);
  const Dimension& bore = part.dimensions[0];
  EXPECT_EQ(bore.entity, "#20");
  EXPECT_EQ(bore.kind, DimensionKind::kDiameter);
  EXPECT_NEAR(bore.nominal, 0.01, 1e-15);
  EXPECT_EQ(bore.fit, "G6");
  EXPECT_FALSE(bore.upper.has_value());
  EXPECT_EQ(bore.faces, std::vector{kCylinderFace});
  const Dimension& distance = part.dimensions[1];  // In inches.
  EXPECT_EQ(distance.kind, DimensionKind::kLinear);
  EXPECT_EQ(distance.name, "linear distance");
  EXPECT_NEAR(distance.nominal, 0.25 * 0.0254, 1e-15);
  EXPECT_NEAR(distance.upper.value(), 0.003 * 0.0254, 1e-15);
  EXPECT_EQ(distance.lower.value(), 0);
  EXPECT_EQ(distance.faces, (std::vector{kPlaneFace, kCylinderFace}));
  const Dimension& angle = part.dimensions[2];  // By its limits, in degrees.
  EXPECT_EQ(angle.kind, DimensionKind::kAngular);
  EXPECT_NEAR(angle.nominal, 90.25 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(angle.upper.value(), 0.75 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(angle.lower.value(), -0.75 * std::numbers::pi / 180, 1e-12);
}

TEST(Tolerances, OfFormAndPlaceHaveMagnitudeDatumsAndFaces) {
  Diagnostics diagnostics;
  const Part part = ReadPart(MakeText(), &diagnostics);
  ASSERT_EQ(part.geometric_tolerances.size(), 2u);
  const auto& position = part.geometric_tolerances[0];
  EXPECT_EQ(position.kind, GeometricToleranceKind::kPosition);
  EXPECT_NEAR(position.magnitude, 0.15e-3, 1e-15);
  EXPECT_EQ(position.datums, (std::vector<std::string>{"A", "B-C"}));
  EXPECT_EQ(position.faces, std::vector{kCylinderFace});  // Those of the dimension that it is on.
  const auto& flatness = part.geometric_tolerances[1];
  EXPECT_EQ(flatness.kind, GeometricToleranceKind::kFlatness);
  EXPECT_EQ(flatness.entity, "#60");
  EXPECT_EQ(flatness.faces, (std::vector{kCylinderFace, kPlaneFace}));  // Aspects in a circle.
}

TEST(Tolerances, FitsAreReadHoweverTheyAreWritten) {
  for (const auto& [written, code] : {std::pair("LIMITS_AND_FITS('G','hole','6','')", "G6"),
                                      std::pair("LIMITS_AND_FITS('g','shaft','6','ISO 286')", "g6"),
                                      std::pair("LIMITS_AND_FITS('','G','6','')", "G6"),
                                      std::pair("LIMITS_AND_FITS('H7/g6','','','')", "H7/g6")}) {
    Diagnostics diagnostics;
    const Part part = ReadPart(
        WithReplaced(MakeText(), "LIMITS_AND_FITS('G6','hole','','')", written), &diagnostics);
    EXPECT_EQ(part.dimensions.at(0).fit, code) << written;
  }
  Diagnostics diagnostics;
  const std::string note =
      MakeText(WithReplaced(kEntities, "(#33)", "(#33,#38)") +
               "#38=DESCRIPTIVE_REPRESENTATION_ITEM('dimensional note','h7');");
  EXPECT_EQ(ReadPart(note, &diagnostics).dimensions.at(1).fit, "h7");
  const std::string thread = WithReplaced(note, "'h7'", "'M8'");
  EXPECT_EQ(ReadPart(thread, &diagnostics).dimensions.at(1).fit, std::nullopt);
}

TEST(Tolerances, ADiameterInTheWrongUnitIsSetRightByItsCylinder) {
  for (const auto& [written, is_explained] :
       {std::pair("0.3937", true), std::pair("0.01", true), std::pair("12.", false)}) {
    Diagnostics diagnostics;
    const Part part =
        ReadPart(WithReplaced(MakeText(), "(10.)", std::string("(") + written + ")"), &diagnostics);
    ASSERT_EQ(diagnostics.items().size(), 1u);
    EXPECT_EQ(diagnostics.items()[0].code, is_explained ? "dimension-unit" : "dimension-differs");
    EXPECT_NEAR(part.dimensions.at(0).nominal, is_explained ? 0.01 : 0.012, 1e-6);
  }
}

TEST(Tolerances, WhatStatesNoValueIsLeftOutAndNamed) {
  Diagnostics diagnostics;
  const Part part = ReadPart(WithReplaced(MakeText(), "#51=", "#151="), &diagnostics);
  EXPECT_TRUE(part.geometric_tolerances.empty());
  EXPECT_EQ(part.dimensions.size(), 3u);
  ASSERT_EQ(diagnostics.items().size(), 1u);
  EXPECT_EQ(diagnostics.items()[0].code, "tolerance-damaged");
  EXPECT_NE(diagnostics.items()[0].message.find("#50, #60"), std::string::npos);
}

TEST(Tolerances, CirclesOfReferencesEnd) {
  std::string text =
      WithReplaced(MakeText(), "#93=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.54E+01),#90)",
                   "#93=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.54E+01),#91)");
  text = WithReplaced(
      text, "#56=DATUM('',$,#80,.F.,'B')",
      "#56=DATUM_SYSTEM('',$,#80,.F.,(#56,#52,#54,#56,#52,#56,#56,#56,#56,#56,#56,#56))");
  Diagnostics diagnostics;
  EXPECT_EQ(ReadPart(text, &diagnostics).dimensions.size(), 3u);
  EXPECT_EQ(testing::CountCode(diagnostics, "limit-datums"), 1);
}

TEST(Tolerances, MoreAspectsThanAreLookedAtAreReported) {
  constexpr int kCount = 100'000;
  std::string aspects;
  for (int i = 0; i < kCount; ++i) {
    aspects +=
        fmt::format("#{}=SHAPE_ASPECT_RELATIONSHIP('','',#11,#{});\n", 1000 + i, 1000 + kCount + i);
  }
  Diagnostics diagnostics;
  (void)ReadPart(WithReplaced(MakeText(), "#60=", aspects + "#60="), &diagnostics);
  EXPECT_EQ(testing::CountCode(diagnostics, "limit-aspects"), 1);
}

TEST(Tolerances, NoDamageToATextCrashesOrHangs) {
  const std::string whole = MakeText();
  constexpr std::string_view kBytes = "#();,'\"/*=.$0123456789eE+-AZ_\n\0\xff";
  Random random(20);
  const auto below = [&random](std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(random.Uniform(0, static_cast<double>(n))));
  };
  std::size_t read = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string text = whole;
    for (std::size_t edit = 0; edit <= below(8); ++edit) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = kBytes[below(kBytes.size())];
          break;
        case 1:
          text.erase(at, below(40));
          break;
        case 2:
          text.insert(at, whole, below(whole.size()), below(80));
          break;
        default:
          text.resize(round % 5 == 0 ? at + 1 : text.size());
      }
    }
    Diagnostics diagnostics;
    const Part part = ReadPart(text, &diagnostics);
    read += part.dimensions.size() + part.geometric_tolerances.size();
    for (const Dimension& dimension : part.dimensions) {
      ASSERT_TRUE(std::isfinite(dimension.nominal));
    }
  }
  EXPECT_GT(read, 2000u);  // Most of the damage leaves something to read.
}

/** The entities from a file's ADVANCED_FACE number of a cylinder to the text above. */
TEST(Tolerances, ReachTheFacesOfAnImportedPart) {
  const hvas::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder / "plate.stp";
  testing::DocumentBuilder builder;
  builder.AddPart(testing::MakePlate(), "plate");
  builder.Write(file);
  std::ifstream stream(file);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  stream.close();
  const StepText entities(text);
  std::string cylinder;
  for (const auto& statement : entities.statements()) {
    const StepEntity entity = ParseStepEntity(statement.body);
    if (!entity.empty() && entity[0].name == "ADVANCED_FACE" &&
        entities.Find(entity[0].values.at(2).reference).at(0).name == "CYLINDRICAL_SURFACE") {
      cylinder = std::to_string(statement.id);
    }
  }
  ASSERT_FALSE(cylinder.empty());
  // The numbers of the text are moved out of the way of the file's own.
  std::string added = kEntities;
  for (std::size_t at = added.find('#'); at != std::string::npos; at = added.find('#', at + 1)) {
    added.insert(at + 1, "9000");
  }
  added = WithReplaced(added, "#900081,#90001)", "#900081,#" + cylinder + ")");
  text.insert(text.rfind("ENDSEC;"), added);
  std::ofstream(file) << text;
  Diagnostics diagnostics;
  const auto product = ReadCad(file, {}, &diagnostics);
  ASSERT_TRUE(product.has_value()) << product.error().ToString();
  const Part& part = product->parts.at(0);
  ASSERT_EQ(part.dimensions.size(), 3u);
  EXPECT_EQ(part.dimensions[0].fit, "G6");
  ASSERT_EQ(part.dimensions[0].faces.size(), 1u);
  const auto& face = part.faces.at(part.dimensions[0].faces[0].index());
  EXPECT_EQ(face.surface.kind, SurfaceKind::kCylinder);
  EXPECT_NEAR(face.surface.radius, 0.005, 1e-9);
  EXPECT_EQ(part.geometric_tolerances.size(), 2u);
}

}  // namespace
}  // namespace hvas::cad
