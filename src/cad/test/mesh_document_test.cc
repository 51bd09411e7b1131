#include "cad/scene/mesh_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/test/temporary_folder.h"
#include "base/units.h"
#include "cad/scene/model_3mf.h"
#include "cad/test/mesh_fixture.h"
#include "cad/test/step_fixture.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::FeatureKind;
using product::Part;
using product::Product;
using testing::CountCode;
using testing::ProfilePoint;

void WriteFile(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

Result<Product> Read(const std::filesystem::path& path, Diagnostics* diagnostics,
                     ImportOptions options = {}) {
  return ReadCad(path, options, diagnostics);
}

/** A bush: outer diameter 20, bore 8, length 12 mm, by 24 segments. */
TriangleSoup MakeBush() {
  return testing::Revolve({{4e-3, 0}, {10e-3, 0}, {10e-3, 12e-3}, {4e-3, 12e-3}}, 24, true);
}

std::string ToObj(const TriangleSoup& soup, std::size_t first_vertex, const std::string& head) {
  std::string text = head;
  for (const Vec3& v : soup.vertices) {
    text += fmt::format("v {:.7f} {:.7f} {:.7f}\n", units::ToMm(v.x()), units::ToMm(v.y()),
                        units::ToMm(v.z()));
  }
  for (const Triangle& t : soup.triangles) {
    text +=
        fmt::format("f {} {} {}\n", first_vertex + t[0], first_vertex + t[1], first_vertex + t[2]);
  }
  return text;
}

std::string ToAsciiStl(const TriangleSoup& soup, const std::string& name) {
  std::string text = "solid " + name + "\n";
  for (const Triangle& t : soup.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) {
      const Vec3 p = 1e3 * soup.vertices[v];
      text += fmt::format("vertex {:.6e} {:.6e} {:.6e}\n", p.x(), p.y(), p.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

template <typename T>
void Put(T value, std::string* bytes) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes->append(raw.data(), raw.size());
}

std::string ToBinaryStl(const TriangleSoup& soup) {
  std::string bytes(80, ' ');
  Put(static_cast<std::uint32_t>(soup.triangles.size()), &bytes);
  for (const Triangle& t : soup.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t v : t) {
      for (int k = 0; k < 3; ++k) {
        Put(static_cast<float>(units::ToMm(soup.vertices[v][k])), &bytes);
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

/** A buffer with the vertices [m] and the indices of a mesh, as glTF wants them. */
std::string ToBuffer(const TriangleSoup& soup) {
  std::string bytes;
  for (const Vec3& v : soup.vertices) {
    for (int k = 0; k < 3; ++k) {
      Put(static_cast<float>(v[k]), &bytes);
    }
  }
  for (const Triangle& t : soup.triangles) {
    for (const std::uint32_t v : t) {
      Put(v, &bytes);
    }
  }
  return bytes;
}

/** glTF with one mesh; `nodes` is the JSON of the nodes, the first of which is the scene's root. */
std::string ToGltf(const TriangleSoup& soup, const std::string& uri, const std::string& nodes) {
  spatial::Box box;
  for (const Vec3& v : soup.vertices) {
    box.Add(v);
  }
  const std::size_t vertex_bytes = 12 * soup.vertices.size();
  const std::size_t index_bytes = 12 * soup.triangles.size();
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],)"
      R"("meshes":[{{"name":"bush","primitives":[{{"attributes":{{"POSITION":0}},"indices":1,)"
      R"("material":0}}]}}],)"
      R"("materials":[{{"name":"red","pbrMetallicRoughness":{{"baseColorFactor":[0.5,0,0,1]}}}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3",)"
      R"("min":[{},{},{}],"max":[{},{},{}]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{"byteLength":{}{}}}]}})",
      nodes, soup.vertices.size(), box.low.x(), box.low.y(), box.low.z(), box.high.x(),
      box.high.y(), box.high.z(), 3 * soup.triangles.size(), vertex_bytes, vertex_bytes,
      index_bytes, vertex_bytes + index_bytes,
      uri.empty() ? "" : fmt::format(R"(,"uri":"{}")", uri));
}

std::string ToGlb(const TriangleSoup& soup, const std::string& nodes) {
  std::string json = ToGltf(soup, "", nodes);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = ToBuffer(soup);
  std::string bytes = "glTF";
  Put(std::uint32_t{2}, &bytes);
  Put(static_cast<std::uint32_t>(28 + json.size() + buffer.size()), &bytes);
  Put(static_cast<std::uint32_t>(json.size()), &bytes);
  bytes += "JSON" + json;
  Put(static_cast<std::uint32_t>(buffer.size()), &bytes);
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

/** A ZIP archive of stored entries. */
std::string ToZip(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string bytes;
  std::string directory;
  for (const auto& [name, data] : entries) {
    const auto offset = static_cast<std::uint32_t>(bytes.size());
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size())));
    std::string common;
    Put(std::uint16_t{20}, &common);
    common.append(8, '\0');  // Flags, method, time, date.
    Put(crc, &common);
    Put(static_cast<std::uint32_t>(data.size()), &common);
    Put(static_cast<std::uint32_t>(data.size()), &common);
    Put(static_cast<std::uint16_t>(name.size()), &common);
    Put(std::uint16_t{0}, &common);
    bytes += std::string("PK\x03\x04", 4) + common + name + data;
    directory += std::string("PK\x01\x02", 4) + std::string("\x14\0", 2) + common;
    directory.append(10, '\0');  // Comment, disk, attributes.
    Put(offset, &directory);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(bytes.size());
  bytes += directory + std::string("PK\x05\x06\0\0\0\0", 8);
  Put(static_cast<std::uint16_t>(entries.size()), &bytes);
  Put(static_cast<std::uint16_t>(entries.size()), &bytes);
  Put(static_cast<std::uint32_t>(directory.size()), &bytes);
  Put(start, &bytes);
  bytes.append(2, '\0');
  return bytes;
}

std::string To3mf(const TriangleSoup& soup, const std::string& unit, double unit_metres) {
  std::string model = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n"
      "<object id=\"7\" name=\"B\xC3\xBC"
      "chse &amp; Co\" type=\"model\"><mesh><vertices>\n",
      unit);
  for (const Vec3& v : soup.vertices) {
    model += fmt::format("<vertex x=\"{:.9g}\" y=\"{:.9g}\" z=\"{:.9g}\"/>\n", v.x() / unit_metres,
                         v.y() / unit_metres, v.z() / unit_metres);
  }
  model += "</vertices><triangles>\n";
  for (const Triangle& t : soup.triangles) {
    model += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0], t[1], t[2]);
  }
  const double shift = 0.03 / unit_metres;
  model += fmt::format(
      "</triangles></mesh></object></resources>\n<build><item objectid=\"7\"/>"
      "<item objectid=\"7\" transform=\"0 1 0 -1 0 0 0 0 1 {:.9g} 0 0\"/></build></model>\n",
      shift);
  return ToZip(
      {{"[Content_Types].xml",
        "<?xml version=\"1.0\"?><Types "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"></Types>"},
       {"_rels/.rels",
        "<?xml version=\"1.0\"?><Relationships "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
        "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
       {"3D/3dmodel.model", model}});
}

/** A bush has its bore and its shaft, whatever it was read from. */
void ExpectBush(const Part& part) {
  ASSERT_EQ(part.faces.size(), 4U);
  EXPECT_FALSE(part.has_brep);
  EXPECT_EQ(part.solid_count, 1);
  const auto feature = [&part](FeatureKind kind) {
    return std::find_if(part.features.begin(), part.features.end(),
                        [kind](const product::Feature& f) { return f.kind == kind; });
  };
  ASSERT_NE(feature(FeatureKind::kHole), part.features.end());
  ASSERT_NE(feature(FeatureKind::kShaft), part.features.end());
  EXPECT_NEAR(feature(FeatureKind::kHole)->radius, 4e-3, 50e-9);
  EXPECT_NEAR(feature(FeatureKind::kShaft)->radius, 10e-3, 50e-9);
  const double ring = 12 * std::sin(2 * std::numbers::pi / 24);  // Over r^2, of 24 triangles.
  EXPECT_NEAR(part.mass.volume, ring * (100e-6 - 16e-6) * 12e-3, 1e-12);
}

TEST(MeshDocument, ReadsTheSameBushFromStlObjGltfAnd3mf) {
  const TemporaryFolder folder;
  const TriangleSoup bush = MakeBush();
  const std::string node = R"({"name":"bush","mesh":0})";
  WriteFile(folder / "ascii.stl", ToAsciiStl(bush, "bush"));
  WriteFile(folder / "binary.stl", ToBinaryStl(bush));
  WriteFile(folder / "bush.obj", ToObj(bush, 1, ""));
  WriteFile(folder / "bush.glb", ToGlb(bush, node));
  WriteFile(folder / "bush.gltf", ToGltf(bush, "bush.bin", node));
  WriteFile(folder / "bush.bin", ToBuffer(bush));
  for (const char* name : {"ascii.stl", "binary.stl", "bush.obj", "bush.glb", "bush.gltf"}) {
    Diagnostics diagnostics;
    const auto product = Read(folder / name, &diagnostics);
    ASSERT_TRUE(product) << name << product.error().ToString();
    ASSERT_EQ(product->occurrences.size(), 1U) << name;
    ExpectBush(product->parts[0]);
    EXPECT_EQ(diagnostics.Count(Severity::kWarning), 0) << name;
    const bool is_unitless = std::string(name).find(".gl") == std::string::npos;
    EXPECT_EQ(CountCode(diagnostics, "assumed-unit"), is_unitless ? 1 : 0) << name;
    // glTF is y up: its y axis became z, its z axis -y.
    const Vec3 up = product->occurrences[0].X_WB.q() * Vec3::UnitZ();
    EXPECT_LT((up - (is_unitless ? Vec3::UnitZ() : Vec3(-Vec3::UnitY()))).norm(), 1e-6) << name;
  }
}

TEST(MeshDocument, Reads3mfInItsOwnUnitWithItsNamesAndSharedParts) {
  const TemporaryFolder folder;
  for (const auto& [unit, metres] : std::map<std::string, double>{
           {"millimeter", 1e-3}, {"inch", 0.0254}, {"micron", 1e-6}, {"meter", 1}}) {
    WriteFile(folder / "bush.3mf", To3mf(MakeBush(), unit, metres));
    Diagnostics diagnostics;
    const auto product = Read(folder / "bush.3mf", &diagnostics);
    ASSERT_TRUE(product) << product.error().ToString();
    ASSERT_EQ(product->parts.size(), 1U);
    ASSERT_EQ(product->occurrences.size(), 2U);
    ExpectBush(product->parts[0]);
    EXPECT_EQ(product->parts[0].name,
              "B\xC3\xBC"
              "chse & Co");
    const spatial::Pose& X_WB = product->occurrences[1].X_WB;
    EXPECT_LT((X_WB.p() - Vec3(0.03, 0, 0)).norm(), 1e-8);
    EXPECT_LT((X_WB.q() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-6);
  }
}

TEST(MeshDocument, TakesTheUnitThatTheUserStates) {
  const TemporaryFolder folder;
  WriteFile(folder / "bush.stl", ToBinaryStl(MakeBush()));
  ImportOptions options;
  options.length_unit = 0.0254;
  Diagnostics diagnostics;
  const auto product = Read(folder / "bush.stl", &diagnostics, options);
  ASSERT_TRUE(product);
  EXPECT_NEAR(product->box_W.size().x(), 20e-3 * 25.4, 1e-6);
}

TEST(MeshDocument, TurnsNodesIntoSubassembliesAndWorksMirrorsIntoParts) {
  const TemporaryFolder folder;
  const std::string nodes = R"({"name":"machine","children":[1,3]},)"
                            R"({"name":"left","children":[2],"translation":[0,0.1,0]},)"
                            R"({"name":"bush","mesh":0,"translation":[0.05,0,0]},)"
                            R"({"name":"right","children":[4,5,6]},)"
                            R"({"name":"bush","mesh":0},{"name":"bush","mesh":0,"scale":[-1,1,1]},)"
                            R"({"name":"lamp"})";
  WriteFile(folder / "machine.glb", ToGlb(MakeBush(), nodes));
  Diagnostics diagnostics;
  const auto product = Read(folder / "machine.glb", &diagnostics);
  ASSERT_TRUE(product) << product.error().ToString();
  ASSERT_EQ(product->occurrences.size(), 3U);
  EXPECT_EQ(product->parts.size(), 2U);  // One of them mirrored.
  EXPECT_EQ(product->subassemblies.size(), 3U);
  EXPECT_EQ(product->occurrences[0].path, "machine/left/bush");
  EXPECT_EQ(product->occurrences[2].path, "machine/right/bush#2");
  // y up in the file: (0.05, 0.1, 0) is (0.05, 0, 0.1) here.
  EXPECT_LT((product->occurrences[0].X_WB.p() - Vec3(0.05, 0, 0.1)).norm(), 1e-7);
  for (const Part& part : product->parts) {
    ExpectBush(part);
  }
  EXPECT_EQ(CountCode(diagnostics, "baked-scale"), 1);
  // Linear 0.5 is 0.735 in sRGB.
  EXPECT_NEAR(product->parts[0].color.r, 0.735, 0.001);
  EXPECT_EQ(product->parts[0].color.g, 0);
}

TEST(MeshDocument, TakesNamesOfLooksForMaterialsWhereTheyNameOne) {
  const TemporaryFolder folder;
  const TriangleSoup bush = MakeBush();
  WriteFile(folder / "looks.mtl",
            "newmtl Aluminium\nKd 0.8 0.8 0.8\nnewmtl Red\nKd 1 0 0\nnewmtl PTFE.001\nKd 1 1 1\n");
  const std::map<std::string, std::pair<std::string, double>> expected{
      {"Aluminium", {"Aluminium", 2700}}, {"Red", {"", 7850}}, {"PTFE.001", {"PTFE.001", 2180}}};
  for (const auto& [look, material] : expected) {
    WriteFile(folder / "bush.obj", ToObj(bush, 1, "mtllib looks.mtl\nusemtl " + look + "\n"));
    Diagnostics diagnostics;
    const auto product = Read(folder / "bush.obj", &diagnostics);
    ASSERT_TRUE(product) << product.error().ToString();
    const Part& part = product->parts[0];
    EXPECT_EQ(part.material.name, material.first);
    EXPECT_NEAR(part.material.density, material.second, 30) << look;
    EXPECT_NEAR(part.mass.mass, part.material.density * part.mass.volume, 1e-9);
    EXPECT_EQ(part.material.is_standard_assumed, material.first.empty()) << look;
  }
}

TEST(MeshDocument, TakesClosedObjObjectsForPartsAndOpenGroupsForFaces) {
  const TemporaryFolder folder;
  const TriangleSoup bush = MakeBush();
  TriangleSoup other = testing::MakeBox({0.02, 0.02, 0.005});
  testing::Move({Quat::Identity(), Vec3(0, 0, 0.012)}, &other);
  WriteFile(folder / "two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  WriteFile(folder / "two.obj", ToObj(bush, 1, "mtllib two.mtl\no K\xC3\xA4se\nusemtl red\n") +
                                    ToObj(other, 1 + bush.vertices.size(), "o lid\nusemtl blue\n"));
  Diagnostics diagnostics;
  const auto two = Read(folder / "two.obj", &diagnostics);
  ASSERT_TRUE(two) << two.error().ToString();
  ASSERT_EQ(two->parts.size(), 2U);
  EXPECT_EQ(two->parts[0].name, "K\xC3\xA4se");
  EXPECT_EQ(two->parts[1].name, "lid");
  EXPECT_EQ(two->parts[0].color.r, 1);
  EXPECT_EQ(two->parts[1].color.b, 1);
  EXPECT_EQ(diagnostics.Count(Severity::kWarning), 0);

  // Every face of a box in a group of its own.
  std::string grouped;
  const TriangleSoup box = testing::MakeBox({0.02, 0.02, 0.005});
  for (std::size_t i = 0; i < box.triangles.size(); i += 2) {
    TriangleSoup face = box;
    face.triangles = {box.triangles[i], box.triangles[i + 1]};
    grouped += ToObj(face, 1 + i / 2 * box.vertices.size(), fmt::format("g face{}\n", i / 2));
  }
  WriteFile(folder / "grouped.obj", grouped);
  const auto one = Read(folder / "grouped.obj", &diagnostics);
  ASSERT_TRUE(one) << one.error().ToString();
  ASSERT_EQ(one->parts.size(), 1U);
  EXPECT_EQ(one->parts[0].name, "grouped");
  EXPECT_EQ(one->parts[0].solid_count, 1);
  EXPECT_EQ(one->parts[0].faces.size(), 6U);
  EXPECT_EQ(CountCode(diagnostics, "joined-groups"), 1);
}

TEST(MeshDocument, ReadsSeveralSolidsOfAnStl) {
  const TemporaryFolder folder;
  TriangleSoup other = MakeBush();
  testing::Move({Quat::Identity(), Vec3(0.05, 0, 0)}, &other);
  WriteFile(folder / "two.stl", ToAsciiStl(MakeBush(), "first") + ToAsciiStl(other, "second"));
  Diagnostics diagnostics;
  const auto product = Read(folder / "two.stl", &diagnostics);
  ASSERT_TRUE(product) << product.error().ToString();
  ASSERT_EQ(product->parts.size(), 2U);
  EXPECT_EQ(product->parts[0].name, "first");
  EXPECT_EQ(product->parts[1].name, "second");
  ExpectBush(product->parts[0]);
}

TEST(MeshDocument, ReportsWhatIsMissingAndReadsNothingOutsideItsFolder) {
  const TemporaryFolder folder;
  const TriangleSoup bush = MakeBush();
  const std::string node = R"({"name":"bush","mesh":0})";
  Diagnostics diagnostics;
  WriteFile(folder / "bush.obj", ToObj(bush, 1, "mtllib gone.mtl\n"));
  ASSERT_TRUE(Read(folder / "bush.obj", &diagnostics));
  EXPECT_GE(CountCode(diagnostics, "missing-file"), 1);

  WriteFile(folder / "lost.gltf", ToGltf(bush, "lost.bin", node));
  const auto lost = Read(folder / "lost.gltf", &diagnostics);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::kNotFound);
  EXPECT_NE(lost.error().message.find("lost.bin"), std::string::npos);

  // The buffer is there, but one folder up, or wherever a link leads.
  std::filesystem::create_directory(folder / "inner");
  WriteFile(folder / "secret.bin", ToBuffer(bush));
  std::filesystem::create_symlink(folder / "secret.bin", folder / "inner" / "link.bin");
  for (const std::string& uri :
       {std::string("../secret.bin"), (folder / "secret.bin").string(), std::string("link.bin"),
        std::string("http://localhost/secret.bin")}) {
    WriteFile(folder / "inner" / "hostile.gltf", ToGltf(bush, uri, node));
    const auto hostile = Read(folder / "inner" / "hostile.gltf", &diagnostics);
    EXPECT_FALSE(hostile) << uri;
  }
}

TEST(MeshDocument, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  const std::map<std::string, std::string> files{
      {"empty.obj", "# nothing\n"},
      {"points.obj", "v 0 0 0\nv 1 0 0\np 1 2\n"},
      {"cut.stl", ToBinaryStl(MakeBush()).substr(0, 700)},
      {"cut.glb", ToGlb(MakeBush(), R"({"mesh":0})").substr(0, 900)},
      {"cut.3mf", To3mf(MakeBush(), "millimeter", 1e-3).substr(0, 900)},
      {"flat.stl",
       "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 "
       "0 0\nendloop\nendfacet\nendsolid x\n"},
      {"poem.txt", "v as in very\n"}};
  for (const auto& [name, bytes] : files) {
    WriteFile(folder / name, bytes);
    Diagnostics diagnostics;
    const auto product = Read(folder / name, &diagnostics);
    ASSERT_FALSE(product) << name;
    EXPECT_EQ(product.error().where, name);
    EXPECT_FALSE(product.error().remedy.empty()) << name;
  }
}

TEST(Model3mf, ReadsUnitAndNamesFromAnyText) {
  EXPECT_EQ(ParseModel3mf("").length_unit, 1e-3);
  EXPECT_EQ(ParseModel3mf("<model unit='foot'>").length_unit, 0.3048);
  EXPECT_FALSE(ParseModel3mf("<model unit=\"furlong\">").is_unit_known);
  EXPECT_EQ(ParseModel3mf("<modelx unit='foot'/><model xml:lang='en'>").length_unit, 1e-3);
  const Model3mf model = ParseModel3mf(
      "<model unit = \"inch\"><objects/><object id='3' name='a &lt; b'/><object id='x' name='y'/>"
      "<object name='lost' id=");
  EXPECT_EQ(model.length_unit, 0.0254);
  ASSERT_EQ(model.names.size(), 1U);
  EXPECT_EQ(model.names.at(3), "a < b");
}

TEST(MeshFolder, IsAProductWithAPartForEachFile) {
  const TemporaryFolder folder;
  const std::filesystem::path inner = folder.path() / "cart";
  std::filesystem::create_directories(inner);
  WriteFile(inner / "10.obj", ToObj(MakeBush(), 1, ""));
  WriteFile(inner / "2.OBJ", ToObj(testing::MakeBox({0.02, 0.03, 0.04}), 1, ""));
  WriteFile(inner / "2.stl", "solid of the same part\n");  // The same part in another format.
  WriteFile(inner / "axle.stl", "no mesh at all");
  WriteFile(inner / "notes.txt", "not a part");
  for (const std::filesystem::path& path : {inner, folder.path()}) {  // The only folder in it.
    Diagnostics diagnostics;
    const auto product = Read(path, &diagnostics);
    ASSERT_TRUE(product) << product.error().ToString();
    EXPECT_EQ(product->name, "cart");
    ASSERT_EQ(product->occurrences.size(), 2u);
    EXPECT_EQ(product->occurrences[0].path, "cart/2");
    EXPECT_EQ(product->occurrences[1].path, "cart/10");
    EXPECT_NEAR(product->parts[0].mass.volume, 24e-6, 1e-9);
    EXPECT_EQ(CountCode(diagnostics, "assumed-unit"), 1);
    EXPECT_EQ(CountCode(diagnostics, "part-skipped"), 1);
  }
}

TEST(MeshFolder, WithoutMeshesOrWithSeveralFoldersOfThemSaysWhatToChoose) {
  const TemporaryFolder folder;
  Diagnostics diagnostics;
  const auto empty = Read(folder.path(), &diagnostics);
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("no mesh files are in it"), std::string::npos);
  for (const char* name : {"a", "b"}) {
    std::filesystem::create_directories(folder.path() / name);
    WriteFile(folder.path() / name / "0.obj", ToObj(MakeBush(), 1, ""));
  }
  const auto several = Read(folder.path(), &diagnostics);
  ASSERT_FALSE(several);
  EXPECT_NE(several.error().remedy.find("/a"), std::string::npos);
}

}  // namespace
}  // namespace hvas::cad
