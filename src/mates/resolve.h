#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "product/mate.h"

/** Exact resolution of mates (X9), for any set of them and by the motions that they leave free.

 Let M be the connector of the placed side, fixed in W, and N the held one, fixed in B. A mate asks
     axis-hole:  z_N = +z_M,  p_MN x z_M = 0      (4 equations)
     face-face:  z_N = -z_M,  p_MN . z_M = 0      (3 equations)
     cone seat:  z_N = +z_M,  p_MN = 0            (5 equations)
     sphere seat:  p_MN = 0                       (3 equations)
     prismatic:  z_N = +z_M,  p_MN . z_M = 0      (3 equations)
 Stacked over all mates, with angles times a characteristic length L of the set, the equations'
 Jacobian by the held part's twist has a nullspace: the free twists. Directions which the mates
 determine only by less than kRankTolerance count as free: two axes drawn parallel within 0.1 deg
 are parallel. Each step is the shortest (Gauss-Newton with a truncated singular value
 decomposition), so what is free stays. All functions are RT-safe. */
namespace hvas::mates {

using spatial::Pose;
using spatial::Twist;

/** Least singular value of a direction that is held, as a part of the largest. */
inline constexpr double kRankTolerance = 2e-3;

struct MateConstraint {
  product::MateKind kind{product::MateKind::kFaceFace};
  Pose X_WM;  ///< Connector of the placed side.
  Pose X_BN;  ///< Connector of the held side in the held part.
};

/** A mate with one part held and the other placed at X_WP. @pre held is one of its occurrences. */
[[nodiscard]] MateConstraint MakeConstraint(const product::Mate& mate, product::OccurrenceId held,
                                            const Pose& X_WP) noexcept;

/** One linearised equation of a mate between its frames M and N. */
struct MateEquation {
  Vec3 axis_W;      ///< The axis of a tilt, or the direction of a shift of the origin of N.
  double right{0};  ///< Tilt [rad] or shift [m] that fulfils it.
  bool is_tilt{false};
};

/** The equations of a mate, tilts first. */
struct MateEquations {
  std::array<MateEquation, 5> items;
  std::size_t count{0};
};

/** Linearises a mate at a pose of N. */
[[nodiscard]] MateEquations CalcEquations(const MateConstraint& mate, const Pose& X_WN) noexcept;

/** Motions that a set of mates leaves. The basis is orthonormal with angles times `length` and
 velocities taken at `p_WR`; pure translations come first. */
struct FreeTwists {
  int translations{0};
  int rotations{0};            ///< Turns, screws included.
  std::array<Twist, 6> basis;  ///< Motions of B about its origin, in W; `count()` of them.
  Vec3 p_WR{Vec3::Zero()};     ///< Mean of the held connectors (of axes, if any).
  double length{0};            ///< Characteristic length L [m].

  [[nodiscard]] int count() const { return translations + rotations; }
};

[[nodiscard]] FreeTwists CalcFreeTwists(std::span<const MateConstraint> mates,
                                        const Pose& X_WB) noexcept;

/** Root of the sum of squares of all equations, angles times L [m]. */
[[nodiscard]] double CalcResidual(std::span<const MateConstraint> mates, const Pose& X_WB) noexcept;

struct Resolution {
  Pose X_WB;
  double residual{0};  ///< What CalcResidual gives [m].
  int iterations{0};
  bool is_converged{false};  ///< residual < 1e-10 m; false where the mates contradict each other.
};

/** The pose that fulfils all mates and is nearest to the start in what they leave free. */
[[nodiscard]] Resolution Resolve(std::span<const MateConstraint> mates,
                                 const Pose& X_WBStart) noexcept;

/** The pose that fulfils all mates and is nearest to the goal in what they leave free. */
[[nodiscard]] Resolution ResolveToward(std::span<const MateConstraint> mates, const Pose& X_WBStart,
                                       const Pose& X_WBGoal) noexcept;

/** One axis in closed form, as in paper X: turns about V_base x V_part through P_part by the angle
 of X(7), then moves by the part of P_base - P_part square to the axis, X(8). Parallel axes turn by
 nothing, opposed ones by half a turn about any axis square to them. */
[[nodiscard]] Pose AlignToAxis(const MateConstraint& mate, const Pose& X_WBStart) noexcept;

}  // namespace hvas::mates
