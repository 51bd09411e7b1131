#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cad/triangles/facets.h"

namespace hvas::cad {

/** Facets on one curved surface. */
struct GrownSurface {
  spatial::Surface surface;
  std::vector<std::uint32_t> facets;  ///< Rising.
  double area{0};                     ///< [m^2]
};

/** Finds cylinders, cones, spheres and tori among facets: a surface is fitted to a facet and those
 around it, and grows over its neighbours as long as their corners lie on it. */
class SurfaceGrower {
 public:
  /** @param tolerance  How far a corner may lie off its surface [m]. */
  SurfaceGrower(const WeldedMesh& mesh, const Facets& facets, double tolerance);

  /** The surface with the largest area through a facet and its surroundings, over facets that
   nothing has taken yet; the simplest when others gain little. */
  [[nodiscard]] std::optional<GrownSurface> Find(std::uint32_t seed);

  void Take(const GrownSurface& grown);

  [[nodiscard]] bool is_taken(std::uint32_t facet) const { return is_taken_[facet]; }

 private:
  void CollectRing(std::uint32_t seed);
  void CollectStrips(std::uint32_t seed);
  [[nodiscard]] std::optional<spatial::Surface> FitSeeds(spatial::SurfaceKind kind,
                                                         const std::vector<std::uint32_t>& seeds);
  void Extend(spatial::Surface* surface, std::vector<std::uint32_t>* members);
  [[nodiscard]] std::optional<GrownSurface> Grow(spatial::SurfaceKind kind,
                                                 const std::vector<std::uint32_t>& seeds);
  void Spread(const spatial::Surface& surface, double tolerance, std::size_t limit,
              std::vector<std::uint32_t>* members);
  [[nodiscard]] bool IsOnSurface(const spatial::Surface& surface, std::uint32_t facet,
                                 double tolerance) const;
  [[nodiscard]] double Refit(std::span<const std::uint32_t> members, spatial::Surface* surface);
  void DropCaps(const spatial::Surface& surface, std::vector<std::uint32_t>* members) const;
  [[nodiscard]] bool IsSupported(const spatial::Surface& surface,
                                 std::span<const std::uint32_t> members);
  [[nodiscard]] bool TurnsMoreThan(double angle, std::span<const std::uint32_t> members) const;
  [[nodiscard]] bool HasSmoothRim(std::span<const std::uint32_t> members);
  void CollectPoints(std::span<const std::uint32_t> members);

  const WeldedMesh& mesh_;
  const Facets& facets_;
  double tolerance_;
  std::vector<bool> is_taken_;
  std::vector<std::uint32_t> ring_;
  std::vector<std::uint32_t> strips_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> facet_stamp_;
  std::vector<std::uint32_t> vertex_stamp_;
  std::uint32_t round_{0};
};

}  // namespace hvas::cad
