#include "contact/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hvas::contact {
namespace {

constexpr double kOnFeature = 1e-9;  // [m]; nearer than this the direction to a feature is noise.

// Unit gradient; where the field has none (on a medial axis), away from the part's centre.
Vec3 DirectionOf(const Hit& field, const Vec3& p) {
  const Vec3 g(static_cast<double>(field.gradient[0]), static_cast<double>(field.gradient[1]),
               static_cast<double>(field.gradient[2]));
  const double norm = g.norm();
  if (norm > 1e-3) {
    return g / norm;
  }
  return p.norm() > 0 ? Vec3(p.normalized()) : Vec3::UnitZ();
}

Refined Trilinear(const Hit& field, const Vec3& p) {
  return {static_cast<double>(field.distance),
          DirectionOf(field, p),
          kNoFace,
          kNoFace,
          kNoFace,
          false,
          true};
}

struct Closest {
  double squared{std::numeric_limits<double>::infinity()};
  Vec3 q{Vec3::Zero()};
  std::uint32_t triangle{kNoFace};
  TriangleFeature feature{TriangleFeature::kInside};
};

// The feature of the solid behind a feature of a triangle.
struct SolidFeature {
  VertexKind kind{VertexKind::kSmooth};  // Smooth: inside a face.
  std::uint32_t face{kNoFace};
  std::uint32_t other_face{kNoFace};
};

SolidFeature FeatureOf(const Mesh& mesh, const Closest& closest) {
  const std::uint32_t t = closest.triangle;
  SolidFeature result;
  result.face = mesh.face[t];
  if (closest.feature == TriangleFeature::kInside) {
    return result;
  }
  const auto index = static_cast<std::size_t>(closest.feature);
  if (closest.feature <= TriangleFeature::kEdge2) {
    const EdgeKind kind = mesh.edge_kind[t][index - 1];
    if (kind == EdgeKind::kConvex || kind == EdgeKind::kConcave) {
      result.kind = VertexKind::kOnEdge;
      result.other_face = mesh.face[mesh.neighbour[t][index - 1]];
    }
    return result;
  }
  const std::uint32_t v = mesh.triangles[t][index - 4];
  result.kind = mesh.vertex_kind[v];
  if (result.kind != VertexKind::kSmooth) {
    // The faces of the two edges at this corner; both belong to it.
    const auto& pair = mesh.vertex_faces[v];
    result.other_face = pair[0] == result.face ? pair[1] : pair[0];
  }
  return result;
}

// The distance from the smooth surface of freeform faces near a triangle. False where it has no
// foot of p.
bool FromCurved(const Shape::Data& shape, std::uint32_t triangle, const Vec3& p, Refined* out) {
  CurvedPoint foot;
  if (!FindFoot(shape.mesh, triangle, p, FootOn::kSurface, &foot)) {
    return false;
  }
  *out = {};
  out->distance = (p - foot.q).dot(foot.normal);
  out->gradient = foot.normal;
  out->face = shape.mesh.face[foot.triangle];
  out->triangle = foot.triangle;
  out->is_exact = true;
  return true;
}

// Whether a distance that is wrong by no more than `error` is good enough.
bool IsRoughEnough(const FaceFilter& filter, double distance, double error) {
  return filter.allows_rough && distance > 2 * error;
}

Refined FromFace(const Shape::Data& shape, const Closest& closest, std::uint32_t face,
                 const Vec3& p, double sign, const Hit& field, const FaceFilter& filter) {
  Refined result;
  result.face = face;
  const double mesh_distance = std::sqrt(closest.squared);
  const auto exact = CalcFaceDistance(shape.exact, face, p);
  const double tolerance = 2 * shape.exact.deviation[face] + kOnFeature;
  if (exact.is_valid && std::abs(std::abs(exact.distance) - mesh_distance) <= tolerance) {
    result.distance = exact.distance;
    result.gradient = exact.gradient;
    result.is_exact = true;
    return result;
  }
  const bool is_freeform = shape.exact.IsFreeform(face);
  const bool is_rough = IsRoughEnough(filter, sign * mesh_distance, tolerance);
  if (is_freeform && !is_rough && FromCurved(shape, closest.triangle, p, &result)) {
    return result;
  }
  result.face = face;
  result.is_rough = is_freeform && is_rough;
  result.distance = sign * mesh_distance;
  const bool is_off = mesh_distance > 1e3 * kOnFeature;
  result.gradient =
      is_off ? Vec3(sign / mesh_distance * (p - closest.q)) : shape.mesh.NormalOf(closest.triangle);
  if (result.gradient.isZero()) {
    result.gradient = DirectionOf(field, p);
  }
  return result;
}

Refined FromEdge(const Shape::Data& shape, const Closest& closest, const SolidFeature& feature,
                 const Vec3& p, double sign, const FaceFilter& filter) {
  Refined result;
  result.face = feature.face;
  result.other_face = feature.other_face;
  Vec3 q = closest.q;
  const Vec3 normal = shape.mesh.Pseudonormal(closest.triangle, closest.feature).normalized();
  const double tolerance =
      feature.kind == VertexKind::kOnEdge
          ? 4 * (shape.exact.deviation[feature.face] + shape.exact.deviation[feature.other_face]) +
                kOnFeature
          : 0;
  const bool is_freeform =
      shape.exact.IsFreeform(feature.face) ||
      (feature.other_face != kNoFace && shape.exact.IsFreeform(feature.other_face));
  result.is_rough =
      is_freeform && IsRoughEnough(filter, sign * std::sqrt(closest.squared), tolerance);
  if (feature.kind == VertexKind::kOnEdge && !result.is_rough) {
    Vec3 on_curve = q;
    const auto index = static_cast<std::size_t>(closest.feature);
    const std::uint32_t other =
        !is_freeform ? kNoFace
        : closest.feature <= TriangleFeature::kEdge2
            ? shape.mesh.neighbour[closest.triangle][index - 1]
            : shape.mesh.AroundOn(closest.triangle, index - 4, feature.other_face);
    if (ProjectOnEdge({shape, nullptr, feature.face, closest.triangle},
                      {shape, nullptr, feature.other_face, other}, p, &on_curve) &&
        std::abs((p - on_curve).norm() - std::sqrt(closest.squared)) <= tolerance) {
      q = on_curve;
      result.is_exact = true;
    }
  } else if (feature.kind == VertexKind::kCorner) {
    result.is_exact = true;  // Corners are where the mesh has them.
  }
  const double distance = (p - q).norm();
  if (distance > 1e2 * kOnFeature) {
    const double side = (p - q).dot(normal) >= 0 ? 1 : -1;
    result.distance = side * distance;
    result.gradient = side / distance * (p - q);
  } else {
    result.distance = sign * distance;
    result.gradient = normal;
  }
  return result;
}

// The list of a zone as seen from a point of it.
class ZoneList {
 public:
  ZoneList(const Shape::Data& shape, std::uint32_t list, const Vec3& p, double from_centre)
      : shape_(shape), p_(p), from_centre_(from_centre), faces_(shape, list, p) {}

  /** Where the solid is what its faces have in common, the way out of it is the way out of the face
   that is left soonest; from outside, the way to a face is the way to the solid if it ends inside
   the other faces. The same with inside and outside exchanged where any face will do. True when
   that decides; what lies no nearer than the filter's limit may be told by a lower bound. False
   with a valid answer when that is a bound only: the way is at least as long. */
  [[nodiscard]] bool FromSurfaces(const FaceFilter& filter, Refined* out) const noexcept {
    if (faces_.kind() == ListFaces::Kind::kMixed) {
      return false;
    }
    const double side = faces_.kind() == ListFaces::Kind::kIntersection ? 1 : -1;
    std::size_t last = 0;
    double others = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < faces_.count(); ++i) {
      if (filter.Drops(faces_.face(i)) || !faces_.surface(i).is_valid) {
        return false;
      }
      if (i > 0 && side * faces_.surface(i).distance > side * faces_.surface(last).distance) {
        others = std::max(others, side * faces_.surface(last).distance);
        last = i;
      } else if (i > 0) {
        others = std::max(others, side * faces_.surface(i).distance);
      }
    }
    const double way = side * faces_.surface(last).distance;
    const bool is_far = side > 0 && way >= filter.limit;
    *out = {faces_.surface(last).distance,
            faces_.surface(last).gradient,
            faces_.face(last),
            kNoFace,
            true,
            true};
    return way <= 0 || others + way <= 0 || is_far;
  }

  /** How near a triangle has to be for the solid to be nearer than a limit. */
  [[nodiscard]] double ReachFor(double limit) const noexcept {
    double reach = limit;
    for (std::size_t i = 0; i < faces_.count(); ++i) {
      constexpr double kMost =
          9;  // Deviations that an edge of two faces may be away from its mesh.
      reach = std::max(reach, limit + kMost * shape_.exact.deviation[faces_.face(i)] + kOnFeature);
    }
    return faces_.count() > 0 ? reach : std::numeric_limits<double>::infinity();
  }

  /** The closest of the triangles nearer than `reach`; may be none. */
  [[nodiscard]] Closest Find(const FaceFilter& filter, double reach) const noexcept {
    Closest best;
    best.squared = reach * reach;
    double best_distance = reach;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const ListDistances::Entries entries = faces_[i];
      if (entries.least > best_distance) {
        break;
      }
      if (!filter.Drops(entries.face)) {
        Search(entries, filter, &best, &best_distance);
      }
    }
    return best;
  }

 private:
  void Search(const ListDistances::Entries& entries, const FaceFilter& filter, Closest* best,
              double* best_distance) const noexcept {
    ForEachNearTriangle(
        shape_, entries, p_, from_centre_, *best_distance,
        [&](std::uint32_t triangle) {
          return entries.face == kNoFace && filter.Drops(shape_.mesh.face[triangle]);
        },
        [&](std::uint32_t triangle, const Vec3& q, TriangleFeature feature, double squared) {
          if (squared < best->squared) {
            *best = {squared, q, triangle, feature};
            *best_distance = std::sqrt(squared) + 1e-6 * from_centre_;
          }
        });
  }

  const Shape::Data& shape_;
  const Vec3& p_;
  double from_centre_;
  ListDistances faces_;
};

Refined FromFeature(const Shape::Data& shape, const Closest& closest, const SolidFeature& feature,
                    const Vec3& p, const Hit& field, const FaceFilter& filter) {
  const Vec3 normal = shape.mesh.Pseudonormal(closest.triangle, closest.feature);
  double sign = (p - closest.q).dot(normal) >= 0 ? 1 : -1;
  if (shape.mesh.IsOpenAt(closest.triangle, closest.feature)) {
    sign = field.distance >= 0 ? 1 : -1;
  }
  return feature.kind == VertexKind::kSmooth
             ? FromFace(shape, closest, feature.face, p, sign, field, filter)
             : FromEdge(shape, closest, feature, p, sign, filter);
}

// True where the closest feature lies on a concave edge between a kept face and an ignored one. At
// a corner only the corner's own edges with ignored faces count: a plane that meets the ignored
// bore in its convex rim may meet a wall in a concave edge at the same corner.
bool IsConcaveWithIgnored(const Mesh& mesh, const Closest& closest, const FaceFilter& filter) {
  const std::uint32_t t = closest.triangle;
  const auto index = static_cast<std::size_t>(closest.feature);
  const auto is_concave = [&](std::size_t k) {
    return mesh.edge_kind[t][k] == EdgeKind::kConcave &&
           filter.Drops(mesh.face[mesh.neighbour[t][k]]);
  };
  if (closest.feature <= TriangleFeature::kEdge2) {
    return is_concave(index - 1);
  }
  return is_concave(index - 4) || is_concave((index - 2) % 3);
}

// The faces that something else answers for are gone, but the material behind them is not: what
// lies beyond them counts only where it faces p. Where a kept face meets an ignored one in a
// concave edge, the kept one goes on beyond the edge, as for a pin at the bottom of its hole.
Refined WithoutIgnored(const Shape::Data& shape, const ZoneList& list, const Vec3& p,
                       const FaceFilter& filter, double reach, const Hit& field) {
  const Closest closest = list.Find(filter, reach);
  if (closest.triangle == kNoFace) {
    return Nothing();
  }
  const SolidFeature feature = FeatureOf(shape.mesh, closest);
  const bool touches_ignored = feature.other_face != kNoFace && filter.Drops(feature.other_face);
  if (touches_ignored && !IsConcaveWithIgnored(shape.mesh, closest, filter)) {
    return Nothing();
  }
  if (touches_ignored) {
    const auto exact = CalcFaceDistance(shape.exact, feature.face, p);
    if (!exact.is_valid || std::abs(exact.distance) > std::sqrt(closest.squared) + kOnFeature) {
      return Nothing();
    }
    Refined result;
    result.distance = exact.distance;
    result.gradient = exact.gradient;
    result.face = feature.face;
    result.is_exact = true;
    result.is_continued = true;
    return result;
  }
  const Refined result = FromFeature(shape, closest, feature, p, field, filter);
  return result.distance >= 0 ? result : Nothing();
}

}  // namespace

bool ProjectOnEdge(FaceSurface a, FaceSurface b, const Vec3& p, Vec3* q) noexcept {
  constexpr int kMaxSteps = 6;          // Newton's error squares in each: a choice.
  constexpr double kConverged = 1e-11;  // [m]: far below what is felt. A choice.
  Vec3 x = *q;
  for (int i = 0; i < kMaxSteps; ++i) {
    const auto da = a.CalcDistance(x);
    const auto db = b.CalcDistance(x);
    if (!da.is_valid || !db.is_valid) {
      return false;
    }
    const Vec3 tangent = da.gradient.cross(db.gradient);
    const double det = tangent.squaredNorm();
    if (det < 1e-3) {
      return false;
    }
    const Vec3 step = (-da.distance * db.gradient.cross(tangent) -
                       db.distance * tangent.cross(da.gradient) + (p - x).dot(tangent) * tangent) /
                      det;
    x += step;
    if (step.squaredNorm() < kConverged * kConverged) {
      *q = x;
      return true;
    }
  }
  *q = x;
  return std::abs(a.CalcDistance(x).distance) < kOnFeature &&
         std::abs(b.CalcDistance(x).distance) < kOnFeature;
}

ZoneAt FindZone(const Shape::Data& shape, const Vec3& p) noexcept {
  const FieldView& grid = shape.field.view;
  const double inverse = 1 / shape.voxel;
  ZoneAt result;
  int cell[3];
  for (int k = 0; k < 3; ++k) {
    const double u = (p[k] - static_cast<double>(grid.origin[k])) * inverse;
    if (!(u >= 0 && u < kBlockCells * grid.blocks[k])) {
      return result;
    }
    cell[k] = static_cast<int>(u);
    result.centre[k] = static_cast<double>(grid.origin[k]) + ((cell[k] & ~1) + 1) * shape.voxel;
  }
  const int block = grid.top[((cell[2] >> 3) * grid.blocks[1] + (cell[1] >> 3)) * grid.blocks[0] +
                             (cell[0] >> 3)];
  if (block <= kTopFace) {
    result.code = zone::kExact | static_cast<std::uint32_t>(kTopFace - block);
    result.is_known = true;
    return result;
  }
  if (block < 0) {
    return result;
  }
  const int index = block * kZonesPerBlock + ((cell[2] & 7) >> 1) * 16 + ((cell[1] & 7) >> 1) * 4 +
                    ((cell[0] & 7) >> 1);
  result.code = shape.exact.zones[static_cast<std::size_t>(index)];
  result.slack = static_cast<double>(shape.field.slack[static_cast<std::size_t>(block)]);
  result.is_known = true;
  return result;
}

Refined Refine(const Shape::Data& shape, const Vec3& p, const Hit& field,
               const FaceFilter& filter) noexcept {
  const ZoneAt at = FindZone(shape, p);
  if (!at.is_known) {
    return Trilinear(field, p);
  }
  const std::uint32_t payload = at.payload();
  if (at.is_list()) {
    if (DropsAll(filter, FacesOfList(shape, payload))) {
      return Nothing();
    }
    const ZoneList list(shape, payload, p, (p - at.centre).norm());
    Refined from_surfaces = Nothing();
    if (list.FromSurfaces(filter, &from_surfaces)) {
      return from_surfaces;
    }
    // Outside, what is no nearer than the limit need not be found.
    const bool is_outside = static_cast<double>(field.distance) > at.slack - filter.limit;
    const double reach =
        is_outside ? list.ReachFor(filter.limit) : std::numeric_limits<double>::infinity();
    const Closest closest = list.Find({}, reach);
    if (closest.triangle == kNoFace) {
      return Nothing();
    }
    const SolidFeature feature = FeatureOf(shape.mesh, closest);
    if (filter.Drops(feature.face) || filter.Drops(feature.other_face)) {
      return WithoutIgnored(shape, list, p, filter, reach, field);
    }
    const Refined from_mesh = FromFeature(shape, closest, feature, p, field, filter);
    // Beside a round edge the chords of the mesh go a little too far.
    const bool is_too_far =
        from_surfaces.is_valid &&
        (from_surfaces.distance > 0 ? from_mesh.distance < from_surfaces.distance - kOnFeature
                                    : from_mesh.distance > from_surfaces.distance + kOnFeature);
    return is_too_far ? from_surfaces : from_mesh;
  }
  const std::uint32_t face = at.FaceIn(shape.mesh);
  if (filter.Drops(face)) {
    return Nothing();
  }
  if ((at.code & ~zone::kPayload) == zone::kExact) {
    const auto exact = CalcFaceDistance(shape.exact, payload, p);
    if (exact.is_valid) {
      return {exact.distance, exact.gradient, payload, kNoFace, kNoFace, true, true};
    }
  }
  const bool is_rough =
      at.is_smooth() && IsRoughEnough(filter, static_cast<double>(field.distance), at.slack);
  Refined result;
  if (at.is_smooth() && !is_rough && FromCurved(shape, payload, p, &result)) {
    return result;
  }
  result = Trilinear(field, p);
  result.face = face;
  result.is_rough = is_rough;
  return result;
}

}  // namespace hvas::contact
