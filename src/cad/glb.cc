#include "cad/glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/glb_container.h"

namespace hvas::cad {
namespace {

using Json = nlohmann::ordered_json;
using product::Color;
using product::Part;
using product::Product;

// Numbers that the glTF 2.0 specification gives.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

/** The kinds of numbers, each in a buffer view of its own; sizes are multiples of 4 bytes. */
enum View { kPositions, kNormals, kFaceIds, kIndices, kMotions, kViewCount };

template <typename T>
void Append(const T& value, std::string* bytes) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes->append(raw.data(), raw.size());
}

/** Triangles of faces with one colour. */
struct Primitive {
  std::vector<Vec3> vertices;
  std::vector<Vec3> normals;  // Sums of triangles' areas; not yet unit.
  std::vector<float> face_ids;
  std::vector<std::uint32_t> indices;
};

using ColorKey = std::tuple<float, float, float>;

/** sRGB to linear, as glTF wants factors (IEC 61966-2-1). */
double ToLinear(float channel) {
  const double c = std::clamp(static_cast<double>(channel), 0.0, 1.0);
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

class GlbBuilder {
 public:
  GlbBuilder(const Product& product, bool is_fine)
      : product_(product), is_fine_(is_fine), node_of_(product.occurrences.size(), -1) {}

  Result<std::string> Build(const std::vector<GlbMotion>& motions) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "HVAS"}};
    json_["scene"] = 0;
    json_["scenes"] = {{{"name", product_.name}, {"nodes", {0}}}};
    json_["nodes"] = Json::array();
    for (const Part& part : product_.parts) {
      AddMesh(part);
    }
    AddNode(product::SubassemblyId(0), /*is_root=*/true);
    for (const GlbMotion& motion : motions) {
      AddMotion(motion);
    }
    return Assemble();
  }

 private:
  void AddFace(const product::Mesh& mesh, std::size_t face, std::uint32_t first,
               std::uint32_t count, Primitive* primitive) {
    std::map<std::uint32_t, std::uint32_t> own;  // Vertices of this face in the primitive.
    for (std::uint32_t t = first; t < first + count && t < mesh.triangles.size(); ++t) {
      const auto& triangle = mesh.triangles[t];
      const Vec3& p0 = mesh.vertices[triangle[0]];
      const Vec3 normal = (mesh.vertices[triangle[1]] - p0).cross(mesh.vertices[triangle[2]] - p0);
      for (const std::uint32_t vertex : triangle) {
        const auto [entry, is_new] =
            own.emplace(vertex, static_cast<std::uint32_t>(primitive->vertices.size()));
        if (is_new) {
          primitive->vertices.push_back(mesh.vertices[vertex]);
          primitive->normals.emplace_back(Vec3::Zero());
          primitive->face_ids.push_back(static_cast<float>(face));
        }
        primitive->normals[entry->second] += normal;
        primitive->indices.push_back(entry->second);
      }
    }
  }

  void AddMesh(const Part& part) {
    const bool is_display = !is_fine_ && !part.display_mesh.triangles.empty();
    const product::Mesh& mesh = is_display ? part.display_mesh : part.mesh;
    std::vector<std::pair<Color, Primitive>> primitives;
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
      const product::Face& face = part.faces[i];
      const Color color = face.color.value_or(part.color);
      auto found = std::find_if(primitives.begin(), primitives.end(), [&](const auto& entry) {
        return KeyOf(entry.first) == KeyOf(color);
      });
      if (found == primitives.end()) {
        primitives.emplace_back(color, Primitive());
        found = primitives.end() - 1;
      }
      AddFace(mesh, i, is_display ? face.first_display_triangle : face.first_triangle,
              is_display ? face.display_triangle_count : face.triangle_count, &found->second);
    }
    Json json{{"name", part.name}, {"primitives", Json::array()}};
    json["extras"] = {{"part", part.id.value()},
                      {"face_count", part.faces.size()},
                      {"shape_hash", part.shape_hash}};
    for (const auto& [color, primitive] : primitives) {
      if (!primitive.indices.empty()) {
        json["primitives"].push_back(AddPrimitive(primitive, MaterialOf(color)));
      }
    }
    mesh_of_part_.push_back(-1);
    if (!json["primitives"].empty()) {  // glTF wants at least one.
      mesh_of_part_.back() = static_cast<int>(json_["meshes"].size());
      json_["meshes"].push_back(std::move(json));
    }
  }

  static ColorKey KeyOf(const Color& color) { return {color.r, color.g, color.b}; }

  std::size_t MaterialOf(const Color& color) {
    const auto [entry, is_new] = materials_.emplace(KeyOf(color), materials_.size());
    if (is_new) {
      // Both sides are shown: parts of shells only have no inside.
      json_["materials"].push_back(
          {{"pbrMetallicRoughness",
            {{"baseColorFactor", {ToLinear(color.r), ToLinear(color.g), ToLinear(color.b), 1.0}},
             {"metallicFactor", 0.1},
             {"roughnessFactor", 0.6}}},
           {"doubleSided", true}});
    }
    return entry->second;
  }

  std::size_t AddAccessor(View view, int component, const char* type, std::size_t count,
                          std::size_t offset) {
    json_["accessors"].push_back({{"bufferView", view},
                                  {"byteOffset", offset},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }

  std::size_t AddVectors(View view, const std::vector<Vec3>& vectors, bool has_limits) {
    std::string& bytes = views_[view];
    const std::size_t offset = bytes.size();
    std::array<float, 3> low;
    low.fill(std::numeric_limits<float>::infinity());
    std::array<float, 3> high;
    high.fill(-std::numeric_limits<float>::infinity());
    for (const Vec3& vector : vectors) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto value = static_cast<float>(vector[static_cast<Eigen::Index>(i)]);
        low[i] = std::min(low[i], value);
        high[i] = std::max(high[i], value);
        Append(value, &bytes);
      }
    }
    const std::size_t accessor = AddAccessor(view, kFloat, "VEC3", vectors.size(), offset);
    if (has_limits) {
      // As doubles: they have to be the very numbers of the buffer.
      json_["accessors"][accessor]["min"] = std::array<double, 3>{low[0], low[1], low[2]};
      json_["accessors"][accessor]["max"] = std::array<double, 3>{high[0], high[1], high[2]};
    }
    return accessor;
  }

  Json AddPrimitive(const Primitive& primitive, std::size_t material) {
    std::vector<Vec3> normals = primitive.normals;
    for (Vec3& normal : normals) {
      const double length = normal.norm();
      normal = length > 0 ? Vec3(normal / length) : Vec3::UnitZ();
    }
    Json attributes{{"POSITION", AddVectors(kPositions, primitive.vertices, true)},
                    {"NORMAL", AddVectors(kNormals, normals, false)}};
    attributes["_FACE_ID"] =
        AddAccessor(kFaceIds, kFloat, "SCALAR", primitive.face_ids.size(), views_[kFaceIds].size());
    for (const float id : primitive.face_ids) {
      Append(id, &views_[kFaceIds]);
    }
    const std::size_t indices = AddAccessor(kIndices, kUnsignedInt, "SCALAR",
                                            primitive.indices.size(), views_[kIndices].size());
    for (const std::uint32_t index : primitive.indices) {
      Append(index, &views_[kIndices]);
    }
    return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material}};
  }

  /** Adds a subassembly with all below it. @returns its index. */
  std::size_t AddNode(product::SubassemblyId id, bool is_root) {
    const product::Subassembly& subassembly = product_.subassemblies[id.index()];
    const std::size_t index = json_["nodes"].size();
    Json node{{"name", subassembly.name}, {"extras", {{"subassembly", id.value()}}}};
    if (is_root) {
      const double half = std::sqrt(0.5);  // A quarter turn about x, backwards: z goes up to y.
      node["rotation"] = {-half, 0.0, 0.0, half};
    }
    json_["nodes"].push_back(std::move(node));
    Json children = Json::array();
    for (const product::SubassemblyId child : subassembly.subassemblies) {
      children.push_back(AddNode(child, false));
    }
    for (const product::OccurrenceId child : subassembly.occurrences) {
      children.push_back(AddLeaf(child));
    }
    if (!children.empty()) {
      json_["nodes"][index]["children"] = std::move(children);
    }
    return index;
  }

  std::size_t AddLeaf(product::OccurrenceId id) {
    const product::Occurrence& occurrence = product_.occurrences[id.index()];
    Json node{{"name", occurrence.name},
              {"extras",
               {{"occurrence", id.value()},
                {"part", occurrence.part.value()},
                {"path", occurrence.path}}}};
    const Vec3& p = occurrence.X_WB.p();
    const Quat q = occurrence.X_WB.q().normalized();
    node["translation"] = {p.x(), p.y(), p.z()};
    node["rotation"] = {q.x(), q.y(), q.z(), q.w()};
    if (mesh_of_part_[occurrence.part.index()] >= 0) {
      node["mesh"] = mesh_of_part_[occurrence.part.index()];
    }
    node_of_[id.index()] = static_cast<int>(json_["nodes"].size());
    json_["nodes"].push_back(std::move(node));
    return json_["nodes"].size() - 1;
  }

  std::size_t AddMotionNumbers(const std::vector<float>& numbers, const char* type,
                               std::size_t count) {
    std::string& bytes = views_[kMotions];
    const std::size_t accessor = AddAccessor(kMotions, kFloat, type, count, bytes.size());
    for (const float number : numbers) {
      Append(number, &bytes);
    }
    return accessor;
  }

  std::size_t AddTimes(const std::vector<float>& times) {
    const std::size_t accessor = AddMotionNumbers(times, "SCALAR", times.size());
    json_["accessors"][accessor]["min"] = {static_cast<double>(times.front())};
    json_["accessors"][accessor]["max"] = {static_cast<double>(times.back())};
    return accessor;
  }

  void AddChannel(int node, const char* path, std::size_t times, std::size_t values,
                  const char* interpolation) {
    Json& animation = json_["animations"][0];
    animation["samplers"].push_back(
        {{"input", times}, {"output", values}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  void AddMotion(const GlbMotion& motion) {
    const int node = node_of_[motion.occurrence.index()];
    if (node < 0 || motion.times_s.empty()) {
      return;
    }
    json_["animations"][0]["name"] = "assembly";
    std::vector<float> times;
    std::vector<float> places;
    std::vector<float> turns;
    for (std::size_t i = 0; i < motion.times_s.size(); ++i) {
      times.push_back(static_cast<float>(motion.times_s[i]));
      const Vec3& p = motion.X_WB[i].p();
      const Quat q = motion.X_WB[i].q().normalized();
      for (const double value : {p.x(), p.y(), p.z()}) {
        places.push_back(static_cast<float>(value));
      }
      for (const double value : {q.x(), q.y(), q.z(), q.w()}) {
        turns.push_back(static_cast<float>(value));
      }
    }
    const std::size_t at = AddTimes(times);
    AddChannel(node, "translation", at, AddMotionNumbers(places, "VEC3", times.size()), "LINEAR");
    AddChannel(node, "rotation", at, AddMotionNumbers(turns, "VEC4", times.size()), "LINEAR");
    if (motion.appears_s > 0) {
      // What is not there yet has no size: glTF 2.0 itself animates no visibility.
      const std::size_t seen = AddTimes({0.0F, static_cast<float>(motion.appears_s)});
      AddChannel(node, "scale", seen, AddMotionNumbers({0, 0, 0, 1, 1, 1}, "VEC3", 2), "STEP");
    }
  }

  Result<std::string> Assemble() {
    std::string binary;
    // [bytes] of a position, a normal; indices and what moves are packed.
    constexpr std::array<int, kViewCount> kStrides{12, 12, 4, 0, 0};
    for (int view = 0; view < kViewCount && json_.contains("meshes"); ++view) {
      const auto at = static_cast<std::size_t>(view);
      if (view == kMotions && views_[at].empty()) {
        continue;
      }
      Json json{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", views_[at].size()}};
      if (kStrides[at] > 0) {
        json["byteStride"] = kStrides[at];
      }
      if (view != kMotions) {
        json["target"] = view == kIndices ? kElementArrayBuffer : kArrayBuffer;
      }
      json_["bufferViews"].push_back(std::move(json));
      binary += views_[at];
      views_[at].clear();
    }
    if (!binary.empty()) {
      json_["buffers"] = {{{"byteLength", binary.size()}}};
    }
    auto glb = PackGlb(json_.dump(-1, ' ', false, Json::error_handler_t::replace), binary);
    if (!glb) {
      glb.error().where = product_.source;
      glb.error().remedy = "export the product without --fine, or each subassembly by itself";
    }
    return glb;
  }

  const Product& product_;
  bool is_fine_;
  Json json_;
  std::array<std::string, kViewCount> views_;
  std::map<ColorKey, std::size_t> materials_;
  std::vector<int> mesh_of_part_;
  std::vector<int> node_of_;  // Each occurrence's node; below zero: none.
};

}  // namespace

Result<std::string> MakeGlb(const Product& product, bool is_fine,
                            const std::vector<GlbMotion>& motions) {
  return GlbBuilder(product, is_fine).Build(motions);
}

}  // namespace hvas::cad
