#include "cad/triangles/mesh_cracks.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace hvas::cad {
namespace {

// How far beside an edge a vertex may be that was made on it, of the edge's length: files in metres
// with six digits behind the point round it by 0.7 um, on edges of a few millimetres. A choice.
constexpr double kRoundedDigits = 2e-4;
// Vertices of open edges up to which T-junctions are looked for. Beyond it a mesh is a heap of
// single triangles, and the search takes seconds. A choice.
constexpr std::size_t kMaxOpenVertices = 50'000;

/** An open edge of a triangle and the vertices of other open edges that lie on it. */
struct CrackedEdge {
  std::uint32_t triangle;
  std::size_t edge;
  std::vector<std::uint32_t> on_it;  // From its first vertex to its second.
};

/** Vertices of open edges, each once, by their x. */
std::vector<std::uint32_t> ListOpenVertices(const WeldedMesh& mesh) {
  std::vector<std::uint32_t> open;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.neighbour[t][k] == kNoTriangle) {
        open.push_back(mesh.triangles[t][k]);
        open.push_back(mesh.triangles[t][(k + 1) % 3]);
      }
    }
  }
  std::sort(open.begin(), open.end(), [&mesh](std::uint32_t a, std::uint32_t b) {
    const double x_a = mesh.vertices[a].x();
    const double x_b = mesh.vertices[b].x();
    return x_a != x_b ? x_a < x_b : a < b;
  });
  open.erase(std::unique(open.begin(), open.end()), open.end());
  return open;
}

/** Finds the vertices of other triangles that lie on the inside of edge k of triangle t.
 @param open  Vertices of open edges, by their x. */
std::vector<std::uint32_t> FindVerticesOn(const WeldedMesh& mesh,
                                          const std::vector<std::uint32_t>& open, std::uint32_t t,
                                          std::size_t k) {
  const std::uint32_t a = mesh.triangles[t][k];
  const std::uint32_t b = mesh.triangles[t][(k + 1) % 3];
  const std::uint32_t apex = mesh.triangles[t][(k + 2) % 3];
  const Vec3& p_a = mesh.vertices[a];
  const Vec3 way = mesh.vertices[b] - p_a;
  const double length = way.norm();
  const double tolerance = std::max(mesh.resolution, kRoundedDigits * length);
  // Nearer to an end it is rather the same vertex, made twice.
  constexpr double kFromEnd = 10;  // Tolerances. A choice.
  const double end = kFromEnd * tolerance;
  const double low = std::min(0.0, way.x()) + p_a.x() - tolerance;
  const double high = std::max(0.0, way.x()) + p_a.x() + tolerance;
  std::vector<std::pair<double, std::uint32_t>> found;
  for (auto v = std::lower_bound(
           open.begin(), open.end(), low,
           [&mesh](std::uint32_t i, double x) { return mesh.vertices[i].x() < x; });
       v != open.end() && mesh.vertices[*v].x() <= high; ++v) {
    const Vec3 to = mesh.vertices[*v] - p_a;
    const double along = to.dot(way) / length;
    if (*v != a && *v != b && *v != apex && along > end && along < length - end &&
        (to - along / length * way).squaredNorm() < tolerance * tolerance) {
      found.emplace_back(along, *v);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> on_it;
  on_it.reserve(found.size());
  for (const auto& [along, v] : found) {
    on_it.push_back(v);
  }
  return on_it;
}

/** One cracked edge of each triangle that has any. */
std::vector<CrackedEdge> FindCracks(const WeldedMesh& mesh) {
  const std::vector<std::uint32_t> open = ListOpenVertices(mesh);
  std::vector<CrackedEdge> cracks;
  if (open.size() > kMaxOpenVertices) {
    return cracks;
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.neighbour[t][k] != kNoTriangle) {
        continue;
      }
      std::vector<std::uint32_t> on_it = FindVerticesOn(mesh, open, t, k);
      if (!on_it.empty()) {
        cracks.push_back({t, k, std::move(on_it)});
        break;
      }
    }
  }
  return cracks;
}

/** Takes triangles out of which there are two with the same corners: what dividing makes of two
 that lay on one another. */
void DropDoubles(WeldedMesh* mesh) {
  const auto key_of = [mesh](std::uint32_t t) {
    Triangle key = mesh->triangles[t];
    std::sort(key.begin(), key.end());
    return key;
  };
  std::vector<std::uint32_t> order(mesh->triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(key_of(a), a) < std::pair(key_of(b), b);
  });
  std::vector<bool> is_double(order.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key_of(order[i - 1]) == key_of(order[i]) && !is_double[order[i - 1]]) {
      is_double[order[i - 1]] = true;
      is_double[order[i]] = true;
    }
  }
  DropTriangles(is_double, mesh);
}

}  // namespace

void DropTriangles(const std::vector<bool>& is_dropped, WeldedMesh* mesh) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < is_dropped.size(); ++t) {
    if (!is_dropped[t]) {
      mesh->triangles[kept] = mesh->triangles[t];
      mesh->source[kept++] = mesh->source[t];
    }
  }
  mesh->triangles.resize(kept);
  mesh->source.resize(kept);
}

bool DivideCracked(WeldedMesh* mesh) {
  const std::vector<CrackedEdge> cracks = FindCracks(*mesh);
  for (const CrackedEdge& crack : cracks) {
    const Triangle whole = mesh->triangles[crack.triangle];
    const std::uint32_t apex = whole[(crack.edge + 2) % 3];
    std::uint32_t from = whole[crack.edge];
    mesh->triangles[crack.triangle] = {from, crack.on_it.front(), apex};
    for (std::size_t i = 0; i < crack.on_it.size(); ++i) {
      from = crack.on_it[i];
      const std::uint32_t to =
          i + 1 < crack.on_it.size() ? crack.on_it[i + 1] : whole[(crack.edge + 1) % 3];
      mesh->triangles.push_back({from, to, apex});
      mesh->source.push_back(mesh->source[crack.triangle]);
    }
  }
  if (!cracks.empty()) {
    DropDoubles(mesh);
  }
  return !cracks.empty();
}

}  // namespace hvas::cad
