#include "cad/triangles/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

// Turn, shift (in scales), radius (in scales), second (in scales; of a cone: the angle itself).
using Parameters = Eigen::Matrix<double, 8, 1>;
using Normal = Eigen::Matrix<double, 8, 8>;

struct Frame {
  Vec3 pivot;  // The centroid of the points.
  double scale;
};

Surface Moved(const Surface& surface, const Parameters& step, const Frame& frame) {
  Surface moved = surface;
  const Vec3 turn = step.head<3>();
  const double angle = turn.norm();
  if (angle > 0) {
    const Mat3 R = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    moved.axis = (R * surface.axis).normalized();
    moved.origin = frame.pivot + R * (surface.origin - frame.pivot);
  }
  moved.origin += frame.scale * step.segment<3>(3);
  moved.radius += frame.scale * step[6];
  moved.second += surface.kind == SurfaceKind::kCone ? step[7] : frame.scale * step[7];
  return moved;
}

bool IsSound(const Surface& surface) {
  if (!surface.origin.allFinite() || !surface.axis.allFinite() || !std::isfinite(surface.radius) ||
      !std::isfinite(surface.second)) {
    return false;
  }
  switch (surface.kind) {
    case SurfaceKind::kCylinder:
    case SurfaceKind::kSphere:
      return surface.radius > 0;
    case SurfaceKind::kCone:
      return surface.second > 0 && surface.second < std::numbers::pi / 2;
    case SurfaceKind::kTorus:
      return surface.second > 0 && surface.radius > 0;
    default:
      return true;
  }
}

/** Sum of squared distances, in scales. */
double CalcCost(std::span<const Vec3> points, const Surface& surface, const Frame& frame) {
  double cost = 0;
  for (const Vec3& p : points) {
    const double d = CalcDistance(surface, p).distance / frame.scale;
    cost += d * d;
  }
  return cost;
}

/** Derivatives of the distance at p. A turn of the surface about the pivot is the opposite turn of
 the point, so for every kind they follow from the gradient. */
Parameters CalcJacobian(const Surface& surface, const Vec3& p, const Vec3& gradient,
                        const Frame& frame) {
  Parameters row = Parameters::Zero();
  row.head<3>() = -((p - frame.pivot) / frame.scale).cross(gradient);
  row.segment<3>(3) = -gradient;
  const Vec3 q = p - surface.origin;
  const double height = q.dot(surface.axis);
  const double r = (q - height * surface.axis).norm();
  switch (surface.kind) {
    case SurfaceKind::kCylinder:
    case SurfaceKind::kSphere:
      row[6] = -surface.outward;
      break;
    case SurfaceKind::kCone:
      row[7] = -surface.outward *
               (r * std::sin(surface.second) + height * std::cos(surface.second)) / frame.scale;
      break;
    case SurfaceKind::kTorus: {
      const double across = r - surface.radius;
      const double minor = std::hypot(across, height);
      row[6] = minor > 0 ? -surface.outward * across / minor : 0;
      row[7] = -surface.outward;
      break;
    }
    default:
      break;
  }
  return row;
}

}  // namespace

double CalcResidual(std::span<const Vec3> points, const Surface& surface) {
  double worst = 0;
  for (const Vec3& p : points) {
    worst = std::max(worst, std::abs(CalcDistance(surface, p).distance));
  }
  return worst;
}

double RefineSurface(std::span<const Vec3> points, double scale, Surface* surface) {
  // Steps of Levenberg and Marquardt at most, and a shift relative to the scale that is nothing but
  // rounding: choices.
  constexpr int kMaxSteps = 30;
  constexpr double kConverged = 1e-13;
  constexpr double kNoFit = std::numeric_limits<double>::infinity();
  if (points.empty() || !IsSound(*surface)) {
    return kNoFit;
  }
  Frame frame{Vec3::Zero(), scale};
  for (const Vec3& p : points) {
    frame.pivot += p;
  }
  frame.pivot /= static_cast<double>(points.size());
  double damping = 1e-6;
  double cost = CalcCost(points, *surface, frame);
  for (int i = 0; i < kMaxSteps; ++i) {
    Normal A = Normal::Zero();
    Parameters b = Parameters::Zero();
    for (const Vec3& p : points) {
      const auto distance = CalcDistance(*surface, p);
      if (distance.is_valid) {
        const Parameters row = CalcJacobian(*surface, p, distance.gradient, frame);
        A.selfadjointView<Eigen::Lower>().rankUpdate(row);
        b -= distance.distance / scale * row;
      }
    }
    A = Normal(A.selfadjointView<Eigen::Lower>());
    const double size = A.trace();
    bool is_better = false;
    double length = 0;
    for (int attempt = 0; attempt < 6 && !is_better; ++attempt) {
      Normal damped = A;
      // The second term holds still what the points say nothing about.
      damped.diagonal() += damping * A.diagonal() + Parameters::Constant(1e-14 * size);
      const Parameters step = damped.ldlt().solve(b);
      const Surface moved = Moved(*surface, step, frame);
      const double moved_cost = IsSound(moved) ? CalcCost(points, moved, frame) : kNoFit;
      if (step.allFinite() && moved_cost < cost) {
        *surface = moved;
        cost = moved_cost;
        damping = std::max(damping / 10, 1e-12);
        length = step.norm();
        is_better = true;
      } else {
        damping = std::max(10 * damping, 1e-8);
      }
    }
    if (!is_better || length < kConverged) {
      break;
    }
  }
  return CalcResidual(points, *surface);
}

}  // namespace hvas::cad
