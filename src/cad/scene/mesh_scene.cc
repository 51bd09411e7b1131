#include "cad/scene/mesh_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "cad/scene/placed_parts.h"
#include "cad/scene/product_tree.h"
#include "cad/step/material.h"
#include "cad/step/text_encoding.h"
#include "cad/triangles/triangle_part.h"
#include "fits/materials.h"
#include "spatial/decompose.h"

namespace hvas::cad {
namespace {

using product::Color;
using product::Part;
using product::PartId;
using product::Product;
using product::SubassemblyId;

using Meshes = std::vector<std::uint32_t>;

// Deeper trees could overflow the stack, by which nodes are visited: a choice, not measured.
constexpr int kDeepestNode = 500;
// A triangle is in a product twice, to touch and to look at, with vertices that it shares with
// others.
constexpr double kBytesPerTriangle = 60;

struct Affine {
  Mat3 A{Mat3::Identity()};
  Vec3 t{Vec3::Zero()};
};

Affine ToAffine(const aiMatrix4x4& m, double unit) {
  Affine affine;
  affine.A << static_cast<double>(m.a1), static_cast<double>(m.a2), static_cast<double>(m.a3),
      static_cast<double>(m.b1), static_cast<double>(m.b2), static_cast<double>(m.b3),
      static_cast<double>(m.c1), static_cast<double>(m.c2), static_cast<double>(m.c3);
  affine.t =
      unit * Vec3(static_cast<double>(m.a4), static_cast<double>(m.b4), static_cast<double>(m.c4));
  return affine;
}

Affine operator*(const Affine& a, const Affine& b) {
  return {a.A * b.A, a.A * b.t + a.t};
}

/** A linear map as a rotation after a stretch, which holds scale, shear and mirror. */
struct Polar {
  Mat3 R;
  Mat3 stretch;
};

Polar Decompose(const Mat3& A) {
  const spatial::SingularValues3 svd = spatial::CalcSingularValues(A);
  const Mat3 R = svd.U * svd.V.transpose();
  const double sign = R.determinant() < 0 ? -1 : 1;
  return {sign * R, sign * svd.V * svd.values.asDiagonal() * svd.V.transpose()};
}

/** Linear light to sRGB (IEC 61966-2-1), which glTF asks for and screens do. */
float ToSrgb(float linear) {
  const double u = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  return static_cast<float>(u <= 0.0031308 ? 12.92 * u : 1.055 * std::pow(u, 1 / 2.4) - 0.055);
}

/** Whether a tree of nodes has more levels than are visited. */
bool IsDeeperThanVisited(const aiNode& root) {
  std::vector<std::pair<const aiNode*, int>> open{{&root, 0}};
  while (!open.empty()) {
    const auto [node, depth] = open.back();
    open.pop_back();
    if (depth > kDeepestNode) {
      return true;
    }
    for (unsigned i = 0; i < node->mNumChildren; ++i) {
      open.emplace_back(node->mChildren[i], depth + 1);
    }
  }
  return false;
}

class SceneBuilder {
 public:
  SceneBuilder(const aiScene& scene, const SceneConventions& conventions,
               const ImportOptions& options, const ReadWatch& watch, Product* product,
               Diagnostics* diagnostics)
      : scene_(scene),
        conventions_(conventions),
        options_(options),
        watch_(watch),
        product_(product),
        diagnostics_(diagnostics),
        tree_(product) {}

  [[nodiscard]] Result<void> Build();

 private:
  /** A part yet to be built. */
  struct Source {
    Meshes meshes;
    Mat3 stretch;
  };

  /** An object of an OBJ, or a solid of an STL. */
  struct Body {
    std::string name;
    Meshes meshes;
  };

  void VisitNode(const aiNode& node, SubassemblyId parent, const Affine& X_WP, int depth);
  void VisitChildren(const aiNode& node, SubassemblyId id, const Affine& X_WN, int depth);
  void BuildBodies();
  void CollectBodies(const aiNode& node, int depth, std::vector<Body>* bodies) const;
  [[nodiscard]] bool IsClosed(const Meshes& meshes) const;
  void AddLeaf(const Meshes& meshes, const std::string& name, SubassemblyId parent,
               const Affine& X_WN);
  [[nodiscard]] PartId FindPart(const Meshes& meshes, const std::string& name, const Mat3& stretch);
  [[nodiscard]] TriangleSoup MakeSoup(const Source& source) const;
  [[nodiscard]] std::optional<Color> ColorOf(const aiMesh& mesh) const;
  [[nodiscard]] std::optional<StatedMaterial> MaterialOf(const aiMesh& mesh) const;
  void BuildPart(const Source& source, Part* part);
  [[nodiscard]] bool HasGeometry(const aiNode& node, int depth);
  [[nodiscard]] Meshes MeshesOf(const aiNode& node) const;
  [[nodiscard]] std::string NameOf(const aiString& name, const std::string& fallback) const;

  const aiScene& scene_;
  const SceneConventions& conventions_;
  const ImportOptions& options_;
  const ReadWatch& watch_;
  Product* product_;
  Diagnostics* diagnostics_;
  ProductTree tree_;
  std::vector<Source> sources_;  // One for each part.
  std::map<std::pair<Meshes, std::array<std::int64_t, 9>>, PartId> known_;
  std::unordered_map<const aiNode*, bool> has_geometry_;
  double triangles_{0};  // All parts' together.
  bool is_too_large_{false};
};

std::string SceneBuilder::NameOf(const aiString& name, const std::string& fallback) const {
  const auto better = conventions_.names.find(name.C_Str());
  const std::string clean = CleanName(
      std::string_view(better != conventions_.names.end() ? better->second.c_str() : name.C_Str()));
  // "<STL_BINARY>" and the like are made up by assimp.
  return clean.empty() || clean.front() == '<' ? fallback : clean;
}

/** Those meshes of a node that have triangles. */
Meshes SceneBuilder::MeshesOf(const aiNode& node) const {
  Meshes meshes;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const unsigned mesh = node.mMeshes[i];
    if (mesh < scene_.mNumMeshes && scene_.mMeshes[mesh] != nullptr &&
        (scene_.mMeshes[mesh]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0) {
      meshes.push_back(mesh);
    }
  }
  return meshes;
}

bool SceneBuilder::HasGeometry(const aiNode& node, int depth) {
  const auto known = has_geometry_.find(&node);
  if (known != has_geometry_.end()) {
    return known->second;
  }
  bool has_geometry = !MeshesOf(node).empty();
  for (unsigned i = 0; i < node.mNumChildren && !has_geometry && depth < kDeepestNode; ++i) {
    has_geometry = HasGeometry(*node.mChildren[i], depth + 1);
  }
  has_geometry_[&node] = has_geometry;
  return has_geometry;
}

void SceneBuilder::VisitNode(const aiNode& node, SubassemblyId parent, const Affine& X_WP,
                             int depth) {
  if (depth > kDeepestNode || is_too_large_ || !HasGeometry(node, depth)) {
    return;
  }
  const Affine X_WN = X_WP * ToAffine(node.mTransformation, conventions_.length_unit);
  bool is_leaf = true;
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    is_leaf = is_leaf && !HasGeometry(*node.mChildren[i], depth + 1);
  }
  if (is_leaf) {
    AddLeaf(MeshesOf(node), NameOf(node.mName, "part"), parent, X_WN);
  } else {
    VisitChildren(node, tree_.AddSubassembly(parent, NameOf(node.mName, "assembly")), X_WN, depth);
  }
}

void SceneBuilder::VisitChildren(const aiNode& node, SubassemblyId id, const Affine& X_WN,
                                 int depth) {
  const Meshes own = MeshesOf(node);
  if (!own.empty()) {
    AddLeaf(own, NameOf(node.mName, product_->name), id, X_WN);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    VisitNode(*node.mChildren[i], id, X_WN, depth + 1);
  }
}

void SceneBuilder::CollectBodies(const aiNode& node, int depth, std::vector<Body>* bodies) const {
  const Meshes own = MeshesOf(node);
  if (!own.empty()) {
    bodies->push_back({NameOf(node.mName, product_->name), own});
  }
  for (unsigned i = 0; i < node.mNumChildren && depth < kDeepestNode; ++i) {
    CollectBodies(*node.mChildren[i], depth + 1, bodies);
  }
}

bool SceneBuilder::IsClosed(const Meshes& meshes) const {
  const WeldedMesh mesh = WeldMesh(MakeSoup({meshes, Mat3::Identity()}));
  return !mesh.shells.empty() &&
         std::all_of(mesh.shells.begin(), mesh.shells.end(),
                     [](const MeshShell& shell) { return shell.is_closed; });
}

/** OBJ groups and STL solids are parts in some files and faces in others. */
void SceneBuilder::BuildBodies() {
  std::vector<Body> bodies;
  CollectBodies(*scene_.mRootNode, 0, &bodies);
  const bool are_parts =
      bodies.size() < 2 || std::all_of(bodies.begin(), bodies.end(),
                                       [this](const Body& body) { return IsClosed(body.meshes); });
  if (!are_parts) {
    Body whole{product_->name, {}};
    for (const Body& body : bodies) {
      whole.meshes.insert(whole.meshes.end(), body.meshes.begin(), body.meshes.end());
    }
    if (IsClosed(whole.meshes)) {
      diagnostics_->Note("joined-groups", product_->source,
                         fmt::format("{} groups form a closed surface only together; they are "
                                     "treated as faces of one part",
                                     bodies.size()));
      bodies.assign(1, whole);
    }
  }
  if (bodies.size() == 1) {
    bodies.front().name = product_->name;
  }
  for (const Body& body : bodies) {
    AddLeaf(body.meshes, body.name, SubassemblyId(0), {});
  }
}

void SceneBuilder::AddLeaf(const Meshes& meshes, const std::string& name, SubassemblyId parent,
                           const Affine& X_WN) {
  if (product_->occurrences.size() == options_.max_parts) {
    is_too_large_ = true;
    return;
  }
  if (!X_WN.A.allFinite() || !X_WN.t.allFinite()) {
    diagnostics_->Warn("unusable-node", name,
                       "the pose of this instance is unusable; the instance is omitted",
                       "export the file again");
    return;
  }
  const Polar polar = Decompose(X_WN.A);
  const PartId part = FindPart(meshes, name, polar.stretch);
  tree_.AddOccurrence(parent, part, name, {Quat(polar.R).normalized(), X_WN.t});
}

PartId SceneBuilder::FindPart(const Meshes& meshes, const std::string& name, const Mat3& stretch) {
  constexpr double kStretchStep = 1e-5;  // Coordinates are in single precision.
  const bool is_rigid = (stretch - Mat3::Identity()).cwiseAbs().maxCoeff() < kStretchStep;
  std::array<std::int64_t, 9> key{};
  for (int i = 0; i < 9 && !is_rigid; ++i) {
    const double value = std::clamp(stretch(i / 3, i % 3) / kStretchStep, -1e18, 1e18);
    key[static_cast<std::size_t>(i)] = std::llround(value);
  }
  const PartId fresh(product_->parts.size());
  const auto [known, is_new] = known_.try_emplace({meshes, key}, fresh);
  if (is_new) {
    Part part;
    part.id = fresh;
    part.name = name;
    product_->parts.push_back(std::move(part));
    sources_.push_back({meshes, is_rigid ? Mat3::Identity() : stretch});
    for (const std::uint32_t mesh : meshes) {
      triangles_ += scene_.mMeshes[mesh]->mNumFaces;
    }
    if (!is_rigid) {
      diagnostics_->Note("baked-scale", name,
                         fmt::format("an instance is {}; it is imported as a part of its own",
                                     stretch.determinant() < 0 ? "mirrored" : "scaled"));
    }
  }
  return known->second;
}

std::optional<Color> SceneBuilder::ColorOf(const aiMesh& mesh) const {
  if (mesh.mMaterialIndex >= scene_.mNumMaterials) {
    return std::nullopt;
  }
  const aiMaterial& material = *scene_.mMaterials[mesh.mMaterialIndex];
  aiString name;
  aiColor4D c;
  if (material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS &&
      std::string_view(name.C_Str()).find("DefaultMaterial") != std::string_view::npos) {
    return std::nullopt;  // Of assimp, not of the file.
  }
  if (conventions_.format == MeshFormat::kGltf &&
      material.Get(AI_MATKEY_BASE_COLOR, c) == AI_SUCCESS) {
    return Color{ToSrgb(c.r), ToSrgb(c.g), ToSrgb(c.b)};
  }
  if (conventions_.format == MeshFormat::kStl ||
      material.Get(AI_MATKEY_COLOR_DIFFUSE, c) != AI_SUCCESS) {
    return std::nullopt;
  }
  const auto part = [](float v) { return std::isfinite(v) ? std::clamp(v, 0.0F, 1.0F) : 0.0F; };
  return Color{part(c.r), part(c.g), part(c.b)};
}

/** What these files call a material is a look; a name like "Steel" tells of what the part is made,
 one like "Red" does not. */
std::optional<StatedMaterial> SceneBuilder::MaterialOf(const aiMesh& mesh) const {
  aiString name;
  if (mesh.mMaterialIndex >= scene_.mNumMaterials ||
      scene_.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name) != AI_SUCCESS) {
    return std::nullopt;
  }
  const std::string clean = CleanName(std::string_view(name.C_Str()));
  return fits::FindMaterial(clean) ? std::optional(StatedMaterial{clean, 0}) : std::nullopt;
}

TriangleSoup SceneBuilder::MakeSoup(const Source& source) const {
  TriangleSoup soup;
  const bool is_mirrored = source.stretch.determinant() < 0;
  for (std::size_t i = 0; i < source.meshes.size(); ++i) {
    const aiMesh& mesh = *scene_.mMeshes[source.meshes[i]];
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      soup.vertices.push_back(
          conventions_.length_unit *
          (source.stretch *
           Vec3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z))));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices == 3 &&
          std::max({face.mIndices[0], face.mIndices[1], face.mIndices[2]}) < mesh.mNumVertices) {
        soup.triangles.push_back(
            {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
        if (is_mirrored) {
          std::swap(soup.triangles.back()[1], soup.triangles.back()[2]);
        }
        soup.face.push_back(static_cast<std::uint32_t>(i));
      }
    }
    soup.faces.push_back({std::nullopt, ColorOf(mesh), 0});
  }
  if (soup.faces.size() < 2) {
    soup.face.clear();  // One colour tells nothing about faces.
    soup.faces.clear();
  }
  return soup;
}

void SceneBuilder::BuildPart(const Source& source, Part* part) {
  unsigned most_colored = 0;
  unsigned most_stated = 0;
  std::optional<StatedMaterial> stated;
  for (const std::uint32_t index : source.meshes) {
    const aiMesh& mesh = *scene_.mMeshes[index];
    const std::optional<Color> color = ColorOf(mesh);
    if (color && mesh.mNumFaces > most_colored) {
      most_colored = mesh.mNumFaces;
      part->color = *color;
    }
    const std::optional<StatedMaterial> material = MaterialOf(mesh);
    if (material && mesh.mNumFaces > most_stated) {
      most_stated = mesh.mNumFaces;
      stated = material;
    }
  }
  part->material = MakeMaterial(stated, part->name, diagnostics_);
  if (!BuildTrianglePart(MakeSoup(source), part, diagnostics_)) {
    diagnostics_->Warn("no-mesh", part->name, "the part has no usable triangle and is omitted",
                       "export the part again");
  }
}

Result<void> SceneBuilder::Build() {
  Affine X_WF;
  if (conventions_.is_y_up) {
    X_WF.A << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  }
  const bool has_bodies =
      conventions_.format == MeshFormat::kStl || conventions_.format == MeshFormat::kObj;
  if (has_bodies) {
    BuildBodies();
  } else {
    VisitChildren(*scene_.mRootNode, SubassemblyId(0),
                  X_WF * ToAffine(scene_.mRootNode->mTransformation, conventions_.length_unit), 0);
  }
  if (is_too_large_) {
    return FailTooManyParts(options_.max_parts, product_->source);
  }
  if (IsDeeperThanVisited(*scene_.mRootNode)) {
    diagnostics_->Warn(
        "limit-depth", product_->source,
        fmt::format("what is nested deeper than {} levels is left out", kDeepestNode),
        "export the product with fewer levels");
  }
  if (const double bytes = kBytesPerTriangle * triangles_;
      bytes > static_cast<double>(options_.max_bytes)) {
    return FailTooManyBytes("the triangles of its parts take", bytes, options_.max_bytes,
                            product_->source);
  }
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (watch_.progress) {
      watch_.progress("parts", static_cast<double>(i) / static_cast<double>(sources_.size()));
    }
    const auto number = static_cast<std::uint32_t>(i);
    if (watch_.part) {
      watch_.part(number, product_->parts[i].name);
    }
    const auto& skipped = options_.skipped_parts;
    if (std::find(skipped.begin(), skipped.end(), number) == skipped.end()) {
      BuildPart(sources_[i], &product_->parts[i]);
    }
  }
  tree_.Finish();
  return {};
}

}  // namespace

Result<void> BuildSceneProduct(const aiScene& scene, const SceneConventions& conventions,
                               const ImportOptions& options, const ReadWatch& watch,
                               product::Product* product, Diagnostics* diagnostics) {
  return SceneBuilder(scene, conventions, options, watch, product, diagnostics).Build();
}

}  // namespace hvas::cad
