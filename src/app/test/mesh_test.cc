#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "app/test/obj_text.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ObjText;
using testing::RunHvas;
using testing::RunHvasJson;

/** Prism over a ten-cornered ring, radii 8 mm and 3 mm, 6 mm high. */
const double kRingVolumeMm3 = 5 * std::sin(2 * std::numbers::pi / 10) * (8.0 * 8.0 - 3.0 * 3.0) * 6;
constexpr double kPlateVolumeMm3 = 20 * 20 * 2;
constexpr double kMmPerInch = 25.4;

struct MeshFile {
  const char* name;
  int occurrences;
  int parts;
  double volume_mm3;
  int face_mates;
  bool is_unit_stated;
  double unit_mm;  // In the file.
};

std::string SeedFile(const std::string& name) {
  return (std::filesystem::path(HVAS_SOURCE_DIR) / "fuzz" / "seeds" / "import" / name).string();
}

class MeshFileTest : public ::testing::TestWithParam<MeshFile> {};

TEST_P(MeshFileTest, X1OpensLikeAnyOther) {  // X2
  const MeshFile& drawn = GetParam();
  const json opened = RunHvasJson({"inspect", SeedFile(drawn.name)});
  const json& summary = opened["summary"];
  EXPECT_EQ(summary["occurrences"], drawn.occurrences);
  EXPECT_EQ(summary["unique_parts"], drawn.parts);
  EXPECT_NEAR(summary["volume_mm3"].get<double>() / drawn.volume_mm3, 1, 1e-5);
  EXPECT_EQ(summary["mates"]["face_face"], drawn.face_mates);
  EXPECT_EQ(summary["warnings"], 0) << opened["diagnostics"].dump(1);
  for (const json& part : opened["parts"]) {
    EXPECT_EQ(part["solid_count"], 1);
    EXPECT_EQ(part["has_brep"], false);
  }
}

TEST_P(MeshFileTest, TakesTheUserUnitForThatOfTheFile) {
  const MeshFile& drawn = GetParam();
  const json as_mm = RunHvasJson({"inspect", SeedFile(drawn.name)});
  const json as_inch = RunHvasJson({"inspect", SeedFile(drawn.name), "--unit", "in"});
  const double scale = kMmPerInch / drawn.unit_mm;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(as_inch["summary"]["size_mm"][axis].get<double>() /
                    as_mm["summary"]["size_mm"][axis].get<double>(),
                scale, 1e-6 * scale);
  }
  EXPECT_NEAR(
      as_inch["summary"]["volume_mm3"].get<double>() / as_mm["summary"]["volume_mm3"].get<double>(),
      std::pow(scale, 3), 1e-5 * std::pow(scale, 3));
  int told = 0;
  for (const json& diagnostic : as_mm["diagnostics"]) {
    if (diagnostic["code"] == "assumed-unit") {
      ++told;
      EXPECT_EQ(diagnostic["entity"], drawn.name);
      EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--unit",
                          diagnostic["remedy"].get<std::string>());
    }
  }
  EXPECT_EQ(told, drawn.is_unit_stated ? 0 : 1);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, MeshFileTest,
    ::testing::Values(MeshFile{"ring_text.stl", 1, 1, kRingVolumeMm3, 0, false, 1},
                      MeshFile{"ring_binary.stl", 1, 1, kRingVolumeMm3, 0, false, 1},
                      MeshFile{"ring_plate.obj", 2, 2, kRingVolumeMm3 + kPlateVolumeMm3, 1, false,
                               1},
                      MeshFile{"rings.gltf", 2, 1, 2 * kRingVolumeMm3, 1, true, 1000},
                      MeshFile{"rings.glb", 2, 1, 2 * kRingVolumeMm3, 1, true, 1000},
                      MeshFile{"rings.3mf", 2, 1, 2 * kRingVolumeMm3, 1, true, 1}),
    [](const auto& instance) {
      std::string name = instance.param.name;
      for (char& c : name) {
        c = c == '.' ? '_' : c;
      }
      return name;
    });

struct Tessellation {
  int segments;
  int decimals;  ///< Of the coordinates in millimetres.
};

/** A plate with a hole of 10 mm, and in it a headed pin of 9.98 mm. The pin is turned by half a
 segment: its edges stand out further than the middles of the hole's flats lie. */
class TrianglePegTest : public ::testing::TestWithParam<Tessellation> {
 protected:
  void SetUp() override {
    const auto [segments, decimals] = GetParam();
    ObjText obj(segments, decimals);
    obj.AddObject("plate");
    const auto outline_0 = obj.AddSquare(20, 0);
    const auto outline_1 = obj.AddSquare(20, 10);
    const auto hole_0 = obj.AddCircle(5, 0, 0);
    const auto hole_1 = obj.AddCircle(5, 10, 0);
    obj.AddBand(outline_0, outline_1);
    obj.AddBand(outline_1, hole_1);
    obj.AddBand(hole_1, hole_0);
    obj.AddBand(hole_0, outline_0);
    obj.AddObject("pin");
    obj.AddTurned({{4.99, 0}, {4.99, 10}, {8, 10}, {8, 14}}, 0.5);
    file_ = folder_.Write("peg.obj", obj.text()).string();
  }

  TemporaryFolder folder_;
  std::string file_;
};

TEST_P(TrianglePegTest, X2HasItsFacesAndMates) {  // X3, W3
  const json opened = RunHvasJson({"inspect", file_});
  ASSERT_EQ(opened["parts"].size(), 2U);
  const auto faces = [&opened](std::size_t part, const char* kind) {
    return opened["parts"][part]["face_counts"][kind].get<int>();
  };
  EXPECT_EQ(faces(0, "plane"), 6);
  EXPECT_EQ(faces(0, "cylinder"), 1);
  EXPECT_EQ(faces(1, "plane"), 3);
  EXPECT_EQ(faces(1, "cylinder"), 2);
  ASSERT_EQ(opened["mates"].size(), 2U);
  const json& axis = opened["mates"][0];
  EXPECT_EQ(axis["kind"], "axis_hole");
  EXPECT_NEAR(axis["hole_diameter_mm"].get<double>(), 10, 1e-3);
  EXPECT_NEAR(axis["shaft_diameter_mm"].get<double>(), 9.98, 1e-3);
  EXPECT_NEAR(axis["engaged_mm"].get<double>(), 10, 1e-2);
  EXPECT_EQ(axis["fit"]["kind"], "clearance");
  EXPECT_EQ(axis["fit"]["is_proposed"], true);
  EXPECT_EQ(opened["mates"][1]["kind"], "face_face");
  const double area = std::numbers::pi * (8 * 8 - 5 * 5);  // mm2, of round rings.
  const double sagitta = 1 - std::cos(std::numbers::pi / GetParam().segments);
  EXPECT_NEAR(opened["mates"][1]["overlap_mm2"].get<double>() / area, 1, 3 * sagitta + 1e-3);
}

TEST_P(TrianglePegTest, GoesIntoItsHoleAsARoundPinWould) {
  const json run = RunHvasJson({"assemble", file_});
  EXPECT_EQ(run["seated"], 2);
  const json& pin = run["parts"][1];
  EXPECT_EQ(pin["name"], "peg/pin");
  EXPECT_EQ(pin["mates"], 2);
  EXPECT_LT(pin["pose_error_um"].get<double>(), 1);
  // The corners of the pin reach further out than the flats of the hole: triangles would cut by
  // up to 33 um, and jam.
  EXPECT_LT(pin["deepest_um"].get<double>(), 1);
}

INSTANTIATE_TEST_SUITE_P(Tessellations, TrianglePegTest,
                         ::testing::Values(Tessellation{48, 9}, Tessellation{48, 4},
                                           Tessellation{48, 3}, Tessellation{24, 6},
                                           Tessellation{24, 3}, Tessellation{200, 6}),
                         [](const auto& instance) {
                           return fmt::format("Segments{}Decimals{}", instance.param.segments,
                                              instance.param.decimals);
                         });

}  // namespace
}  // namespace hvas::app
