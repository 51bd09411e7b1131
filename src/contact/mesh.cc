#include "contact/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr double kWeldRelative = 1e-9;  // Of the diagonal.
// Edges that bend by more are sharp, and have samples: 8 degrees between faces, 30 within a
// freeform face, where triangles bend. Choices, not measured.
const double kCosSharpBetweenFaces = std::cos(8.0 * std::numbers::pi / 180.0);
const double kCosSharpInFreeform = std::cos(30.0 * std::numbers::pi / 180.0);

std::uint64_t CellKey(const std::array<std::int64_t, 3>& cell) {
  std::uint64_t key = 0x9e3779b97f4a7c15ULL;
  for (const std::int64_t c : cell) {
    key ^= static_cast<std::uint64_t>(c) + 0x9e3779b97f4a7c15ULL + (key << 6U) + (key >> 2U);
    key *= 0xff51afd7ed558ccdULL;
  }
  return key;
}

// Finds the welded vertex of each given one. Cells are a hundred tolerances wide, so that nearly
// every point looks into one cell only.
class Welder {
 public:
  Welder(double tolerance, std::size_t count) : tolerance_(tolerance), cell_(100 * tolerance) {
    cells_.reserve(count);
  }

  std::uint32_t Add(const Vec3& p, std::vector<Vec3>* welded) {
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> high{};
    std::array<std::int64_t, 3> home{};
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      low[i] = static_cast<std::int64_t>(std::floor((p[k] - tolerance_) / cell_));
      high[i] = static_cast<std::int64_t>(std::floor((p[k] + tolerance_) / cell_));
      home[i] = static_cast<std::int64_t>(std::floor(p[k] / cell_));
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto found = cells_.find(CellKey({x, y, z}));
          for (std::uint32_t v = found == cells_.end() ? kNoFace : found->second; v != kNoFace;
               v = next_[v]) {
            if (((*welded)[v] - p).norm() <= tolerance_) {
              return v;
            }
          }
        }
      }
    }
    const auto v = static_cast<std::uint32_t>(welded->size());
    welded->push_back(p);
    const auto [entry, is_new] = cells_.try_emplace(CellKey(home), v);
    next_.push_back(is_new ? kNoFace : entry->second);
    entry->second = v;
    return v;
  }

 private:
  double tolerance_;
  double cell_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
  std::vector<std::uint32_t> next_;
};

struct HalfEdge {
  std::uint32_t from, to, triangle;
  std::uint8_t edge;
};

void FindNeighbours(Mesh* mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh->triangles.size());
  for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const auto& v = mesh->triangles[t];
      edges.push_back({v[k], v[(k + 1U) % 3U], t, k});
    }
  }
  const auto key = [](const HalfEdge& e) {
    return std::pair(std::min(e.from, e.to), std::max(e.from, e.to));
  };
  std::sort(edges.begin(), edges.end(), [&](const HalfEdge& a, const HalfEdge& b) {
    return key(a) != key(b) ? key(a) < key(b) : a.triangle < b.triangle;
  });
  mesh->neighbour.assign(mesh->triangles.size(), {kNoFace, kNoFace, kNoFace});
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && key(edges[end]) == key(edges[i])) {
      ++end;
    }
    // Opposite half edges are paired in order; a bundle of four (two bodies that touch along an
    // edge) gives two pairs.
    for (std::size_t a = i; a < end; ++a) {
      auto& mine = mesh->neighbour[edges[a].triangle][edges[a].edge];
      for (std::size_t b = i; b < end && mine == kNoFace; ++b) {
        auto& other = mesh->neighbour[edges[b].triangle][edges[b].edge];
        if (edges[b].from == edges[a].to && other == kNoFace) {
          mine = edges[b].triangle;
          other = edges[a].triangle;
        }
      }
    }
    i = end;
  }
}

/** `faces` are in B, the mesh in the centred frame C. */
EdgeKind ClassifyEdge(const Mesh& mesh, const std::vector<spatial::Surface>& faces,
                      const Vec3& p_BC, std::uint32_t t, std::size_t k) {
  const std::uint32_t n = mesh.neighbour[t][k];
  if (n == kNoFace) {
    return EdgeKind::kOpen;
  }
  const std::uint32_t f = mesh.face[t];
  const std::uint32_t g = mesh.face[n];
  const bool is_freeform = faces[f].kind == spatial::SurfaceKind::kFreeform;
  if (f == g && !is_freeform) {
    return EdgeKind::kSmooth;
  }
  // Across faces the surfaces' own normals decide: the facets of a coarse mesh meet at an angle
  // even where the surfaces are tangent.
  const Vec3& a = mesh.vertices[mesh.triangles[t][k]];
  const Vec3& b = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
  const auto normal_of = [&](std::uint32_t triangle) {
    const auto exact = spatial::CalcDistance(faces[mesh.face[triangle]], a + p_BC);
    // A sliver's own normal may point anywhere; the surface's is right where it has the edge on it.
    const bool is_right = exact.is_valid && (std::abs(exact.distance) < kOnSurface ||
                                             exact.gradient.dot(mesh.NormalOf(triangle)) > 0.5);
    return is_right ? exact.gradient : mesh.NormalOf(triangle);
  };
  const Vec3 n1 = f == g ? mesh.NormalOf(t) : normal_of(t);
  const Vec3 n2 = f == g ? mesh.NormalOf(n) : normal_of(n);
  if (n1.isZero() || n2.isZero() ||
      n1.dot(n2) > (f == g ? kCosSharpInFreeform : kCosSharpBetweenFaces)) {
    return EdgeKind::kSmooth;
  }
  // Counter-clockwise about n1, the edge runs along n1 x n2 at a convex edge.
  return n1.cross(n2).dot(b - a) > 0 ? EdgeKind::kConvex : EdgeKind::kConcave;
}

void ClassifyVertices(Mesh* mesh) {
  const std::size_t count = mesh->vertices.size();
  mesh->vertex_kind.assign(count, VertexKind::kSmooth);
  mesh->vertex_faces.assign(count, {kNoFace, kNoFace});
  std::vector<Vec3> normals(count, Vec3::Zero());
  mesh->is_vertex_open.assign(count, 0);
  std::vector<std::uint16_t> sharp_ends(count, 0);
  for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
    const auto& v = mesh->triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 e1 = (mesh->vertices[v[(k + 1) % 3]] - mesh->vertices[v[k]]).normalized();
      const Vec3 e2 = (mesh->vertices[v[(k + 2) % 3]] - mesh->vertices[v[k]]).normalized();
      normals[v[k]] += std::acos(std::clamp(e1.dot(e2), -1.0, 1.0)) * mesh->NormalOf(t);
      const EdgeKind kind = mesh->edge_kind[t][k];
      if (kind == EdgeKind::kSmooth) {
        continue;
      }
      const std::uint32_t n = mesh->neighbour[t][k];
      const std::uint32_t f = mesh->face[t];
      const std::uint32_t g = n == kNoFace ? f : mesh->face[n];
      const std::array<std::uint32_t, 2> pair{std::min(f, g), std::max(f, g)};
      for (const std::uint32_t end : {v[k], v[(k + 1) % 3]}) {
        ++sharp_ends[end];
        if (kind == EdgeKind::kOpen) {
          mesh->is_vertex_open[end] = 1;
        }
        if (mesh->vertex_kind[end] == VertexKind::kSmooth) {
          mesh->vertex_kind[end] = VertexKind::kOnEdge;
          mesh->vertex_faces[end] = pair;
        } else if (mesh->vertex_faces[end] != pair) {
          mesh->vertex_kind[end] = VertexKind::kCorner;
        }
      }
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    mesh->vertex_normals.emplace_back(normals[v]);
    // An edge is seen from both its triangles: an edge passing through leaves four ends.
    if (mesh->vertex_kind[v] == VertexKind::kOnEdge && sharp_ends[v] != 4) {
      mesh->vertex_kind[v] = VertexKind::kCorner;
    }
  }
}

}  // namespace

TrianglePoint CalcClosestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                    const Vec3& c) noexcept {
  return CalcClosestOnTriangle(p, MakeTriangleCorners(a, b, c));
}

TriangleCorners MakeTriangleCorners(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const double ab[3]{b.x() - a.x(), b.y() - a.y(), b.z() - a.z()};
  const double ac[3]{c.x() - a.x(), c.y() - a.y(), c.z() - a.z()};
  return {{a.x(), a.y(), a.z()},
          {b.x(), b.y(), b.z()},
          {c.x(), c.y(), c.z()},
          ab[0] * ab[0] + ab[1] * ab[1] + ab[2] * ab[2],
          ab[0] * ac[0] + ab[1] * ac[1] + ab[2] * ac[2],
          ac[0] * ac[0] + ac[1] * ac[1] + ac[2] * ac[2]};
}

void CalcEightClosestScalar(const TriangleCorners* triangles, const std::uint32_t numbers[8],
                            int count, const EightPoints& p, EightClosest* out) noexcept {
  for (int i = 0; i < count; ++i) {
    const Vec3 point(p.at[0][i], p.at[1][i], p.at[2][i]);
    const TrianglePoint closest = CalcClosestOnTriangle(point, triangles[numbers[i]]);
    for (int k = 0; k < 3; ++k) {
      out->q.at[k][i] = closest.q[k];
    }
    out->squared[i] = (closest.q - point).squaredNorm();
    out->features[i] = static_cast<std::int32_t>(closest.feature);
  }
}

void CalcFourClosestScalar(const TriangleArrays& mesh, const std::uint32_t numbers[4],
                           const double p[3], FourClosest* out) noexcept {
  const Vec3 point(p[0], p[1], p[2]);
  const auto vertex = [&mesh](std::uint32_t number) {
    const double* v = mesh.vertices[number];
    return Vec3(v[0], v[1], v[2]);
  };
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t* t = mesh.triangles[numbers[i]];
    const TrianglePoint closest =
        CalcClosestOnTriangle(point, vertex(t[0]), vertex(t[1]), vertex(t[2]));
    for (int k = 0; k < 3; ++k) {
      out->at[k][i] = closest.q[k];
    }
    const Vec3 way = closest.q - point;
    out->squared[i] = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    out->features[i] = static_cast<std::int32_t>(closest.feature);
  }
}

ClosestKernels ChooseClosestKernels() noexcept {
#ifdef HVAS_HAS_AVX2_KERNEL
  if (__builtin_cpu_supports("avx2")) {
    return {&CalcFourClosestAvx2, &CalcEightClosestAvx2};
  }
#endif
  return {&CalcFourClosestScalar, &CalcEightClosestScalar};
}

std::uint32_t Mesh::NeighbourOn(std::uint32_t triangle, std::uint32_t on_face) const noexcept {
  const auto& around = neighbour[triangle];
  const auto* const found = std::find_if(around.begin(), around.end(), [&](std::uint32_t other) {
    return other != kNoFace && face[other] == on_face;
  });
  return found != around.end() ? *found : kNoFace;
}

Mesh::Corner Mesh::TurnAbout(const Corner& at, bool is_forward) const noexcept {
  const std::uint32_t corner = triangles[at.triangle][at.k];
  const std::uint32_t next = neighbour[at.triangle][is_forward ? at.k : (at.k + 2) % 3];
  if (next == kNoFace) {
    return {};
  }
  const auto& corners = triangles[next];
  const auto* const found = std::find(corners.begin(), corners.end(), corner);
  return found != corners.end() ? Corner{next, static_cast<std::size_t>(found - corners.begin())}
                                : Corner{};
}

std::uint32_t Mesh::AroundOn(std::uint32_t triangle, std::size_t k,
                             std::uint32_t on_face) const noexcept {
  constexpr int kMost = 32;  // Bounds the triangles around a corner, each way: a choice.
  for (const bool is_forward : {true, false}) {
    Corner at{triangle, k};
    for (int i = 0; i < kMost; ++i) {
      at = TurnAbout(at, is_forward);
      if (at.triangle == kNoFace || at.triangle == triangle) {
        break;
      }
      if (face[at.triangle] == on_face) {
        return at.triangle;
      }
    }
  }
  return kNoFace;
}

Vec3 Mesh::Pseudonormal(std::uint32_t triangle, TriangleFeature feature) const noexcept {
  if (feature == TriangleFeature::kInside) {
    return NormalOf(triangle);
  }
  if (feature <= TriangleFeature::kEdge2) {
    const std::uint32_t n = neighbour[triangle][static_cast<std::size_t>(feature) - 1];
    return n == kNoFace ? NormalOf(triangle) : Vec3(NormalOf(triangle) + NormalOf(n));
  }
  return vertex_normals[triangles[triangle][static_cast<std::size_t>(feature) - 4]].full();
}

bool Mesh::IsOpenAt(std::uint32_t triangle, TriangleFeature feature) const noexcept {
  if (is_closed || feature == TriangleFeature::kInside) {
    return false;
  }
  if (feature <= TriangleFeature::kEdge2) {
    return neighbour[triangle][static_cast<std::size_t>(feature) - 1] == kNoFace;
  }
  return is_vertex_open[triangles[triangle][static_cast<std::size_t>(feature) - 4]] != 0;
}

double Mesh::CalcWindingNumber(const Vec3& p) const {
  double sum = 0;
  for (const auto& t : triangles) {
    const Vec3 a = vertices[t[0]] - p;
    const Vec3 b = vertices[t[1]] - p;
    const Vec3 c = vertices[t[2]] - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

Mesh KeepTriangles(const Mesh& mesh, const std::vector<bool>& is_wanted,
                   std::vector<std::uint32_t>* number) {
  std::vector<bool> is_kept = is_wanted;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t n : mesh.neighbour[t]) {
      if (is_wanted[t] && n != kNoFace) {
        is_kept[n] = true;
      }
    }
  }
  Mesh kept;
  kept.is_closed = mesh.is_closed;
  number->assign(mesh.triangles.size(), kNoFace);
  std::vector<std::uint32_t> vertex(mesh.vertices.size(), kNoFace);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_kept[t]) {
      continue;
    }
    (*number)[t] = static_cast<std::uint32_t>(kept.triangles.size());
    kept.triangles.push_back(mesh.triangles[t]);
    kept.face.push_back(mesh.face[t]);
    kept.normals.push_back(mesh.normals[t]);
    kept.neighbour.push_back(mesh.neighbour[t]);
    kept.edge_kind.push_back(mesh.edge_kind[t]);
    if (!mesh.bends.empty()) {
      kept.bends.push_back(mesh.bends[t]);
    }
    for (std::uint32_t& v : kept.triangles.back()) {
      if (vertex[v] == kNoFace) {
        vertex[v] = static_cast<std::uint32_t>(kept.vertices.size());
        kept.vertices.push_back(mesh.vertices[v]);
        kept.vertex_kind.push_back(mesh.vertex_kind[v]);
        kept.vertex_normals.push_back(mesh.vertex_normals[v]);
        kept.vertex_faces.push_back(mesh.vertex_faces[v]);
        kept.is_vertex_open.push_back(mesh.is_vertex_open[v]);
      }
      v = vertex[v];
    }
  }
  for (auto& neighbours : kept.neighbour) {
    for (std::uint32_t& n : neighbours) {
      n = n == kNoFace ? kNoFace : (*number)[n];
    }
  }
  return kept;
}

Mesh MakeMesh(const ShapeSource& source, const Vec3& p_BC) {
  spatial::Box box;
  for (const Vec3& v : source.vertices) {
    box.Add(v);
  }
  Mesh mesh;
  Welder welder(kWeldRelative * std::max(box.size().norm(), 1e-9), source.vertices.size());
  std::vector<std::uint32_t> weld(source.vertices.size());
  for (std::size_t i = 0; i < weld.size(); ++i) {
    weld[i] = welder.Add(source.vertices[i] - p_BC, &mesh.vertices);
  }
  for (std::size_t i = 0; i < source.triangles.size(); ++i) {
    const auto& s = source.triangles[i];
    const std::array<std::uint32_t, 3> t{weld[s[0]], weld[s[1]], weld[s[2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      continue;
    }
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 cross = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    mesh.triangles.push_back(t);
    mesh.face.push_back(source.triangle_face[i]);
    // A sliver without area keeps the mesh closed; its neighbours carry the sign.
    const double length = cross.norm();
    mesh.normals.emplace_back(length > 0 ? Vec3(cross / length) : Vec3::Zero());
  }
  FindNeighbours(&mesh);
  mesh.edge_kind.resize(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.edge_kind[t][k] = ClassifyEdge(mesh, source.faces, p_BC, t, k);
      mesh.is_closed = mesh.is_closed && mesh.edge_kind[t][k] != EdgeKind::kOpen;
    }
  }
  ClassifyVertices(&mesh);
  return mesh;
}

}  // namespace hvas::contact
