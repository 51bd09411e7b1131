#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "product/product.h"
#include "product/test/mesh_mass.h"

namespace hvas::product::testing {

/** A ring about the z axis from z = 0 on, with a gap about the x axis. */
struct RingMesh {
  double inner{0};  ///< Radii [m].
  double outer{0};
  double height{0};  ///< [m]
  double gap{0};     ///< [rad]; 0: it is closed.
};

/** Makes a part whose round faces lie on cylinders. */
inline Part MakeRingPart(const RingMesh& ring, const Quat& turned = Quat::Identity()) {
  constexpr int kPieces = 360;
  Part part;
  part.name = "part";
  for (int i = 0; i <= kPieces; ++i) {
    const double share = static_cast<double>(i) / kPieces;
    const double angle = 0.5 * ring.gap + share * (2 * std::numbers::pi - ring.gap);
    for (const auto& [r, z] : {std::pair(ring.inner, 0.0),
                               {ring.outer, 0.0},
                               {ring.outer, ring.height},
                               {ring.inner, ring.height}}) {
      part.mesh.vertices.push_back(turned * Vec3(r * std::cos(angle), r * std::sin(angle), z));
    }
  }
  const bool is_closed = ring.gap == 0;
  const auto corner = [is_closed](int i, int k) {
    return static_cast<std::uint32_t>(4 * (is_closed ? i % kPieces : i) + k % 4);
  };
  const auto add = [&part](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    part.mesh.triangles.push_back({a, b, c});
  };
  for (int i = 0; i < kPieces; ++i) {
    for (int k = 0; k < 4; ++k) {
      add(corner(i, k), corner(i + 1, k), corner(i + 1, k + 1));
      add(corner(i, k), corner(i + 1, k + 1), corner(i, k + 1));
    }
  }
  if (!is_closed) {
    add(0, 1, 2);
    add(0, 2, 3);
    const auto last = static_cast<std::uint32_t>(4 * kPieces);
    add(last, last + 2, last + 1);
    add(last, last + 3, last + 2);
  }
  part.mass = CalcMass(part.mesh, 1);
  if (part.mass.volume < 0) {
    for (auto& triangle : part.mesh.triangles) {
      std::swap(triangle[1], triangle[2]);
    }
    part.mass = CalcMass(part.mesh, 1);
  }
  for (const Vec3& p : part.mesh.vertices) {
    part.box_B.Add(p);
  }
  for (const double outward : {-1.0, 1.0}) {
    const double radius = outward < 0 ? ring.inner : ring.outer;
    Face face;
    face.surface = {
        SurfaceKind::kCylinder, Vec3::Zero(), turned * Vec3::UnitZ(), radius, 0, outward};
    face.area = (2 * std::numbers::pi - ring.gap) * radius * ring.height;
    part.faces.push_back(face);
  }
  return part;
}

}  // namespace hvas::product::testing
