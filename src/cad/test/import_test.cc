#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "cad/brep/assembly_tree.h"
#include "cad/process/read_cad.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::FeatureKind;
using product::Part;
using product::Product;
using spatial::SurfaceKind;
using testing::CountCode;
using testing::DocumentBuilder;
using testing::kRed;
using testing::kTeal;
using testing::MakePlate;
using testing::Translation;

constexpr double kPlateVolume = (60 * 40 * 10 - std::numbers::pi * 25 * 10) * 1e-9;  // [m^3]

/** A plate and, in a subassembly, two of the same pin. */
void WriteAssembly(const std::filesystem::path& file, const std::string& unit) {
  DocumentBuilder builder;
  const TopoDS_Shape plate = MakePlate();
  const TDF_Label plate_label = builder.AddPart(plate, "Gehäuse");
  const TDF_Label pin_label = builder.AddPart(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "ねじ M10");
  builder.SetColor(plate_label, kTeal);
  builder.SetFaceColor(plate_label, TopExp_Explorer(plate, TopAbs_FACE).Current(), kRed);
  builder.SetMaterial(plate_label, "Aluminium", 2.7);
  const TDF_Label pins = builder.AddAssembly("Stifte/pins");
  builder.AddComponent(pins, pin_label, Translation(0, 0, 0), "Stift");
  builder.AddComponent(pins, pin_label, Translation(100, 0, 0), "Stift");
  const TDF_Label root = builder.AddAssembly("Прибор");
  builder.AddComponent(root, plate_label, Translation(0, 0, 0), "Gehäuse");
  builder.AddComponent(root, pins, Translation(20, 20, -5), "Stifte/pins");
  builder.Write(file, unit);
}

Product ImportOrDie(const std::filesystem::path& file, Diagnostics* diagnostics) {
  Result<Product> product = ReadCad(file, {}, diagnostics);
  EXPECT_TRUE(product.has_value()) << product.error().ToString();
  return product.value_or(Product{});
}

/** Imports one shape by way of a STEP file. */
Part ImportShape(const TopoDS_Shape& shape) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  builder.AddPart(shape, "part");
  builder.Write(folder / "part.step");
  Diagnostics diagnostics;
  Product product = ImportOrDie(folder / "part.step", &diagnostics);
  EXPECT_EQ(product.parts.size(), 1u);
  return product.parts.empty() ? Part{} : product.parts.front();
}

Vec3 AreaNormal(const Part& part, std::size_t triangle) {
  const auto& t = part.mesh.triangles[triangle];
  const Vec3& a = part.mesh.vertices[t[0]];
  return 0.5 * (part.mesh.vertices[t[1]] - a).cross(part.mesh.vertices[t[2]] - a);
}

/** Every triangle of an analytic face has its vertices on the surface and its normal along the
 gradient of the distance; the mesh is closed. */
void ExpectConsistent(const Part& part) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    SCOPED_TRACE(::testing::Message() << "face " << f);
    const product::Face& face = part.faces[f];
    ASSERT_NE(face.surface.kind, SurfaceKind::kFreeform);
    ASSERT_GT(face.triangle_count, 0u);
    for (std::size_t i = 0; i < face.triangle_count; ++i) {
      const std::size_t triangle = face.first_triangle + i;
      Vec3 centre = Vec3::Zero();
      for (const auto vertex : part.mesh.triangles[triangle]) {
        const Vec3& p = part.mesh.vertices[vertex];
        centre += p / 3;
        const auto distance = CalcDistance(face.surface, p);
        if (distance.is_valid) {
          EXPECT_LT(std::abs(distance.distance), 1e-9);
        }
      }
      const Vec3 normal = AreaNormal(part, triangle);
      sum += normal;
      EXPECT_GT(CalcDistance(face.surface, centre).gradient.dot(normal), 0.9 * normal.norm());
    }
  }
  EXPECT_LT(sum.norm(), 1e-12) << "the mesh is not closed";
}

TEST(ReadCad, X1KeepsTheTreeSharesPartsAndNamesThemInUtf8) {  // X2.
  const TemporaryFolder folder;
  WriteAssembly(folder / "a.step", "MM");
  Diagnostics diagnostics;
  const Product product = ImportOrDie(folder / "a.step", &diagnostics);
  EXPECT_EQ(product.name, "Прибор");
  EXPECT_EQ(product.source, "a.step");
  EXPECT_EQ(product.depth(), 2);
  ASSERT_EQ(product.parts.size(), 2u);
  ASSERT_EQ(product.occurrences.size(), 3u);
  ASSERT_EQ(product.subassemblies.size(), 2u);
  EXPECT_EQ(product.parts[0].name, "Gehäuse");
  EXPECT_EQ(product.parts[1].name, "ねじ M10");
  EXPECT_EQ(product.occurrences[1].part, product.occurrences[2].part);
  EXPECT_EQ(product.occurrences[0].path, "Прибор/Gehäuse");
  EXPECT_EQ(product.occurrences[1].path, "Прибор/Stifte_pins/Stift");
  EXPECT_EQ(product.occurrences[2].path, "Прибор/Stifte_pins/Stift#2");
  EXPECT_LT((product.occurrences[2].X_WB.p() - Vec3(0.120, 0.020, -0.005)).norm(), 1e-12);
  EXPECT_EQ(product.subassemblies[1].parent, product.subassemblies[0].id);
  EXPECT_EQ(product.subassemblies[0].subassemblies.size(), 1u);
  EXPECT_EQ(product.subassemblies[1].occurrences.size(), 2u);
  EXPECT_LT((product.box_W.high - Vec3(0.125, 0.040, 0.015)).norm(), 1e-6);
}

TEST(ReadCad, ReadsColoursOfPartsAndFaces) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "a.step", "MM");
  Diagnostics diagnostics;
  const Product product = ImportOrDie(folder / "a.step", &diagnostics);
  const Part& plate = product.parts.at(0);
  EXPECT_NEAR(plate.color.g, 0.5, 1e-3);
  const auto red = std::count_if(plate.faces.begin(), plate.faces.end(), [](const auto& face) {
    return face.color && face.color->r > 0.999F && face.color->g < 1e-3F;
  });
  EXPECT_EQ(red, 1);
}

TEST(ReadCad, GivesTheSameMassInEveryLengthUnit) {
  const TemporaryFolder folder;
  for (const std::string unit : {"MM", "INCH", "M"}) {
    SCOPED_TRACE(unit);
    WriteAssembly(folder / "a.step", unit);
    Diagnostics diagnostics;
    const Product product = ImportOrDie(folder / "a.step", &diagnostics);
    const Part& plate = product.parts.at(0);
    const Part& pin = product.parts.at(1);
    EXPECT_NEAR(plate.mass.volume, kPlateVolume, 1e-9 * kPlateVolume);
    EXPECT_NEAR(plate.mass.mass, 2700 * kPlateVolume, 1e-9 * 2700 * kPlateVolume);
    EXPECT_EQ(plate.material.name, "Aluminium");
    EXPECT_FALSE(plate.material.is_assumed);
    EXPECT_TRUE(pin.material.is_assumed);
    EXPECT_NEAR(pin.mass.volume, std::numbers::pi * 500e-9, 1e-9 * std::numbers::pi * 500e-9);
    EXPECT_EQ(CountCode(diagnostics, "assumed-density"), 1);
    EXPECT_LT((product.occurrences.at(2).X_WB.p() - Vec3(0.120, 0.020, -0.005)).norm(), 1e-10);
  }
}

TEST(ReadCad, GivesCentreAndInertiaOfACylinder) {
  const Part pin = ImportShape(BRepPrimAPI_MakeCylinder(5, 20).Shape());
  const double m = 7850 * std::numbers::pi * 500e-9;
  const double along = 0.5 * m * 0.005 * 0.005;
  const double across = m * (3 * 0.005 * 0.005 + 0.020 * 0.020) / 12;
  EXPECT_LT((pin.mass.p_BoBcm_B - Vec3(0, 0, 0.010)).norm(), 1e-11);
  EXPECT_LT((pin.mass.I_BBcm_B - Vec3(across, across, along).asDiagonal().toDenseMatrix()).norm(),
            1e-9 * across);
}

TEST(ReadCad, OrientsEveryAnalyticSurfaceOutOfTheMaterial) {  // N2.
  const Part plate = ImportShape(MakePlate());
  ExpectConsistent(plate);
  const auto hole = std::find_if(plate.faces.begin(), plate.faces.end(), [](const auto& face) {
    return face.surface.kind == SurfaceKind::kCylinder;
  });
  ASSERT_NE(hole, plate.faces.end());
  EXPECT_EQ(hole->surface.outward, -1);
  EXPECT_NEAR(hole->area, 2 * std::numbers::pi * 0.005 * 0.010, 1e-12);
  EXPECT_FALSE(hole->is_recognised);
  for (const auto& [shape, kind] :
       {std::pair(BRepPrimAPI_MakeCylinder(5, 20).Shape(), SurfaceKind::kCylinder),
        std::pair(BRepPrimAPI_MakeCone(2, 6, 9).Shape(), SurfaceKind::kCone),
        std::pair(BRepPrimAPI_MakeCone(6, 2, 9).Shape(), SurfaceKind::kCone),
        std::pair(BRepPrimAPI_MakeSphere(7).Shape(), SurfaceKind::kSphere),
        std::pair(BRepPrimAPI_MakeTorus(9, 2).Shape(), SurfaceKind::kTorus)}) {
    const Part part = ImportShape(shape);
    ExpectConsistent(part);
    EXPECT_EQ(std::count_if(part.faces.begin(), part.faces.end(),
                            [wanted = kind](const auto& face) {
                              return face.surface.kind == wanted && face.surface.outward == 1;
                            }),
              1);
  }
}

TEST(ReadCad, RecognisesHolesAndPlanesDrawnAsBSplines) {  // N1.
  const Part plate = ImportShape(BRepBuilderAPI_NurbsConvert(MakePlate()).Shape());
  ExpectConsistent(plate);
  EXPECT_TRUE(std::all_of(plate.faces.begin(), plate.faces.end(),
                          [](const auto& face) { return face.is_recognised; }));
  ASSERT_EQ(std::count_if(plate.features.begin(), plate.features.end(),
                          [](const auto& f) { return f.kind == FeatureKind::kHole; }),
            1);
  EXPECT_NEAR(plate.features.front().radius, 0.005, 1e-9);
  EXPECT_NEAR(plate.mass.volume, kPlateVolume, 1e-7 * kPlateVolume);
}

TEST(ReadCad, FindsTheHoleWithItsSpan) {  // Layer T of X2.
  const Part plate = ImportShape(MakePlate());
  ASSERT_EQ(plate.features.size(), 7u);
  const product::Feature& hole = plate.features.front();
  EXPECT_EQ(hole.kind, FeatureKind::kHole);
  EXPECT_NEAR(hole.coverage, 2 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(hole.span_high - hole.span_low, 0.010, 1e-9);
  EXPECT_LT((hole.origin_B - Vec3(0.020, 0.020, 0.005)).norm(), 1e-9);
}

TEST(ReadCad, GivesTheSameBytesTwice) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "a.step", "MM");
  Diagnostics diagnostics;
  const Product first = ImportOrDie(folder / "a.step", &diagnostics);
  const Product second = ImportOrDie(folder / "a.step", &diagnostics);
  ASSERT_EQ(first.parts.size(), second.parts.size());
  for (std::size_t i = 0; i < first.parts.size(); ++i) {
    EXPECT_EQ(first.parts[i].shape_hash, second.parts[i].shape_hash);
    EXPECT_EQ(first.parts[i].mesh.vertices, second.parts[i].mesh.vertices);
  }
  EXPECT_NE(first.parts[0].shape_hash, first.parts[1].shape_hash);
}

TEST(ReadCad, ReportsProgressUpToTheEnd) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "a.step", "MM");
  Diagnostics diagnostics;
  std::string last;
  double fraction = -1;
  ASSERT_TRUE(ReadCad(folder / "a.step", {}, &diagnostics,
                      {[&](std::string_view stage, double f) {
                         last = stage;
                         fraction = f;
                       },
                       {},
                       nullptr})
                  .has_value());
  EXPECT_EQ(last, "done");
  EXPECT_EQ(fraction, 1);
}

/** Reads a STEP file, and writes its statements again as `change` leaves them; empty ones are left
 out. */
void RewriteStatements(const std::filesystem::path& file,
                       const std::function<void(std::string*)>& change) {
  std::ifstream in(file);
  std::string text;
  for (std::string statement; std::getline(in, statement, ';');) {
    change(&statement);
    text += statement.empty() ? "" : statement + ";";
  }
  in.close();
  std::ofstream(file) << text;
}

bool HasAnyOf(const std::string& text, const std::vector<const char*>& words) {
  return std::any_of(words.begin(), words.end(),
                     [&text](const char* word) { return text.find(word) != std::string::npos; });
}

TEST(ReadCad, ADocumentFromWhichAPartWasExportedIsNoMissingFile) {
  for (const char* document : {"plate.CATPart", "C:\\work\\plate.SLDPRT", "plate.prt"}) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "plate.step";
    DocumentBuilder builder;
    builder.AddPart(MakePlate(), "plate");
    builder.Write(file);
    RewriteStatements(file, [document](std::string* statement) {
      const std::string plain = "PRODUCT_DEFINITION('design','',";
      const std::size_t at = statement->find(plain);
      if (at != std::string::npos) {
        statement->replace(at, plain.size(),
                           "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS('design','',");
        statement->insert(statement->rfind(')'), ",(#99002)");
        *statement += std::string(";\n#99001 = DOCUMENT_TYPE('');\n#99002 = DOCUMENT('1','") +
                      document + "','a document',#99001)";
      }
    });
    Diagnostics diagnostics;
    const Product product = ImportOrDie(file, &diagnostics);
    EXPECT_EQ(product.parts.size(), 1u) << document;
    EXPECT_EQ(CountCode(diagnostics, "missing-file"), 0) << document;
  }
}

TEST(ReadCad, SolidsWithoutAProductAreThePartsWithAWarning) {
  for (const char* unit : {"MM", "INCH"}) {
    SCOPED_TRACE(unit);
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "loose.step";
    DocumentBuilder builder;
    const TDF_Label plate = builder.AddPart(MakePlate(), "plate");
    const TDF_Label pin = builder.AddPart(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "pin");
    const TDF_Label root = builder.AddAssembly("rig");
    builder.AddComponent(root, plate, Translation(0, 0, 0), "plate");
    builder.AddComponent(root, pin, Translation(0, 0, 0), "pin");
    builder.Write(file, unit);
    int solids = 0;
    RewriteStatements(file, [&solids](std::string* statement) {
      if (HasAnyOf(*statement,
                   {"= PRODUCT", "=PRODUCT", "NEXT_ASSEMBLY", "SHAPE_REPRESENTATION_REL",
                    "REPRESENTATION_RELATIONSHIP", "CONTEXT_DEPENDENT_SHAPE",
                    "SHAPE_DEFINITION_REPRESENTATION", "APPLICATION_"})) {
        statement->clear();
      }
      const std::size_t at = statement->find("MANIFOLD_SOLID_BREP('");
      const std::size_t begin = at + std::string("MANIFOLD_SOLID_BREP('").size();
      if (at != std::string::npos && ++solids == 2) {  // The first keeps no name.
        statement->replace(begin, statement->find('\'', begin) - begin, "Bolzen 5");
      } else if (at != std::string::npos) {
        statement->erase(begin, statement->find('\'', begin) - begin);
      }
    });
    Diagnostics diagnostics;
    const Product product = ImportOrDie(file, &diagnostics);
    ASSERT_EQ(product.parts.size(), 2u);
    EXPECT_EQ(CountCode(diagnostics, "no-product"), 1);
    EXPECT_EQ(product.parts[1].name, "Bolzen 5");
    EXPECT_EQ(product.parts[0].name.rfind("solid #", 0), 0u) << product.parts[0].name;
    EXPECT_NEAR(product.parts[0].mass.volume, kPlateVolume, 1e-6 * kPlateVolume);
    EXPECT_NEAR(product.box_W.size().x(), 0.065, 1e-4);
  }
}

Error ErrorOf(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  const Result<Product> product = ReadCad(file, {}, &diagnostics);
  EXPECT_FALSE(product.has_value());
  return product ? Error{} : product.error();
}

TEST(ReadCadErrors, NameTheFileAndTheRemedy) {
  const TemporaryFolder folder;
  std::ofstream(folder / "empty.step").close();
  std::ofstream(folder / "photo.step") << "\x89PNG\r\n and so on";
  std::ofstream(folder / "cut.step") << "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n";
  const Error missing = ErrorOf(folder / "missing.step");
  EXPECT_EQ(missing.code, ErrorCode::kNotFound);
  EXPECT_NE(missing.where.find("missing.step"), std::string::npos);
  for (const std::string name : {"empty.step", "photo.step", "cut.step"}) {
    SCOPED_TRACE(name);
    const Error error = ErrorOf(folder / name);
    EXPECT_EQ(error.code, ErrorCode::kUnreadable);
    EXPECT_NE(error.where.find(name), std::string::npos);
    EXPECT_FALSE(error.remedy.empty());
  }
  EXPECT_EQ(ErrorOf(folder / ".").code, ErrorCode::kUnreadable);
}

TEST(ReadCad, CurvesAloneAreShownAsThinTubesWithoutMass) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  const TDF_Label line =
      builder.AddPart(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(40, 0, 0)).Shape(), "line");
  const TDF_Label ring = builder.AddPart(
      BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(), gp_Dir(0, 0, 1)), 30)).Shape(), "ring");
  const TDF_Label root = builder.AddAssembly("curves");
  builder.AddComponent(root, line, Translation(0, 100, 0), "line");
  builder.AddComponent(root, ring, Translation(0, 0, 0), "ring");
  builder.Write(folder / "curves.step");
  Diagnostics diagnostics;
  const Product product = ImportOrDie(folder / "curves.step", &diagnostics);
  ASSERT_EQ(product.occurrences.size(), 2u);
  EXPECT_EQ(CountCode(diagnostics, "curves-only"), 2);
  EXPECT_EQ(CountCode(diagnostics, "surfaces-only"), 1);
  for (const Part& part : product.parts) {
    EXPECT_EQ(part.solid_count, 0);
    EXPECT_EQ(part.mass.mass, 0);
    ASSERT_EQ(part.faces.size(), 1u);
    EXPECT_EQ(part.faces[0].triangle_count, part.display_mesh.triangles.size());
    double six_volumes = 0;  // Positive where the triangles face outwards.
    for (const auto& t : part.mesh.triangles) {
      const auto& v = part.mesh.vertices;
      six_volumes += v[t[0]].dot(v[t[1]].cross(v[t[2]]));
    }
    // A tube with three sides has the length of its curve times 3 sqrt(3) / 4 r^2; chords are
    // shorter than a circle.
    const bool is_line = part.name == "line";
    const double diagonal = is_line ? 0.04 : 0.06 * std::sqrt(2);
    const double length = is_line ? 0.04 : 0.06 * std::numbers::pi;
    const double section = 0.75 * std::sqrt(3) * 1e-6 * diagonal * diagonal;
    EXPECT_NEAR(six_volumes / 6 / (length * section), 1, is_line ? 1e-6 : 0.05) << part.name;
  }
}

TEST(ReadCadErrors, AFileOfPointsHasNoSolid) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  builder.AddPart(BRepBuilderAPI_MakeVertex(gp_Pnt(1, 2, 3)).Shape(), "datum");
  builder.Write(folder / "points.step");
  EXPECT_EQ(ErrorOf(folder / "points.step").code, ErrorCode::kUnreadable);
}

TEST(ReadCad, LeavesCurvesOutAndKeepsSurfacesWithoutMass) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  const TDF_Label root = builder.AddAssembly("mixed");
  const TDF_Label parts[] = {
      builder.AddPart(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(9, 0, 0)).Shape(), "datum"),
      builder.AddPart(box, "block"),
      builder.AddPart(
          TopExp_Explorer(BRepPrimAPI_MakeCylinder(3, 9).Shape(), TopAbs_FACE).Current(), "sheet")};
  for (const TDF_Label& part : parts) {
    builder.AddComponent(root, part, Translation(50, 0, 0), "x");
  }
  builder.Write(folder / "mixed.step");
  Diagnostics diagnostics;
  const Product product = ImportOrDie(folder / "mixed.step", &diagnostics);
  ASSERT_EQ(product.parts.size(), 2u);
  EXPECT_EQ(product.occurrences.size(), 2u);
  EXPECT_EQ(CountCode(diagnostics, "no-face"), 1);
  EXPECT_EQ(CountCode(diagnostics, "no-solid"), 1);
  EXPECT_EQ(product.parts[1].solid_count, 0);
  EXPECT_EQ(product.parts[1].mass.mass, 0);
  EXPECT_NEAR(product.volume(), 6000e-9, 1e-17);
}

/** Builds a product from a document in memory, for what a STEP file of OpenCASCADE cannot hold. */
Product BuildInMemory(DocumentBuilder* builder, Diagnostics* diagnostics) {
  Product product;
  const Result<void> result =
      BuildProduct({builder->document(), {}, {}, {}}, {}, {}, &product, diagnostics);
  EXPECT_TRUE(result.has_value()) << result.error().ToString();
  return product;
}

TEST(BuildProduct, TurnsSolidsThatAreInsideOut) {
  DocumentBuilder builder;
  builder.AddPart(MakePlate().Reversed(), "inside out");
  Diagnostics diagnostics;
  const Product product = BuildInMemory(&builder, &diagnostics);
  ASSERT_EQ(product.parts.size(), 1u);
  EXPECT_EQ(CountCode(diagnostics, "reversed-solid"), 1);
  EXPECT_NEAR(product.parts[0].mass.volume, kPlateVolume, 1e-9 * kPlateVolume);
  ExpectConsistent(product.parts[0]);
  EXPECT_EQ(product.parts[0].features.front().kind, FeatureKind::kHole);
}

TEST(BuildProduct, TakesAClosedShellAsASolid) {
  DocumentBuilder builder;
  builder.AddPart(TopExp_Explorer(MakePlate(), TopAbs_SHELL).Current(), "shell");
  Diagnostics diagnostics;
  const Product product = BuildInMemory(&builder, &diagnostics);
  ASSERT_EQ(product.parts.size(), 1u);
  EXPECT_EQ(CountCode(diagnostics, "closed-shell"), 1);
  EXPECT_EQ(product.parts[0].solid_count, 1);
  EXPECT_NEAR(product.parts[0].mass.volume, kPlateVolume, 1e-9 * kPlateVolume);
  ExpectConsistent(product.parts[0]);
}

TEST(BuildProduct, MakesAMirroredInstanceAPartOfItsOwn) {
  DocumentBuilder builder;
  const TDF_Label plate = builder.AddPart(MakePlate(), "plate");
  const TDF_Label root = builder.AddAssembly("pair");
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(100, 0, 0), gp::DX()));  // About the plane x = 100 mm.
  builder.AddComponent(root, plate, Translation(0, 0, 0), "left");
  builder.AddComponent(root, plate, Translation(0, 0, 0), "left");
  builder.SetLocation(root, 2, mirror);
  Diagnostics diagnostics;
  const Product product = BuildInMemory(&builder, &diagnostics);
  ASSERT_EQ(product.parts.size(), 2u);
  EXPECT_EQ(CountCode(diagnostics, "baked-scale"), 1);
  ExpectConsistent(product.parts[1]);
  EXPECT_NEAR(product.parts[1].mass.volume, kPlateVolume, 1e-9 * kPlateVolume);
  // The hole at x = 20 mm of the plate is seen at x = 180 mm in the world, y unchanged.
  const product::Occurrence& mirrored = product.occurrences.at(1);
  const Vec3 hole_W = mirrored.X_WB * product.parts[1].features.front().origin_B;
  EXPECT_LT((hole_W - Vec3(0.180, 0.020, 0.005)).norm(), 1e-9);
}

}  // namespace
}  // namespace hvas::cad
