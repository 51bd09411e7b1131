#include "product/features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "product/axis_features.h"
#include "product/face_adjacency.h"
#include "product/forms.h"
#include "product/recognition_limits.h"
#include "product/sphere_features.h"
#include "product/threads.h"

namespace hvas::product {
namespace {

constexpr double kLength = 2e-6;          // Same point, radius or plane [m].
constexpr double kRelativeLength = 1e-6;  // The same, of the part's size, for huge parts.
constexpr double kRightAngle = 1e-3;      // A right angle [rad].
constexpr double kPlaneAngle = 1e-4;      // Same plane, which is larger than a hole [rad].

double Tolerance(const Part& part) {
  const double size = part.box_B.is_empty() ? 0 : part.box_B.size().norm();
  return std::max(kLength, kRelativeLength * size);
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

bool IsSamePlane(const Feature& plane, const Vec3& nhat, const Vec3& centre, double tolerance) {
  return plane.axis_B.dot(nhat) > 0 && plane.axis_B.cross(nhat).norm() < kPlaneAngle &&
         std::abs((centre - plane.origin_B).dot(plane.axis_B)) < tolerance &&
         std::abs((centre - plane.origin_B).dot(nhat)) < tolerance;
}

/** Planes by their first face. The search looks only at planes that pass the origin at nearly the
 same distance. */
std::vector<Feature> FindPlanes(const Part& part, double tolerance) {
  std::vector<Feature> planes;
  std::vector<std::pair<double, Vec3>> moments;
  std::multimap<double, std::size_t> by_offset;
  for (std::uint32_t i = 0; i < part.faces.size(); ++i) {
    const Face& face = part.faces[i];
    const auto [area, moment] = CalcMoment(part, face);
    if (face.surface.kind != SurfaceKind::kPlane || !(area > 0)) {
      continue;
    }
    const Vec3 centre = moment / area;
    const Vec3& nhat = face.surface.axis;
    const double slack = tolerance + face.residual;
    const double reach = slack + kPlaneAngle * centre.norm();
    std::size_t k = planes.size();
    for (auto it = by_offset.lower_bound(centre.dot(nhat) - reach);
         it != by_offset.end() && it->first <= centre.dot(nhat) + reach; ++it) {
      if (it->second < k && IsSamePlane(planes[it->second], nhat, centre, slack)) {
        k = it->second;
      }
    }
    if (k == planes.size()) {
      planes.emplace_back();
      planes[k].origin_B = centre;
      planes[k].axis_B = nhat;
      moments.emplace_back(0, Vec3::Zero());
      by_offset.emplace(centre.dot(nhat), k);
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
  return planes;
}

/** The constraint of a sphere and another feature: one centre, a centre on an axis or in a plane.
 */
std::optional<InnerConstraintKind> RelateSphere(const Feature& sphere, const Feature& other,
                                                double tolerance) {
  const Vec3 offset = sphere.origin_B - other.origin_B;
  if (IsSphere(other.kind)) {
    return offset.norm() < tolerance ? std::optional(InnerConstraintKind::kConcentric)
                                     : std::nullopt;
  }
  if (other.kind == FeatureKind::kPlane) {
    return std::abs(offset.dot(other.axis_B)) < tolerance
               ? std::optional(InnerConstraintKind::kCoplanar)
               : std::nullopt;
  }
  return offset.cross(other.axis_B).norm() < tolerance
             ? std::optional(InnerConstraintKind::kCoaxial)
             : std::nullopt;
}

/** The constraint that two features fulfil, if any. */
std::optional<InnerConstraintKind> Relate(const Feature& a, const Feature& b, double tolerance) {
  if (IsSphere(a.kind) || IsSphere(b.kind)) {
    return IsSphere(a.kind) ? RelateSphere(a, b, tolerance) : RelateSphere(b, a, tolerance);
  }
  const bool is_plane_a = a.kind == FeatureKind::kPlane;
  const bool is_plane_b = b.kind == FeatureKind::kPlane;
  const bool is_along = IsParallel(a.axis_B, b.axis_B);
  const bool is_across = std::abs(a.axis_B.dot(b.axis_B)) < kRightAngle;
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

/** Finds the first of the features seen so far that is on the axis of another, or has its centre.
 */
class AxisIndex {
 public:
  AxisIndex(const std::vector<Feature>& features, double tolerance)
      : features_(features), tolerance_(tolerance) {}

  /** The first feature that `i` is coaxial or concentric with, except `skip`; then adds `i`. */
  std::optional<std::size_t> FindAndAdd(std::size_t i, std::size_t skip) {
    const Feature& feature = features_[i];
    const double key = Key(feature);
    const double reach = tolerance_ + 4 * kRightAngle * feature.origin_B.norm();
    std::optional<std::size_t> found;
    for (auto it = by_key_.lower_bound(key - reach);
         it != by_key_.end() && it->first <= key + reach; ++it) {
      if (it->second == skip || (found && it->second > *found)) {
        continue;
      }
      const auto kind = Relate(features_[it->second], feature, tolerance_);
      if (kind == InnerConstraintKind::kCoaxial || kind == InnerConstraintKind::kConcentric) {
        found = it->second;
      }
    }
    by_key_.emplace(key, i);
    return found;
  }

 private:
  /** Along a direction that is nobody's axis: the axis point nearest to the origin, or a centre. */
  static double Key(const Feature& feature) {
    const Vec3 probe(0.36, 0.48, 0.8);
    const Vec3& p = feature.origin_B;
    const Vec3 foot = IsSphere(feature.kind) ? p : Vec3(p - p.dot(feature.axis_B) * feature.axis_B);
    return foot.dot(probe);
  }

  const std::vector<Feature>& features_;
  double tolerance_;
  std::multimap<double, std::size_t> by_key_;
};

void AddInnerConstraints(Part* part, double tolerance) {
  const std::vector<Feature>& features = part->features;
  std::optional<std::size_t> plane;
  std::optional<std::size_t> axis;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (IsSphere(features[i].kind)) {
      continue;
    }
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
  AxisIndex index(features, tolerance);
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (plane && i != *plane) {
      tie(*plane, i);
    }
    if (features[i].kind == FeatureKind::kPlane) {
      continue;
    }
    const bool is_other = axis && i != *axis;
    const auto kind = is_other ? tie(*axis, i) : std::nullopt;
    const auto first = index.FindAndAdd(i, axis.value_or(features.size()));
    if (first && (is_other || !axis) && kind != InnerConstraintKind::kCoaxial) {
      tie(*first, i);
    }
  }
}

}  // namespace

void BuildFeatures(Part* part, Diagnostics* diagnostics) {
  HVAS_DEMAND(part != nullptr);
  part->features.clear();
  part->forms.clear();
  part->inner_constraints.clear();
  const double tolerance = Tolerance(*part);
  const FaceAdjacency adjacency(*part, tolerance);
  RecognitionLimits limits;
  std::vector<Feature> partial;
  for (auto&& found :
       {FindCylinders(*part, tolerance, &limits, &partial), FindPlanes(*part, tolerance),
        FindCones(*part, tolerance, &limits), FindSpheres(*part, adjacency, tolerance)}) {
    part->features.insert(part->features.end(), found.begin(), found.end());
  }
  AddInnerConstraints(part, tolerance);
  MarkThreads(part, tolerance, &limits);
  part->forms = FindForms(*part, adjacency, tolerance, &limits);
  // Teeth and round ends make no forms and no threads: they only tell where a hub sits on its
  // shaft, and a key in its seat.
  part->features.insert(part->features.end(), partial.begin(), partial.end());
  if (diagnostics != nullptr && !limits.items().empty()) {
    diagnostics->Note("limit-features", part->name,
                      fmt::format("features beyond the limits of recognition are left out: {}",
                                  fmt::join(limits.items(), ", ")));
  }
}

}  // namespace hvas::product
