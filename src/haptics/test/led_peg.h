#pragma once

#include <cmath>

#include "fits/insertion.h"
#include "haptics/test/peg_rig.h"

/** Equilibria of a peg that a spring leads into a hole beside the axis and tilted, as Whitney's
 compliantly supported peg, in the plane of its tilt and without small angles. */
namespace hvas::haptics::testing {

inline constexpr double kMu = 0.2;
inline constexpr double kCentre =
    0.5 * kPegLength;                      // Height of the centre of mass above the tip [m].
inline constexpr double kOffset = 0.5e-3;  // How far the tip is led into the wall [m].
inline constexpr double kTilt = 0.02;      // Of the hand [rad].

/** Forces of the hole on the peg in the plane of its tilt, and the moment about its centre. */
struct PlanarLoad {
  double f_x{0}, f_z{0}, m{0};
};

/** A peg in the plane of its tilt, with the axis of the hole along z and the rim at z = 0. */
struct PlanarPeg {
  double x_tip, depth, tilt;

  [[nodiscard]] Vec3 axis() const { return {std::sin(tilt), 0, std::cos(tilt)}; }

  [[nodiscard]] Vec3 across() const { return {std::cos(tilt), 0, -std::sin(tilt)}; }

  [[nodiscard]] Vec3 tip() const { return {x_tip, 0, -depth}; }

  [[nodiscard]] Vec3 centre() const { return tip() + kCentre * axis(); }

  /** Force of the rim for a normal force of 1 N, with friction against the motion inwards. */
  [[nodiscard]] Vec3 ForceAtRim() const { return -across() + kMu * axis(); }

  [[nodiscard]] double MomentAtRim() const {
    return (Vec3(kHoleRadius, 0, 0) - centre()).cross(ForceAtRim()).y();
  }
};

/** The hand's spring: where it leads the centre, and its tilt. */
struct PlanarSpring {
  double k_x, k_t;
  double x;  ///< Where the centre is led to [m].

  [[nodiscard]] double ForceOn(const PlanarPeg& peg) const { return k_x * (x - peg.centre().x()); }

  [[nodiscard]] double MomentOn(const PlanarPeg& peg) const { return k_t * (kTilt - peg.tilt); }
};

/** The root of a function that rises or falls through zero once in between. */
template <typename Function>
double FindRoot(double low, double high, const Function& function) {
  const bool rises = function(high) > 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((function(middle) > 0) == rises ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/** A peg with its side on the rim, at a tilt. */
inline PlanarPeg MakeOnRim(double depth, double tilt) {
  return {kHoleRadius - (kPegRadius + depth * std::sin(tilt)) / std::cos(tilt), depth, tilt};
}

/** Normal force of the rim on a peg that leans on it [N]. */
inline double CalcRimForce(const PlanarSpring& spring, const PlanarPeg& peg) {
  return -spring.ForceOn(peg) / peg.ForceAtRim().x();
}

/** Tilt of a peg that slides in on one point, without small angles. */
inline double FindTiltOnRim(const PlanarSpring& spring, double depth) {
  return FindRoot(-0.05, 0.1, [&](double t) {
    const PlanarPeg peg = MakeOnRim(depth, t);
    return spring.MomentOn(peg) + CalcRimForce(spring, peg) * peg.MomentAtRim();
  });
}

/** The equilibrium of such a peg. */
inline PlanarLoad CalcOnePoint(const PlanarSpring& spring, double depth) {
  const PlanarPeg peg = MakeOnRim(depth, FindTiltOnRim(spring, depth));
  const double force = CalcRimForce(spring, peg);
  const Vec3 f = force * peg.ForceAtRim();
  return {f.x(), f.z(), force * peg.MomentAtRim()};
}

/** The forces of two sliding points on a peg whose pose they determine. */
inline PlanarLoad CalcTwoPoint(const PlanarSpring& spring, double depth) {
  const double tilt = FindRoot(1e-4, 0.9 * fits::CalcLargestTilt(kPair),
                               [&](double t) { return fits::CalcTipDepth(kPair, t) - depth; });
  const PlanarPeg peg{kPegRadius * std::cos(tilt) - kHoleRadius, depth, tilt};
  const Vec3 at_tip(1, 0, kMu);
  const double m_tip = (peg.tip() - kPegRadius * peg.across() - peg.centre()).cross(at_tip).y();
  // tip * at_tip + rim * ForceAtRim() balances the spring, in x and about y.
  const double f = -spring.ForceOn(peg);
  const double m = -spring.MomentOn(peg);
  const Vec3 at_rim = peg.ForceAtRim();
  const double rim = (m - f * m_tip) / (peg.MomentAtRim() - at_rim.x() * m_tip);
  const double tip = f - rim * at_rim.x();
  return {f, kMu * tip + rim * at_rim.z(), m};
}

inline constexpr double kChamfer = 1e-3;  // Width of a hole's chamfer of 45 degrees [m].

/** The equilibrium of a peg whose tip slides down the chamfer of its hole, `depth` under the mouth:
 without a tilt of the hand, which is led beside the axis. The corner of the tip is the only point.
 */
inline PlanarLoad CalcOnChamfer(const PlanarSpring& spring, double depth) {
  const Vec3 push(kMu - 1, 0, kMu + 1);  // Times a force: of the slope, and of friction up it.
  const auto make = [&](double tilt) {
    const double corner = kHoleRadius + kChamfer - depth - kPegRadius * std::sin(tilt);
    return PlanarPeg{corner - kPegRadius * std::cos(tilt), depth, tilt};
  };
  const auto force = [&](const PlanarPeg& peg) { return -spring.ForceOn(peg) / push.x(); };
  const auto moment = [&](const PlanarPeg& peg) {
    return (peg.tip() + kPegRadius * peg.across() - peg.centre()).cross(push).y();
  };
  const double tilt = FindRoot(-0.1, 0.1, [&](double t) {
    const PlanarPeg peg = make(t);
    return -spring.k_t * t + force(peg) * moment(peg);
  });
  const PlanarPeg peg = make(tilt);
  return {force(peg) * push.x(), force(peg) * push.z(), force(peg) * moment(peg)};
}

}  // namespace hvas::haptics::testing
