#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "spatial/pose.h"

/** Where a round shaft with play touches its hole, tilted or not: exact, from the two cylinders and
 the edges at their ends, whatever the meshes of the parts are (N5). */
namespace hvas::haptics {

/** A cylindrical hole and a shaft in it. */
struct Bore {
  double hole_radius{0};               ///< R [m].
  double shaft_radius{0};              ///< r [m], 0 < r < R.
  double hole_low{0}, hole_high{0};    ///< Span along z of the hole's frame [m].
  double shaft_low{0}, shaft_high{0};  ///< Span along z of the shaft's frame [m].
};

/** A place where the shaft touches the wall or an edge of the hole, or would if it moved on. */
struct BoreContact {
  Vec3 p_WC{Vec3::Zero()};     ///< Point of the edge that touches.
  Vec3 nhat_W{Vec3::UnitZ()};  ///< Unit, out of the surface that is touched, towards the shaft.
  double distance{0};          ///< Negative where they overlap [m].
};

/** Directions in which an edge is looked at: the one in which it is deepest, and five more at even
 angles, so that a shaft with less play than it moves in a tick cannot slip past all of them. */
inline constexpr std::size_t kBoreDirections = 6;

/** An edge at each end of the shaft and of the hole. */
inline constexpr std::size_t kMaxBoreContacts = 4 * kBoreDirections;

using BoreContacts = std::array<BoreContact, kMaxBoreContacts>;

/** Calculates the contacts nearer than a margin. The circle of an edge is seen along the axis of
 the other cylinder as an ellipse with half axes (rho cos t, rho), t the tilt. With its support
 function h(u) = u . c + rho sqrt(cos^2 t u_1^2 + u_2^2), an end of the shaft lies within the hole
 as far as h(u) <= R for every u across the hole's axis, and the shaft passes an edge of the hole
 as far as h(u) >= r for every u across the shaft's axis. The least of these gaps is the distance:
 there the ellipse's point lies along u. In the plane of the tilt both are zero where
 D = d cos t + l sin t, the two-point contact of fits::CalcTwoPointLength().
 @param X_WH  The hole's frame, its axis along z. @param X_WS  The shaft's frame, z alike.
 @param margin  [m]
 @returns how many of `contacts` are filled. RT-safe. */
std::size_t CalcBoreContacts(const Bore& bore, const spatial::Pose& X_WH, const spatial::Pose& X_WS,
                             double margin, BoreContacts* contacts) noexcept;

}  // namespace hvas::haptics
