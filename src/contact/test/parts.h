#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "contact/shape.h"

/** Parts with known surfaces, meshed here to a stated deviation. */
namespace hvas::contact::testing {

struct ProfilePiece {
  std::vector<Eigen::Vector2d> rz;  ///< Points (r, z), the material on the left.
  spatial::Surface surface;
};

/** Turns a profile about the z axis; n segments. */
inline ShapeSource Lathe(const std::vector<ProfilePiece>& profile, int n) {
  ShapeSource source;
  const auto vertex = [&](const Eigen::Vector2d& rz, int i) {
    const double angle = 2 * std::numbers::pi * (i % n) / n;
    source.vertices.emplace_back(rz.x() * std::cos(angle), rz.x() * std::sin(angle), rz.y());
    return static_cast<std::uint32_t>(source.vertices.size() - 1);
  };
  for (std::uint32_t f = 0; f < profile.size(); ++f) {
    source.faces.push_back(profile[f].surface);
    const auto& rz = profile[f].rz;
    for (std::size_t k = 0; k + 1 < rz.size(); ++k) {
      for (int i = 0; i < n; ++i) {
        const auto a = vertex(rz[k], i);
        const auto b = vertex(rz[k], i + 1);
        const auto c = vertex(rz[k + 1], i + 1);
        const auto d = vertex(rz[k + 1], i);
        if (rz[k].x() > 0) {
          source.triangles.push_back({a, b, c});
          source.triangle_face.push_back(f);
        }
        if (rz[k + 1].x() > 0) {
          source.triangles.push_back({a, c, d});
          source.triangle_face.push_back(f);
        }
      }
    }
  }
  return source;
}

/** Segments that keep a circle's chords within the deviation. */
inline int Segments(double radius, double deviation = 1e-6) {
  return std::max(
      12, static_cast<int>(std::ceil(std::numbers::pi / std::acos(1 - deviation / radius))));
}

inline spatial::Surface PlaneAt(double z, double up) {
  return {spatial::SurfaceKind::kPlane, Vec3(0, 0, z), Vec3(0, 0, up), 0, 0, 1};
}

inline spatial::Surface CylinderZ(double radius, double outward) {
  return {spatial::SurfaceKind::kCylinder, Vec3::Zero(), Vec3::UnitZ(), radius, 0, outward};
}

/** Faces: 0 bottom, 1 side, 2 top; from z = 0 to `length`. */
inline ShapeSource Shaft(double radius, double length, double deviation = 1e-6) {
  return Lathe({{{{0, 0}, {radius, 0}}, PlaneAt(0, -1)},
                {{{radius, 0}, {radius, length}}, CylinderZ(radius, 1)},
                {{{radius, length}, {0, length}}, PlaneAt(length, 1)}},
               Segments(radius, deviation));
}

/** Faces: 0 bottom, 1 outside, 2 top, 3 bore; from z = 0 to `length`. */
inline ShapeSource Bushing(double bore, double outside, double length, double deviation = 1e-6) {
  return Lathe({{{{bore, 0}, {outside, 0}}, PlaneAt(0, -1)},
                {{{outside, 0}, {outside, length}}, CylinderZ(outside, 1)},
                {{{outside, length}, {bore, length}}, PlaneAt(length, 1)},
                {{{bore, length}, {bore, 0}}, CylinderZ(bore, -1)}},
               Segments(bore, deviation));
}

/** A blind hole from the top. Faces: 0 bottom, 1 outside, 2 top, 3 bore, 4 floor. */
inline ShapeSource Cup(double bore, double outside, double floor, double length) {
  return Lathe({{{{0, 0}, {outside, 0}}, PlaneAt(0, -1)},
                {{{outside, 0}, {outside, length}}, CylinderZ(outside, 1)},
                {{{outside, length}, {bore, length}}, PlaneAt(length, 1)},
                {{{bore, length}, {bore, floor}}, CylinderZ(bore, -1)},
                {{{bore, floor}, {0, floor}}, PlaneAt(floor, 1)}},
               Segments(bore));
}

/** An arc of a circle about (r, z), from angle a to b [rad]. */
inline std::vector<Eigen::Vector2d> Arc(double r, double z, double radius, double a, double b,
                                        double deviation = 1e-6) {
  const int n = std::max(
      2, static_cast<int>(std::ceil(std::abs(b - a) / (2 * std::acos(1 - deviation / radius)))));
  std::vector<Eigen::Vector2d> out;
  for (int i = 0; i <= n; ++i) {
    const double t = a + (b - a) * i / n;
    out.emplace_back(r + radius * std::cos(t), z + radius * std::sin(t));
  }
  return out;
}

/** A ball about the origin; one face. */
inline ShapeSource Ball(double radius, double deviation = 1e-6) {
  auto arc = Arc(0, 0, radius, -std::numbers::pi / 2, std::numbers::pi / 2, deviation);
  arc.front().x() = arc.back().x() = 0;
  spatial::Surface s{spatial::SurfaceKind::kSphere, Vec3::Zero(), Vec3::UnitZ(), radius, 0, 1};
  return Lathe({{arc, s}}, Segments(radius, deviation));
}

/** A ring about the z axis; one face. */
inline ShapeSource Ring(double major, double minor, double deviation = 1e-6) {
  auto arc = Arc(major, 0, minor, 0, 2 * std::numbers::pi, deviation);
  arc.back() = arc.front();
  spatial::Surface s{spatial::SurfaceKind::kTorus, Vec3::Zero(), Vec3::UnitZ(), major, minor, 1};
  return Lathe({{arc, s}}, Segments(major + minor, deviation));
}

/** A truncated cone on z = 0. Faces: 0 bottom, 1 side, 2 top. */
inline ShapeSource Cone(double bottom, double top, double length, double deviation = 1e-6) {
  const double half_angle = std::atan2(bottom - top, length);
  const Vec3 apex(0, 0, bottom / std::tan(half_angle));
  spatial::Surface side{spatial::SurfaceKind::kCone, apex, -Vec3::UnitZ(), 0, half_angle, 1};
  return Lathe({{{{0, 0}, {bottom, 0}}, PlaneAt(0, -1)},
                {{{bottom, 0}, {top, length}}, side},
                {{{top, length}, {0, length}}, PlaneAt(length, 1)}},
               Segments(bottom, deviation));
}

/** A box from -half to half. Faces: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z. */
inline ShapeSource Block(const Vec3& half) {
  ShapeSource source;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 n = Vec3::Zero();
      n[axis] = side;
      const auto f = static_cast<std::uint32_t>(source.faces.size());
      source.faces.push_back(
          {spatial::SurfaceKind::kPlane, side * half[axis] * Vec3::Unit(axis), n, 0, 0, 1});
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const auto first = static_cast<std::uint32_t>(source.vertices.size());
      for (const auto& [su, sv] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        Vec3 p = side * half[axis] * Vec3::Unit(axis);
        p[u] = su * half[u];
        p[v] = sv * half[v];
        source.vertices.push_back(p);
      }
      if (side > 0) {
        source.triangles.push_back({first, first + 1, first + 2});
        source.triangles.push_back({first, first + 2, first + 3});
      } else {
        source.triangles.push_back({first, first + 2, first + 1});
        source.triangles.push_back({first, first + 3, first + 2});
      }
      source.triangle_face.insert(source.triangle_face.end(), 2, f);
    }
  }
  return source;
}

inline std::shared_ptr<const Shape> Build(const ShapeSource& source,
                                          const ShapeOptions& options = {}) {
  return Shape::Build(source, options).value();
}

}  // namespace hvas::contact::testing
