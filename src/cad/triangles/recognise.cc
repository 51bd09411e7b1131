#include "cad/triangles/recognise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spatial/decompose.h"

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;
using Samples = std::span<const SurfaceSample>;

// Beyond this many times the patch's size a radius is a plane within any tolerance of interest, and
// the fit is only noise.
constexpr double kLargestRadius = 1e3;

// Of the sum of squares of points, squared: below it their moments are rounding.
constexpr double kSingular = 1e-15;

struct Extent {
  Vec3 centroid{Vec3::Zero()};
  double size{0};  // Distance of the sample farthest from it.
};

Extent CalcExtent(Samples samples) {
  Extent extent;
  for (const SurfaceSample& sample : samples) {
    extent.centroid += sample.p;
  }
  extent.centroid /= static_cast<double>(samples.size());
  for (const SurfaceSample& sample : samples) {
    extent.size = std::max(extent.size, (sample.p - extent.centroid).norm());
  }
  return extent;
}

struct Circle {
  double x, y, radius;
};

/** Algebraic least-squares circle (Kasa), exact for exact data. About the mean of the points, q,
 its centre solves the normal equations sum(q q^T) c = sum(|q|^2 q) / 2. */
std::optional<Circle> FitCircle(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    mean += point;
  }
  mean /= static_cast<double>(points.size());
  double xx = 0, xy = 0, yy = 0;
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d q = point - mean;
    xx += q.x() * q.x();
    xy += q.x() * q.y();
    yy += q.y() * q.y();
    b += 0.5 * q.squaredNorm() * q;
  }
  const double determinant = xx * yy - xy * xy;
  const double square_of_radii = (xx + yy) / static_cast<double>(points.size());
  if (!(determinant > kSingular * (xx + yy) * (xx + yy))) {
    return std::nullopt;  // All points are on one line.
  }
  const double x = (yy * b.x() - xy * b.y()) / determinant;
  const double y = (xx * b.y() - xy * b.x()) / determinant;
  return Circle{mean.x() + x, mean.y() + y, std::sqrt(square_of_radii + x * x + y * y)};
}

std::optional<Surface> FitPlane(Samples samples, const Vec3& centroid) {
  Mat3 C = Mat3::Zero();
  for (const SurfaceSample& sample : samples) {
    C += (sample.p - centroid) * (sample.p - centroid).transpose();
  }
  Surface surface;
  surface.kind = SurfaceKind::kPlane;
  surface.origin = centroid;
  surface.axis = spatial::CalcEigensystem(C).vectors.col(0).normalized();
  return surface;
}

std::optional<Surface> FitCylinder(Samples samples, const Vec3& centroid) {
  Mat3 C = Mat3::Zero();
  for (const SurfaceSample& sample : samples) {
    C += sample.nhat * sample.nhat.transpose();
  }
  const Vec3 axis = spatial::CalcEigensystem(C).vectors.col(0).normalized();
  const Mat3 R = spatial::FrameFromZ(axis).toRotationMatrix();
  std::vector<Eigen::Vector2d> points;
  points.reserve(samples.size());
  for (const SurfaceSample& sample : samples) {
    points.emplace_back((R.transpose() * (sample.p - centroid)).head<2>());
  }
  const std::optional<Circle> circle = FitCircle(points);
  if (!circle) {
    return std::nullopt;
  }
  Surface surface;
  surface.kind = SurfaceKind::kCylinder;
  surface.origin = centroid + R * Vec3(circle->x, circle->y, 0);
  surface.axis = axis;
  surface.radius = circle->radius;
  return surface;
}

/** Algebraic least-squares sphere, exact for exact data. The samples' mean is the centroid: their
 sum of q vanishes, so the equations of the centre and of the radius are apart. */
std::optional<Surface> FitSphere(Samples samples, const Vec3& centroid) {
  Mat3 A = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  for (const SurfaceSample& sample : samples) {
    const Vec3 q = sample.p - centroid;
    A += q * q.transpose();
    b += 0.5 * q.squaredNorm() * q;
  }
  const std::optional<Vec3> centre = spatial::SolveNormalEquations(A, b);
  if (!centre) {
    return std::nullopt;
  }
  Surface surface;
  surface.kind = SurfaceKind::kSphere;
  surface.origin = centroid + *centre;
  surface.radius =
      std::sqrt(A.trace() / static_cast<double>(samples.size()) + centre->squaredNorm());
  return surface;
}

std::optional<Surface> FitCone(Samples samples, const Vec3& centroid) {
  Vec3 mean = Vec3::Zero();
  for (const SurfaceSample& sample : samples) {
    mean += sample.nhat;
  }
  mean /= static_cast<double>(samples.size());
  Mat3 C = Mat3::Zero();
  Mat3 A = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  for (const SurfaceSample& sample : samples) {
    C += (sample.nhat - mean) * (sample.nhat - mean).transpose();
    const Mat3 nn = sample.nhat * sample.nhat.transpose();
    A += nn;
    b += nn * (sample.p - centroid);
  }
  const std::optional<Vec3> apex = spatial::SolveNormalEquations(A, b);
  if (!apex) {
    return std::nullopt;
  }
  Vec3 axis = spatial::CalcEigensystem(C).vectors.col(0).normalized();
  if (axis.dot(*apex) > 0) {  // The samples are centred on the origin: point from the apex to them.
    axis = -axis;
  }
  Surface surface;
  surface.kind = SurfaceKind::kCone;
  surface.origin = centroid + *apex;
  surface.axis = axis;
  surface.second = std::asin(std::clamp(std::abs(mean.dot(axis)), 0.0, 1.0));
  return surface;
}

std::optional<Surface> FitTorus(Samples samples, const Vec3& centroid, double size) {
  Mat6 C = Mat6::Zero();
  for (const SurfaceSample& sample : samples) {
    Vec6 line;
    line << sample.nhat, ((sample.p - centroid) / size).cross(sample.nhat);
    C += line * line.transpose();
  }
  const Vec6 complex = spatial::CalcLeastEigenvector(C);
  const Vec3 direction = complex.tail<3>();  // Pairs with the moment of a line.
  const double norm = direction.norm();
  if (norm < 1e-6) {
    return std::nullopt;
  }
  const Vec3 axis = direction / norm;
  const Vec3 foot = size * axis.cross(Vec3(complex.head<3>() / norm));
  std::vector<Eigen::Vector2d> points;
  points.reserve(samples.size());
  for (const SurfaceSample& sample : samples) {
    const Vec3 q = (sample.p - centroid) - foot;
    const double height = q.dot(axis);
    points.emplace_back((q - height * axis).norm(), height);
  }
  const std::optional<Circle> circle = FitCircle(points);
  if (!circle || circle->x <= circle->radius) {
    return std::nullopt;
  }
  Surface surface;
  surface.kind = SurfaceKind::kTorus;
  surface.origin = centroid + foot + circle->y * axis;
  surface.axis = axis;
  surface.radius = circle->x;
  surface.second = circle->radius;
  return surface;
}

/** True when all samples lie on the surface and its gradients are their normals, up to one sign,
 which then becomes the sense of the surface. */
bool Accept(Samples samples, double tolerance, double size, Surface* surface) {
  constexpr double kLeastCosine = 0.995;  // Normals of B-splines are less exact than points.
  if (!surface->origin.allFinite() || !surface->axis.allFinite() ||
      surface->radius > kLargestRadius * size || surface->second > kLargestRadius * size) {
    return false;
  }
  double sum = 0;
  for (const SurfaceSample& sample : samples) {
    const spatial::SurfaceDistance distance = CalcDistance(*surface, sample.p);
    if (distance.is_valid) {
      const double cosine = distance.gradient.dot(sample.nhat);
      if (std::abs(distance.distance) > tolerance || std::abs(cosine) < kLeastCosine) {
        return false;
      }
      sum += cosine;
    } else if (surface->kind != SurfaceKind::kCone) {  // The apex itself is on a cone.
      return false;
    }
  }
  if (std::abs(sum) < kLeastCosine * 0.9 * static_cast<double>(samples.size())) {
    return false;  // Normals of both senses: no sense to give.
  }
  if (surface->kind == SurfaceKind::kPlane) {
    surface->axis *= sum < 0 ? -1.0 : 1.0;
  } else {
    surface->outward = sum < 0 ? -1.0 : 1.0;
  }
  return true;
}

}  // namespace

std::optional<Surface> RecogniseSurface(Samples samples, double tolerance) {
  if (samples.size() < 9) {
    return std::nullopt;
  }
  const auto [centroid, size] = CalcExtent(samples);
  if (!(size > 0)) {
    return std::nullopt;
  }
  for (std::optional<Surface> surface :
       {FitPlane(samples, centroid), FitCylinder(samples, centroid), FitSphere(samples, centroid),
        FitCone(samples, centroid), FitTorus(samples, centroid, size)}) {
    if (surface && Accept(samples, tolerance, size, &*surface)) {
      return surface;
    }
  }
  return std::nullopt;
}

std::optional<Surface> FitSurface(SurfaceKind kind, Samples samples) {
  if (samples.empty()) {
    return std::nullopt;
  }
  const auto [centroid, size] = CalcExtent(samples);
  if (!(size > 0)) {
    return std::nullopt;
  }
  switch (kind) {
    case SurfaceKind::kPlane:
      return FitPlane(samples, centroid);
    case SurfaceKind::kCylinder:
      return FitCylinder(samples, centroid);
    case SurfaceKind::kCone:
      return FitCone(samples, centroid);
    case SurfaceKind::kSphere:
      return FitSphere(samples, centroid);
    case SurfaceKind::kTorus:
      return FitTorus(samples, centroid, size);
    case SurfaceKind::kFreeform:
      break;
  }
  return std::nullopt;
}

double OrientSurface(std::span<const Vec3> vertices,
                     std::span<const std::array<std::uint32_t, 3>> triangles, Surface* surface) {
  Vec3 mean = Vec3::Zero();
  double total = 0;
  for (const auto& t : triangles) {
    const Vec3& a = vertices[t[0]];
    const double area = 0.5 * (vertices[t[1]] - a).cross(vertices[t[2]] - a).norm();
    mean += area / 3 * (a + vertices[t[1]] + vertices[t[2]]);
    total += area;
  }
  if (!(total > 0)) {
    return 0;
  }
  if (surface->kind == SurfaceKind::kCone &&
      (mean / total - surface->origin).dot(surface->axis) < 0) {
    surface->axis = -surface->axis;
  }
  double agreement = 0;
  for (const auto& t : triangles) {
    const Vec3& a = vertices[t[0]];
    const Vec3 area_normal = 0.5 * (vertices[t[1]] - a).cross(vertices[t[2]] - a);
    const Vec3 centre = (a + vertices[t[1]] + vertices[t[2]]) / 3;
    agreement += CalcDistance(*surface, centre).gradient.dot(area_normal);
  }
  if (agreement < 0) {
    if (surface->kind == SurfaceKind::kPlane) {
      surface->axis = -surface->axis;
    } else {
      surface->outward = -surface->outward;
    }
  }
  return std::abs(agreement) / total;
}

}  // namespace hvas::cad
