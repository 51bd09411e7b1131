// The ways of parts as glTF 2.0 (the specification's names and numbers).

#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/bytes.h"
#include "base/glb_container.h"
#include "evidence/holds.h"
#include "evidence/output_file.h"
#include "evidence/tables.h"
#include "session/recorded_model.h"

namespace hvas::evidence {
namespace {

using Json = nlohmann::ordered_json;

// OpenGL has these numbers, and glTF 2.0 with it.
constexpr int kFloat = 5126;
constexpr int kArrayBuffer = 34962;
constexpr int kLineStrip = 3;

class PathGlb {
 public:
  PathGlb() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "HVAS"}};
    json_["scene"] = 0;
    // A root turns z up into y up.
    const double half = std::sqrt(0.5);
    json_["nodes"] = {{{"name", "paths"}, {"rotation", {-half, 0, 0, half}}}};
    json_["scenes"] = {{{"nodes", {0}}}};
    json_["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.04, 0.13, 0.55, 1}}}},
                           {"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
    json_["extensionsUsed"] = {"KHR_materials_unlit"};
  }

  void Add(const Hold& hold, const std::string& name) {
    if (hold.points.size() < 2) {
      return;
    }
    std::array<float, 3> low{INFINITY, INFINITY, INFINITY};
    std::array<float, 3> high{-INFINITY, -INFINITY, -INFINITY};
    for (const Vec3& p : hold.points) {
      std::array<float, 3> xyz{};
      for (std::size_t k = 0; k < 3; ++k) {
        xyz[k] = static_cast<float>(p[static_cast<Eigen::Index>(k)]);
        low[k] = std::min(low[k], xyz[k]);
        high[k] = std::max(high[k], xyz[k]);
      }
      positions_.Plain(xyz.data(), xyz.size());
    }
    const std::size_t index = json_["accessors"].size();
    json_["accessors"].push_back({{"bufferView", 0},
                                  {"byteOffset", sizeof(float) * 3 * points_},
                                  {"componentType", kFloat},
                                  {"count", hold.points.size()},
                                  {"type", "VEC3"},
                                  {"min", low},
                                  {"max", high}});
    points_ += hold.points.size();
    json_["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", index}}}, {"material", 0}, {"mode", kLineStrip}}}}});
    json_["nodes"].push_back({{"name", name},
                              {"mesh", index},
                              {"extras",
                               {{"occurrence", hold.occurrence},
                                {"hand", hold.hand},
                                {"start_s", 1e-9 * static_cast<double>(hold.start_ns)},
                                {"end_s", 1e-9 * static_cast<double>(hold.end_ns)},
                                {"path_m", hold.path},
                                {"seated", hold.is_seated}}}});
    json_["nodes"][0]["children"].push_back(index + 1);
  }

  Result<std::string> Pack() {
    const std::string_view positions(reinterpret_cast<const char*>(positions_.bytes().data()),
                                     positions_.bytes().size());
    if (!positions.empty()) {
      const std::size_t size = positions.size();
      json_["buffers"] = {{{"byteLength", size}}};
      json_["bufferViews"] = {{{"buffer", 0}, {"byteLength", size}, {"target", kArrayBuffer}}};
    }
    return PackGlb(json_.dump(-1, ' ', false, Json::error_handler_t::replace), positions);
  }

 private:
  Json json_;
  ByteWriter positions_;
  std::size_t points_{0};
};

}  // namespace

Result<void> WritePathGlb(record::Reader* reader, const Selection& selection,
                          const std::filesystem::path& file) {
  const auto product = session::FindProduct(reader);
  if (!product) {
    return Unexpected(product.error());
  }
  const auto holds = FindHolds(reader, selection.span, MakeCentres(*product));
  if (!holds) {
    return Unexpected(holds.error());
  }
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  const std::vector<std::string> paths = ReadPaths(*reader);
  PathGlb glb;
  for (const Hold& hold : *holds) {
    glb.Add(hold, NameOf(paths, hold.occurrence));
  }
  const auto bytes = glb.Pack();
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  output->Write(*bytes);
  return output->Finish();
}

}  // namespace hvas::evidence
