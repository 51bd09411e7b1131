#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "contact/shape.h"

namespace hvas::contact::testing {

/** A thread with straight flanks of 30 degrees: along the axis, from the middle of the crest of the
 bolt, flat for a quarter of the pitch, and at the root for an eighth or so. */
struct ThreadSize {
  double pitch{1.25e-3};
  double crest{4e-3};  ///< Radius of the bolt's crest.
  double depth{0.7e-3};
  double flat{0.25};  ///< Share of the pitch that is flat at the crest.
  double sense{1};    ///< +1: right-handed.

  /** Radius at a height along the axis from the middle of the crest. */
  [[nodiscard]] double RadiusAt(double z) const {
    const double off = std::abs(z / pitch - std::round(z / pitch)) * pitch;
    const double down = std::max(0.0, off - 0.5 * flat * pitch) * std::numbers::sqrt3;
    return crest - std::min(down, depth);
  }
};

/** Adds the vertices of a thread about z, row by row along it, n of them in a turn and in a pitch.
 */
inline void AddProfile(const ThreadSize& size, double clearance, int rows, int n,
                       std::vector<Vec3>* vertices) {
  for (int k = 0; k <= rows; ++k) {
    for (int j = 0; j < n; ++j) {
      const double turn = static_cast<double>(j) / n;
      const double z = k * size.pitch / n;
      const double r = size.RadiusAt(z - size.sense * size.pitch * turn) + clearance;
      const double angle = 2 * std::numbers::pi * turn;
      vertices->emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
}

/** A piece of thread about z, from 0 to a height: cut off straight at its ends.
 @param clearance  By how much all of its profile is farther from the axis [m].
 @param outside  Radius of the cylinder about a nut; 0: a bolt.
 @param n  Vertices in a turn, and in a pitch: a multiple of 16. */
inline ShapeSource ThreadMesh(const ThreadSize& size, double height, double clearance,
                              double outside, int n = 48) {
  ShapeSource source;
  source.faces.resize(outside > 0 ? 4 : 3);
  const auto rows = static_cast<int>(std::lround(height / size.pitch * n));
  AddProfile(size, clearance, rows, n, &source.vertices);
  const auto at = [n](int k, int j) { return static_cast<std::uint32_t>(k * n + (j + n) % n); };
  const auto face = [&](std::uint32_t f, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    // A nut's thread looks the other way.
    source.triangles.push_back(outside > 0 ? std::array{a, c, b} : std::array{a, b, c});
    source.triangle_face.push_back(f);
  };
  for (int k = 0; k < rows; ++k) {
    for (int j = 0; j < n; ++j) {
      if (size.sense > 0) {
        face(0, at(k, j), at(k, j + 1), at(k + 1, j + 1));
        face(0, at(k, j), at(k + 1, j + 1), at(k + 1, j));
      } else {
        face(0, at(k, j), at(k, j + 1), at(k + 1, j));
        face(0, at(k, j + 1), at(k + 1, j + 1), at(k + 1, j));
      }
    }
  }
  source.faces[1] = {spatial::SurfaceKind::kPlane, Vec3::Zero(), -Vec3::UnitZ(), 0, 0, 1};
  source.faces[2] = {spatial::SurfaceKind::kPlane, Vec3(0, 0, height), Vec3::UnitZ(), 0, 0, 1};
  const auto first = static_cast<std::uint32_t>(source.vertices.size());
  if (outside <= 0) {
    source.vertices.emplace_back(0, 0, 0);
    source.vertices.emplace_back(0, 0, height);
    for (int j = 0; j < n; ++j) {
      face(1, first, at(0, j + 1), at(0, j));
      face(2, first + 1, at(rows, j), at(rows, j + 1));
    }
    return source;
  }
  source.faces[3] = {spatial::SurfaceKind::kCylinder, Vec3::Zero(), Vec3::UnitZ(), outside, 0, 1};
  for (const double z : {0.0, height}) {
    for (int j = 0; j < n; ++j) {
      const double angle = 2 * std::numbers::pi * j / n;
      source.vertices.emplace_back(outside * std::cos(angle), outside * std::sin(angle), z);
    }
  }
  const auto low = [&](int j) { return first + static_cast<std::uint32_t>((j + n) % n); };
  const auto high = [&](int j) { return low(j) + static_cast<std::uint32_t>(n); };
  for (int j = 0; j < n; ++j) {
    face(1, at(0, j), low(j), low(j + 1));
    face(1, at(0, j), low(j + 1), at(0, j + 1));
    face(2, at(rows, j), high(j + 1), high(j));
    face(2, at(rows, j), at(rows, j + 1), high(j + 1));
    face(3, low(j), high(j + 1), low(j + 1));
    face(3, low(j), high(j), high(j + 1));
  }
  return source;
}

}  // namespace hvas::contact::testing
