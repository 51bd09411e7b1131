#include "product/face_adjacency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "base/units.h"

namespace hvas::product {
namespace {

constexpr double kTangent = units::FromDeg(2);           // Between analytic faces.
constexpr double kTangentOnFacets = units::FromDeg(12);  // Where one normal is a triangle's.
constexpr std::uint32_t kNone = 0xffffffffU;             // No vertex.

/** Gives vertices that lie within a tolerance of each other one number. */
class Welder {
 public:
  explicit Welder(double tolerance) : tolerance_(tolerance), cell_(16 * tolerance) {}

  std::uint32_t Weld(const Vec3& p) {
    const Vec3 scaled = p / cell_;
    constexpr double kFarthest = 1e12;  // Cells that can be counted.
    if (!(scaled.cwiseAbs().maxCoeff() < kFarthest) || !p.allFinite()) {
      return Append(p);
    }
    const Cell low = CellOf(scaled.array() - tolerance_ / cell_);
    const Cell high = CellOf(scaled.array() + tolerance_ / cell_);
    // The cells that a ball about p reaches: nearly always one.
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          if (const std::uint32_t found = FindIn(Key({x, y, z}), p); found != kNone) {
            return found;
          }
        }
      }
    }
    const std::uint32_t number = Append(p);
    const auto [head, is_new] = heads_.try_emplace(Key(CellOf(scaled)), number);
    next_.back() = is_new ? kNone : head->second;
    head->second = number;
    return number;
  }

  [[nodiscard]] std::size_t size() const { return points_.size(); }

 private:
  using Cell = std::array<std::int64_t, 3>;

  std::uint32_t Append(const Vec3& p) {
    points_.push_back(p);
    next_.push_back(kNone);
    return static_cast<std::uint32_t>(points_.size() - 1);
  }

  static Cell CellOf(const Vec3& scaled) {
    return {static_cast<std::int64_t>(std::floor(scaled.x())),
            static_cast<std::int64_t>(std::floor(scaled.y())),
            static_cast<std::int64_t>(std::floor(scaled.z()))};
  }

  static std::uint64_t Key(const Cell& cell) {
    return static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15ULL ^
           static_cast<std::uint64_t>(cell[1]) * 0xC2B2AE3D27D4EB4FULL ^
           static_cast<std::uint64_t>(cell[2]) * 0x165667B19E3779F9ULL;
  }

  [[nodiscard]] std::uint32_t FindIn(std::uint64_t key, const Vec3& p) const {
    const auto it = heads_.find(key);
    for (std::uint32_t i = it == heads_.end() ? kNone : it->second; i != kNone; i = next_[i]) {
      if ((points_[i] - p).squaredNorm() <= tolerance_ * tolerance_) {
        return i;
      }
    }
    return kNone;
  }

  double tolerance_;
  double cell_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> next_;  // In the same cell.
  std::unordered_map<std::uint64_t, std::uint32_t> heads_;
};

/** A side of a triangle, from `low` to `high` or back. */
struct HalfEdge {
  std::uint32_t high{0};
  std::uint32_t face{0};
  std::uint32_t triangle{0};
  std::uint8_t corner{0};  // Where it starts in the triangle.
  bool is_forward{true};   // From the lower vertex to the higher.
  bool is_used{false};
};

struct HalfEdges {
  std::vector<HalfEdge> items;     // Grouped by their lower vertex, then by face and triangle.
  std::vector<std::size_t> first;  // By vertex, and one more.
};

HalfEdges CollectHalfEdges(const Part& part, double tolerance) {
  Welder welder(tolerance);
  std::vector<std::uint32_t> number(part.mesh.vertices.size());
  for (std::size_t i = 0; i < number.size(); ++i) {
    number[i] = welder.Weld(part.mesh.vertices[i]);
  }
  HalfEdges edges;
  edges.first.assign(welder.size() + 1, 0);
  const auto visit = [&](const auto& use) {
    for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
      const Face& face = part.faces[f];
      for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count;
           ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = number[part.mesh.triangles[t][k]];
          const std::uint32_t b = number[part.mesh.triangles[t][(k + 1) % 3]];
          if (a != b) {
            use(std::min(a, b),
                HalfEdge{std::max(a, b), f, t, static_cast<std::uint8_t>(k), a < b, false});
          }
        }
      }
    }
  };
  visit([&](std::uint32_t low, const HalfEdge&) { ++edges.first[low + 1]; });
  for (std::size_t i = 1; i < edges.first.size(); ++i) {
    edges.first[i] += edges.first[i - 1];
  }
  edges.items.resize(edges.first.back());
  std::vector<std::size_t> next(edges.first.begin(), edges.first.end() - 1);
  visit([&](std::uint32_t low, const HalfEdge& edge) { edges.items[next[low]++] = edge; });
  return edges;
}

Vec3 FlatNormal(const Part& part, std::uint32_t triangle) {
  const auto& t = part.mesh.triangles[triangle];
  const Vec3& a = part.mesh.vertices[t[0]];
  return (part.mesh.vertices[t[1]] - a).cross(part.mesh.vertices[t[2]] - a).normalized();
}

FaceEdge MakeEdge(const Part& part, const HalfEdge& edge, const HalfEdge* twin) {
  const auto& t = part.mesh.triangles[edge.triangle];
  FaceEdge out;
  out.start = part.mesh.vertices[t[edge.corner]];
  out.end = part.mesh.vertices[t[(edge.corner + 1U) % 3]];
  const Vec3 middle = 0.5 * (out.start + out.end);
  const Vec3 along = (out.end - out.start).normalized();
  const Face& face = part.faces[edge.face];
  const Vec3 nhat = CalcNormal(face, middle, FlatNormal(part, edge.triangle));
  out.conormal = along.cross(nhat).normalized();
  if (twin == nullptr) {
    return out;
  }
  const Face& other = part.faces[twin->face];
  const Vec3 mhat = CalcNormal(other, middle, FlatNormal(part, twin->triangle));
  out.other = FaceId(twin->face);
  out.angle = std::atan2(nhat.cross(mhat).dot(along), nhat.dot(mhat));
  const bool is_exact =
      face.surface.kind != SurfaceKind::kFreeform && other.surface.kind != SurfaceKind::kFreeform;
  const double slack = is_exact ? kTangent : kTangentOnFacets;
  out.sense = std::abs(out.angle) < slack ? EdgeSense::kTangent
              : out.angle > 0             ? EdgeSense::kConvex
                                          : EdgeSense::kConcave;
  return out;
}

/** The half edge that answers to `edge` among those of one lower vertex: of another face, the other
 way round. Sides of two triangles of one face answer to each other first. */
HalfEdge* FindTwin(std::span<HalfEdge> bundle, const HalfEdge& edge, bool in_face) {
  for (HalfEdge& other : bundle) {
    if (!other.is_used && other.high == edge.high && other.is_forward != edge.is_forward &&
        (other.face == edge.face) == in_face) {
      return &other;
    }
  }
  return nullptr;
}

using EdgeOfFace = std::pair<std::uint32_t, FaceEdge>;

/** Joins the half edges at a vertex to edges: first those within a face, which are none. */
void AddEdges(const Part& part, std::span<HalfEdge> bundle, std::vector<EdgeOfFace>* found) {
  for (const bool in_face : {true, false}) {
    for (HalfEdge& edge : bundle) {
      HalfEdge* twin = edge.is_used ? nullptr : FindTwin(bundle, edge, in_face);
      if (twin == nullptr) {
        continue;
      }
      edge.is_used = twin->is_used = true;
      if (!in_face) {
        found->emplace_back(edge.face, MakeEdge(part, edge, twin));
        found->emplace_back(twin->face, MakeEdge(part, *twin, &edge));
      }
    }
  }
  for (const HalfEdge& edge : bundle) {
    if (!edge.is_used) {
      found->emplace_back(edge.face, MakeEdge(part, edge, nullptr));
    }
  }
}

}  // namespace

Vec3 CalcNormal(const Face& face, const Vec3& p, const Vec3& flat) {
  const spatial::SurfaceDistance found = CalcDistance(face.surface, p);
  return found.is_valid ? found.gradient : flat;
}

bool FaceNeighbour::Is(EdgeSense sense) const {
  const double share = sense == EdgeSense::kConvex    ? convex
                       : sense == EdgeSense::kConcave ? concave
                       : sense == EdgeSense::kTangent ? tangent
                                                      : 0;
  return share >= 0.9 * length;
}

FaceAdjacency::FaceAdjacency(const Part& part, double tolerance) {
  HalfEdges half_edges = CollectHalfEdges(part, tolerance);
  std::vector<EdgeOfFace> found;
  for (std::size_t v = 0; v + 1 < half_edges.first.size(); ++v) {
    AddEdges(part,
             std::span(half_edges.items)
                 .subspan(half_edges.first[v], half_edges.first[v + 1] - half_edges.first[v]),
             &found);
  }
  first_edge_.assign(part.faces.size() + 1, 0);
  for (const auto& entry : found) {
    ++first_edge_[entry.first + 1];
  }
  for (std::size_t i = 1; i < first_edge_.size(); ++i) {
    first_edge_[i] += first_edge_[i - 1];
  }
  edges_.resize(found.size());
  std::vector<std::size_t> next(first_edge_.begin(), first_edge_.end() - 1);
  for (const auto& entry : found) {
    edges_[next[entry.first]++] = entry.second;
  }
  CollectNeighbours(part.faces.size());
}

void FaceAdjacency::CollectNeighbours(std::size_t face_count) {
  first_neighbour_.assign(1, 0);
  std::vector<FaceNeighbour> found;
  for (std::size_t f = 0; f < face_count; ++f) {
    found.clear();
    for (const FaceEdge& edge : edges(FaceId(f))) {
      if (edge.sense == EdgeSense::kOpen) {
        continue;
      }
      const double length = (edge.end - edge.start).norm();
      FaceNeighbour entry{edge.other, length, 0, 0, 0, length * edge.angle};
      (edge.sense == EdgeSense::kConvex    ? entry.convex
       : edge.sense == EdgeSense::kConcave ? entry.concave
                                           : entry.tangent) = length;
      found.push_back(entry);
    }
    std::stable_sort(
        found.begin(), found.end(),
        [](const FaceNeighbour& a, const FaceNeighbour& b) { return a.face < b.face; });
    for (const FaceNeighbour& entry : found) {
      if (neighbours_.size() == first_neighbour_.back() || neighbours_.back().face != entry.face) {
        neighbours_.push_back(entry);
        continue;
      }
      FaceNeighbour& sum = neighbours_.back();
      sum.length += entry.length;
      sum.convex += entry.convex;
      sum.concave += entry.concave;
      sum.tangent += entry.tangent;
      sum.angle += entry.angle;
    }
    for (std::size_t i = first_neighbour_.back(); i < neighbours_.size(); ++i) {
      neighbours_[i].angle /= std::max(neighbours_[i].length, 1e-300);
    }
    first_neighbour_.push_back(neighbours_.size());
  }
}

}  // namespace hvas::product
