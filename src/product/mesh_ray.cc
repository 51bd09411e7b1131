#include "product/mesh_ray.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hvas::product {
namespace {

bool MeetsBox(const Box& box, const Vec3& p, const Vec3& dir, double reach) {
  double low = 0;
  double high = reach;
  for (Vec3::Index k = 0; k < 3; ++k) {
    const double a = (box.low[k] - p[k]) / dir[k];
    const double b = (box.high[k] - p[k]) / dir[k];
    if (dir[k] == 0) {
      if (p[k] < box.low[k] || p[k] > box.high[k]) {
        return false;
      }
      continue;
    }
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  return low <= high;
}

/** Moeller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997. @returns the
 distance to the triangle; none where the ray does not meet it. */
std::optional<double> MeetTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p,
                                   const Vec3& dir, double reach) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 h = dir.cross(v);
  const double det = u.dot(h);
  if (std::abs(det) < 1e-30) {
    return std::nullopt;
  }
  const Vec3 s = p - a;
  const double beta = s.dot(h) / det;
  const Vec3 q = s.cross(u);
  const double gamma = dir.dot(q) / det;
  const double t = v.dot(q) / det;
  constexpr double kAtStart = 1e-9;  // [m]: the face that a ray begins on is not met.
  const bool is_met = beta >= 0 && gamma >= 0 && beta + gamma <= 1 && t > kAtStart && t <= reach;
  return is_met ? std::optional(t) : std::nullopt;
}

/** Visits the triangles that a ray meets, in no order, until the visitor returns false.
 @param visit  bool(std::uint32_t triangle, double distance). */
template <typename Visit>
void ForEachHit(const Part& part, const Vec3& p, const Vec3& dir, double reach,
                const Visit& visit) {
  for (const Face& face : part.faces) {
    if (face.triangle_count == 0 || !MeetsBox(face.box_B, p, dir, reach)) {
      continue;
    }
    for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count;
         ++t) {
      const auto& [a, b, c] = part.mesh.triangles[t];
      const std::vector<Vec3>& vertices = part.mesh.vertices;
      const auto distance = MeetTriangle(vertices[a], vertices[b], vertices[c], p, dir, reach);
      if (distance && !visit(t, *distance)) {
        return;
      }
    }
  }
}

}  // namespace

bool IsBlocked(const Part& part, const Vec3& p, const Vec3& dir, double reach) {
  bool is_blocked = false;
  ForEachHit(part, p, dir, reach, [&](std::uint32_t /*triangle*/, double /*distance*/) {
    is_blocked = true;
    return false;
  });
  return is_blocked;
}

std::optional<RayHit> FindFirstHit(const Part& part, const Vec3& p, const Vec3& dir, double reach) {
  std::optional<RayHit> first;
  ForEachHit(part, p, dir, reach, [&](std::uint32_t triangle, double distance) {
    if (!first || distance < first->distance) {
      first = RayHit{distance, triangle};
    }
    return true;
  });
  return first;
}

std::vector<Crossing> ListCrossings(const Part& part, const Vec3& p, const Vec3& dir,
                                    double reach) {
  constexpr double kSameEdge = 1e-9;  // [m]: rounding, far below any wall. A choice.
  std::vector<Crossing> crossings;
  ForEachHit(part, p, dir, reach, [&](std::uint32_t triangle, double distance) {
    const auto& [a, b, c] = part.mesh.triangles[triangle];
    const std::vector<Vec3>& vertices = part.mesh.vertices;
    const Vec3 normal = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    crossings.push_back({distance, normal.dot(dir) < 0});
    return true;
  });
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return std::pair(a.distance, a.is_entering) < std::pair(b.distance, b.is_entering);
  });
  const auto end =
      std::unique(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.is_entering == b.is_entering && b.distance - a.distance < kSameEdge;
      });
  crossings.erase(end, crossings.end());
  return crossings;
}

}  // namespace hvas::product
