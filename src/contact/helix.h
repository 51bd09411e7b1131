#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "spatial/pose.h"

namespace hvas::contact {

/** Azimuths in a turn at which the edges of a thread are sampled. Between them the gap of two
 threads that lean or are off centre changes as a cosine, so that its least is met within 4 %. A
 choice. */
inline constexpr std::size_t kHelixAzimuths = 12;

/** Threads of a part that are looked for. A choice: parts with modelled threads have one or two. */
inline constexpr std::size_t kMaxHelices = 4;

/** A corner of a thread's profile. */
struct HelixCorner {
  double z{0};  ///< Along the axis at azimuth zero, 0 <= z < pitch [m].
  double r{0};  ///< Distance from the axis [m].
  /** Unit normals of the sides before and behind it, out of the material: in the directions of the
   radius, of the azimuth and of the axis. */
  std::array<Vec3, 2> normals{Vec3::UnitX(), Vec3::UnitX()};
  bool is_convex{false};  ///< May touch another part first.
};

/** A straight side of a thread's profile, in a plane through the axis. */
struct HelixSide {
  double z{0}, r{0};      ///< Where it begins [m].
  double dz{0}, dr{0};    ///< Way from there to its end, dz > 0 [m].
  double slope{0};        ///< dr / dz.
  double inverse{0};      ///< 1 / (dz^2 + dr^2) [1/m^2].
  double n_z{0}, n_r{1};  ///< Unit normal, out of the material.
};

/** A thread that is modelled, in or on a part: the surface that a profile sweeps when it turns
 about an axis and moves along it, evenly. Analytic where a mesh of it has facets. In the frame of
 the shape it belongs to. */
struct Helix {
  Vec3 origin{Vec3::Zero()};  ///< A point of the axis.
  Vec3 axis{Vec3::UnitZ()};   ///< Unit.
  Vec3 u{Vec3::UnitX()};      ///< Unit, across the axis: azimuth zero.
  Vec3 v{Vec3::UnitY()};      ///< Unit, axis x u: a quarter of a turn on.
  double pitch{0};            ///< Advance in a turn, > 0; of all starts together [m].
  double sense{1};            ///< +1: right-handed; -1: left-handed.
  double outward{1};          ///< +1: material is within, as in a bolt; -1: as in a nut.
  double low{0}, high{0};     ///< Span along the axis in which the part is this surface [m].
  double least_radius{0}, largest_radius{0};  ///< Radii of the profile [m].
  double inverse_pitch{0};                    ///< [1/m]
  double least_cosine{0};            ///< Least of what the distance is of that across the axis.
  double deviation{0};               ///< Largest distance of the part's mesh from it there [m].
  std::vector<HelixCorner> corners;  ///< Corners by z, at least two; after a pitch they come again.
  /** Sides behind each corner, with the last two of the turn before and the first two of the next.
   */
  std::vector<HelixSide> sides;
  std::vector<std::uint16_t> side_at;  ///< Side in which each bin of the pitch begins.

  /** Fills in what follows from corners: radii, normals and sides. */
  void Complete();

  /** @param direction  Of the axis, unit. @param across  Makes u. */
  void SetAxis(const Vec3& direction, const Vec3& across) {
    axis = direction;
    u = (across - across.dot(axis) * axis).normalized();
    v = axis.cross(u);
  }
};

/** A point in a helix's own coordinates. */
struct HelixPoint {
  double height{0};           ///< Along the axis from the origin [m].
  double radius{0};           ///< [m]
  double cosine{1}, sine{0};  ///< Those of its azimuth.

  /** @param x,y  Along u and v from the axis [m]. */
  static HelixPoint At(double x, double y, double height) noexcept {
    const double radius = std::sqrt(x * x + y * y);
    return radius > 0 ? HelixPoint{height, radius, x / radius, y / radius}
                      : HelixPoint{height, 0, 1, 0};
  }
};

/** Distance from a helix and what decides it. */
struct HelixDistance {
  double distance{0};            ///< [m], positive outside of the material.
  Vec3 gradient{Vec3::UnitX()};  ///< Unit, out of the material.
};

/** RT-safe. */
[[nodiscard]] inline HelixPoint Locate(const Helix& helix, const Vec3& p) noexcept {
  const Vec3 d = p - helix.origin;
  return HelixPoint::At(d.dot(helix.u), d.dot(helix.v), d.dot(helix.axis));
}

/** A unit vector of a cylinder's coordinates: away from the axis, around it, along it. RT-safe. */
[[nodiscard]] inline Vec3 FromCylinder(const Helix& helix, const HelixPoint& at, double radial,
                                       double around, double along) noexcept {
  return (radial * at.cosine - around * at.sine) * helix.u +
         (radial * at.sine + around * at.cosine) * helix.v + along * helix.axis;
}

/** Whether a point is in the span of a thread and between its root and its crest, or nearer to them
 than a margin. RT-safe. */
[[nodiscard]] inline bool IsInThread(const Helix& helix, const HelixPoint& at,
                                     double margin) noexcept {
  return at.height >= helix.low && at.height <= helix.high &&
         at.radius >= helix.least_radius - margin && at.radius <= helix.largest_radius + margin;
}

/** Calculates the distance to the unbounded thread where it is less than a limit, and infinity
 elsewhere, or the distance. In a plane through the axis it is that from the
 profile; where the profile's side leans by n_z towards the axis, the surface's gradient is
 (1 + (n_z p / (2 pi r))^2)^(1/2) times as long, with p the pitch: exact on the surface and to the
 second order beside it. RT-safe. */
[[nodiscard]] HelixDistance CalcHelixDistance(
    const Helix& helix, const HelixPoint& at,
    double limit = std::numeric_limits<double>::infinity()) noexcept;

[[nodiscard]] inline HelixDistance CalcHelixDistance(const Helix& helix, const Vec3& p) noexcept {
  return CalcHelixDistance(helix, Locate(helix, p));
}

/** How far along the axis a thread is in another one [m]; 0 where it is not: where they are not one
 outer and one inner, with the same pitch, and about so coaxial that their flanks face each other.
 @param R,p  Take coordinates of the other's shape to this one's. RT-safe. */
[[nodiscard]] double CalcThreadOverlap(const Helix& helix, const Helix& other, const Mat3& R,
                                       const Vec3& p) noexcept;

/** An edge of a thread at the surface of another one. */
struct HelixContact {
  Vec3 p{Vec3::Zero()};         ///< Point of the edge, in the frame of its shape.
  Vec3 gradient{Vec3::Zero()};  ///< Unit, out of the other one, in the frame of that one's shape.
  double distance{0};           ///< [m]
};

/** Finds where edges of one thread are nearer to another one than a margin, for as long as `visit`
 says so. Parallel flanks touch with the edges of both, so each is to be asked in the other.
 @param R,p  Take coordinates of the edges' shape to the field's.
 @param visit  bool(const HelixContact&): whether to go on.
 @returns how many points of edges were looked at. RT-safe. */
template <typename Visit>
std::uint32_t ForEachEdgeContact(const Helix& edges, const Helix& field, const Mat3& R,
                                 const Vec3& p, double margin, const Visit& visit) noexcept;

/** The azimuths at which edges are sampled: cosine and sine. */
[[nodiscard]] const std::array<std::array<double, 2>, kHelixAzimuths>& HelixAzimuths() noexcept;

}  // namespace hvas::contact

#include "contact/helix.inl.h"
