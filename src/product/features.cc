#include "product/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/units.h"

namespace hvas::product {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kLeastCoverage = units::FromDeg(200);
constexpr double kLength = 2e-6;          // Same point, radius or plane [m].
constexpr double kRelativeLength = 1e-6;  // The same, of the part's size, for huge parts.
constexpr double kAngle = 1e-3;           // Same direction [rad].
constexpr double kPlaneAngle = 1e-4;      // Same plane, which is larger than a hole [rad].

/** A cylindrical face with its extent along its axis and around it. */
struct CylinderFace {
  std::uint32_t face{0};
  double low{0}, high{0};                         // Along the axis of its feature [m].
  std::vector<std::pair<double, double>> angles;  // Covered, start and length [rad].
};

/** Faces of one axis, radius and sense; may still fall apart along the axis. */
struct CylinderGroup {
  Vec3 origin;
  Vec3 axis;
  double radius{0};
  double outward{1};
  std::vector<CylinderFace> faces;
};

/** Of the two directions of a line the one whose largest component is positive. */
Vec3 Canonical(const Vec3& axis) {
  Vec3::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0 ? Vec3(-axis) : axis;
}

bool IsParallel(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() < kAngle;
}

double DistanceToAxis(const Vec3& p, const Vec3& origin, const Vec3& axis) {
  return (p - origin).cross(axis).norm();
}

double Tolerance(const Part& part) {
  const double size = part.box_B.is_empty() ? 0 : part.box_B.size().norm();
  return std::max(kLength, kRelativeLength * size);
}

CylinderFace MeasureFace(const Part& part, std::uint32_t index, const CylinderGroup& group) {
  const Face& face = part.faces[index];
  const Mat3 R = spatial::FrameFromZ(group.axis).toRotationMatrix();
  CylinderFace measured;
  measured.face = index;
  measured.low = std::numeric_limits<double>::infinity();
  measured.high = -measured.low;
  for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
    const auto& triangle = part.mesh.triangles[face.first_triangle + i];
    std::array<double, 3> angle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 q = R.transpose() * (part.mesh.vertices[triangle[k]] - group.origin);
      measured.low = std::min(measured.low, q.z());
      measured.high = std::max(measured.high, q.z());
      angle[k] = std::atan2(q.y(), q.x());
    }
    // A triangle spans less than half a turn: unwrap about its first corner.
    double low = 0;
    double high = 0;
    for (const double other : {angle[1], angle[2]}) {
      const double turn = std::remainder(other - angle[0], kTwoPi);
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    measured.angles.emplace_back(angle[0] + low, high - low);
  }
  return measured;
}

/** Length of the union of arcs [rad]. */
double CalcCoverage(const std::vector<CylinderFace>& faces) {
  std::vector<std::pair<double, double>> arcs;  // Start in [0, 2 pi), end; cut at 2 pi.
  for (const CylinderFace& face : faces) {
    for (const auto& [start, length] : face.angles) {
      const double low = start - kTwoPi * std::floor(start / kTwoPi);
      arcs.emplace_back(low, std::min(low + length, kTwoPi));
      if (low + length > kTwoPi) {
        arcs.emplace_back(0, low + length - kTwoPi);
      }
    }
  }
  std::sort(arcs.begin(), arcs.end());
  double covered = 0;
  double end = 0;
  for (const auto& [low, high] : arcs) {
    covered += std::max(0.0, high - std::max(low, end));
    end = std::max(end, high);
  }
  return covered;
}

std::vector<CylinderGroup> GroupCylinders(const Part& part, double tolerance) {
  std::vector<CylinderGroup> groups;
  for (std::uint32_t i = 0; i < part.faces.size(); ++i) {
    const Face& face = part.faces[i];
    if (face.surface.kind != SurfaceKind::kCylinder || face.triangle_count == 0) {
      continue;
    }
    const Vec3 axis = Canonical(face.surface.axis);
    auto group = std::find_if(groups.begin(), groups.end(), [&](const CylinderGroup& g) {
      const Vec3 near = face.box_B.centre();
      const Vec3 on_axis = face.surface.origin + (near - face.surface.origin).dot(axis) * axis;
      return g.outward == face.surface.outward &&
             std::abs(g.radius - face.surface.radius) < tolerance && IsParallel(g.axis, axis) &&
             DistanceToAxis(on_axis, g.origin, g.axis) < tolerance;
    });
    if (group == groups.end()) {
      groups.push_back({face.surface.origin, axis, face.surface.radius, face.surface.outward, {}});
      group = std::prev(groups.end());
    }
    group->faces.push_back(MeasureFace(part, i, *group));
  }
  return groups;
}

/** A hole or shaft from faces that touch along the axis; its origin is the middle of its span. */
Feature MakeCylinderFeature(const Part& part, const CylinderGroup& group,
                            std::vector<CylinderFace> faces) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  Feature feature;
  feature.kind = group.outward > 0 ? FeatureKind::kShaft : FeatureKind::kHole;
  feature.coverage = CalcCoverage(faces);
  std::sort(faces.begin(), faces.end(),
            [](const CylinderFace& a, const CylinderFace& b) { return a.face < b.face; });
  for (const CylinderFace& face : faces) {
    low = std::min(low, face.low);
    high = std::max(high, face.high);
    feature.area += part.faces[face.face].area;
    feature.faces.emplace_back(face.face);
  }
  feature.origin_B = group.origin + 0.5 * (low + high) * group.axis;
  feature.axis_B = group.axis;
  feature.radius = group.radius;
  feature.span_low = -0.5 * (high - low);
  feature.span_high = 0.5 * (high - low);
  return feature;
}

void AddCylinders(Part* part, double tolerance) {
  std::vector<Feature> found;
  for (CylinderGroup& group : GroupCylinders(*part, tolerance)) {
    std::sort(group.faces.begin(), group.faces.end(),
              [](const CylinderFace& a, const CylinderFace& b) {
                return std::pair(a.low, a.face) < std::pair(b.low, b.face);
              });
    std::vector<CylinderFace> run;
    double end = 0;
    const auto flush = [&] {
      if (!run.empty()) {
        Feature feature = MakeCylinderFeature(*part, group, std::move(run));
        if (feature.coverage >= kLeastCoverage) {
          found.push_back(std::move(feature));
        }
        run = {};
      }
    };
    for (CylinderFace& face : group.faces) {
      if (!run.empty() && face.low > end + tolerance) {
        flush();
      }
      end = run.empty() ? face.high : std::max(end, face.high);
      run.push_back(std::move(face));
    }
    flush();
  }
  std::stable_sort(found.begin(), found.end(), [](const Feature& a, const Feature& b) {
    return a.faces.front() < b.faces.front();
  });
  part->features.insert(part->features.end(), found.begin(), found.end());
}

/** Area and area times centroid of a face's triangles. */
std::pair<double, Vec3> CalcMoment(const Part& part, const Face& face) {
  double area = 0;
  Vec3 moment = Vec3::Zero();
  for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
    const auto& t = part.mesh.triangles[face.first_triangle + i];
    const Vec3& a = part.mesh.vertices[t[0]];
    const Vec3& b = part.mesh.vertices[t[1]];
    const Vec3& c = part.mesh.vertices[t[2]];
    const double piece = 0.5 * (b - a).cross(c - a).norm();
    area += piece;
    moment += piece / 3 * (a + b + c);
  }
  return {area, moment};
}

void AddPlanes(Part* part, double tolerance) {
  std::vector<Feature> planes;
  std::vector<std::pair<double, Vec3>> moments;
  for (std::uint32_t i = 0; i < part->faces.size(); ++i) {
    const Face& face = part->faces[i];
    const auto [area, moment] = CalcMoment(*part, face);
    if (face.surface.kind != SurfaceKind::kPlane || !(area > 0)) {
      continue;
    }
    const Vec3 centre = moment / area;
    std::size_t k = 0;
    for (; k < planes.size(); ++k) {
      const Feature& plane = planes[k];
      if (plane.axis_B.dot(face.surface.axis) > 0 &&
          plane.axis_B.cross(face.surface.axis).norm() < kPlaneAngle &&
          std::abs((centre - plane.origin_B).dot(plane.axis_B)) < tolerance &&
          std::abs((centre - plane.origin_B).dot(face.surface.axis)) < tolerance) {
        break;
      }
    }
    if (k == planes.size()) {
      planes.emplace_back();
      planes[k].origin_B = centre;
      planes[k].axis_B = face.surface.axis;
      moments.emplace_back(0, Vec3::Zero());
    }
    planes[k].faces.emplace_back(i);
    planes[k].area += face.area;
    moments[k].first += area;
    moments[k].second += moment;
  }
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Vec3 centroid = moments[k].second / moments[k].first;
    const Vec3& nhat = planes[k].axis_B;
    // The centroid of several faces, brought back onto the plane of the first.
    planes[k].origin_B = centroid - (centroid - planes[k].origin_B).dot(nhat) * nhat;
  }
  part->features.insert(part->features.end(), planes.begin(), planes.end());
}

/** The constraint that two features fulfil, if any. */
std::optional<InnerConstraintKind> Relate(const Feature& a, const Feature& b, double tolerance) {
  const bool is_plane_a = a.kind == FeatureKind::kPlane;
  const bool is_plane_b = b.kind == FeatureKind::kPlane;
  const bool is_along = IsParallel(a.axis_B, b.axis_B);
  const bool is_across = std::abs(a.axis_B.dot(b.axis_B)) < kAngle;
  if (is_plane_a != is_plane_b) {  // The axis and the plane, not the axis and the normal.
    if (is_along) {
      return InnerConstraintKind::kPerpendicular;
    }
    return is_across ? std::optional(InnerConstraintKind::kParallel) : std::nullopt;
  }
  if (is_across) {
    return InnerConstraintKind::kPerpendicular;
  }
  if (!is_along) {
    return std::nullopt;
  }
  if (is_plane_a) {
    const bool is_same = std::abs((b.origin_B - a.origin_B).dot(a.axis_B)) < tolerance;
    return is_same ? InnerConstraintKind::kCoplanar : InnerConstraintKind::kParallel;
  }
  const bool is_same = DistanceToAxis(b.origin_B, a.origin_B, a.axis_B) < tolerance;
  return is_same ? InnerConstraintKind::kCoaxial : InnerConstraintKind::kParallel;
}

void AddInnerConstraints(Part* part, double tolerance) {
  const std::vector<Feature>& features = part->features;
  std::optional<std::size_t> plane;
  std::optional<std::size_t> axis;
  for (std::size_t i = 0; i < features.size(); ++i) {
    std::optional<std::size_t>& best = features[i].kind == FeatureKind::kPlane ? plane : axis;
    if (!best || features[i].area > features[*best].area) {
      best = i;
    }
  }
  const auto tie = [&](std::size_t a, std::size_t b) {
    const auto kind = Relate(features[a], features[b], tolerance);
    if (kind) {
      part->inner_constraints.push_back({*kind, FeatureId(a), FeatureId(b)});
    }
    return kind;
  };
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (plane && i != *plane) {
      tie(*plane, i);
    }
    if (axis && i != *axis && features[i].kind != FeatureKind::kPlane) {
      const auto kind = tie(*axis, i);
      for (std::size_t k = 0; kind != InnerConstraintKind::kCoaxial && k < i; ++k) {
        if (k != *axis && features[k].kind != FeatureKind::kPlane &&
            Relate(features[k], features[i], tolerance) == InnerConstraintKind::kCoaxial) {
          part->inner_constraints.push_back(
              {InnerConstraintKind::kCoaxial, FeatureId(k), FeatureId(i)});
          break;
        }
      }
    }
  }
}

}  // namespace

void BuildFeatures(Part* part) {
  part->features.clear();
  part->inner_constraints.clear();
  const double tolerance = Tolerance(*part);
  AddCylinders(part, tolerance);
  AddPlanes(part, tolerance);
  AddInnerConstraints(part, tolerance);
}

}  // namespace hvas::product
