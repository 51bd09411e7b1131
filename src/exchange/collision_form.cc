#include "exchange/collision_form.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

namespace hvas::exchange {
namespace {

using product::Feature;
using product::FeatureKind;
using product::Part;
using std::numbers::pi;

constexpr double kFullTurn =
    2 * pi - 0.1;                    // [rad]; less is an arc, whose triangles serve: a choice.
constexpr double kOnSurface = 1e-6;  // [m] from a cylinder, of points that lie on it.
constexpr double kFlatness = 2e-4;   // Of the diagonal: what chords are off convexity by.
constexpr std::size_t kMostPieces = 4000;   // As MuJoCo takes seconds to load more: a choice.
constexpr double kLeastArea = 1e-9;         // [m^2]; smaller triangles have no frustum: a choice.
constexpr double kMostDepth = 2e-3;         // [m] that a frustum goes in: a choice.
constexpr double kDepthOfThickness = 0.25;  // Of the smallest side of the box: a choice.
constexpr double kNarrowing = 0.6;  // Of the inner triangle against the outer one: a choice.
constexpr double kPlane =
    1 - 1e-6;  // Cosine of 1.4 mrad between normals of one plane, or axes: a choice.
constexpr double kWallOfRadius = 0.3;  // Thickness of the walls of a hole: a choice.

bool IsFull(const Feature& feature, FeatureKind kind) {
  return feature.kind == kind && feature.coverage >= kFullTurn;
}

double RadiusOf(const Feature& feature, std::size_t index, const FeatureRadii& radii) {
  const auto sized = radii.find(index);
  return sized == radii.end() ? feature.radius : sized->second;
}

// Where a point is relative to a feature's axis.
struct OffAxis {
  double along{0};
  Vec3 out{Vec3::Zero()};  // From the axis to the point.
};

OffAxis MeasureOffAxis(const Feature& feature, const Vec3& p_B) {
  const Vec3 from_origin = p_B - feature.origin_B;
  const double along = from_origin.dot(feature.axis_B);
  return {along, from_origin - along * feature.axis_B};
}

std::vector<Vec3> MoveToRadii(const Part& part, const FeatureRadii& radii) {
  std::vector<Vec3> vertices = part.display_mesh.vertices;
  for (const auto& [index, radius] : radii) {
    const Feature& feature = part.features[index];
    for (Vec3& p_B : vertices) {
      const auto [along, out] = MeasureOffAxis(feature, p_B);
      const double distance = out.norm();
      if (std::abs(distance - feature.radius) < kOnSurface &&
          along > feature.span_low - kOnSurface && along < feature.span_high + kOnSurface) {
        p_B += (radius / distance - 1) * out;
      }
    }
  }
  return vertices;
}

bool IsConvex(const Part& part, const std::vector<Vec3>& vertices) {
  const double slack = kFlatness * part.box_B.size().norm();
  return std::all_of(
      part.display_mesh.triangles.begin(), part.display_mesh.triangles.end(), [&](const auto& t) {
        const Vec3& a = vertices[t[0]];
        const Vec3 normal = (vertices[t[1]] - a).cross(vertices[t[2]] - a);
        const double length = normal.norm();
        return length < 2 * kLeastArea ||
               std::all_of(vertices.begin(), vertices.end(),
                           [&](const Vec3& p) { return (p - a).dot(normal) <= slack * length; });
      });
}

Cylinder MakeCylinder(const Feature& feature, double radius) {
  const double middle = 0.5 * (feature.span_low + feature.span_high);
  return {spatial::Pose(Quat::FromTwoVectors(Vec3::UnitZ(), feature.axis_B),
                        feature.origin_B + middle * feature.axis_B),
          radius, 0.5 * (feature.span_high - feature.span_low)};
}

// A wall is a box whose inner side touches the circle in its middle.
void AddWalls(const Feature& feature, double radius, CollisionForm* form) {
  const Cylinder hole = MakeCylinder(feature, radius);
  const double half = radius * std::tan(pi / kWalls);
  const double outside = (1 + kWallOfRadius) * radius;
  for (int i = 0; i < kWalls; ++i) {
    const double angle = 2 * pi * i / kWalls;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const Vec3 side(-std::sin(angle), std::cos(angle), 0);
    std::vector<Vec3> piece;
    for (const double r : {radius, outside}) {
      for (const double s : {-half, half}) {
        for (const double z : {-hole.half_length, hole.half_length}) {
          piece.push_back(hole.X_BC * Vec3(r * out + s * side + z * Vec3::UnitZ()));
        }
      }
    }
    form->pieces.push_back(std::move(piece));
  }
}

using Polygon = std::vector<std::uint32_t>;  // Vertices, counterclockwise from outside.

bool IsConvexPolygon(const Polygon& polygon, const std::vector<Vec3>& vertices,
                     const Vec3& normal) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = vertices[polygon[i]];
    const Vec3 before = p - vertices[polygon[(i + n - 1) % n]];
    const Vec3 after = vertices[polygon[(i + 1) % n]] - p;
    if (before.cross(after).dot(normal) < -1e-9 * before.norm() * after.norm()) {
      return false;
    }
  }
  return true;
}

// One polygon from two that share the edge from u to v of the first, where that is convex.
std::optional<Polygon> Join(const Polygon& first, const Polygon& second, std::uint32_t u,
                            std::uint32_t v, const std::vector<Vec3>& vertices,
                            const Vec3& normal) {
  Polygon joined = first;
  std::rotate(joined.begin(), std::find(joined.begin(), joined.end(), v), joined.end());  // v .. u
  Polygon rest = second;
  std::rotate(rest.begin(), std::find(rest.begin(), rest.end(), u), rest.end());  // u .. v
  if (joined.back() != u || rest.back() != v) {
    return std::nullopt;
  }
  joined.insert(joined.end(), rest.begin() + 1, rest.end() - 1);
  return IsConvexPolygon(joined, vertices, normal) ? std::optional(joined) : std::nullopt;
}

Vec3 NormalOf(const Polygon& polygon, const std::vector<Vec3>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += (vertices[polygon[i - 1]] - vertices[polygon[0]])
               .cross(vertices[polygon[i]] - vertices[polygon[0]]);
  }
  return sum.normalized();
}

// Convex polygons of a face: triangles that are joined across their edges as long as that is plane
// and convex (after Hertel and Mehlhorn). A strip of a cylinder or a cone is a row of quadrangles.
std::vector<Polygon> ListPolygons(const Part& part, const product::Face& face,
                                  const std::vector<Vec3>& vertices) {
  std::vector<Polygon> polygons;
  for (std::uint32_t i = 0; i < face.display_triangle_count; ++i) {
    const auto& t = part.display_mesh.triangles[face.first_display_triangle + i];
    polygons.push_back({t[0], t[1], t[2]});
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> owner;  // Of directed edges.
  const auto own = [&](std::size_t polygon) {
    const Polygon& corners = polygons[polygon];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      owner[{corners[i], corners[(i + 1) % corners.size()]}] = polygon;
    }
  };
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    own(i);
  }
  const auto edges = owner;
  for (const auto& [edge, unused] : edges) {
    const auto [u, v] = edge;
    const auto other = owner.find({v, u});
    if (u > v || other == owner.end() || owner.at(edge) == other->second) {
      continue;
    }
    const std::size_t first = owner.at(edge);
    const std::size_t second = other->second;
    const Vec3 normal = NormalOf(polygons[first], vertices);
    if (normal.dot(NormalOf(polygons[second], vertices)) < kPlane) {
      continue;
    }
    if (auto joined = Join(polygons[first], polygons[second], u, v, vertices, normal)) {
      polygons[first] = std::move(*joined);
      polygons[second].clear();
      owner.erase({u, v});
      owner.erase({v, u});
      own(first);
    }
  }
  std::erase_if(polygons, [](const Polygon& polygon) { return polygon.empty(); });
  return polygons;
}

// Whether a hole goes along the axis of a shaft, within its span.
bool IsHollow(const Part& part, const Feature& shaft) {
  return std::any_of(part.features.begin(), part.features.end(), [&](const Feature& hole) {
    if (hole.kind != FeatureKind::kHole || hole.radius >= shaft.radius ||
        std::abs(hole.axis_B.dot(shaft.axis_B)) < kPlane) {
      return false;
    }
    const auto [along, out] = MeasureOffAxis(shaft, hole.origin_B);
    const double half = 0.5 * (hole.span_high - hole.span_low);
    const double middle =
        along + 0.5 * (hole.span_high + hole.span_low) * hole.axis_B.dot(shaft.axis_B);
    return out.norm() + hole.radius < shaft.radius && middle + half > shaft.span_low &&
           middle - half < shaft.span_high;
  });
}

void AddFrustum(const Polygon& polygon, const std::vector<Vec3>& vertices, double depth,
                CollisionForm* form) {
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t i : polygon) {
    middle += vertices[i] / static_cast<double>(polygon.size());
  }
  Vec3 doubled_area = Vec3::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    doubled_area +=
        (vertices[polygon[i]] - middle).cross(vertices[polygon[(i + 1) % polygon.size()]] - middle);
  }
  if (doubled_area.norm() < 2 * kLeastArea) {
    return;
  }
  std::vector<Vec3> piece;
  for (const std::uint32_t i : polygon) {
    piece.push_back(vertices[i]);
  }
  for (const std::uint32_t i : polygon) {
    piece.push_back(middle - depth * doubled_area.normalized() +
                    kNarrowing * (vertices[i] - middle));
  }
  form->pieces.push_back(std::move(piece));
}

}  // namespace

CollisionForm MakeCollisionForm(const Part& part, const FeatureRadii& radii) {
  CollisionForm form;
  const std::vector<Vec3> vertices = MoveToRadii(part, radii);
  std::set<std::size_t> done;  // Faces that have a form already.
  const auto add_features = [&](FeatureKind kind, const auto& add) {
    for (std::size_t i = 0; i < part.features.size(); ++i) {
      const Feature& feature = part.features[i];
      if (IsFull(feature, kind) && (kind == FeatureKind::kHole || !IsHollow(part, feature))) {
        add(feature, RadiusOf(feature, i, radii));
        for (const product::FaceId face : feature.faces) {
          done.insert(face.index());
        }
      }
    }
  };
  add_features(FeatureKind::kShaft, [&](const Feature& feature, double radius) {
    form.cylinders.push_back(MakeCylinder(feature, radius));
  });
  if (IsConvex(part, vertices)) {
    form.pieces.push_back(vertices);
    return form;
  }
  add_features(FeatureKind::kHole,
               [&](const Feature& feature, double radius) { AddWalls(feature, radius, &form); });
  const double depth = std::min(kMostDepth, kDepthOfThickness * part.box_B.size().minCoeff());
  for (std::size_t i = 0; i < part.faces.size(); ++i) {
    if (!done.contains(i)) {
      for (const Polygon& polygon : ListPolygons(part, part.faces[i], vertices)) {
        AddFrustum(polygon, vertices, depth, &form);
      }
    }
  }
  if (form.pieces.size() > kMostPieces) {
    form = {{vertices}, {}, true};
  }
  return form;
}

}  // namespace hvas::exchange
