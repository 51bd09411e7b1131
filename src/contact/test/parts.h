#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <numeric>
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

/** A shaft with a lead-in and a ring groove. Faces: 0 bottom, 2 side to the groove, 4 its floor, 6
 side, 7 top; on z from 0 to `length`. */
inline ShapeSource GroovedShaft(double radius, double length, double deviation = 1e-6) {
  constexpr double kChamfer = 1e-3, kDepth = 1e-3, kFrom = 20e-3, kTo = 24e-3;
  const double floor = radius - kDepth;
  const Vec3 apex(0, 0, kChamfer - radius);
  const spatial::Surface lead_in{spatial::SurfaceKind::kCone, apex, Vec3::UnitZ(), 0,
                                 std::numbers::pi / 4,        1};
  return Lathe({{{{0, 0}, {radius - kChamfer, 0}}, PlaneAt(0, -1)},
                {{{radius - kChamfer, 0}, {radius, kChamfer}}, lead_in},
                {{{radius, kChamfer}, {radius, kFrom}}, CylinderZ(radius, 1)},
                {{{radius, kFrom}, {floor, kFrom}}, PlaneAt(kFrom, 1)},
                {{{floor, kFrom}, {floor, kTo}}, CylinderZ(floor, 1)},
                {{{floor, kTo}, {radius, kTo}}, PlaneAt(kTo, -1)},
                {{{radius, kTo}, {radius, length}}, CylinderZ(radius, 1)},
                {{{radius, length}, {0, length}}, PlaneAt(length, 1)}},
               Segments(radius, deviation));
}

/** A bushing with an oil groove, from z = 0 to `length`. Faces: 0 bottom, 1 outside, 2 top, 3 and 7
 bore, 5 floor of the groove. */
inline ShapeSource GroovedBore(double bore, double outside, double length,
                               double deviation = 1e-6) {
  constexpr double kDepth = 1e-3;
  const double from = 0.5 * length, to = from - 4e-3;
  const double floor = bore + kDepth;
  return Lathe({{{{bore, 0}, {outside, 0}}, PlaneAt(0, -1)},
                {{{outside, 0}, {outside, length}}, CylinderZ(outside, 1)},
                {{{outside, length}, {bore, length}}, PlaneAt(length, 1)},
                {{{bore, length}, {bore, from}}, CylinderZ(bore, -1)},
                {{{bore, from}, {floor, from}}, PlaneAt(from, -1)},
                {{{floor, from}, {floor, to}}, CylinderZ(floor, -1)},
                {{{floor, to}, {bore, to}}, PlaneAt(to, 1)},
                {{{bore, to}, {bore, 0}}, CylinderZ(bore, -1)}},
               Segments(bore, deviation));
}

/** A tapered hole through a round body from z = 0 to `length`. Faces: 0 bottom, 1 outside, 2 top, 3
 seat. */
inline ShapeSource ConeSeat(double bottom, double top, double length, double outside,
                            double deviation = 1e-6) {
  const double half_angle = std::atan2(top - bottom, length);
  const Vec3 apex(0, 0, -bottom / std::tan(half_angle));
  const spatial::Surface seat{spatial::SurfaceKind::kCone, apex, Vec3::UnitZ(), 0, half_angle, -1};
  return Lathe({{{{bottom, 0}, {outside, 0}}, PlaneAt(0, -1)},
                {{{outside, 0}, {outside, length}}, CylinderZ(outside, 1)},
                {{{outside, length}, {top, length}}, PlaneAt(length, 1)},
                {{{top, length}, {bottom, 0}}, seat}},
               Segments(top, deviation));
}

/** The lower half of a spherical socket about the origin. Faces: 0 bottom, 1 outside, 2 top, 3
 * seat.
 */
inline ShapeSource Socket(double radius, double outside, double deviation = 1e-6) {
  auto arc = Arc(0, 0, radius, 0, -std::numbers::pi / 2, deviation);
  arc.back().x() = 0;
  const spatial::Surface seat{
      spatial::SurfaceKind::kSphere, Vec3::Zero(), Vec3::UnitZ(), radius, 0, -1};
  return Lathe({{{{0, -outside}, {outside, -outside}}, PlaneAt(-outside, -1)},
                {{{outside, -outside}, {outside, 0}}, CylinderZ(outside, 1)},
                {{{outside, 0}, {radius, 0}}, PlaneAt(0, 1)},
                {arc, seat}},
               Segments(radius, deviation));
}

/** A plate about the z axis with a half-round ring groove in its top at z = 0. Faces: 0 bottom, 1
 outside, 2 top outside the groove, 3 groove, 4 top inside. */
inline ShapeSource RingGroove(double major, double minor, double deviation = 1e-6) {
  const double outside = major + 3 * minor, bottom = -3 * minor;
  const spatial::Surface groove{
      spatial::SurfaceKind::kTorus, Vec3::Zero(), Vec3::UnitZ(), major, minor, -1};
  return Lathe({{{{0, bottom}, {outside, bottom}}, PlaneAt(bottom, -1)},
                {{{outside, bottom}, {outside, 0}}, CylinderZ(outside, 1)},
                {{{outside, 0}, {major + minor, 0}}, PlaneAt(0, 1)},
                {Arc(major, 0, minor, 0, -std::numbers::pi, deviation), groove},
                {{{major - minor, 0}, {0, 0}}, PlaneAt(0, 1)}},
               Segments(major + minor, deviation));
}

/** A box from -half to half with a rectangular window through it along z, the half sizes of which
 are given. Faces: 0..3 outside, 4..7 window, 8 bottom, 9 top. */
inline ShapeSource Frame(const Vec3& half, const Eigen::Vector2d& window) {
  ShapeSource source;
  const auto corner = [&](double x, double y, int k, double z) {
    const double sx[4] = {1, -1, -1, 1};
    const double sy[4] = {1, 1, -1, -1};
    source.vertices.emplace_back(sx[k % 4] * x, sy[k % 4] * y, z);
    return static_cast<std::uint32_t>(source.vertices.size() - 1);
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                        std::uint32_t face) {
    source.triangles.push_back({a, b, c});
    source.triangles.push_back({a, c, d});
    source.triangle_face.insert(source.triangle_face.end(), 2, face);
  };
  source.faces.resize(10);
  const auto plane = [&](std::uint32_t face, const Vec3& p, const Vec3& n) {
    source.faces[face] = {spatial::SurfaceKind::kPlane, p, n, 0, 0, 1};
  };
  const double h = half.z();
  for (std::uint32_t k = 0; k < 4; ++k) {
    const int i = static_cast<int>(k);
    const auto outer = [&](int j, double z) { return corner(half.x(), half.y(), j, z); };
    const auto inner = [&](int j, double z) { return corner(window.x(), window.y(), j, z); };
    const Vec3 n = k % 2 == 0 ? Vec3(0, k == 0 ? 1 : -1, 0) : Vec3(k == 1 ? -1 : 1, 0, 0);
    plane(k, n.cwiseProduct(half), n);
    plane(k + 4, n.cwiseProduct(Vec3(window.x(), window.y(), 0)), -n);
    quad(outer(i, -h), outer(i + 1, -h), outer(i + 1, h), outer(i, h), k);
    quad(inner(i + 1, -h), inner(i, -h), inner(i, h), inner(i + 1, h), k + 4);
    quad(outer(i + 1, -h), outer(i, -h), inner(i, -h), inner(i + 1, -h), 8);
    quad(outer(i, h), outer(i + 1, h), inner(i + 1, h), inner(i, h), 9);
  }
  plane(8, Vec3(0, 0, -h), -Vec3::UnitZ());
  plane(9, Vec3(0, 0, h), Vec3::UnitZ());
  return source;
}

/** Triangles of a simple outline that turns left, by cutting off ears. */
inline std::vector<std::array<std::uint32_t, 3>> Triangulate(
    const std::vector<Eigen::Vector2d>& outline) {
  const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Eigen::Vector2d u = outline[b] - outline[a];
    const Eigen::Vector2d v = outline[c] - outline[a];
    return u.x() * v.y() - u.y() * v.x();
  };
  std::vector<std::uint32_t> left(outline.size());
  std::iota(left.begin(), left.end(), 0U);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; left.size() > 2; i = i + 1 < left.size() ? i + 1 : 0) {
    const std::uint32_t a = left[(i + left.size() - 1) % left.size()];
    const std::uint32_t b = left[i];
    const std::uint32_t c = left[(i + 1) % left.size()];
    const bool is_ear =
        turn(a, b, c) > 0 && std::none_of(left.begin(), left.end(), [&](std::uint32_t p) {
          return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                 turn(c, a, p) >= 0;
        });
    if (is_ear || left.size() == 3) {
      triangles.push_back({a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
  }
  return triangles;
}

/** A prism along x from -half_length to half_length, over an outline (y, z) that turns left. Faces:
 one over each edge of the outline, then -x and +x. */
inline ShapeSource Prism(const std::vector<Eigen::Vector2d>& outline, double half_length) {
  ShapeSource source;
  const auto vertex = [&](std::size_t k, double x) {
    const Eigen::Vector2d& p = outline[k % outline.size()];
    source.vertices.emplace_back(x, p.x(), p.y());
    return static_cast<std::uint32_t>(source.vertices.size() - 1);
  };
  const auto face = [&source](const Vec3& p, const Vec3& n) {
    source.faces.push_back({spatial::SurfaceKind::kPlane, p, n, 0, 0, 1});
    return static_cast<std::uint32_t>(source.faces.size() - 1);
  };
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d edge = outline[(k + 1) % outline.size()] - outline[k];
    const std::uint32_t f =
        face(Vec3(0, outline[k].x(), outline[k].y()), Vec3(0, edge.y(), -edge.x()).normalized());
    const std::uint32_t a = vertex(k, -half_length);
    const std::uint32_t b = vertex(k + 1, -half_length);
    const std::uint32_t c = vertex(k + 1, half_length);
    const std::uint32_t d = vertex(k, half_length);
    source.triangles.push_back({a, b, c});
    source.triangles.push_back({a, c, d});
    source.triangle_face.insert(source.triangle_face.end(), 2, f);
  }
  for (const double side : {-1.0, 1.0}) {
    const std::uint32_t f = face(side * half_length * Vec3::UnitX(), side * Vec3::UnitX());
    const auto first = static_cast<std::uint32_t>(source.vertices.size());
    for (std::size_t k = 0; k < outline.size(); ++k) {
      (void)vertex(k, side * half_length);
    }
    for (const auto& [a, b, c] : Triangulate(outline)) {
      source.triangles.push_back(side > 0 ? std::array{first + a, first + b, first + c}
                                          : std::array{first + a, first + c, first + b});
      source.triangle_face.push_back(f);
    }
  }
  return source;
}

inline std::shared_ptr<const Shape> Build(const ShapeSource& source,
                                          const ShapeOptions& options = {}) {
  return Shape::Build(source, options).value();
}

}  // namespace hvas::contact::testing
