#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "spatial/pose.h"

namespace hvas::product::testing {

/** A coil of round wire about z, from z = 0 on. Lengths in metres. */
struct Coil {
  double wire{2e-3};
  double mean_diameter{14e-3};
  double active{5};    ///< Turns with gaps between them.
  double pitch{4e-3};  ///< Pitch of the active turns.
  double closed{1};    ///< Turns at each end that nearly touch.
  int section{16};     ///< Corners of the wire's section.
  int steps{32};       ///< Steps of a turn.
};

struct CoilMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double length{0};  ///< Along z.
};

/** The section stands upright, so that it is as high as the wire is thick. */
inline CoilMesh MakeCoil(const Coil& coil) {
  CoilMesh mesh;
  const double turns = coil.active + 2 * coil.closed;
  const int count = static_cast<int>(std::lround(turns * coil.steps));
  const double close_pitch = 1.02 * coil.wire;
  const auto climb = [&](double turn) {
    const double low = std::min(turn, coil.closed);
    const double middle = std::clamp(turn - coil.closed, 0.0, coil.active);
    const double high = std::max(0.0, turn - coil.closed - coil.active);
    return close_pitch * (low + high) + coil.pitch * middle;
  };
  const auto corner = [&](int i, int k) {
    return static_cast<std::uint32_t>(i * coil.section + k % coil.section);
  };
  for (int i = 0; i <= count; ++i) {
    const double turn = turns * i / count;
    const double angle = 2 * std::numbers::pi * turn;
    const double z = 0.5 * coil.wire + climb(turn);
    for (int k = 0; k < coil.section; ++k) {
      const double around = 2 * std::numbers::pi * k / coil.section;
      const double r = 0.5 * coil.mean_diameter + 0.5 * coil.wire * std::cos(around);
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle),
                                 z + 0.5 * coil.wire * std::sin(around));
    }
  }
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < coil.section; ++k) {
      mesh.triangles.push_back({corner(i, k), corner(i, k + 1), corner(i + 1, k + 1)});
      mesh.triangles.push_back({corner(i, k), corner(i + 1, k + 1), corner(i + 1, k)});
    }
  }
  for (int k = 1; k + 1 < coil.section; ++k) {
    mesh.triangles.push_back({corner(0, 0), corner(0, k + 1), corner(0, k)});
    mesh.triangles.push_back({corner(count, 0), corner(count, k), corner(count, k + 1)});
  }
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  if (volume < 0) {
    for (auto& t : mesh.triangles) {
      std::swap(t[1], t[2]);
    }
  }
  mesh.length = coil.wire + climb(turns);
  return mesh;
}

}  // namespace hvas::product::testing
