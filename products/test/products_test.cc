#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include <BRepCheck_Analyzer.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "relations.h"
#include "tools.h"
#include "truth.h"

namespace hvas::products {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(HVAS_SOURCE_DIR) / "products";

std::string ReadBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

nlohmann::json ReadTruth(const std::string& name) {
  return nlohmann::json::parse(ReadBytes(kFolder / (name + ".truth.json")));
}

const Drawing& Pump() {
  static const Drawing drawing = DrawGearPump();
  return drawing;
}

void ExpectFilesAsStored(const Drawing& drawing) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("hvas_products_{}", ::getpid());
  std::filesystem::create_directories(folder);
  WriteProduct(drawing, folder.string());
  for (const char* ending : {".step", ".truth.json", ".hvas.json"}) {
    const std::string file = drawing.name + ending;
    const std::string stored = ReadBytes(kFolder / file);
    EXPECT_FALSE(stored.empty()) << file;
    EXPECT_TRUE(ReadBytes(folder / file) == stored) << file << " is not what its program writes";
  }
  std::filesystem::remove_all(folder);
}

/** Volumes summed by hand from the formulas of the bodies, against the kernel's own integration. */
void ExpectHandVolumes(const Drawing& drawing) {
  for (const PartDefinition& part : drawing.parts) {
    EXPECT_TRUE(BRepCheck_Analyzer(part.solid.shape).IsValid()) << part.name;
    const double volume_mm3 = CalcVolumeFinely(part.solid.shape);
    EXPECT_NEAR(part.solid.volume_mm3 / volume_mm3, 1, 1e-6) << part.name;
  }
}

void ExpectNoOverlap(const Drawing& drawing) {
  const std::vector<PlacedPart> placed = Flatten(drawing);
  Relations relations;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      EXPECT_LT(relations.CalcCommonVolume(placed[i], placed[j]), 1e-3)
          << placed[i].path << " and " << placed[j].path;
    }
  }
}

/** The first `steps` of the order: every part can be drawn back the way it came, past all parts
 that were there before it. */
void ExpectOrderWorks(const Drawing& drawing, std::size_t steps,
                      const std::vector<double>& offsets) {
  const std::vector<PlacedPart> placed = Flatten(drawing);
  const std::vector<std::string> names = ReferenceNames(placed);
  std::map<std::string, const PlacedPart*> by_name;
  for (std::size_t i = 0; i < placed.size(); ++i)
    by_name[names[i]] = &placed[i];
  ASSERT_EQ(by_name.size(), placed.size());
  ASSERT_EQ(drawing.order.size(), placed.size());
  Relations relations;
  for (std::size_t k = 0; k < steps; ++k) {
    const AssemblyStep& step = drawing.order[k];
    for (const double offset : offsets) {
      PlacedPart moved = *by_name.at(step.occurrence);
      const auto [x, y, z] = step.direction;
      moved.X_WB = Translation(-offset * x, -offset * y, -offset * z) * moved.X_WB;
      for (std::size_t j = 0; j < k; ++j) {
        const PlacedPart& other = *by_name.at(drawing.order[j].occurrence);
        EXPECT_LT(relations.CalcCommonVolume(other, moved), 1e-3)
            << step.occurrence << " hits " << other.path << " at " << offset << " mm";
      }
    }
  }
}

/** Every fit given is on a pair that the exact faces show to be concentric at that diameter. */
void ExpectFitsAreMates(const std::string& name) {
  const nlohmann::json truth = ReadTruth(name);
  const auto leaf = [](const std::string& path) { return path.substr(path.rfind('/') + 1); };
  for (const auto& fit : truth["fits"]) {
    int mates = 0;
    for (const auto& mate : truth["mates"]) {
      mates += mate["kind"] == "axis_hole" && leaf(mate["a"]) == fit["hole"] &&
                       leaf(mate["b"]) == fit["shaft"] &&
                       mate["diameter_mm"] == fit["diameter_mm"] && mate["clearance_mm"] == 0.0
                   ? 1
                   : 0;
    }
    EXPECT_GE(mates, 1) << fit.dump();
  }
}

std::string NameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  std::string text(static_cast<std::size_t>(name->Get().LengthOfCString()) + 1, '\0');
  char* bytes = text.data();
  name->Get().ToUTF8CString(bytes);
  text.resize(static_cast<std::size_t>(name->Get().LengthOfCString()));
  return text;
}

/** Reads the stored file as any program with this kernel would. */
void ExpectStepReadsBack(const Drawing& drawing) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  STEPCAFControl_Reader reader;
  reader.SetMatMode(Standard_True);
  ASSERT_EQ(reader.ReadFile((kFolder / (drawing.name + ".step")).c_str()), IFSelect_RetDone);
  ASSERT_TRUE(reader.Transfer(document));
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const auto materials = XCAFDoc_DocumentTool::MaterialTool(document->Main());
  std::map<std::string, TDF_Label> labels;
  TDF_LabelSequence all;
  shapes->GetShapes(all);
  for (const TDF_Label& label : all)
    labels[NameOf(label)] = label;

  for (const PartDefinition& part : drawing.parts) {
    ASSERT_TRUE(labels.contains(part.name)) << part.name;
    const TDF_Label& label = labels[part.name];
    Quantity_Color color;
    ASSERT_TRUE(colors->GetColor(label, XCAFDoc_ColorSurf, color)) << part.name;
    EXPECT_NEAR(color.Red(), part.color.r, 1e-6);
    EXPECT_NEAR(color.Green(), part.color.g, 1e-6);
    EXPECT_NEAR(color.Blue(), part.color.b, 1e-6);
    Handle(TDataStd_TreeNode) node;
    ASSERT_TRUE(label.FindAttribute(XCAFDoc::MaterialRefGUID(), node)) << part.name;
    Handle(TCollection_HAsciiString) name, description, density_name, density_type;
    double density_g_cm3 = 0;
    materials->GetMaterial(node->Father()->Label(), name, description, density_g_cm3, density_name,
                           density_type);
    EXPECT_EQ(std::string(name->ToCString()), part.material.name);
    EXPECT_NEAR(density_g_cm3 * 1000, part.material.density_kg_m3, 1e-6);
    EXPECT_NEAR(CalcVolumeFinely(shapes->GetShape(label)) / part.solid.volume_mm3, 1, 2e-6)
        << part.name;
  }
  for (const AssemblyDefinition& assembly : drawing.assemblies) {
    ASSERT_TRUE(labels.contains(assembly.name)) << assembly.name;
    TDF_LabelSequence components;
    shapes->GetComponents(labels[assembly.name], components);
    ASSERT_EQ(static_cast<std::size_t>(components.Length()), assembly.children.size());
    for (std::size_t i = 0; i < assembly.children.size(); ++i) {
      const TDF_Label& component = components.Value(static_cast<int>(i) + 1);
      EXPECT_EQ(NameOf(component), assembly.children[i].name);
      const gp_Trsf X_AC = shapes->GetLocation(component).Transformation();
      for (int row = 1; row <= 3; ++row) {
        for (int column = 1; column <= 4; ++column) {
          EXPECT_NEAR(X_AC.Value(row, column), assembly.children[i].X_AC.Value(row, column), 1e-9);
        }
      }
    }
  }
}

TEST(Bushing, FilesAreWhatTheProgramWrites) {
  ExpectFilesAsStored(DrawBushing());
}

TEST(GearPump, FilesAreWhatTheProgramWrites) {
  ExpectFilesAsStored(Pump());
}

TEST(Frame500, FilesAreWhatTheProgramWrites) {
  ExpectFilesAsStored(DrawFrame500());
}

TEST(LooseTwelve, FilesAreWhatTheProgramWrites) {
  ExpectFilesAsStored(DrawLooseTwelve());
}

TEST(FitRig, FilesAreWhatTheProgramWrites) {
  ExpectFilesAsStored(DrawFitRig());
}

TEST(SnapJoint, FilesAreWhatTheProgramWrites) {
  ExpectFilesAsStored(DrawSnapJoint());
}

TEST(PegHole, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(DrawPegHole());
}

TEST(NutBolt, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(DrawNutBolt());
}

TEST(SnapJoint, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(DrawSnapJoint());
}

// The O-ring is drawn with its own section: the sleeve has a tenth of it, and nothing else
// overlaps.
TEST(SnapJoint, OnlyTheSleeveOverlapsTheORing) {
  const Drawing drawing = DrawSnapJoint();
  const std::vector<PlacedPart> placed = Flatten(drawing);
  Relations relations;
  int overlaps = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      const bool is_squeezed = placed[i].name == "O-ring" && placed[j].name == "sleeve";
      const double common = relations.CalcCommonVolume(placed[i], placed[j]);
      overlaps += is_squeezed && common > 1 ? 1 : 0;
      EXPECT_TRUE(is_squeezed || common < 1e-3) << placed[i].path << " and " << placed[j].path;
    }
  }
  EXPECT_EQ(overlaps, 1);
}

TEST(Bushing, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(DrawBushing());
}

TEST(GearPump, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(Pump());
}

TEST(Frame500, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(DrawFrame500());
}

TEST(LooseTwelve, VolumesByHandAndByKernelAgree) {
  ExpectHandVolumes(DrawLooseTwelve());
}

TEST(Bushing, ReadsBackWithNamesColorsDensitiesAndPlaces) {
  ExpectStepReadsBack(DrawBushing());
}

TEST(GearPump, ReadsBackWithNamesColorsDensitiesAndPlaces) {
  ExpectStepReadsBack(Pump());
}

TEST(Frame500, ReadsBackWithNamesColorsDensitiesAndPlaces) {
  ExpectStepReadsBack(DrawFrame500());
}

TEST(LooseTwelve, ReadsBackWithNamesColorsDensitiesAndPlaces) {
  ExpectStepReadsBack(DrawLooseTwelve());
}

// W7: the bushing is 40 x 80 x 50 mm; the seat, the nose and two end faces are all that touches.
TEST(Bushing, HasTheRigsMates) {
  const nlohmann::json truth = ReadTruth("bushing");
  EXPECT_EQ(truth["occurrences"], 3);
  EXPECT_EQ(truth["mates"].size(), 4U);
  const double chamfer_mm3 =
      2 * std::acos(-1.0) * (40 - 1.0 / 3);  // Two rims of 1/2 mm^2, by Pappus.
  const double bore_mm3 = 2 * std::acos(-1.0) * (20 + 1.0 / 3);
  const double body_mm3 = std::acos(-1.0) * (1600 - 400) * 50;
  EXPECT_NEAR(truth["parts"][1]["volume_mm3"], body_mm3 - chamfer_mm3 - bore_mm3, 1e-3);
}

TEST(Bushing, NothingOverlapsAndTheOrderWorks) {
  ExpectNoOverlap(DrawBushing());
  ExpectOrderWorks(DrawBushing(), 3, {0.5, 7, 30, 70});
}

TEST(GearPump, NothingOverlaps) {
  ExpectNoOverlap(Pump());
}

TEST(GearPump, EveryPartGoesInAlongAStraightLine) {
  ExpectOrderWorks(Pump(), Pump().order.size(), {0.7, 6, 45});
}

// Counted on the drawing. Nominal: bushings, shafts in them, dowels, threads, hub, seal. With
// clearance: gasket, cover's screw holes, lock washers, end disc, sealing rings.
TEST(GearPump, HasTheMatesCountedByHand) {
  const nlohmann::json truth = ReadTruth("gear_pump");
  EXPECT_EQ(truth["occurrences"], 38);
  EXPECT_EQ(truth["unique_parts"], 18);
  EXPECT_EQ(truth["depth"], 2);
  const int nominal = 4 + 4 + 4 + 12 + 1 + 2;
  const int clearance = 10 + 8 + 8 + 1 + 3;
  EXPECT_EQ(truth["mate_counts"]["axis_hole_nominal"], nominal);
  EXPECT_EQ(truth["mate_counts"]["axis_hole"], nominal + clearance);
  const int on_housing = 2 + 2 + 2 + 1 + 3;  // Bushings, dowels, gears, gasket, rings.
  const int on_cover = 1 + 2 + 1 + 8;        // Gasket, bushings, seal, lock washers.
  const int others = 2 + 3 + 1 + 2 + 8 + 3;  // Gears on bushings; key; hub; disc; screws; plugs.
  EXPECT_EQ(truth["mate_counts"]["face_face"], on_housing + on_cover + others);
}

TEST(GearPump, HasFitsOfAllThreeKindsWhereFacesMate) {
  ExpectFitsAreMates("gear_pump");
  std::map<std::string, int> codes;
  const nlohmann::json truth = ReadTruth("gear_pump");
  for (const auto& fit : truth["fits"])
    ++codes[fit["fit"].get<std::string>()];
  EXPECT_EQ(codes["H7/p6"], 5);
  EXPECT_EQ(codes["H7/k6"], 3);
  EXPECT_EQ(codes["H7/g6"], 6);
  EXPECT_EQ(codes["thread"], 12);
}

TEST(Frame500, NothingOverlaps) {
  ExpectNoOverlap(DrawFrame500());
}

// Two tiers and what is under them: the others are equal.
TEST(Frame500, TwoTiersGoInFromAbove) {
  const Drawing frame = DrawFrame500();
  ExpectOrderWorks(frame, 9 + 2 * 113, {0.7, 17, 80});
}

TEST(Frame500, HasTheCountsOfItsPattern) {
  ExpectFitsAreMates("frame_500");
  const nlohmann::json truth = ReadTruth("frame_500");
  EXPECT_EQ(truth["occurrences"], 1 + 8 + 5 * (8 + 8 + 1 + 6 * 16) + 8);
  EXPECT_EQ(truth["unique_parts"], 13);
  EXPECT_EQ(truth["depth"], 3);
  // A module has 8 in itself with its shelf at the nominal size, and 12 with clearance.
  const int nominal = 8 + 8 + 5 * (8 + 8) + 4 * 8 + 8 + 30 * 10;
  EXPECT_EQ(truth["mate_counts"]["axis_hole_nominal"], nominal);
  EXPECT_EQ(truth["mate_counts"]["axis_hole"], nominal + 30 * 12);
}

/** A STEP file without the numbers of its occurrences, which the kernel counts over all files that
 a process writes. */
std::string WithoutOccurrenceNumbers(const std::string& bytes) {
  static const std::regex number("NEXT_ASSEMBLY_USAGE_OCCURRENCE\\('[0-9]+'");
  return std::regex_replace(bytes, number, "NEXT_ASSEMBLY_USAGE_OCCURRENCE(''");
}

TEST(ToolsX16, AreTheFilesOfTheRepositoryAndValidSolids) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("hvas_tools_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const auto tools = DrawTools();
  EXPECT_EQ(tools.size(), 12);
  for (const Drawing& tool : tools) {
    const std::string file = tool.name + ".step";
    WriteStep(tool, (folder / file).string());
    EXPECT_EQ(WithoutOccurrenceNumbers(ReadBytes(folder / file)),
              WithoutOccurrenceNumbers(ReadBytes(kFolder / "tools" / file)))
        << file;
    const Solid& solid = tool.parts.front().solid;
    EXPECT_TRUE(BRepCheck_Analyzer(solid.shape).IsValid()) << file;
    EXPECT_NEAR(CalcVolumeFinely(solid.shape) / solid.volume_mm3, 1, 1e-5) << file;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace hvas::products
