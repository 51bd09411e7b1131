#include "peer_mesh.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

#include "contact/mesh.h"

namespace hvas::bench {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // The lower vertex first.

Edge MakeEdge(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

class Splitter {
 public:
  explicit Splitter(PeerMesh* mesh) : mesh_(mesh) {
    for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
      Enter(t);
    }
  }

  void Run(std::size_t at_least) {
    while (mesh_->triangles.size() < at_least && !queue_.empty()) {
      const auto [length, a, b] = queue_.top();
      queue_.pop();
      Halve({a, b});
    }
  }

 private:
  void Enter(std::uint32_t t) {
    const auto& v = mesh_->triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge = MakeEdge(v[k], v[(k + 1) % 3]);
      std::vector<std::uint32_t>& sides = sides_[edge];
      if (sides.empty()) {
        const double length =
            (mesh_->vertices_mm[edge.first] - mesh_->vertices_mm[edge.second]).norm();
        queue_.emplace(length, edge.first, edge.second);
      }
      sides.push_back(t);
    }
  }

  void Leave(std::uint32_t t) {
    const auto& v = mesh_->triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<std::uint32_t>& sides = sides_[MakeEdge(v[k], v[(k + 1) % 3])];
      sides.erase(std::remove(sides.begin(), sides.end(), t), sides.end());
    }
  }

  void Halve(const Edge& edge) {
    const std::vector<std::uint32_t> sides = sides_[edge];
    const auto middle = static_cast<std::uint32_t>(mesh_->vertices_mm.size());
    mesh_->vertices_mm.push_back(
        0.5 * (mesh_->vertices_mm[edge.first] + mesh_->vertices_mm[edge.second]));
    for (const std::uint32_t t : sides) {
      Leave(t);
      auto first = mesh_->triangles[t];
      auto second = first;
      for (std::size_t k = 0; k < 3; ++k) {
        first[k] = first[k] == edge.first ? middle : first[k];
        second[k] = second[k] == edge.second ? middle : second[k];
      }
      mesh_->triangles[t] = first;
      mesh_->triangles.push_back(second);
      mesh_->face.push_back(mesh_->face[t]);
      Enter(t);
      Enter(static_cast<std::uint32_t>(mesh_->triangles.size() - 1));
    }
  }

  PeerMesh* mesh_;
  std::map<Edge, std::vector<std::uint32_t>> sides_;
  std::priority_queue<std::tuple<double, std::uint32_t, std::uint32_t>> queue_;
};

}  // namespace

PeerMesh MakePeerMesh(const contact::ShapeSource& source, std::size_t at_least) {
  const contact::Mesh welded = contact::MakeMesh(source, Vec3::Zero());
  PeerMesh mesh;
  for (const Vec3& v : welded.vertices) {
    mesh.vertices_mm.push_back(1e3 * v);
  }
  mesh.triangles = welded.triangles;
  mesh.face = welded.face;
  mesh.face_count = source.faces.size();
  Splitter(&mesh).Run(at_least);
  return mesh;
}

}  // namespace hvas::bench
