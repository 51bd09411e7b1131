#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mates/resolve.h"
#include "product/mate.h"

/** Mates between several bodies, resolved together: chains and closed loops, which `Resolve` cannot
 do for one held part at a time (X12, docs/algorithms/mates.md, section 6). Not for the loops. */
namespace hvas::mates {

/** A mate between two bodies; a body is one part, or several that move as one. */
struct BodyMate {
  product::MateKind kind{product::MateKind::kFaceFace};
  std::size_t a{0};                    ///< Body with the connector M.
  std::size_t b{0};                    ///< Body with the connector N.
  Pose X_AM;                           ///< Connector M in body a.
  Pose X_BN;                           ///< Connector N in body b.
  bool is_sense_open{false};           ///< Axis-hole: either end of the shaft may go in first.
  double hole_low{0}, hole_high{0};    ///< Span along z of M [m]; axis-hole only.
  double shaft_low{0}, shaft_high{0};  ///< Span along z of N [m]; axis-hole only.
  double distance_limit{0};            ///< The mate is fulfilled up to this distance [m],
  double angle_limit{0};               ///< and up to this angle [rad].
};

/** How far a mate is from being fulfilled. */
struct MateError {
  double distance{0};  ///< Across the axis, off the plane, or between the centres [m].
  double angle{0};     ///< Angle between the axes or normals [rad].
};

[[nodiscard]] MateError CalcError(const BodyMate& mate, const std::vector<Pose>& X_WB);

[[nodiscard]] bool IsFulfilled(const BodyMate& mate, const std::vector<Pose>& X_WB);

/** The mate with one of its bodies held and the other at its pose. @param is_turned  The held
 connector points the other way. */
[[nodiscard]] MateConstraint MakeBodyConstraint(const BodyMate& mate, bool holds_b,
                                                const Pose& X_WOther, bool is_turned);

/** True where the mate is nearer to being fulfilled with the shaft the other way round, which may
 go in by either end. */
[[nodiscard]] bool IsNearerTurned(const BodyMate& mate, const std::vector<Pose>& X_WB);

/** Moves the bodies that are not fixed until the mates are fulfilled: Levenberg-Marquardt on all of
 them at once, each step by conjugate gradients on the damped least squares, from zero, so that what
 is free stays. Contradicting mates end in the least squares.
 @param weights  Of the mates. @param X_WB  Poses by body, changed in place. */
void SolveTogether(std::span<const BodyMate> mates, std::span<const double> weights,
                   const std::vector<bool>& is_fixed, std::vector<Pose>* X_WB);

/** Motions of a body that mates leave, in W: pure shifts, and turns (screws included). */
struct BodyFreedom {
  std::vector<Vec3> shifts;  ///< Directions.
  std::vector<Twist> turns;  ///< Velocity v of the body's origin; w of length 1.

  [[nodiscard]] std::size_t count() const { return shifts.size() + turns.size(); }
};

/** What the mates leave each body free to do, the others following as far as they have to. Beyond
 kMaxTogether bodies that are not fixed the others stay where they are. */
[[nodiscard]] std::vector<BodyFreedom> CalcBodyFreedoms(std::span<const BodyMate> mates,
                                                        const std::vector<bool>& is_fixed,
                                                        const std::vector<Pose>& X_WB);

/** Largest number of moving bodies whose freedom is found with all of them: a choice, as the work
 grows with its cube and takes about a second here. */
inline constexpr std::size_t kMaxTogether = 100;

}  // namespace hvas::mates
