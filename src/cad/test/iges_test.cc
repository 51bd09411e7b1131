// IGES files that OpenCASCADE writes: of solids (type 186) and of trimmed surfaces (type 144).
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "cad/brep/occt_session.h"
#include "cad/brep/sew_faces.h"
#include "cad/brep/solid_measure.h"
#include "cad/iges/iges_text.h"
#include "cad/process/read_cad.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::FeatureKind;
using product::Part;
using product::Product;
using testing::CountCode;
using testing::DocumentBuilder;
using testing::kRed;
using testing::MakePlate;
using testing::Translation;

constexpr double kIgesPlateVolume = (60 * 40 * 10 - std::numbers::pi * 25 * 10) * 1e-9;  // [m^3]
constexpr double kPinVolume = std::numbers::pi * 25 * 20 * 1e-9;                         // [m^3]

enum class Form { kSurfaces, kSolids };

void WriteIges(DocumentBuilder* builder, const std::filesystem::path& file, Form form,
               const std::string& unit = "MM") {
  InitialiseOpenCascade();
  Interface_Static::SetIVal("write.iges.brep.mode", form == Form::kSolids ? 1 : 0);
  Interface_Static::SetCVal("write.iges.unit", unit.c_str());
  XCAFDoc_DocumentTool::ShapeTool(builder->document()->Main())->UpdateAssemblies();
  IGESCAFControl_Writer writer;
  ASSERT_TRUE(writer.Transfer(builder->document()));
  IGESData_GlobalSection global = writer.Model()->GlobalSection();
  global.SetAuthorName(new TCollection_HAsciiString("A. Smith"));
  global.SetCompanyName(new TCollection_HAsciiString("Works"));
  writer.Model()->SetGlobalSection(global);
  ASSERT_TRUE(writer.Write(file.c_str()));
}

/** A plate and two of the same red pin. */
void WriteAssembly(const std::filesystem::path& file, Form form, const std::string& unit = "MM") {
  DocumentBuilder builder;
  const TDF_Label plate = builder.AddPart(MakePlate(), "plate");
  const TDF_Label pin = builder.AddPart(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "pin");
  builder.SetColor(pin, kRed);
  const TDF_Label root = builder.AddAssembly("rig");
  builder.AddComponent(root, plate, Translation(0, 0, 0), "plate");
  builder.AddComponent(root, pin, Translation(20, 20, -5), "pin_1");
  builder.AddComponent(root, pin, Translation(100, 0, 0), "pin_2");
  WriteIges(&builder, file, form, unit);
}

void WriteShape(const TopoDS_Shape& shape, const std::filesystem::path& file, Form form) {
  DocumentBuilder builder;
  builder.AddPart(shape, "body");
  WriteIges(&builder, file, form);
}

Product ImportIges(const std::filesystem::path& file, Diagnostics* diagnostics) {
  Result<Product> product = ReadCad(file, {}, diagnostics);
  EXPECT_TRUE(product.has_value()) << product.error().ToString();
  return product.value_or(Product{});
}

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/** The volumes of all occurrences, largest first, must be those of a plate and two pins. */
void ExpectPlateAndPins(const Product& product) {
  ASSERT_EQ(product.occurrences.size(), 3u);
  EXPECT_EQ(product.parts.size(), 2u) << "the pins share one part";
  int plates = 0;
  int pins = 0;
  for (const product::Occurrence& occurrence : product.occurrences) {
    const Part& part = product.part_of(occurrence.id);
    EXPECT_EQ(part.solid_count, 1);
    EXPECT_TRUE(part.has_brep);
    plates += std::abs(part.mass.volume - kIgesPlateVolume) < 1e-6 * kIgesPlateVolume ? 1 : 0;
    pins += std::abs(part.mass.volume - kPinVolume) < 1e-6 * kPinVolume ? 1 : 0;
  }
  EXPECT_EQ(plates, 1);
  EXPECT_EQ(pins, 2);
}

TEST(ReadIges, X2SolidsArePartsOfAnAssemblyWithTheirVolumesAndPlaces) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "rig.igs", Form::kSolids);
  Diagnostics diagnostics;
  const Product product = ImportIges(folder / "rig.igs", &diagnostics);
  EXPECT_EQ(product.source, "rig.igs");
  EXPECT_EQ(product.name, "rig");
  ExpectPlateAndPins(product);
  EXPECT_EQ(CountCode(diagnostics, "sewn-faces"), 0);
  EXPECT_NEAR(product.box_W.high.x(), 0.105, 1e-5);
}

TEST(ReadIges, X2SurfacesOfEachGroupAreSewnIntoASolidWithNameAndColour) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "rig.iges", Form::kSurfaces);
  Diagnostics diagnostics;
  const Product product = ImportIges(folder / "rig.iges", &diagnostics);
  ExpectPlateAndPins(product);
  EXPECT_EQ(CountCode(diagnostics, "sewn-faces"), 1);
  EXPECT_EQ(CountCode(diagnostics, "open-faces"), 0);
  ASSERT_GE(product.occurrences.size(), 2u);
  EXPECT_EQ(product.occurrences[1].name, "pin_1");
  const Part& pin = product.part_of(product.occurrences[1].id);
  EXPECT_GT(pin.color.r, 0.9F);
  EXPECT_LT(pin.color.g, 0.1F);
}

TEST(ReadIges, X2FacesAreAnalyticSurfacesSoThatHolesAndShaftsAreFound) {
  const TemporaryFolder folder;
  for (const Form form : {Form::kSurfaces, Form::kSolids}) {
    WriteAssembly(folder / "rig.igs", form);
    Diagnostics diagnostics;
    const Product product = ImportIges(folder / "rig.igs", &diagnostics);
    int holes = 0;
    int shafts = 0;
    for (const Part& part : product.parts) {
      for (const product::Feature& feature : part.features) {
        const bool is_round = std::abs(feature.radius - 5e-3) < 1e-6;
        holes += feature.kind == FeatureKind::kHole && is_round ? 1 : 0;
        shafts += feature.kind == FeatureKind::kShaft && is_round ? 1 : 0;
      }
    }
    EXPECT_EQ(holes, 1);
    EXPECT_EQ(shafts, 1);
  }
}

TEST(ReadIges, ConvertsTheUnitOfTheFile) {
  const TemporaryFolder folder;
  for (const char* unit : {"MM", "INCH", "M"}) {
    SCOPED_TRACE(unit);
    WriteAssembly(folder / "rig.igs", Form::kSurfaces, unit);
    Diagnostics diagnostics;
    ExpectPlateAndPins(ImportIges(folder / "rig.igs", &diagnostics));
  }
}

TEST(ReadIges, TakesTheUnitThatTheUserGivesForThatOfTheFile) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "rig.igs", Form::kSolids);
  std::vector<double> sizes;
  for (const double unit : {1e-3, 0.0254, 0.3048}) {
    ImportOptions options;
    options.length_unit = unit;
    Diagnostics diagnostics;
    const auto product = ReadCad(folder / "rig.igs", options, &diagnostics);
    ASSERT_TRUE(product) << product.error().ToString();
    sizes.push_back(product->box_W.size().norm());
  }
  EXPECT_NEAR(sizes[1] / sizes[0], 25.4, 1e-3);
  EXPECT_NEAR(sizes[2] / sizes[0], 304.8, 1e-2);
  ImportOptions options;
  options.length_unit = 0.003;
  Diagnostics diagnostics;
  EXPECT_FALSE(ReadCad(folder / "rig.igs", options, &diagnostics));
}

TEST(ReadIges, X2TheHeaderNamesAuthorCompanyAndSystem) {
  const TemporaryFolder folder;
  WriteAssembly(folder / "rig.igs", Form::kSolids);
  Diagnostics diagnostics;
  const product::FileHeader header = ImportIges(folder / "rig.igs", &diagnostics).header;
  EXPECT_EQ(header.format, "IGES");
  EXPECT_EQ(header.authors, "A. Smith");
  EXPECT_EQ(header.organisations, "Works");
  EXPECT_NE(header.originating_system.find("Open CASCADE"), std::string::npos);
  EXPECT_FALSE(header.time_stamp.empty());
}

TEST(SewFaces, AClosedShellInsideAnotherOneIsACavityOfItsSolid) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(10, 10, 10), 4).Shape();
  const TopoDS_Shape box = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(20, 20, 20).Shape(), ball).Shape();
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer it(box, TopAbs_FACE); it.More(); it.Next()) {
    faces.push_back(it.Current());
  }
  const SewnFaces sewn = SewFaces(faces, 0.01);
  ASSERT_EQ(sewn.solids.size(), 1u);
  EXPECT_TRUE(sewn.open.IsNull());
  const double expected = 8000 - 4.0 / 3 * std::numbers::pi * 64;  // [mm^3]
  EXPECT_NEAR(std::abs(MeasureSolid(sewn.solids[0], gp_Pnt()).volume_mm3), expected,
              1e-6 * expected);
}

TEST(ReadIges, SurfacesThatDoNotCloseAreAPartWithoutASolidAndAWarning) {
  const TemporaryFolder folder;
  TopoDS_Compound open;
  const BRep_Builder builder;
  builder.MakeCompound(open);
  int count = 0;
  for (TopExp_Explorer it(BRepPrimAPI_MakeBox(20, 20, 20).Shape(), TopAbs_FACE);
       it.More() && count < 5; it.Next(), ++count) {
    builder.Add(open, it.Current());
  }
  WriteShape(open, folder / "open.igs", Form::kSurfaces);
  Diagnostics diagnostics;
  const Product product = ImportIges(folder / "open.igs", &diagnostics);
  ASSERT_EQ(product.parts.size(), 1u);
  EXPECT_EQ(product.parts[0].solid_count, 0);
  EXPECT_EQ(product.parts[0].faces.size(), 5u);
  ASSERT_EQ(CountCode(diagnostics, "open-faces"), 1);
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "open-faces") {
      EXPECT_NE(item.message.find("4 edges"), std::string::npos) << item.message;
      EXPECT_NE(item.message.find("entities D"), std::string::npos) << item.message;
    }
  }
}

TEST(ReadIges, ASolidWhoseShellDoesNotCloseSaysSoWithItsEntity) {
  const TemporaryFolder folder;
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  int count = 0;
  for (TopExp_Explorer it(BRepPrimAPI_MakeBox(20, 20, 20).Shape(), TopAbs_FACE);
       it.More() && count < 5; it.Next(), ++count) {
    builder.Add(shell, it.Current());
  }
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  WriteShape(solid, folder / "open.igs", Form::kSolids);
  Diagnostics diagnostics;
  ImportIges(folder / "open.igs", &diagnostics);
  ASSERT_EQ(CountCode(diagnostics, "open-faces"), 1);
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "open-faces") {
      EXPECT_NE(item.message.find("4 edges"), std::string::npos) << item.message;
      EXPECT_NE(item.message.find(" D"), std::string::npos) << item.message;
    }
  }
  // Closed ones have seams and poles, and say nothing.
  for (const TopoDS_Shape& closed :
       {BRepPrimAPI_MakeSphere(10).Shape(), BRepPrimAPI_MakeCylinder(5, 20).Shape(), MakePlate()}) {
    WriteShape(closed, folder / "closed.igs", Form::kSolids);
    Diagnostics silent;
    ImportIges(folder / "closed.igs", &silent);
    EXPECT_EQ(CountCode(silent, "open-faces"), 0);
  }
}

TEST(ReadIges, CurvesAloneAreShown) {
  const TemporaryFolder folder;
  WriteShape(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(40, 0, 0)).Shape(),
             folder / "line.igs", Form::kSolids);
  Diagnostics diagnostics;
  const Product product = ImportIges(folder / "line.igs", &diagnostics);
  ASSERT_EQ(product.parts.size(), 1u);
  EXPECT_EQ(product.parts[0].solid_count, 0);
  EXPECT_EQ(CountCode(diagnostics, "curves-only"), 1);
}

TEST(ReadIges, GivesTheSameAsStepForTheSameShapes) {
  const TemporaryFolder folder;
  DocumentBuilder builder;
  builder.AddPart(MakePlate(), "plate");
  builder.Write(folder / "plate.step");
  WriteShape(MakePlate(), folder / "plate.igs", Form::kSolids);
  Diagnostics diagnostics;
  const Part step = ImportIges(folder / "plate.step", &diagnostics).parts.at(0);
  const Part iges = ImportIges(folder / "plate.igs", &diagnostics).parts.at(0);
  EXPECT_EQ(iges.faces.size(), step.faces.size());
  EXPECT_EQ(iges.features.size(), step.features.size());
  EXPECT_NEAR(iges.mass.mass, step.mass.mass, 1e-9 * step.mass.mass);
  EXPECT_LT((iges.mass.p_BoBcm_B - step.mass.p_BoBcm_B).norm(), 1e-9);
}

class DamagedIges : public ::testing::Test {
 protected:
  DamagedIges() {
    WriteAssembly(folder_ / "rig.igs", Form::kSolids);
    text_ = ReadText(folder_ / "rig.igs");
  }

  /** The error of a file with this text. */
  Error Refuse(const std::string& text) {
    WriteText(folder_ / "damaged.igs", text);
    Diagnostics diagnostics;
    const auto product = ReadCad(folder_ / "damaged.igs", {}, &diagnostics);
    EXPECT_FALSE(product.has_value());
    return product ? Error{} : product.error();
  }

  TemporaryFolder folder_;
  std::string text_;
};

TEST_F(DamagedIges, FileThatIsCutOffIsRefusedWithItsLastLine) {
  const Error error = Refuse(text_.substr(0, text_.size() / 2));
  EXPECT_EQ(error.code, ErrorCode::kUnreadable);
  EXPECT_NE(error.where.find("damaged.igs:"), std::string::npos);
  EXPECT_FALSE(error.message.empty());
  EXPECT_FALSE(error.remedy.empty());
}

TEST_F(DamagedIges, MissingLineIsRefusedWithItsPlace) {
  std::string text = text_;
  const std::size_t at = text.find("D0000005");
  const std::size_t begin = text.rfind('\n', at) + 1;
  text.erase(begin, text.find('\n', at) + 1 - begin);
  const Error error = Refuse(text);
  EXPECT_NE(error.message.find("D0000005"), std::string::npos) << error.message;
}

TEST_F(DamagedIges, OtherTextThatIsCalledIgesIsRefusedAsDamaged) {
  EXPECT_NE(Refuse("Dear Sir,\nthe parts are late.\n").message.find("column 73"),
            std::string::npos);
}

TEST_F(DamagedIges, CompressedFormIsRefusedWithARemedy) {
  std::string line(72, ' ');
  const Error error = Refuse(line + "C0000001\n" + text_);
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_NE(error.remedy.find("ASCII"), std::string::npos);
}

TEST_F(DamagedIges, FileIsKnownByItsContentWhateverItIsCalled) {
  WriteText(folder_ / "rig.step", text_);
  Diagnostics diagnostics;
  ExpectPlateAndPins(ImportIges(folder_ / "rig.step", &diagnostics));
}

TEST_F(DamagedIges, MorePartsThanAllowedAreRefused) {
  ImportOptions options;
  options.max_parts = 2;
  Diagnostics diagnostics;
  const auto product = ReadCad(folder_ / "rig.igs", options, &diagnostics);
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, ErrorCode::kUnsupported);
}

TEST_F(DamagedIges, EntityThatCannotBeReadIsNamedByItsNumber) {
  // The first plane surface (type 190) refers to an entity that is not there.
  std::string text = text_;
  const std::size_t at = text.find("\n190,") + 1;
  ASSERT_NE(at, 0u);
  text.replace(at, 6, "190,99");
  WriteText(folder_ / "damaged.igs", text);
  Diagnostics diagnostics;
  const auto product = ReadCad(folder_ / "damaged.igs", {}, &diagnostics);
  EXPECT_TRUE(!product || CountCode(diagnostics, "iges-entity") > 0 ||
              CountCode(diagnostics, "open-faces") > 0);
}

}  // namespace
}  // namespace hvas::cad
