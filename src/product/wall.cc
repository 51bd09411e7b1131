#include "product/wall.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "product/mesh_ray.h"

namespace hvas::product {
namespace {

constexpr std::size_t kMostFaces = 2000;  // As long as a second for most parts: a choice.
constexpr std::size_t kTrianglesOfAFace =
    3;                               // A choice: a face is seldom thin in one corner alone.
constexpr double kOpposite = 0.906;  // Cosine of 25 degrees: a choice.

/** Normal of a triangle, as long as twice its area. */
Vec3 CalcAreaNormal(const Part& part, std::uint32_t triangle) {
  const auto& [a, b, c] = part.mesh.triangles[triangle];
  const std::vector<Vec3>& vertices = part.mesh.vertices;
  return (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
}

Vec3 CalcCentre(const Part& part, std::uint32_t triangle) {
  const auto& [a, b, c] = part.mesh.triangles[triangle];
  const std::vector<Vec3>& vertices = part.mesh.vertices;
  return (vertices[a] + vertices[b] + vertices[c]) / 3;
}

/** The largest triangles of a face. */
std::vector<std::uint32_t> ListLargest(const Part& part, const Face& face) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
    triangles.push_back(face.first_triangle + i);
  }
  const std::size_t count = std::min(kTrianglesOfAFace, triangles.size());
  std::partial_sort(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(count),
                    triangles.end(), [&part](std::uint32_t x, std::uint32_t y) {
                      return CalcAreaNormal(part, x).norm() > CalcAreaNormal(part, y).norm();
                    });
  triangles.resize(count);
  return triangles;
}

std::vector<const Face*> ListLargestFaces(const Part& part) {
  std::vector<const Face*> faces;
  for (const Face& face : part.faces) {
    faces.push_back(&face);
  }
  const std::size_t count = std::min(kMostFaces, faces.size());
  std::partial_sort(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(count), faces.end(),
                    [](const Face* x, const Face* y) { return x->area > y->area; });
  faces.resize(count);
  return faces;
}

}  // namespace

std::optional<double> CalcThinnestWall(const Part& part) {
  std::optional<double> thinnest;
  for (const Face* face : ListLargestFaces(part)) {
    for (const std::uint32_t triangle : ListLargest(part, *face)) {
      const Vec3 normal = CalcAreaNormal(part, triangle);
      if (!(normal.norm() > 0)) {
        continue;
      }
      const Vec3 inward = -normal.normalized();
      const double reach = thinnest.value_or(part.box_B.size().norm());
      const auto hit = FindFirstHit(part, CalcCentre(part, triangle), inward, reach);
      if (hit && CalcAreaNormal(part, hit->triangle).normalized().dot(inward) > kOpposite) {
        thinnest = hit->distance;
      }
    }
  }
  return thinnest;
}

double CalcExtentAlong(const Part& part, const Vec3& along_B) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& vertex : part.mesh.vertices) {
    const double at = along_B.dot(vertex);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return std::max(0.0, high - low);
}

}  // namespace hvas::product
