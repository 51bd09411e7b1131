#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gp.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/test/temporary_folder.h"
#include "cad/brep/assembly_tree.h"
#include "cad/brep/equal_shapes.h"
#include "cad/brep/solid_measure.h"
#include "cad/process/read_cad.h"
#include "cad/step/text_encoding.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::Part;
using product::Product;
using testing::CountCode;
using testing::DocumentBuilder;
using testing::kRed;
using testing::kTeal;
using testing::MakePlate;
using testing::Translation;

/** A box with one corner cut out: no mirror image of it is a rotated copy. */
TopoDS_Shape MakeNotchedBox() {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(60, 40, 20).Shape(),
                         BRepPrimAPI_MakeBox(gp_Pnt(50, 33, 17), gp_Pnt(70, 50, 30)).Shape())
      .Shape();
}

gp_Trsf MakeMotion(double angle, double x_mm) {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(3, 2, 1), gp_Dir(1, 2, 3)), angle);
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(x_mm, -7, 11));
  return shift * turn;
}

TopoDS_Shape Moved(const TopoDS_Shape& shape, const gp_Trsf& motion) {
  return BRepBuilderAPI_Transform(shape, motion, /*copy=*/true).Shape();
}

Product Build(DocumentBuilder* builder, Diagnostics* diagnostics, unsigned threads = 0) {
  Product product;
  ImportOptions options;
  options.threads = threads;
  const Result<void> result =
      BuildProduct({builder->document(), {}, {}, {}}, options, {}, &product, diagnostics);
  EXPECT_TRUE(result.has_value()) << result.error().ToString();
  return product;
}

TEST(EqualParts, WrittenInPlaceAreOnePartAtItsPoses) {
  DocumentBuilder builder;
  const TopoDS_Shape box = MakeNotchedBox();
  const std::vector<gp_Trsf> motions{gp_Trsf(), MakeMotion(0.7, 100), MakeMotion(2.9, 200)};
  for (const gp_Trsf& motion : motions) {
    builder.AddPart(Moved(box, motion), "box");
  }
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(), gp::DX()));
  builder.AddPart(Moved(box, mirror), "mirrored box");
  builder.AddPart(MakePlate(), "plate");
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  ASSERT_EQ(product.occurrences.size(), 5u);
  ASSERT_EQ(product.parts.size(), 3u);  // Box, mirrored box, plate.
  EXPECT_EQ(CountCode(diagnostics, "shared-parts"), 1);
  EXPECT_EQ(product.occurrences[3].part.index(), 1u);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    SCOPED_TRACE(i);
    const product::Occurrence& occurrence = product.occurrences[i];
    EXPECT_EQ(occurrence.part.index(), 0u);
    for (const gp_Pnt& p : {gp_Pnt(0, 0, 0), gp_Pnt(60, 0, 20), gp_Pnt(50, 33, 17)}) {
      const gp_Pnt moved = p.Transformed(motions[i]);
      const Vec3 here = occurrence.X_WB * (1e-3 * Vec3(p.X(), p.Y(), p.Z()));
      EXPECT_LT((here - 1e-3 * Vec3(moved.X(), moved.Y(), moved.Z())).norm(), 1e-9);
    }
  }
}

TEST(EqualParts, OfOtherColoursAreOtherPartsOfTheSameShape) {
  DocumentBuilder builder;
  const TDF_Label red = builder.AddPart(MakePlate(), "red");
  const TDF_Label teal = builder.AddPart(Moved(MakePlate(), MakeMotion(1, 90)), "teal");
  builder.SetColor(red, kRed);
  builder.SetColor(teal, kTeal);
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  ASSERT_EQ(product.parts.size(), 2u);
  EXPECT_EQ(product.parts[0].shape_hash, product.parts[1].shape_hash);
  EXPECT_EQ(product.parts[0].mesh.vertices, product.parts[1].mesh.vertices);
  EXPECT_EQ(product.parts[1].name, "teal");
  EXPECT_NEAR(product.parts[1].color.g, 0.5, 1e-3);
  EXPECT_EQ(product.parts[0].features.size(), product.parts[1].features.size());
  const gp_Pnt corner = gp_Pnt(60, 40, 10).Transformed(MakeMotion(1, 90));
  EXPECT_LT((product.occurrences[1].X_WB * Vec3(0.060, 0.040, 0.010) -
             1e-3 * Vec3(corner.X(), corner.Y(), corner.Z()))
                .norm(),
            1e-9);
}

TEST(EqualParts, AreNotThoseThatDifferByTenMicrometres) {
  const std::vector<TopoDS_Shape> shapes{
      BRepPrimAPI_MakeCylinder(5, 20).Shape(), BRepPrimAPI_MakeCylinder(5.01, 20).Shape(),
      Moved(BRepPrimAPI_MakeCylinder(5, 20).Shape(), MakeMotion(2, 5)),
      BRepPrimAPI_MakeCylinder(5, 20.01).Shape(), TopoDS_Shape()};
  const std::vector<EqualShape> equal = FindEqualShapes(shapes);
  ASSERT_EQ(equal.size(), shapes.size());
  EXPECT_EQ(equal[1].base, 1u);
  EXPECT_EQ(equal[2].base, 0u);
  EXPECT_EQ(equal[3].base, 3u);
  EXPECT_EQ(equal[4].base, 4u);
  // The turn about its own axis is free, but all of the cylinder has to be in place.
  const gp_Pnt top = gp_Pnt(0, 0, 20).Transformed(MakeMotion(2, 5));
  EXPECT_LT((equal[2].X_SB * Vec3(0, 0, 0.020) - 1e-3 * Vec3(top.X(), top.Y(), top.Z())).norm(),
            1e-9);
}

TEST(EqualParts, AreFoundAmongRoundAndFreeShapes) {
  for (const TopoDS_Shape& shape :
       {BRepPrimAPI_MakeSphere(7).Shape(), BRepPrimAPI_MakeTorus(9, 2).Shape(),
        BRepPrimAPI_MakeCone(2, 6, 9).Shape(), BRepBuilderAPI_NurbsConvert(MakePlate()).Shape()}) {
    const auto equal = FindEqualShapes({shape, Moved(shape, MakeMotion(0.3, 40))});
    EXPECT_EQ(equal[1].base, 0u);
  }
}

TEST(BuildProduct, GivesTheSameOnOneThreadAndOnMany) {
  DocumentBuilder builder;
  for (int i = 0; i < 6; ++i) {
    builder.AddPart(BRepPrimAPI_MakeCylinder(5 + i, 20).Shape(), "pin");
  }
  Diagnostics diagnostics;
  const Product one = Build(&builder, &diagnostics, 1);
  const Product many = Build(&builder, &diagnostics, 4);
  ASSERT_EQ(one.parts.size(), 6u);
  ASSERT_EQ(many.parts.size(), 6u);
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    EXPECT_EQ(one.parts[i].shape_hash, many.parts[i].shape_hash);
    EXPECT_EQ(one.parts[i].mesh.vertices, many.parts[i].mesh.vertices);
    EXPECT_EQ(one.parts[i].display_mesh.triangles, many.parts[i].display_mesh.triangles);
  }
}

TEST(BuildProduct, MeshesPartsLighterForTheEye) {
  DocumentBuilder builder;
  builder.AddPart(MakePlate(), "plate");
  builder.AddPart(BRepPrimAPI_MakeCone(2, 6, 9).Shape(), "cone");
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  for (const Part& part : product.parts) {
    SCOPED_TRACE(part.name);
    if (part.name == "plate") {  // A cone's rims are finer for contact, its inside is coarser.
      EXPECT_LT(2 * part.display_mesh.triangles.size(), part.mesh.triangles.size());
    }
    const double diagonal = part.box_B.size().norm();
    std::uint32_t next = 0;
    for (const product::Face& face : part.faces) {
      EXPECT_EQ(face.first_display_triangle, next);
      ASSERT_GT(face.display_triangle_count, 0u);
      next += face.display_triangle_count;
      for (std::uint32_t i = face.first_display_triangle; i < next; ++i) {
        const auto& t = part.display_mesh.triangles[i];
        Vec3 centre = Vec3::Zero();
        for (const auto vertex : t) {
          const Vec3& p = part.display_mesh.vertices[vertex];
          EXPECT_LT(std::abs(CalcDistance(face.surface, p).distance), 1e-9);
          centre += p / 3;
        }
        EXPECT_LT(std::abs(CalcDistance(face.surface, centre).distance), 3e-3 * diagonal);
      }
    }
    EXPECT_EQ(next, part.display_mesh.triangles.size());
  }
}

void ExpectMeasure(const TopoDS_Shape& solid, double volume) {
  const gp_Pnt about(3, -5, 8);
  const SolidMeasure measure = MeasureSolid(solid, about);
  EXPECT_NEAR(measure.volume_mm3, volume, 1e-6 * volume);
  // Against the adaptive integration of OpenCASCADE over the whole solid.
  GProp_GProps whole(about);
  BRepGProp::VolumeProperties(solid, whole, 1e-9);
  const gp_Pnt centre = whole.CentreOfMass();
  const Vec3 r = Vec3(centre.X(), centre.Y(), centre.Z()) - Vec3(3, -5, 8);
  EXPECT_LT((measure.first_mm4 / measure.volume_mm3 - r).norm(), 1e-6 * r.norm());
  const Mat3 shift = measure.volume_mm3 * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  const gp_Mat inertia = whole.MatrixOfInertia();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(measure.inertia_mm5(i, j) - shift(i, j), inertia(i + 1, j + 1),
                  1e-5 * measure.inertia_mm5.trace());
    }
  }
}

TEST(MeasureSolid, GivesVolumeCentreAndInertiaOfSolidsAnywhere) {
  const std::vector<std::pair<TopoDS_Shape, double>> solids{
      {MakePlate(), 60 * 40 * 10 - std::numbers::pi * 25 * 10},
      {MakeNotchedBox(), 60 * 40 * 20 - 10 * 7 * 3},
      {BRepPrimAPI_MakeSphere(7).Shape(), 4 * std::numbers::pi / 3 * 343},
      {BRepPrimAPI_MakeTorus(9, 2).Shape(), 2 * std::numbers::pi * std::numbers::pi * 9 * 4},
      {BRepPrimAPI_MakeCone(2, 6, 9).Shape(), std::numbers::pi * 9 / 3 * (4 + 12 + 36)},
      {BRepBuilderAPI_NurbsConvert(MakePlate()).Shape(),
       60 * 40 * 10 - std::numbers::pi * 25 * 10}};
  for (std::size_t i = 0; i < solids.size(); ++i) {
    SCOPED_TRACE(i);
    ExpectMeasure(solids[i].first, solids[i].second);
    ExpectMeasure(Moved(solids[i].first, MakeMotion(1.1, 30)), solids[i].second);
    ExpectMeasure(solids[i].first.Moved(MakeMotion(1.1, 30)), solids[i].second);
  }
  EXPECT_NEAR(MeasureSolid(MakePlate().Reversed(), gp_Pnt(1, 2, 3)).volume_mm3,
              -(60 * 40 * 10 - std::numbers::pi * 25 * 10), 1e-6);
}

// Two pipes of one radius that cross have four cylindrical faces between ellipses, which are
// splines in the parameters: 16/3 r^3, 16 r^2, and by their squares, as by slices of 4 (r^2 - z^2),
// the moments.
TEST(MeasureSolid, IsExactBetweenCurvesThatAreSplines) {
  const double r = 3;
  const gp_Pnt at(50, -20, 30);
  const auto make_pipe = [&](const gp_Dir& axis) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(at.Translated(gp_Vec(axis) * -10), axis), r, 20).Shape();
  };
  const TopoDS_Shape solid = BRepAlgoAPI_Common(make_pipe(gp::DX()), make_pipe(gp::DY())).Shape();
  for (const gp_Pnt& about : {at, gp_Pnt(51, -18, 33)}) {
    const SolidMeasure measure = MeasureSolid(solid, about);
    const double volume = 16.0 / 3 * r * r * r;
    const Vec3 d(at.X() - about.X(), at.Y() - about.Y(), at.Z() - about.Z());
    EXPECT_NEAR(measure.volume_mm3, volume, 1e-6 * volume);
    EXPECT_LT((measure.first_mm4 - volume * d).norm(), 1e-5 * volume);
    const double area =
        std::accumulate(measure.face_areas_mm2.begin(), measure.face_areas_mm2.end(), 0.0);
    EXPECT_NEAR(area, 16 * r * r, 1e-6 * area);
    const double zz = 16.0 / 15 * std::pow(r, 5);
    const double xx = 64.0 / 45 * std::pow(r, 5);
    const Mat3 own = Vec3(xx + zz, xx + zz, 2 * xx).asDiagonal();
    const Mat3 inertia = own + volume * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    EXPECT_LT((measure.inertia_mm5 - inertia).norm(), 1e-6 * inertia.norm());
  }
}

TEST(ForEachIndex, DoesAllOnceAndHandsOnTheFirstFailure) {
  for (const unsigned threads : {1U, 3U}) {
    std::vector<std::atomic<int>> done(50);
    ForEachIndex(done.size(), threads, [&done](std::size_t i) { ++done[i]; });
    EXPECT_TRUE(std::all_of(done.begin(), done.end(), [](const auto& n) { return n == 1; }));
    const auto fail = [](std::size_t i) {
      if (i >= 7) {
        throw std::runtime_error(std::to_string(i));
      }
    };
    try {
      ForEachIndex(50, threads, fail);
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
    }
  }
}

/** Replaces every occurrence of a word in a file. */
void ReplaceInFile(const std::filesystem::path& file, const std::string& word,
                   const std::string& by) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  std::string content = text.str();
  ASSERT_NE(content.find(word), std::string::npos) << word;
  for (std::size_t at = 0; (at = content.find(word, at)) != std::string::npos; at += by.size()) {
    content.replace(at, word.size(), by);
  }
  std::ofstream(file, std::ios::binary) << content;
}

/** Imports a box whose name in the file is given in raw bytes.
 @param encoding  What the user gives; empty: nothing. */
std::string ReadNameBack(const std::string& bytes, const std::string& encoding = "",
                         Diagnostics* diagnostics = nullptr) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  builder.AddPart(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), "PLACEHOLDER");
  builder.Write(folder / "a.step");
  ReplaceInFile(folder / "a.step", "PLACEHOLDER", bytes);
  ImportOptions options;
  options.encoding = encoding;
  Diagnostics ignored;
  const auto product =
      ReadCad(folder / "a.step", options, diagnostics != nullptr ? diagnostics : &ignored);
  EXPECT_TRUE(product.has_value());
  if (!product || product->parts.empty()) {
    return "";
  }
  EXPECT_EQ(product->parts[0].identity.id, product->parts[0].name) << "read from the text by HVAS";
  return product->parts[0].name;
}

TEST(Names, AreReadInEveryEncodingThatFilesUse) {
  EXPECT_EQ(ReadNameBack("Geh\\X\\E4use"), "Gehäuse");
  EXPECT_EQ(ReadNameBack("\\X2\\041F04400438\\X0\\ 2"), "При 2");
  EXPECT_EQ(ReadNameBack("Gehäuse"), "Gehäuse");                          // UTF-8.
  EXPECT_EQ(ReadNameBack("Geh\xE4use"), "Gehäuse");                       // Latin-1.
  EXPECT_EQ(ReadNameBack("\x83\x7B\x83\x8B\x83\x67 M3"), "ボルト M3");    // Shift-JIS.
  EXPECT_EQ(ReadNameBack("\x95\x5C\x96\xCA"), "表面");                    // With a "\" in it.
  EXPECT_EQ(ReadNameBack("20\xB0, 5 \x80"), "20°, 5 €");                  // Windows-1252.
  EXPECT_EQ(ReadNameBack("\xC4\xE5\xF2\xE0\xEB\xFC 5"), "Деталь 5");      // Windows-1251.
  EXPECT_EQ(ReadNameBack("\xC1\xE3\xBC\xFE"), "零件");                    // GB 2312.
  EXPECT_EQ(ReadNameBack("Tower Pro_Pe\\X\\87a:1"), "Tower Pro_Peça:1");  // DOS.
  EXPECT_EQ(ReadNameBack("Geh\x84use"), "Gehäuse");                       // DOS.
  EXPECT_EQ(ReadNameBack("Men\x92s \x93plate\x94"), "Men’s “plate”");     // Windows-1252.
  EXPECT_EQ(ReadNameBack("A\x83\x41\x83\x43"), "Aアイ");                  // Shift-JIS.
  EXPECT_EQ(ReadNameBack("\\PE\\\\S\\4\\S\\U\\S\\b"), "Дет");             // ISO 8859-5.
  EXPECT_EQ(ReadNameBack("\\X4\\0001F529\\X0\\"), "\xF0\x9F\x94\xA9");
}

TEST(Names, AreReadInTheEncodingThatTheUserGives) {
  EXPECT_EQ(ReadNameBack("o\x9C \xB9", "CP1250"), "oś ą");
  EXPECT_EQ(ReadNameBack("\xBA\xCE\xC7\xB0", "EUC-KR"), "부품");
  EXPECT_EQ(ReadNameBack("\xD6\xE1", "GBK"), "轴");
}

TEST(Names, OfAnEncodingThatIsGuessedAreNoted) {
  for (const auto& [bytes, encoding] :
       {std::pair("Geh\xE4use", "CP1252"), std::pair("\xC4\xE5\xF2\xE0\xEB\xFC", "CP1251")}) {
    Diagnostics guessed;
    (void)ReadNameBack(bytes, "", &guessed);
    ASSERT_EQ(CountCode(guessed, "assumed-encoding"), 1);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, encoding, guessed.items()[0].message);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--encoding", guessed.items()[0].remedy);
    Diagnostics given;
    (void)ReadNameBack(bytes, encoding, &given);
    EXPECT_EQ(CountCode(given, "assumed-encoding"), 0);
  }
}

TEST(CleanName, NeverGivesInvalidUtf8) {
  EXPECT_EQ(CleanName(std::string_view("  a\tb\n ")), "a b");
  EXPECT_EQ(CleanName(std::u16string_view(u"x\xD800y")), "x\xEF\xBF\xBDy");
  EXPECT_EQ(CleanName(std::u16string_view(u"\xD83D\xDE00")), "\xF0\x9F\x98\x80");
  EXPECT_EQ(CleanName(std::u16string_view(u"Geh\u00E4use")), "Gehäuse");
  EXPECT_EQ(CleanName(std::string_view("5 \x80")), "5 €");
  for (int lead = 0; lead < 256; ++lead) {
    for (int trail = 0; trail < 256; ++trail) {
      const std::string bytes{'q', static_cast<char>(lead), static_cast<char>(trail)};
      const std::string once = CleanName(std::string_view(bytes));
      EXPECT_EQ(CleanName(std::string_view(once)), once) << lead << " " << trail;
    }
  }
}

TEST(Units, OfEveryKindGiveTheSameCube) {
  const TemporaryFolder folder;
  for (const std::string unit : {"MM", "CM", "M", "KM", "UM", "INCH", "FT", "MI", "MIL", "UIN"}) {
    SCOPED_TRACE(unit);
    DocumentBuilder builder;
    builder.AddPart(BRepPrimAPI_MakeBox(20, 20, 20).Shape(), "cube");
    builder.Write(folder / "cube.step", unit);
    Diagnostics diagnostics;
    const auto product = ReadCad(folder / "cube.step", {}, &diagnostics);
    ASSERT_TRUE(product.has_value());
    EXPECT_NEAR(product->volume(), 8e-6, 1e-9 * 8e-6);
    EXPECT_EQ(product->parts[0].faces.size(), 6u);
  }
}

TEST(Units, ThatTheUserGivesTakeThePlaceOfThoseOfTheFile) {
  const TemporaryFolder folder;
  for (const char* stated : {"MM", "INCH", "M"}) {
    DocumentBuilder builder;
    const TDF_Label cube = builder.AddPart(BRepPrimAPI_MakeBox(25.4, 25.4, 25.4).Shape(), "cube");
    const TDF_Label pair = builder.AddAssembly("pair");
    builder.AddComponent(pair, cube, TopLoc_Location(), "a");
    builder.AddComponent(pair, cube, Translation(50.8, 0, 0), "b");
    builder.Write(folder / "pair.step", stated);
    const double number = stated == std::string("MM")  ? 25.4
                          : stated == std::string("M") ? 0.0254
                                                       : 1;
    for (const double unit : {1e-3, 0.0254, 1.0}) {
      ImportOptions options;
      options.length_unit = unit;
      Diagnostics diagnostics;
      const auto product = ReadCad(folder / "pair.step", options, &diagnostics);
      ASSERT_TRUE(product) << product.error().ToString();
      const double side = number * unit;
      EXPECT_NEAR(product->parts[0].mass.volume / (side * side * side), 1, 1e-9) << stated << unit;
      ASSERT_EQ(product->occurrences.size(), 2U);
      EXPECT_NEAR(product->occurrences[1].X_WB.p().x() / side, 2, 1e-9) << stated << unit;
    }
  }
}

TEST(Units, MayBeOfTheFilesOwnMaking) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  builder.AddPart(BRepPrimAPI_MakeBox(25.4, 25.4, 25.4).Shape(), "cube");
  builder.Write(folder / "cube.step", "INCH");
  ReplaceInFile(folder / "cube.step", "'INCH'", "'SPAN'");
  ReplaceInFile(folder / "cube.step", "WITH_UNIT(25.4,", "WITH_UNIT(228.6,");
  Diagnostics diagnostics;
  const auto product = ReadCad(folder / "cube.step", {}, &diagnostics);
  ASSERT_TRUE(product.has_value());
  EXPECT_NEAR(product->volume(), std::pow(0.2286, 3), 1e-9 * std::pow(0.2286, 3));
}

TEST(OddContent, SurfacesAloneAreAProductWithoutMass) {
  DocumentBuilder builder;
  const TopoDS_Shape face =
      TopExp_Explorer(BRepPrimAPI_MakeCylinder(3, 9).Shape(), TopAbs_FACE).Current();
  builder.AddPart(face, "sheet");
  builder.AddPart(Moved(face, MakeMotion(1, 50)), "sheet");
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  EXPECT_EQ(product.occurrences.size(), 2u);
  ASSERT_EQ(product.parts.size(), 1u);
  EXPECT_EQ(product.mass(), 0);
  EXPECT_EQ(CountCode(diagnostics, "surfaces-only"), 1);
  EXPECT_EQ(CountCode(diagnostics, "no-solid"), 1);
}

TEST(OddContent, SeveralSolidsOfOnePartMoveTogether) {
  TopoDS_Compound compound;
  const BRep_Builder make;
  make.MakeCompound(compound);
  make.Add(compound, BRepPrimAPI_MakeBox(10, 10, 10).Shape());
  make.Add(compound, BRepPrimAPI_MakeBox(gp_Pnt(30, 0, 0), 10, 10, 20).Shape());
  DocumentBuilder builder;
  builder.AddPart(compound, "pair");
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  ASSERT_EQ(product.parts.size(), 1u);
  EXPECT_EQ(product.parts[0].solid_count, 2);
  EXPECT_EQ(CountCode(diagnostics, "several-solids"), 1);
  EXPECT_NEAR(product.volume(), 3e-6, 1e-15);
  // (5 * 1000 + 35 * 2000) / 3000 along x.
  EXPECT_NEAR(product.parts[0].mass.p_BoBcm_B.x(), 0.025, 1e-12);
}

TEST(OddContent, ASolidOfNoThicknessHasNoMass) {
  TopoDS_Solid flat;
  TopoDS_Shell shell;
  const BRep_Builder make;
  make.MakeShell(shell);
  const TopoDS_Shape face =
      TopExp_Explorer(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), TopAbs_FACE).Current();
  make.Add(shell, face);
  make.Add(shell, face.Reversed());
  make.MakeSolid(flat);
  make.Add(flat, shell);
  DocumentBuilder builder;
  builder.AddPart(flat, "flat");
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  EXPECT_EQ(product.mass(), 0);
  EXPECT_EQ(CountCode(diagnostics, "no-volume"), 1);
}

TEST(OddContent, AThousandTimesTooLargeIsMeshedAsFast) {
  gp_Trsf enlarge;
  enlarge.SetScale(gp_Pnt(), 1000);
  DocumentBuilder builder;
  builder.AddPart(MakePlate(), "plate");
  builder.AddPart(Moved(MakePlate(), enlarge), "huge plate");
  Diagnostics diagnostics;
  const Product product = Build(&builder, &diagnostics);
  ASSERT_EQ(product.parts.size(), 2u);
  EXPECT_EQ(product.parts[0].mesh.triangles.size(), product.parts[1].mesh.triangles.size());
  EXPECT_NEAR(product.parts[1].mass.volume, 1e9 * product.parts[0].mass.volume, 1);
}

}  // namespace
}  // namespace hvas::cad
