#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "spatial/pose.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using spatial::Pose;
using testing::ProductFile;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

template <typename T>
T Read(const std::string& bytes, std::size_t at) {
  T value{};
  EXPECT_LE(at + sizeof(T), bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/** A strict reader of .glb files, of its own: every rule of glTF 2.0 that the export could break is
 an expectation. */
class Glb {
 public:
  explicit Glb(const std::string& file) : bytes_(ReadText(file)) {
    EXPECT_EQ(bytes_.substr(0, 4), "glTF");
    EXPECT_EQ(Read<std::uint32_t>(bytes_, 4), 2U);
    EXPECT_EQ(Read<std::uint32_t>(bytes_, 8), bytes_.size());
    const auto json_size = Read<std::uint32_t>(bytes_, 12);
    EXPECT_EQ(bytes_.substr(16, 4), "JSON");
    EXPECT_EQ(json_size % 4, 0U);
    root_ = json::parse(bytes_.substr(20, json_size), nullptr, false);
    EXPECT_TRUE(root_.is_object());
    binary_ = 20 + json_size + 8;
    const auto size = Read<std::uint32_t>(bytes_, 20 + json_size);
    EXPECT_EQ(bytes_.substr(24 + json_size, 4), std::string("BIN\0", 4));
    EXPECT_EQ(size % 4, 0U);
    EXPECT_EQ(binary_ + size, bytes_.size());
    EXPECT_EQ(root_["buffers"].size(), 1U);
    EXPECT_EQ(root_["buffers"][0]["byteLength"], size);
    EXPECT_EQ(root_["asset"]["version"], "2.0");
    std::size_t end = 0;
    for (const json& view : root_["bufferViews"]) {
      EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
      EXPECT_EQ(view["byteOffset"], end);  // No gaps, no overlaps.
      end += view["byteLength"].get<std::size_t>();
    }
    EXPECT_EQ(end, size);
  }

  [[nodiscard]] const json& root() const { return root_; }

  /** The numbers of an accessor, a row for each element. */
  [[nodiscard]] std::vector<std::vector<double>> Values(std::size_t index) const {
    const json& accessor = root_["accessors"].at(index);
    const json& view = root_["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    const std::size_t columns = accessor["type"] == "VEC3" ? 3 : 1;
    const bool is_float = accessor["componentType"] == 5126;
    EXPECT_TRUE(is_float || accessor["componentType"] == 5125);
    const std::size_t stride = view.value("byteStride", std::size_t{4 * columns});
    const std::size_t offset = accessor["byteOffset"];
    const std::size_t count = accessor["count"];
    EXPECT_EQ(stride, 4 * columns);
    EXPECT_EQ(offset % 4, 0U);
    EXPECT_GT(count, 0U);
    EXPECT_LE(offset + stride * count, view["byteLength"].get<std::size_t>());
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> row;
      for (std::size_t c = 0; c < columns; ++c) {
        const std::size_t at =
            binary_ + view["byteOffset"].get<std::size_t>() + offset + i * stride + 4 * c;
        row.push_back(is_float ? static_cast<double>(Read<float>(bytes_, at))
                               : Read<std::uint32_t>(bytes_, at));
        EXPECT_TRUE(std::isfinite(row.back()));
      }
      rows.push_back(row);
    }
    return rows;
  }

 private:
  std::string bytes_;
  json root_;
  std::size_t binary_{0};
};

/** Checks a primitive; adds its volume, by the divergence theorem, and the faces it shows. */
void CheckPrimitive(const Glb& glb, const json& primitive, double* volume, std::set<int>* faces) {
  const json& attributes = primitive["attributes"];
  const std::size_t position = attributes["POSITION"];
  const auto points = glb.Values(position);
  const auto normals = glb.Values(attributes["NORMAL"]);
  const auto ids = glb.Values(attributes["_FACE_ID"]);
  const auto indices = glb.Values(primitive["indices"]);
  EXPECT_EQ(normals.size(), points.size());
  EXPECT_EQ(ids.size(), points.size());
  EXPECT_EQ(indices.size() % 3, 0U);
  EXPECT_LT(primitive["material"].get<std::size_t>(), glb.root()["materials"].size());
  for (std::size_t c = 0; c < 3; ++c) {
    double low = 1e9;
    double high = -1e9;
    for (const auto& point : points) {
      low = std::min(low, point[c]);
      high = std::max(high, point[c]);
    }
    EXPECT_EQ(glb.root()["accessors"][position]["min"][c], low);
    EXPECT_EQ(glb.root()["accessors"][position]["max"][c], high);
  }
  for (const auto& normal : normals) {
    EXPECT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-6);
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<Vec3, 3> corners;
    std::set<double> face;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto index = static_cast<std::size_t>(indices[i + k][0]);
      ASSERT_LT(index, points.size());
      corners[k] = Vec3(points[index][0], points[index][1], points[index][2]);
      face.insert(ids[index][0]);
    }
    EXPECT_EQ(face.size(), 1U);  // A triangle is of one face.
    faces->insert(static_cast<int>(*face.begin()));
    *volume += corners[0].dot(corners[1].cross(corners[2])) / 6;
  }
}

TEST(ExportGlb, X3IsValidAndHoldsEveryPartFacePoseAndId) {
  const TemporaryFolder folder;
  const std::string file = (folder / "pump.glb").string();
  const Ran ran = RunHvas({"export", ProductFile("gear_pump"), "-o", file});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const Glb glb(file);
  const json inspected = RunHvasJson({"inspect", ProductFile("gear_pump")});
  const json& root = glb.root();
  ASSERT_EQ(root["meshes"].size(), inspected["parts"].size());  // Instances share them.
  for (std::size_t i = 0; i < root["meshes"].size(); ++i) {
    const json& mesh = root["meshes"][i];
    const json& part = inspected["parts"][i];
    EXPECT_EQ(mesh["extras"]["part"], part["id"]);
    EXPECT_EQ(mesh["name"], part["name"]);
    double volume = 0;
    std::set<int> faces;
    for (const json& primitive : mesh["primitives"]) {
      CheckPrimitive(glb, primitive, &volume, &faces);
    }
    // Closed and outward, in metres; chords lose little.
    EXPECT_NEAR(volume * 1e9 / part["volume_mm3"].get<double>(), 1, 0.03) << part["name"];
    std::size_t count = 0;
    for (const char* kind : {"plane", "cylinder", "cone", "sphere", "torus", "freeform"}) {
      count += part["face_counts"][kind].get<std::size_t>();
    }
    EXPECT_EQ(faces.size(), count) << part["name"];
    EXPECT_EQ(mesh["extras"]["face_count"], count);
  }
  // The tree, each node once, with the poses of the occurrences below a root that turns z to y.
  std::set<std::size_t> seen;
  std::size_t leaves = 0;
  const std::function<void(std::size_t)> visit = [&](std::size_t index) {
    ASSERT_TRUE(seen.insert(index).second);
    const json& node = root["nodes"].at(index);
    for (const json& child : node.value("children", json::array())) {
      visit(child.get<std::size_t>());
    }
    if (!node["extras"].contains("occurrence")) {
      return;
    }
    ++leaves;
    const json& occurrence = inspected["occurrences"][node["extras"]["occurrence"].get<int>()];
    EXPECT_EQ(node["name"], occurrence["name"]);
    EXPECT_EQ(node["extras"]["path"], occurrence["path"]);
    EXPECT_EQ(node["mesh"], occurrence["part"]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(node["translation"][c].get<double>() * 1e3,
                  occurrence["position_mm"][c].get<double>(), 1e-9);
      EXPECT_NEAR(node["rotation"][c].get<double>(),
                  occurrence["rotation_wxyz"][c + 1].get<double>(), 1e-12);
    }
  };
  visit(root["scenes"][0]["nodes"][0]);
  EXPECT_EQ(seen.size(), root["nodes"].size());
  EXPECT_EQ(leaves, inspected["occurrences"].size());
  const json& q = root["nodes"][0]["rotation"];
  const Quat turn(q[3], q[0], q[1], q[2]);
  EXPECT_LT((turn * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((turn * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-12);
  // Finer meshes on request; the same bytes each time.
  const std::string fine = (folder / "fine.glb").string();
  const std::string again = (folder / "again.GLB").string();
  ASSERT_EQ(RunHvas({"export", ProductFile("gear_pump"), "-o", fine, "--fine"}).status, 0);
  ASSERT_EQ(RunHvas({"export", ProductFile("gear_pump"), "-o", again}).status, 0);
  EXPECT_GT(ReadText(fine).size(), ReadText(file).size());
  EXPECT_TRUE(ReadText(again) == ReadText(file));
}

TEST(ExportJson, IsWhatInspectPrintsAndMeshesOnRequest) {
  const TemporaryFolder folder;
  const std::string file = (folder / "rig.json").string();
  ASSERT_EQ(RunHvas({"export", ProductFile("bushing"), "-o", file}).status, 0);
  const json inspected = RunHvasJson({"inspect", ProductFile("bushing")});
  EXPECT_EQ(json::parse(ReadText(file)), inspected);
  ASSERT_EQ(RunHvas({"export", ProductFile("bushing"), "-o", file, "--meshes", "--fine", "--force"})
                .status,
            0);
  const json meshes = json::parse(ReadText(file));
  const json schema = json::parse(
      ReadText(std::filesystem::path(HVAS_SOURCE_DIR) / "data/schemas/inspect.schema.json"));
  EXPECT_EQ(testing::Validate(schema, meshes), std::vector<std::string>{});
  ASSERT_EQ(meshes["meshes"].size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(meshes["meshes"][i]["triangles"].size(), inspected["parts"][i]["triangle_count"]);
  }
}

TEST(ExportStep, ComesBackTheSame) {
  const TemporaryFolder folder;
  const std::string file = (folder / "pump.step").string();
  const Ran ran = RunHvas({"export", ProductFile("gear_pump"), "-o", file});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json before = RunHvasJson({"inspect", ProductFile("gear_pump")});
  const json after = RunHvasJson({"inspect", file});
  for (const char* key : {"occurrences", "unique_parts", "depth", "mates", "linked_parts"}) {
    EXPECT_EQ(after["summary"][key], before["summary"][key]) << key;
  }
  for (const char* key : {"volume_mm3", "mass_kg"}) {
    EXPECT_NEAR(after["summary"][key].get<double>() / before["summary"][key].get<double>(), 1, 1e-6)
        << key;
  }
  ASSERT_EQ(after["occurrences"].size(), before["occurrences"].size());
  for (std::size_t i = 0; i < after["occurrences"].size(); ++i) {
    const json& is = after["occurrences"][i];
    const json& was = before["occurrences"][i];
    EXPECT_EQ(is["path"], was["path"]);
    EXPECT_EQ(after["parts"][is["part"].get<int>()]["name"],
              before["parts"][was["part"].get<int>()]["name"]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(is["position_mm"][c].get<double>(), was["position_mm"][c].get<double>(), 1e-6);
      EXPECT_NEAR(after["parts"][is["part"].get<int>()]["color_srgb"][c].get<double>(),
                  before["parts"][was["part"].get<int>()]["color_srgb"][c].get<double>(), 0.01);
    }
  }
}

TEST(ExportStep, GivesTheSameBytesTwice) {
  const TemporaryFolder folder;
  const std::string pump = ProductFile("gear_pump");
  for (const char* name : {"a.step", "b.step"}) {
    ASSERT_EQ(RunHvas({"export", pump, "-o", (folder / name).string()}).status, 0);
  }
  const std::string text = ReadText(folder / "a.step");
  EXPECT_NE(text.find("COLOUR_RGB"), std::string::npos);
  EXPECT_TRUE(text == ReadText(folder / "b.step"));
}

/** Each occurrence turned and pushed its own way, as a pose file. */
json MakePoses(const json& occurrences) {
  json poses{{"format", "hvas-poses-1"}, {"poses", json::array()}};
  for (std::size_t i = 0; i < occurrences.size(); ++i) {
    const auto n = static_cast<double>(i + 1);
    const Quat q(Eigen::AngleAxisd(0.3 * n, Vec3(1, n, -2).normalized()));
    poses["poses"].push_back({{"occurrence", occurrences[i]["path"]},
                              {"position_mm", {7.3 * n, -1.0 / n, 100 + n}},
                              {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}}});
  }
  return poses;
}

void ExpectPoses(const json& expected, const json& occurrences) {
  ASSERT_EQ(occurrences.size(), expected["poses"].size());
  for (std::size_t i = 0; i < occurrences.size(); ++i) {
    const json& want = expected["poses"][i];
    EXPECT_EQ(occurrences[i]["path"], want["occurrence"]);
    const auto q = occurrences[i]["rotation_wxyz"].get<std::array<double, 4>>();
    const auto r = want["rotation_wxyz"].get<std::array<double, 4>>();
    const Quat is(q[0], q[1], q[2], q[3]);
    EXPECT_LT(spatial::RotationBetween(Quat(r[0], r[1], r[2], r[3]), is).norm(), 1e-9);
    for (std::size_t c = 0; c < 3; ++c) {  // 1e-9 m.
      EXPECT_NEAR(occurrences[i]["position_mm"][c].get<double>(),
                  want["position_mm"][c].get<double>(), 1e-6);
    }
  }
}

TEST(ExportPosesReleaseTest, ComeBackFromStepAndJson) {
  for (const char* name : {"gear_pump", "frame_500"}) {  // With subassemblies used many times.
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    const std::string file = ProductFile(name);
    const json poses = MakePoses(RunHvasJson({"inspect", file})["occurrences"]);
    const std::string given = folder.Write("poses.json", poses.dump(1)).string();
    const std::string step = (folder / "moved.step").string();
    const std::string text = (folder / "moved.json").string();
    for (const std::string& output : {step, text}) {
      const Ran ran = RunHvas({"export", file, "-o", output, "--poses", given});
      ASSERT_EQ(ran.status, 0) << ran.err;
    }
    ExpectPoses(poses, RunHvasJson({"inspect", step})["occurrences"]);
    ExpectPoses(poses, json::parse(ReadText(text))["occurrences"]);
  }
}

TEST(ExportPoses, OfARecordAreWherePartsWereLetGo) {
  const TemporaryFolder folder;
  const std::string file = ProductFile("bushing");
  const std::string record = (folder / "run.hvasrec").string();
  ASSERT_EQ(RunHvas({"assemble", file, "--record", record}).status, 0);
  const std::string moved = (folder / "moved.json").string();
  const Ran ran = RunHvas({"export", file, "-o", moved, "--poses", record});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json after = json::parse(ReadText(moved))["occurrences"];
  const json drawn = RunHvasJson({"inspect", file})["occurrences"];
  ASSERT_EQ(after.size(), drawn.size());
  for (std::size_t i = 0; i < after.size(); ++i) {  // Every part is in its place.
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(after[i]["position_mm"][c].get<double>(),
                  drawn[i]["position_mm"][c].get<double>(), 1e-3);
    }
  }
  const Ran other = RunHvas(
      {"export", ProductFile("gear_pump"), "-o", (folder / "x.json").string(), "--poses", record});
  EXPECT_EQ(other.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "another product", other.err);
}

TEST(ExportPoses, ErrorsNameTheLine) {
  const TemporaryFolder folder;
  const auto expect = [&folder](const std::string& entry, const std::string& error) {
    const auto file =
        folder.Write("p.json", "{\"format\": \"hvas-poses-1\",\n\"poses\": [\n" + entry + "]}\n");
    const std::string output = (folder / "x.json").string();
    const Ran ran =
        RunHvas({"export", ProductFile("bushing"), "-o", output, "--poses", file.string()});
    EXPECT_EQ(ran.status, 1);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, error, ran.err);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "p.json:3", ran.err);
    EXPECT_FALSE(std::filesystem::exists(output));
  };
  expect(R"({"occurrence": "no such part"})", "no such part");
  expect(R"({"occurrence": "o0", "position_mm": [1, 2]})", "position_mm");
  expect(R"({"occurrence": "o0", "rotation_wxyz": [1, 1, 0, 0]})", "quaternion");
  expect(R"({"occurrence": "o0", "angle": 3})", "\"angle\"");
  expect(R"({"occurrence": "o0"}, {"occurrence": "o0"})", "twice");
}

TEST(ExportForSimulators, WritesEachFormatAndTheSameBytesTwice) {
  const TemporaryFolder folder;
  for (const char* format : {"mjcf", "xml", "urdf", "usda"}) {
    const std::string file = (folder / (std::string("rig.") + format)).string();
    const std::string product = ProductFile("bushing");
    ASSERT_EQ(RunHvas({"export", product, "-o", file, "-q"}).status, 0) << format;
    const std::string first = ReadText(file);
    EXPECT_NE(first.find("H7/g6"), std::string::npos) << format;
    ASSERT_EQ(RunHvas({"export", product, "-o", file, "-q", "--force"}).status, 0) << format;
    EXPECT_EQ(ReadText(file), first) << format;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "rig_meshes/part0.stl"));
}

TEST(ExportDemonstrations, OfARecordAndOfAPlan) {
  const TemporaryFolder folder;
  const std::string record = (folder / "run.hvasrec").string();
  const std::string rig = ProductFile("bushing");
  ASSERT_EQ(RunHvas({"assemble", rig, "--record", record, "-q"}).status, 0);
  for (const std::string& input : {record, rig}) {
    const std::string file = (folder / "demonstrations.h5").string();
    const Ran ran = RunHvas(
        {"export", input, "-o", file, "--demonstrations", "--every", "20", "--force", "-q"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ReadText(file).substr(1, 3), "HDF");
    const std::string mcap = (folder / "demonstrations.mcap").string();
    ASSERT_EQ(
        RunHvas({"export", input, "-o", mcap, "--demonstrations", "--every", "20", "--force", "-q"})
            .status,
        0);
    EXPECT_EQ(ReadText(mcap).substr(1, 4), "MCAP");
  }
  const Ran refused =
      RunHvas({"export", record, "-o", (folder / "x.csv").string(), "--demonstrations"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, ".h5", refused.err);
}

TEST(ExportErrorTest, NothingIsWrittenOverOrHalf) {
  const TemporaryFolder folder;
  const auto letter = folder.Write("letter.glb", "Dear all,\n");
  const auto expect = [](const std::string& output, const std::string& text,
                         const std::string& input) {
    const Ran ran = RunHvas({"export", input, "-o", output});
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.out, "");
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, ran.err);
  };
  const std::string rig = ProductFile("bushing");
  expect(letter.string(), "--force", rig);
  EXPECT_EQ(ReadText(letter), "Dear all,\n");
  expect((folder / "rig.obj").string(), ".glb, .json, .step, .mjcf", rig);
  expect((folder / "rig").string(), ".glb, .json, .step, .mjcf", rig);
  expect((folder / "no" / "rig.glb").string(), "folder", rig);
  expect(rig, "the output is the input file", rig);
  expect((folder / "x.glb").string(), "letter.glb", letter.string());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace hvas::app
