#include "product/mesh_ray.h"

#include <algorithm>
#include <cmath>

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

/** Moeller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997. */
bool MeetsTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& dir,
                   double reach) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 h = dir.cross(v);
  const double det = u.dot(h);
  if (std::abs(det) < 1e-30) {
    return false;
  }
  const Vec3 s = p - a;
  const double beta = s.dot(h) / det;
  const Vec3 q = s.cross(u);
  const double gamma = dir.dot(q) / det;
  const double t = v.dot(q) / det;
  constexpr double kAtStart = 1e-9;  // [m]: the face that a ray begins on is not met.
  return beta >= 0 && gamma >= 0 && beta + gamma <= 1 && t > kAtStart && t <= reach;
}

}  // namespace

bool IsBlocked(const Part& part, const Vec3& p, const Vec3& dir, double reach) {
  for (const Face& face : part.faces) {
    if (face.triangle_count == 0 || !MeetsBox(face.box_B, p, dir, reach)) {
      continue;
    }
    for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count;
         ++t) {
      const auto& triangle = part.mesh.triangles[t];
      if (MeetsTriangle(part.mesh.vertices[triangle[0]], part.mesh.vertices[triangle[1]],
                        part.mesh.vertices[triangle[2]], p, dir, reach)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace hvas::product
