#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/closest_kernel.h"
#include "contact/shape.h"

namespace hvas::contact {

inline constexpr double kOnSurface = 1e-7;  ///< A point this near a face lies on it [m].

/** Where on a triangle the closest point lies: the inside, edge k (from corner k to k + 1) or
 * corner k. */
enum class TriangleFeature : std::uint8_t {
  kInside,
  kEdge0,
  kEdge1,
  kEdge2,
  kCorner0,
  kCorner1,
  kCorner2
};

struct TrianglePoint {
  Vec3 q{Vec3::Zero()};
  TriangleFeature feature{TriangleFeature::kInside};
};

/** Closest point of triangle abc to p; Ericson, Real-Time Collision Detection, 5.1.5. RT-safe. */
[[nodiscard]] TrianglePoint CalcClosestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                  const Vec3& c) noexcept;

[[nodiscard]] TriangleCorners MakeTriangleCorners(const Vec3& a, const Vec3& b,
                                                  const Vec3& c) noexcept;

/** Finds that point where the dot products are known. RT-safe. */
[[nodiscard]] inline TrianglePoint CalcClosestOnTriangle(const Vec3& p,
                                                         const TriangleCorners& t) noexcept {
  // In plain numbers. Everything follows from the dot products of the sides ab, ac with ap, bp, cp.
  const double ab_x = t.b[0] - t.a[0];
  const double ab_y = t.b[1] - t.a[1];
  const double ab_z = t.b[2] - t.a[2];
  const double ac_x = t.c[0] - t.a[0];
  const double ac_y = t.c[1] - t.a[1];
  const double ac_z = t.c[2] - t.a[2];
  const double ap_x = p.x() - t.a[0];
  const double ap_y = p.y() - t.a[1];
  const double ap_z = p.z() - t.a[2];
  const double d1 = ab_x * ap_x + ab_y * ap_y + ab_z * ap_z;
  const double d2 = ac_x * ap_x + ac_y * ap_y + ac_z * ap_z;
  const auto at = [&](double u, double v, TriangleFeature feature) {
    return TrianglePoint{Vec3(t.a[0] + u * ab_x + v * ac_x, t.a[1] + u * ab_y + v * ac_y,
                              t.a[2] + u * ab_z + v * ac_z),
                         feature};
  };
  const auto at_corner = [](const double corner[3], TriangleFeature feature) {
    return TrianglePoint{Vec3(corner[0], corner[1], corner[2]), feature};
  };
  if (d1 <= 0 && d2 <= 0) {
    return at_corner(t.a, TriangleFeature::kCorner0);
  }
  const double d3 = d1 - t.ab_ab;
  const double d4 = d2 - t.ab_ac;
  if (d3 >= 0 && d4 <= d3) {
    return at_corner(t.b, TriangleFeature::kCorner1);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    return at(d1 / (d1 - d3), 0, TriangleFeature::kEdge0);
  }
  const double d5 = d1 - t.ab_ac;
  const double d6 = d2 - t.ac_ac;
  if (d6 >= 0 && d5 <= d6) {
    return at_corner(t.c, TriangleFeature::kCorner2);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    return at(0, d2 / (d2 - d6), TriangleFeature::kEdge2);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(1 - along, along, TriangleFeature::kEdge1);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) {
    return at_corner(t.a, TriangleFeature::kCorner0);  // No area.
  }
  return at(vb / sum, vc / sum, TriangleFeature::kInside);
}

/** How two triangles meet at an edge. Smooth also stands for edges inside one face. */
enum class EdgeKind : std::uint8_t { kSmooth, kConvex, kConcave, kOpen };

/** What a vertex is to the faces around it. */
enum class VertexKind : std::uint8_t { kSmooth, kOnEdge, kCorner };

/** A vector that need not be told to more than single precision. */
struct ShortVec3 {
  std::array<float, 3> v{};

  ShortVec3() = default;

  explicit ShortVec3(const Vec3& full)
      : v{static_cast<float>(full[0]), static_cast<float>(full[1]), static_cast<float>(full[2])} {}

  [[nodiscard]] Vec3 full() const noexcept {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
  }
};

/** The welded triangles of a shape with what sign and face decisions need. */
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face;  ///< Each triangle's face.
  std::vector<ShortVec3> normals;   ///< Unit, of each triangle; zero where it has no area.
  std::vector<std::array<std::uint32_t, 3>>
      neighbour;  ///< Triangle across edge k; kNoFace if none.
  std::vector<std::array<EdgeKind, 3>> edge_kind;
  std::vector<VertexKind> vertex_kind;
  std::vector<ShortVec3> vertex_normals;  ///< Angle-weighted pseudonormals, not unit.
  std::vector<std::array<std::uint32_t, 2>> vertex_faces;  ///< Both faces of a kOnEdge.
  std::vector<std::uint8_t> is_vertex_open;
  /** Each triangle's bends, zero on analytic faces (contact/smooth_surface.h); empty where no face
   is freeform. */
  std::vector<std::array<ShortVec3, 3>> bends;
  bool is_closed{true};

  [[nodiscard]] Vec3 NormalOf(std::uint32_t triangle) const noexcept {
    return normals[triangle].full();
  }

  [[nodiscard]] double CalcArea(std::uint32_t triangle) const noexcept {
    const auto& t = triangles[triangle];
    const Vec3& a = vertices[t[0]];
    return 0.5 * (vertices[t[1]] - a).cross(vertices[t[2]] - a).norm();
  }

  [[nodiscard]] TrianglePoint ClosestOn(std::uint32_t triangle, const Vec3& p) const noexcept {
    const auto& t = triangles[triangle];
    return CalcClosestOnTriangle(p, vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  }

  /** The vertices and triangles as the kernels take them; valid while the mesh is as it is. */
  [[nodiscard]] TriangleArrays arrays() const noexcept {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {reinterpret_cast<const double(*)[3]>(vertices.data()),
            reinterpret_cast<const std::uint32_t(*)[3]>(triangles.data())};
  }

  /** True where a face ends at edge k of a triangle, or bends sharply. */
  [[nodiscard]] bool IsRim(std::uint32_t triangle, std::size_t k) const noexcept {
    const std::uint32_t other = neighbour[triangle][k];
    return other == kNoFace || face[other] != face[triangle] ||
           edge_kind[triangle][k] != EdgeKind::kSmooth;
  }

  /** Finds a triangle of a face across one of a triangle's edges; kNoFace where none is. */
  [[nodiscard]] std::uint32_t NeighbourOn(std::uint32_t triangle,
                                          std::uint32_t on_face) const noexcept;

  /** A triangle, and the number of one of its corners. */
  struct Corner {
    std::uint32_t triangle{kNoFace};
    std::size_t k{0};
  };

  /** Turns about a corner to the next triangle, across edge k or, backwards, the one before it.
   kNoFace where there is none. */
  [[nodiscard]] Corner TurnAbout(const Corner& at, bool is_forward) const noexcept;

  /** Finds a triangle of a face around corner k of a triangle; kNoFace where none is found. */
  [[nodiscard]] std::uint32_t AroundOn(std::uint32_t triangle, std::size_t k,
                                       std::uint32_t on_face) const noexcept;

  /** The pseudonormal of a feature (not unit): (p - q) . n > 0 exactly when p is outside, for the
   closest feature of a closed mesh; Baerentzen and Aanaes, IEEE TVCG 11(3), 2005. */
  [[nodiscard]] Vec3 Pseudonormal(std::uint32_t triangle, TriangleFeature feature) const noexcept;
  /** True when the feature lies at a gap of the mesh, where the pseudonormal tells nothing. */
  [[nodiscard]] bool IsOpenAt(std::uint32_t triangle, TriangleFeature feature) const noexcept;
  /** Generalised winding number of the whole mesh about p: 1 inside, 0 outside; Jacobson 2013. */
  [[nodiscard]] double CalcWindingNumber(const Vec3& p) const;
};

/** The triangles that are wanted, and those across their edges, which the pseudonormals and the
 faces beyond need; in their order. What is as seen from the wanted ones only stays right.
 @param number  Of each old triangle, its new number; kNoFace where there is none. */
[[nodiscard]] Mesh KeepTriangles(const Mesh& mesh, const std::vector<bool>& is_wanted,
                                 std::vector<std::uint32_t>* number);

/** Welds the vertices, drops triangles without area, finds neighbours and classifies edges.
 @param p_BC  Subtracted from all vertices, so that coordinates are small. */
[[nodiscard]] Mesh MakeMesh(const ShapeSource& source, const Vec3& p_BC);

}  // namespace hvas::contact
