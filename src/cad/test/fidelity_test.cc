#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "base/units.h"
#include "cad/brep/assembly_tree.h"
#include "cad/process/read_cad.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::Part;
using product::Product;
using testing::CountCode;
using testing::DocumentBuilder;

/** A box of 20 mm as a solid, and `loose_faces` of the six of another one of 10 mm beside it. */
TopoDS_Compound MakeHybrid(int loose_faces, bool is_shell) {
  const BRep_Builder builder;
  TopoDS_Compound hybrid;
  builder.MakeCompound(hybrid);
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  const TopoDS_Shape other = BRepPrimAPI_MakeBox(gp_Pnt(50, 0, 0), 10, 10, 10).Shape();
  for (TopExp_Explorer it(other, TopAbs_FACE); it.More() && loose_faces > 0;
       it.Next(), --loose_faces) {
    if (is_shell) {
      builder.Add(shell, it.Current());
    } else {
      builder.Add(hybrid, it.Current());
    }
  }
  if (is_shell) {
    builder.Add(hybrid, shell);
  }
  builder.Add(hybrid, BRepPrimAPI_MakeBox(20, 20, 20).Shape());
  return hybrid;
}

Part BuildOnePart(const TopoDS_Shape& shape, Diagnostics* diagnostics) {
  DocumentBuilder builder;
  builder.AddPart(shape, "part");
  Product product;
  CadDocument document;
  document.document = builder.document();
  const auto built = BuildProduct(document, {}, {}, &product, diagnostics);
  EXPECT_TRUE(built.has_value());
  EXPECT_EQ(product.parts.size(), 1U);
  return product.parts.empty() ? Part() : product.parts.front();
}

std::string ReadAll(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Fidelity, SurfacesBesideASolidThatCloseBecomeSolidsOfThePart) {
  for (const bool is_shell : {false, true}) {
    Diagnostics diagnostics;
    const Part part = BuildOnePart(MakeHybrid(6, is_shell), &diagnostics);
    EXPECT_EQ(part.faces.size(), 12U);
    EXPECT_EQ(part.solid_count, 2);
    EXPECT_NEAR(units::ToMm3(part.mass.volume), 9000, 1e-6);
    EXPECT_NEAR(part.box_B.high.x(), 0.060, 1e-9);
    EXPECT_EQ(CountCode(diagnostics, "loose-faces"), 0);
    EXPECT_EQ(CountCode(diagnostics, "closed-shell"), 1);
    EXPECT_EQ(CountCode(diagnostics, "volume-mismatch"), 0);
  }
}

TEST(Fidelity, OpenSurfacesBesideASolidAreShownWithoutContactAndCountedInAWarning) {
  Diagnostics diagnostics;
  const Part part = BuildOnePart(MakeHybrid(5, true), &diagnostics);
  ASSERT_EQ(part.faces.size(), 11U);
  EXPECT_EQ(part.solid_count, 1);
  EXPECT_NEAR(units::ToMm3(part.mass.volume), 8000, 1e-6);
  for (std::size_t i = 0; i < part.faces.size(); ++i) {
    EXPECT_GT(part.faces[i].display_triangle_count, 0U);
    EXPECT_EQ(part.faces[i].triangle_count > 0, i < 6);
  }
  ASSERT_EQ(CountCode(diagnostics, "loose-faces"), 1);
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "loose-faces") {
      EXPECT_EQ(item.entity, "part");
      EXPECT_NE(item.message.find("5 of 11 faces (17.2 % of the area)"), std::string::npos)
          << item.message;
    }
  }
}

TEST(Fidelity, FacesOfTheFileThatCannotBeReadAreCountedInAWarningThatNamesThePart) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  builder.AddPart(testing::MakePlate(), "plate");
  builder.Write(folder / "plate.step");
  std::string text = ReadAll(folder / "plate.step");
  const std::size_t face = text.find("ADVANCED_FACE(");
  ASSERT_NE(face, std::string::npos);
  const std::size_t surface = text.find("),#", face) + 2;  // The reference to its surface.
  text.replace(surface, text.find(',', surface) - surface, "$");
  std::ofstream(folder / "plate.step") << text;
  Diagnostics diagnostics;
  const auto product = ReadCad(folder / "plate.step", {}, &diagnostics);
  ASSERT_TRUE(product.has_value()) << product.error().ToString();
  ASSERT_EQ(CountCode(diagnostics, "lost-faces"), 1);
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "lost-faces") {
      EXPECT_EQ(item.entity, "plate");
      EXPECT_NE(item.message.find("1 of 7 faces"), std::string::npos) << item.message;
    }
  }
}

TEST(Fidelity, APlateWithFourHundredHolesIsMeshedWhole) {
  constexpr int kSide = 20;
  const gp_Pln plane(gp::XOY());
  const double width = 10.0 * kSide;
  BRepBuilderAPI_MakeFace plate(
      plane, BRepBuilderAPI_MakePolygon(gp_Pnt(0, 0, 0), gp_Pnt(width, 0, 0),
                                        gp_Pnt(width, width, 0), gp_Pnt(0, width, 0), true)
                 .Wire());
  for (int i = 0; i < kSide * kSide; ++i) {
    const gp_Pnt centre(10 * (i % kSide) + 5, 10 * (i / kSide) + 5, 0);
    const gp_Circ circle(gp_Ax2(centre, gp::DZ()), 3);
    const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire();
    plate.Add(TopoDS::Wire(wire.Reversed()));
  }
  Diagnostics diagnostics;
  const Part part =
      BuildOnePart(BRepPrimAPI_MakePrism(plate.Face(), gp_Vec(0, 0, 5)).Shape(), &diagnostics);
  EXPECT_EQ(part.faces.size(), 406U);
  EXPECT_NEAR(units::ToMm3(part.mass.volume), 5 * (width * width - 400 * M_PI * 9), 1e-3);
  EXPECT_EQ(CountCode(diagnostics, "volume-mismatch"), 0);
  EXPECT_EQ(CountCode(diagnostics, "unmeshed-face"), 0);
}

}  // namespace
}  // namespace hvas::cad
