#include "contact/helix_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>

#include "base/units.h"
#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr std::size_t kMaxAxes = 8;  // Axes of faces of revolution that are looked at. A choice.

/** The axes of the faces of revolution, each once, those with the most area first. */
std::vector<ThreadAxis> ListRoundAxes(const Mesh& mesh, const std::vector<spatial::Surface>& faces,
                                      double size) {
  constexpr double kSameDirection = 2e-3;  // [rad]: a choice.
  constexpr double kSamePlace = 2e-3;      // Of the part's size: a choice.
  std::vector<double> area(faces.size(), 0.0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    area[mesh.face[t]] += mesh.CalcArea(t);
  }
  std::vector<ThreadAxis> axes;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const spatial::Surface& face = faces[f];
    if (face.kind != spatial::SurfaceKind::kCylinder && face.kind != spatial::SurfaceKind::kCone) {
      continue;
    }
    const auto same = std::find_if(axes.begin(), axes.end(), [&](const ThreadAxis& axis) {
      const Vec3 d = face.origin - axis.origin;
      return axis.direction.cross(face.axis).norm() < kSameDirection &&
             axis.direction.cross(d).norm() < kSamePlace * size;
    });
    if (same == axes.end()) {
      axes.push_back({face.origin, face.axis, area[f]});
    } else {
      same->area += area[f];
    }
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const ThreadAxis& a, const ThreadAxis& b) { return a.area > b.area; });
  axes.resize(std::min(axes.size(), kMaxAxes));
  return axes;
}

/** The axis of the screw motion that moves most of the freeform faces along themselves: with its
 velocity c + w x p, (p x n) . w + n . c is zero there (Pottmann and Wallner, Computational Line
 Geometry, 2001, ch. 4). What does not obey counts for less and less. None where there are hardly
 any freeform faces. */
std::optional<ThreadAxis> FindScrewAxis(const std::vector<SurfacePoint>& points,
                                        const spatial::Box& box) {
  constexpr std::size_t kLeast = 200;  // Points: fewer are no thread.
  constexpr std::size_t kMost = 4000;  // Points that are looked at.
  constexpr int kSteps = 40;           // Half of them with the wider of the two scales.
  constexpr double kWide = 0.02;       // Residual that counts for a quarter.
  constexpr double kNarrow = 0.002;    // The same in the second half. All are choices.
  std::vector<const SurfacePoint*> freeform;
  for (const SurfacePoint& point : points) {
    if (point.is_freeform) {
      freeform.push_back(&point);
    }
  }
  if (freeform.size() < kLeast) {
    return std::nullopt;
  }
  const double size = box.size().norm();
  std::vector<std::pair<Vec6, double>> rows;  // With the area.
  for (const SurfacePoint* const at : Thinned(freeform, kMost)) {
    const SurfacePoint& point = *at;
    const Vec3 p = (point.p - box.centre()) / size;
    Vec6 row;
    row << p.cross(point.n) / point.area, point.n / point.area;
    rows.emplace_back(row, point.area);
  }
  Vec6 screw = Vec6::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const double scale = i < kSteps / 2 ? kWide : kNarrow;
    const double turning = screw.head<3>().norm();
    Mat6 matrix = Mat6::Zero();
    for (const auto& [row, area] : rows) {
      const double residual = turning > 0 ? row.dot(screw) / (turning * scale) : 0;
      const double weight = area / ((1 + residual * residual) * (1 + residual * residual));
      matrix += weight * row * row.transpose();
    }
    screw = Eigen::SelfAdjointEigenSolver<Mat6>(matrix).eigenvectors().col(0);
  }
  const Vec3 turning = screw.head<3>();
  if (!(turning.norm() > 1e-6)) {
    return std::nullopt;
  }
  const Vec3 origin = box.centre() + turning.cross(screw.tail<3>()) / turning.squaredNorm() * size;
  return ThreadAxis{origin, turning.normalized(), 0};
}

}  // namespace

std::vector<SurfacePoint> ListSurfacePoints(const Mesh& mesh,
                                            const std::vector<spatial::Surface>& faces) {
  constexpr double kAlike = 0.9;  // Cosine: 26 degrees. A choice.
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      around[v].push_back(t);
    }
  }
  std::vector<SurfacePoint> points;
  for (std::size_t v = 0; v < around.size(); ++v) {
    const std::size_t first = points.size();
    for (const std::uint32_t t : around[v]) {
      const Vec3 n = mesh.NormalOf(t);
      const double area = mesh.CalcArea(t) / 3;
      const auto alike = std::find_if(
          points.begin() + static_cast<std::ptrdiff_t>(first), points.end(),
          [&n](const SurfacePoint& point) { return point.n.dot(n) > kAlike * point.n.norm(); });
      SurfacePoint& point = alike != points.end() ? *alike : points.emplace_back();
      point.p = mesh.vertices[v];
      point.n += area * n;
      point.area += area;
      point.is_freeform =
          point.is_freeform || faces[mesh.face[t]].kind == spatial::SurfaceKind::kFreeform;
    }
  }
  return points;
}

std::vector<ThreadAxis> ListThreadAxes(const Mesh& mesh, const std::vector<spatial::Surface>& faces,
                                       const std::vector<SurfacePoint>& points) {
  spatial::Box box;
  for (const auto& triangle : mesh.triangles) {
    box.Add(mesh.vertices[triangle[0]]);
  }
  std::vector<ThreadAxis> axes = ListRoundAxes(mesh, faces, box.size().norm());
  if (const auto screw = FindScrewAxis(points, box)) {
    axes.push_back(*screw);
  }
  return axes;
}

double CalcThreadPitch(const SurfacePoint& point, const ThreadAxis& axis) {
  constexpr double kFlat = 0.1;    // Cosine: less along the axis tells no pitch.
  constexpr double kLevel = 2e-3;  // Tangent of the rise: less is a surface of revolution.
  // Both are choices: threads rise by a hundredth at least, and their flanks lean.
  const Vec3 around = axis.direction.cross(point.p - axis.origin);  // As long as the radius.
  const double along = point.n.dot(axis.direction);
  const double turned = point.n.dot(around);
  const double radius = around.norm();
  const bool tells = std::abs(along) > kFlat * point.area &&
                     std::abs(turned) > kLevel * radius * std::abs(along) &&
                     std::abs(turned) < radius * std::abs(along);
  return tells ? -units::kTurn * turned / along : 0;
}

std::pair<double, double> FindThreadPitch(const std::vector<SurfacePoint>& points,
                                          const ThreadAxis& axis) {
  constexpr double kWidest = 1.3;                  // Largest pitch over the least one. A choice.
  std::vector<std::pair<double, double>> pitches;  // With their area.
  for (const SurfacePoint& point : points) {
    const double pitch = CalcThreadPitch(point, axis);
    if (pitch != 0) {
      pitches.emplace_back(pitch, point.area);
    }
  }
  std::sort(pitches.begin(), pitches.end());
  // Sums of a window's area, and of its area times the pitch.
  double area = 0;
  double moment = 0;
  std::pair<double, double> best{0, 0};
  const auto is_together = [](double a, double b) {
    return a * b > 0 &&
           std::max(std::abs(a), std::abs(b)) <= kWidest * std::min(std::abs(a), std::abs(b));
  };
  for (std::size_t begin = 0, end = 0; end < pitches.size(); ++end) {
    area += pitches[end].second;
    moment += pitches[end].second * pitches[end].first;
    for (; !is_together(pitches[begin].first, pitches[end].first); ++begin) {
      area -= pitches[begin].second;
      moment -= pitches[begin].second * pitches[begin].first;
    }
    if (area > best.second) {
      best = {moment / area, area};
    }
  }
  return best;
}

}  // namespace hvas::contact
