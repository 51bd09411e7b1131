#include "cad/triangles/shape_hash.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace hvas::cad {
namespace {

constexpr double kStep = 1e-8;      // [m]: files write as many digits. A choice.
constexpr double kUnitStep = 1e-8;  // Of directions and angles.

/** Two independent 64-bit lanes, each the finaliser of SplitMix64 over the words. */
class Hasher {
 public:
  void Add(std::uint64_t word) {
    low_ = Mix(low_ ^ word);
    high_ = Mix(high_ + 0x9e3779b97f4a7c15u + word);
  }

  void AddReal(double value, double step) {
    Add(static_cast<std::uint64_t>(std::llround(value / step)));
  }

  void AddVector(const Vec3& v, double step) {
    for (int i = 0; i < 3; ++i) {
      AddReal(v[i], step);
    }
  }

  [[nodiscard]] std::string ToHex() const { return fmt::format("{:016x}{:016x}", high_, low_); }

 private:
  static std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t low_{0x243f6a8885a308d3u};
  std::uint64_t high_{0x13198a2e03707344u};
};

}  // namespace

std::string CalcShapeHash(const product::Part& part) {
  Hasher hasher;
  hasher.Add(part.mesh.vertices.size());
  for (const Vec3& v : part.mesh.vertices) {
    hasher.AddVector(v, kStep);
  }
  hasher.Add(part.mesh.triangles.size());
  for (const auto& triangle : part.mesh.triangles) {
    hasher.Add(triangle[0]);
    hasher.Add(triangle[1]);
    hasher.Add(triangle[2]);
  }
  hasher.Add(part.faces.size());
  for (const product::Face& face : part.faces) {
    const spatial::Surface& surface = face.surface;
    hasher.Add(face.triangle_count);
    hasher.Add(static_cast<std::uint64_t>(surface.kind));
    hasher.AddReal(surface.outward, 1);
    hasher.AddVector(surface.origin, kStep);
    hasher.AddVector(surface.axis, kUnitStep);
    hasher.AddReal(surface.radius, kStep);
    hasher.AddReal(surface.second, kStep);
  }
  return hasher.ToHex();
}

}  // namespace hvas::cad
