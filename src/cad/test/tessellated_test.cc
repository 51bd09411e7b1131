#include "cad/triangles/tessellated.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "cad/test/mesh_fixture.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using product::Product;
using spatial::SurfaceKind;

/** The faces of a turned part (radius 10, height 5 mm) as AP242 tessellation: bottom by a list of
 triangles, side by strips with its cylinder given, top by a fan. In inches, and used twice. */
std::string MakeStep(double side_radius) {
  constexpr int kSegments = 16;
  const double r = 10 / 25.4;
  const double h = 5 / 25.4;
  std::string points;
  for (const double z : {0.0, h}) {
    for (int i = 0; i < kSegments; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSegments;
      points += fmt::format("{}({:.9f},{:.9f},{:.9f})", points.empty() ? "" : ",",
                            r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  std::string bottom;
  std::string strip;
  std::string fan;
  for (int i = 0; i < kSegments; ++i) {
    if (i > 1) {
      bottom += fmt::format("{}(1,{},{})", bottom.empty() ? "" : ",", i + 1, i);
    }
    strip += fmt::format("{},{},", i + 1, i + 1 + kSegments);
    fan += fmt::format("{}{}", fan.empty() ? "" : ",", i + 1 + kSegments);
  }
  return fmt::format(
      "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AP242'));\nENDSEC;\nDATA;\n"
      "#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
      "#2=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#1);\n"
      "#3=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
      "#4=(CONVERSION_BASED_UNIT('INCH',#2)LENGTH_UNIT()NAMED_UNIT(#3));\n"
      "#5=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#4))"
      "REPRESENTATION_CONTEXT('',''));\n"
      "#10=COORDINATES_LIST('',{0},({1}));\n"
      "#11=TRIANGULATED_FACE('',#10,{0},((0.,0.,-1.)),$,(),({2}));\n"
      "#12=COMPLEX_TRIANGULATED_FACE('',#10,{0},(),#23,(),(({3}1,{4})),());\n"
      "#13=COMPLEX_TRIANGULATED_FACE('',#10,{0},(),$,(),(),(({5})));\n"
      "#20=CARTESIAN_POINT('',(0.,0.,0.));\n#21=AXIS2_PLACEMENT_3D('',#20,$,$);\n"
      "#23=CYLINDRICAL_SURFACE('',#21,{6:.9f});\n"
      "#24=TESSELLATED_SOLID('',(#11,#12,#13),$);\n"
      "#25=TESSELLATED_SHAPE_REPRESENTATION('',(#24),#5);\n"
      "#30=PRODUCT('disc','Disc','',());\n#31=PRODUCT_DEFINITION_FORMATION('','',#30);\n"
      "#32=PRODUCT_DEFINITION('','',#31,$);\n#33=PRODUCT_DEFINITION_SHAPE('','',#32);\n"
      "#34=SHAPE_DEFINITION_REPRESENTATION(#33,#25);\n"
      "#40=PRODUCT('pair','Pair','',());\n#41=PRODUCT_DEFINITION_FORMATION('','',#40);\n"
      "#42=PRODUCT_DEFINITION('','',#41,$);\n#43=PRODUCT_DEFINITION_SHAPE('','',#42);\n"
      "#44=SHAPE_REPRESENTATION('',(#21),#5);\n#45=SHAPE_DEFINITION_REPRESENTATION(#43,#44);\n"
      "#50=NEXT_ASSEMBLY_USAGE_OCCURRENCE('1','','',#42,#32,$);\n"
      "#51=NEXT_ASSEMBLY_USAGE_OCCURRENCE('2','','',#42,#32,$);\n"
      "#52=PRODUCT_DEFINITION_SHAPE('','',#51);\n"
      "#53=CARTESIAN_POINT('',(2.,0.,0.));\n#54=DIRECTION('',(0.,1.,0.));\n"
      "#55=DIRECTION('',(1.,0.,0.));\n#56=AXIS2_PLACEMENT_3D('',#53,#54,#55);\n"
      "#57=ITEM_DEFINED_TRANSFORMATION('','',#21,#56);\n"
      "#58=(REPRESENTATION_RELATIONSHIP('','',#25,#44)"
      "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#57)"
      "SHAPE_REPRESENTATION_RELATIONSHIP());\n"
      "#59=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#58,#52);\n"
      "#60=COLOUR_RGB('',1.,0.5,0.);\n#61=FILL_AREA_STYLE_COLOUR('',#60);\n"
      "#62=STYLED_ITEM('',(#61),#12);\n"
      "ENDSEC;\nEND-ISO-10303-21;\n",
      2 * kSegments, points, bottom, strip, 1 + kSegments, fan, side_radius / 25.4);
}

TEST(Tessellated, ReadsFacesUnitsColoursAndPlacesOfAnAssembly) {
  Product product;
  product.name = "file";
  Diagnostics diagnostics;
  ASSERT_TRUE(ReadTessellated(StepText(MakeStep(10)), {}, {}, &product, &diagnostics));
  EXPECT_EQ(product.name, "Pair");
  ASSERT_EQ(product.parts.size(), 1U);
  const product::Part& part = product.parts[0];
  EXPECT_EQ(part.name, "Disc");
  EXPECT_FALSE(part.has_brep);
  EXPECT_EQ(part.solid_count, 1);
  ASSERT_EQ(part.faces.size(), 3U);
  const auto side = std::find_if(part.faces.begin(), part.faces.end(),
                                 [](const product::Face& f) { return f.entity == 12; });
  ASSERT_NE(side, part.faces.end());
  EXPECT_EQ(side->surface.kind, SurfaceKind::kCylinder);
  EXPECT_NEAR(side->surface.radius, 10e-3, 1e-9);
  EXPECT_EQ(side->surface.outward, 1);
  ASSERT_TRUE(side->color);
  EXPECT_EQ(side->color->g, 0.5F);
  ASSERT_EQ(product.occurrences.size(), 2U);
  const spatial::Pose& X_WB = product.occurrences[1].X_WB;
  EXPECT_LT((X_WB * Vec3(0, 0, 0.01) - Vec3(0.0508, 0.01, 0)).norm(), 1e-12);
  EXPECT_EQ(std::count_if(diagnostics.items().begin(), diagnostics.items().end(),
                          [](const Diagnostic& item) { return item.code == "no-brep"; }),
            1);
}

TEST(Tessellated, FitsASurfaceWhereTheOneGivenIsNotThatOfTheTriangles) {
  Product product;
  Diagnostics diagnostics;
  ASSERT_TRUE(ReadTessellated(StepText(MakeStep(12)), {}, {}, &product, &diagnostics));
  const auto& faces = product.parts.at(0).faces;
  const auto side = std::find_if(faces.begin(), faces.end(),
                                 [](const product::Face& f) { return f.entity == 12; });
  ASSERT_NE(side, faces.end());
  EXPECT_NEAR(side->surface.radius, 10e-3, 50e-9);
}

TEST(Tessellated, IsWhatAFileWithoutSolidsIsReadBy) {
  const hvas::testing::TemporaryFolder folder;
  std::ofstream(folder / "pair.stp", std::ios::binary) << MakeStep(10);
  Diagnostics diagnostics;
  const auto product = ReadCad(folder / "pair.stp", {}, &diagnostics);
  ASSERT_TRUE(product) << product.error().ToString();
  EXPECT_EQ(product->occurrences.size(), 2U);
}

int CountDeep(const std::string& step) {
  Product product;
  Diagnostics diagnostics;
  EXPECT_TRUE(ReadTessellated(StepText(step), {}, {}, &product, &diagnostics));
  return testing::CountCode(diagnostics, "limit-depth");
}

TEST(Tessellated, ShellsInShellsBeyondTheLimitAreReported) {
  for (const int levels : {4, 5}) {
    std::string step = MakeStep(10);
    std::string shells;
    for (int i = 0; i < levels; ++i) {
      shells += fmt::format("#{}=TESSELLATED_SHELL('',({}),$);\n", 100 + i,
                            i + 1 < levels ? fmt::format("#{}", 101 + i) : "");
    }
    step.insert(step.find("#24="), shells);
    step.replace(step.find("(#11,#12,#13)"), 13, "(#11,#12,#13,#100)");
    EXPECT_EQ(CountDeep(step), levels > 4 ? 1 : 0) << levels;
  }
}

TEST(Tessellated, ProductsInProductsBeyondTheLimitAreReported) {
  for (const int levels : {50, 102}) {
    std::string step = MakeStep(10);
    std::string products;
    for (int i = 0; i < levels; ++i) {
      products += fmt::format(
          "#{0}=PRODUCT_DEFINITION('','',#41,$);\n"
          "#{1}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('{1}','','',#{0},#{2},$);\n",
          1000 + i, 2000 + i, i + 1 < levels ? 1001 + i : 42);
    }
    step.insert(step.find("#60="), products);
    step.insert(step.find("#60="),  // One that is not nested.
                "#3000=PRODUCT_DEFINITION('','',#41,$);\n"
                "#3001=NEXT_ASSEMBLY_USAGE_OCCURRENCE('x','','',#3000,#32,$);\n");
    EXPECT_EQ(CountDeep(step), levels > 100 ? 1 : 0) << levels;
  }
}

TEST(Tessellated, TakesAnyText) {
  const std::string step = MakeStep(10);
  Random random(5);
  int read = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string text = step;
    for (int i = 0; i < 3; ++i) {
      text[random.NextBits() % text.size()] = "0123456789#(),.'$*-ABE"[random.NextBits() % 22];
    }
    text.resize(trial % 3 == 0 ? random.NextBits() % text.size() : text.size());
    Product product;
    Diagnostics diagnostics;
    if (ReadTessellated(StepText(std::move(text)), {}, {}, &product, &diagnostics)) {
      ++read;
      for (const product::Occurrence& occurrence : product.occurrences) {
        EXPECT_LT(occurrence.part.index(), product.parts.size());
      }
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_LT(read, 300);
}

}  // namespace
}  // namespace hvas::cad
