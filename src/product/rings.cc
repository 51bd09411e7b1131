#include "product/rings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/units.h"
#include "product/axis_features.h"

namespace hvas::product {
namespace {

constexpr int kSectors = 24;  // Sectors of a turn, 15 degrees each (docs/algorithms/features.md).
constexpr double kLargestStep = 4;  // Ratio of radii of bores that follow each other.

bool IsMember(const std::vector<FaceId>& faces, FaceId face) {
  return std::find(faces.begin(), faces.end(), face) != faces.end();
}

/** Extent along the axis, and the sense by the normals of the triangles. */
void MeasureRing(const Part& part, Ring* ring) {
  ring->low = std::numeric_limits<double>::infinity();
  ring->high = -ring->low;
  double inward = 0;
  for (const FaceId id : ring->faces) {
    const Face& face = part.faces[id.index()];
    for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count;
         ++t) {
      const auto& triangle = part.mesh.triangles[t];
      const Vec3& a = part.mesh.vertices[triangle[0]];
      const Vec3& b = part.mesh.vertices[triangle[1]];
      const Vec3& c = part.mesh.vertices[triangle[2]];
      const Vec3 q = (a + b + c) / 3 - ring->origin_B;
      inward -= (b - a).cross(c - a).dot(q - q.dot(ring->axis_B) * ring->axis_B);
      for (const Vec3* p : {&a, &b, &c}) {
        const double z = (*p - ring->origin_B).dot(ring->axis_B);
        ring->low = std::min(ring->low, z);
        ring->high = std::max(ring->high, z);
      }
    }
  }
  ring->is_inward = inward > 0;
}

/** At which end of the ring a segment of its border is; none for those along it. */
std::optional<std::size_t> FindEnd(const Ring& ring, const FaceEdge& edge, double z,
                                   const Vec3& radial) {
  if (ring.kind == SurfaceKind::kTorus) {
    return z > 0.5 * (ring.low + ring.high) ? 1 : 0;
  }
  Vec3 meridian = ring.axis_B;
  if (ring.kind == SurfaceKind::kCone) {
    const double sign = ring.surface.axis.dot(ring.axis_B) > 0 ? 1 : -1;
    meridian = std::cos(ring.surface.second) * ring.axis_B +
               sign * std::sin(ring.surface.second) * radial.normalized();
  }
  const double along = edge.conormal.dot(meridian);
  constexpr double kAcross = 0.3;  // Sine: 17 degrees off the axis. A choice.
  if (std::abs(along) < kAcross) {
    return std::nullopt;
  }
  return along > 0 ? 1 : 0;
}

double CalcEndRadius(const Ring& ring, std::size_t end, double seen) {
  if (ring.kind == SurfaceKind::kCylinder) {
    return ring.surface.radius;
  }
  if (ring.kind == SurfaceKind::kCone) {
    const Vec3 p = ring.point(end);
    return std::abs((p - ring.surface.origin).dot(ring.axis_B)) * std::tan(ring.surface.second);
  }
  return seen > 0 ? seen : ring.surface.radius;
}

/** The segment of the border that lies furthest out in a sector of an end. */
struct EndSector {
  const FaceEdge* edge{nullptr};
  double z{0};
  double radius{0};
};

using EndSectors = std::array<EndSector, kSectors>;

std::array<EndSectors, 2> CollectEndSectors(const FaceAdjacency& adjacency, const Ring& ring) {
  std::array<EndSectors, 2> sectors;
  const Mat3 R = spatial::FrameFromZ(ring.axis_B).toRotationMatrix();
  for (const FaceId face : ring.faces) {
    for (const FaceEdge& edge : adjacency.edges(face)) {
      if (edge.sense != EdgeSense::kOpen && IsMember(ring.faces, edge.other)) {
        continue;
      }
      const Vec3 q = 0.5 * (edge.start + edge.end) - ring.origin_B;
      const double z = q.dot(ring.axis_B);
      const Vec3 radial = q - z * ring.axis_B;
      const auto end = FindEnd(ring, edge, z, radial);
      if (!end) {
        continue;
      }
      const Vec3 local = R.transpose() * radial;
      const double turn = std::atan2(local.y(), local.x()) / units::kTurn + 0.5;
      EndSector& sector =
          sectors[*end][static_cast<std::size_t>(std::min(kSectors - 1.0, kSectors * turn))];
      if (sector.edge == nullptr || (*end == 1 ? z > sector.z : z < sector.z)) {
        sector = {&edge, z, radial.norm()};
      }
    }
  }
  return sectors;
}

void CountSector(const FaceEdge& edge, RingEnd* end) {
  ++end->sectors;
  switch (edge.sense) {
    case EdgeSense::kConvex:
      ++end->convex;
      break;
    case EdgeSense::kConcave:
      ++end->concave;
      break;
    case EdgeSense::kTangent:
      ++end->tangent;
      break;
    case EdgeSense::kOpen:
      ++end->open;
      return;  // No face is there.
  }
  const auto it = std::find_if(end->neighbours.begin(), end->neighbours.end(),
                               [&](const auto& entry) { return entry.first == edge.other; });
  if (it == end->neighbours.end()) {
    end->neighbours.emplace_back(edge.other, 1);
  } else {
    ++it->second;
  }
}

void MeasureEnds(const FaceAdjacency& adjacency, Ring* ring) {
  const std::array<EndSectors, 2> sectors = CollectEndSectors(adjacency, *ring);
  for (std::size_t k = 0; k < 2; ++k) {
    RingEnd& end = ring->ends[k];
    double radii = 0;
    for (const EndSector& sector : sectors[k]) {
      if (sector.edge != nullptr) {
        radii += sector.radius;
        CountSector(*sector.edge, &end);
      }
    }
    std::sort(end.neighbours.begin(), end.neighbours.end(), [](const auto& a, const auto& b) {
      return std::pair(-a.second, a.first) < std::pair(-b.second, b.first);
    });
    end.radius = CalcEndRadius(*ring, k, end.sectors > 0 ? radii / end.sectors : 0);
  }
}

Ring MakeRing(const Part& part, const FaceAdjacency& adjacency, std::vector<FaceId> faces,
              FeatureId feature) {
  Ring ring;
  ring.surface = part.faces[faces.front().index()].surface;
  ring.kind = ring.surface.kind;
  ring.faces = std::move(faces);
  ring.feature = feature;
  ring.origin_B = ring.surface.origin;
  ring.axis_B = Canonical(ring.surface.axis);
  MeasureRing(part, &ring);
  MeasureEnds(adjacency, &ring);
  return ring;
}

bool IsSame(const Surface& a, const Surface& b, double tolerance) {
  return a.kind == b.kind && a.outward == b.outward && IsParallel(a.axis, b.axis) &&
         std::abs(a.radius - b.radius) < tolerance && std::abs(a.second - b.second) < tolerance &&
         DistanceToAxis(b.origin, a.origin, a.axis) < tolerance &&
         (a.kind == SurfaceKind::kCylinder || (a.origin - b.origin).norm() < tolerance);
}

/** Faces of one surface that meet, by their first face; only those that `use` admits. */
template <typename Use>
std::vector<std::vector<FaceId>> CollectPatches(const Part& part, const FaceAdjacency& adjacency,
                                                double tolerance, const Use& use) {
  std::vector<std::vector<FaceId>> patches;
  std::vector<bool> is_seen(part.faces.size(), false);
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    if (is_seen[f] || !use(FaceId(f))) {
      continue;
    }
    std::vector<FaceId> patch{FaceId(f)};
    is_seen[f] = true;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (const FaceNeighbour& neighbour : adjacency.neighbours(patch[i])) {
        const std::size_t other = neighbour.face.index();
        if (!is_seen[other] && use(neighbour.face) &&
            IsSame(part.faces[f].surface, part.faces[other].surface,
                   tolerance + part.faces[f].residual)) {
          is_seen[other] = true;
          patch.push_back(neighbour.face);
        }
      }
    }
    std::sort(patch.begin(), patch.end());
    patches.push_back(std::move(patch));
  }
  return patches;
}

double CalcTurn(const Part& part, const Ring& ring) {
  double area = 0;
  for (const FaceId face : ring.faces) {
    area += part.faces[face.index()].area;
  }
  const double length = ring.high - ring.low;
  return length > 0 ? area / (length * ring.surface.radius) : 0;
}

bool IsCoaxial(const Ring& a, const Ring& b, double tolerance) {
  const Vec3 near = b.origin_B + (a.origin_B - b.origin_B).dot(b.axis_B) * b.axis_B;
  return a.is_inward == b.is_inward && IsParallel(a.axis_B, b.axis_B) &&
         DistanceToAxis(near, a.origin_B, a.axis_B) < tolerance;
}

class Linker {
 public:
  Linker(const Part& part, const FaceAdjacency& adjacency, const RingSet& set, double tolerance)
      : part_(part), adjacency_(adjacency), set_(set), tolerance_(2 * tolerance) {}

  [[nodiscard]] std::optional<RingLink> Find(std::uint32_t ring, std::size_t end) const {
    const RingEnd& at = set_.rings[ring].ends[end];
    std::map<std::uint32_t, int> direct;
    std::vector<FaceId> shoulder;
    int across = 0;
    for (const auto& [face, count] : at.neighbours) {
      const std::uint32_t other = set_.ring_of_face[face.index()];
      const Surface& surface = part_.faces[face.index()].surface;
      if (other != RingSet::kNone && IsNext(ring, other)) {
        direct[other] += count;
      } else if (surface.kind == SurfaceKind::kPlane &&
                 IsParallel(surface.axis, set_.rings[ring].axis_B)) {
        shoulder.push_back(face);
        across += count;
      }
    }
    for (const auto& [other, count] : direct) {
      if (2 * count >= at.sectors) {
        const auto other_end = FindEndAt(other, set_.rings[ring].faces);
        return other_end ? std::optional(RingLink{other, *other_end, {}}) : std::nullopt;
      }
    }
    if (2 * at.open > at.sectors) {
      return FindTouching(ring, end);
    }
    return 2 * across >= at.sectors && across > 0 ? FindAcross(ring, shoulder) : std::nullopt;
  }

 private:
  [[nodiscard]] bool IsNext(std::uint32_t a, std::uint32_t b) const {
    return a != b && IsCoaxial(set_.rings[a], set_.rings[b], tolerance_);
  }

  /** The ring whose open end has the same circle: faces that were not sewn, or that the mesher did
   not bring together. */
  [[nodiscard]] std::optional<RingLink> FindTouching(std::uint32_t ring, std::size_t end) const {
    const Ring& from = set_.rings[ring];
    for (std::uint32_t other = 0; other < set_.rings.size(); ++other) {
      for (std::size_t e = 0; e < 2; ++e) {
        const Ring& to = set_.rings[other];
        const double slack = 10 * tolerance_;
        if (IsNext(ring, other) && 2 * to.ends[e].open > to.ends[e].sectors &&
            (from.point(end) - to.point(e)).dot(from.axis_B) < slack &&
            (from.point(end) - to.point(e)).dot(from.axis_B) > -slack &&
            std::abs(from.ends[end].radius - to.ends[e].radius) < slack) {
          return RingLink{other, e, {}};
        }
      }
    }
    return std::nullopt;
  }

  /** The end of a ring that has one of `faces` beside it. */
  [[nodiscard]] std::optional<std::size_t> FindEndAt(std::uint32_t ring,
                                                     const std::vector<FaceId>& faces) const {
    std::array<int, 2> counts{0, 0};
    for (std::size_t end = 0; end < 2; ++end) {
      for (const auto& [face, count] : set_.rings[ring].ends[end].neighbours) {
        counts[end] += IsMember(faces, face) ? count : 0;
      }
    }
    if (counts[0] == counts[1]) {
      return std::nullopt;
    }
    return counts[0] > counts[1] ? 0 : 1;
  }

  [[nodiscard]] std::optional<RingLink> FindAcross(std::uint32_t ring,
                                                   const std::vector<FaceId>& shoulder) const {
    std::optional<RingLink> found;
    const Ring& from = set_.rings[ring];
    for (const FaceId face : shoulder) {
      for (const FaceNeighbour& neighbour : adjacency_.neighbours(face)) {
        const std::uint32_t other = set_.ring_of_face[neighbour.face.index()];
        if (other == RingSet::kNone || other == ring) {
          continue;
        }
        if (!IsNext(ring, other)) {
          if (from.is_inward && set_.rings[other].is_inward && !neighbour.Is(EdgeSense::kConcave)) {
            return std::nullopt;  // Another hole in the same floor.
          }
          continue;
        }
        const auto end = FindEndAt(other, shoulder);
        if (end && (!found || other < found->ring)) {
          found = RingLink{other, *end, shoulder};
        }
      }
    }
    if (found && from.is_inward) {
      const auto [a, b] = std::minmax(from.surface.radius, set_.rings[found->ring].surface.radius);
      if (from.kind == SurfaceKind::kCylinder &&
          set_.rings[found->ring].kind == SurfaceKind::kCylinder && b > kLargestStep * a) {
        return std::nullopt;
      }
    }
    return found;
  }

  const Part& part_;
  const FaceAdjacency& adjacency_;
  const RingSet& set_;
  double tolerance_;
};

}  // namespace

RingSet FindRings(const Part& part, const FaceAdjacency& adjacency, double tolerance) {
  RingSet set;
  set.ring_of_face.assign(part.faces.size(), RingSet::kNone);
  const auto add = [&](const std::vector<FaceId>& faces, FeatureId feature) {
    for (const FaceId face : faces) {
      set.ring_of_face[face.index()] = static_cast<std::uint32_t>(set.rings.size());
    }
    set.rings.push_back(MakeRing(part, adjacency, faces, feature));
  };
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    const Feature& feature = part.features[i];
    if (IsCylinder(feature.kind) || IsCone(feature.kind)) {
      add(feature.faces, FeatureId(i));
    }
  }
  const auto is_torus = [&part](FaceId face) {
    const Face& f = part.faces[face.index()];
    return f.surface.kind == SurfaceKind::kTorus && f.triangle_count > 0;
  };
  for (const auto& patch : CollectPatches(part, adjacency, tolerance, is_torus)) {
    add(patch, FeatureId());
  }
  return set;
}

std::vector<Ring> FindPartialCylinders(const Part& part, const FaceAdjacency& adjacency,
                                       const RingSet& set, double tolerance) {
  const auto is_partial = [&](FaceId face) {
    const Face& f = part.faces[face.index()];
    return f.surface.kind == SurfaceKind::kCylinder && f.triangle_count > 0 &&
           set.ring_of_face[face.index()] == RingSet::kNone;
  };
  std::vector<Ring> found;
  for (const auto& patch : CollectPatches(part, adjacency, tolerance, is_partial)) {
    found.push_back(MakeRing(part, adjacency, patch, FeatureId()));
    found.back().turn = CalcTurn(part, found.back());
  }
  return found;
}

std::vector<RingChain> FindChains(const Part& part, const FaceAdjacency& adjacency,
                                  const RingSet& set, double tolerance) {
  const Linker linker(part, adjacency, set, tolerance);
  std::vector<std::array<std::optional<RingLink>, 2>> links(set.rings.size());
  for (std::uint32_t r = 0; r < set.rings.size(); ++r) {
    links[r] = {linker.Find(r, 0), linker.Find(r, 1)};
  }
  const auto follow = [&](std::uint32_t ring, std::size_t end) -> const RingLink* {
    const auto& link = links[ring][end];
    if (!link) {
      return nullptr;
    }
    const auto& back = links[link->ring][link->end];
    return back && back->ring == ring && back->end == end ? &*link : nullptr;
  };
  std::vector<RingChain> chains;
  std::vector<bool> is_seen(set.rings.size(), false);
  for (std::uint32_t r = 0; r < set.rings.size(); ++r) {
    if (is_seen[r]) {
      continue;
    }
    std::uint32_t ring = r;  // To the low end of the chain first; rings may run in a circle.
    std::size_t end = 0;
    for (std::size_t i = 0; i < set.rings.size(); ++i) {
      const RingLink* link = follow(ring, end);
      if (link == nullptr || link->ring == r) {
        break;
      }
      ring = link->ring;
      end = 1 - link->end;
    }
    RingChain chain{{ring, end, {}}};
    is_seen[ring] = true;
    while (const RingLink* link = follow(chain.back().ring, chain.back().far())) {
      if (is_seen[link->ring]) {
        break;
      }
      is_seen[link->ring] = true;
      chain.push_back({link->ring, link->end, link->shoulder});
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace hvas::product
