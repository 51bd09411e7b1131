#pragma once

#include <array>

/** A round peg in a round hole, planar: two-point contact, jamming, wedging, compliant support
 (N5). Geometry exact; statics after Whitney, "Quasi-static assembly of compliantly supported rigid
 parts", ASME J. Dyn. Syst. 104 (1982), derived anew. Lengths in metres, angles in radians.

 l is measured along the peg's side from the corner of its tip that is in contact to where the rim
 touches the other side. */
namespace hvas::fits {

struct PegInHole {
  double hole_diameter{0};  ///< D [m], > d.
  double peg_diameter{0};   ///< d [m], > 0.

  /** (D - d) / D. */
  [[nodiscard]] double relative_clearance() const noexcept;
};

/** The tilt at which both points touch at a given l:  D = d cos t + l sin t, the smaller solution
 t = atan2(l, d) - acos(D / sqrt(d^2 + l^2)). NaN where l < l_min: the peg is free to tilt. */
[[nodiscard]] double CalcTwoPointTilt(const PegInHole& pair, double l) noexcept;

/** l of two-point contact at a tilt t in (0, t_m): l = (D - d cos t) / sin t. +inf at t <= 0, NaN
 beyond t_m, where the peg does not enter. */
[[nodiscard]] double CalcTwoPointLength(const PegInHole& pair, double tilt) noexcept;

/** t_m = acos(d / D): the largest tilt at which the peg enters at all. */
[[nodiscard]] double CalcLargestTilt(const PegInHole& pair) noexcept;

/** l_min = sqrt(D^2 - d^2), the l of two-point contact at t_m. */
[[nodiscard]] double CalcLeastTwoPointLength(const PegInHole& pair) noexcept;

/** Depth of the middle of the tip under the rim in two-point contact at a tilt, R and r the radii:
 h = (2 R cos t - r cos^2 t - r) / sin t. */
[[nodiscard]] double CalcTipDepth(const PegInHole& pair, double tilt) noexcept;

/** How far off the hole's axis an upright peg may be to enter: (D - d) / 2 and the widths of the
 chamfers, radially, of hole and peg. */
[[nodiscard]] double CalcEntryWindow(const PegInHole& pair, double hole_chamfer,
                                     double peg_chamfer) noexcept;

/** The load on a peg at the middle of its tip, in the plane of the tilt. */
struct PegLoad {
  double f_x{0};  ///< Across [N].
  double f_z{0};  ///< Along, inwards [N].
  double m{0};    ///< [N m]
};

/** Forces at the two contacts of a peg that slides in: f1 at the corner of its tip, f2 at the rim.
   F_x = f1 - f2,  F_z = mu (f1 + f2),  M = l f2 + mu r (f2 - f1). */
[[nodiscard]] PegLoad CalcTwoPointLoad(double f1, double f2, double l, double radius,
                                       double friction) noexcept;

/** lambda = l / (2 r mu). */
[[nodiscard]] double CalcLambda(double l, double radius, double friction) noexcept;

/** Corners of the parallelogram of loads (F_x / F_z, M / (r F_z)) within which a peg in two-point
 contact does not jam. */
struct DiagramPoint {
  double f_x_over_f_z{0};
  double m_over_r_f_z{0};
};

[[nodiscard]] std::array<DiagramPoint, 4> CalcJammingDiagram(double lambda,
                                                             double friction) noexcept;

/** Whether a load moves the peg on:  |F_x / F_z| < 1 / mu  and
 |M / (r F_z) + mu (1 + lambda) F_x / F_z| < lambda, with F_z > 0. */
[[nodiscard]] bool IsSliding(const PegLoad& load, double l, double radius,
                             double friction) noexcept;

/** Whether the two friction cones see each other, so that the peg can hold itself without a load:
 l <= mu d. */
[[nodiscard]] bool CanWedge(const PegInHole& pair, double l, double friction) noexcept;

/** The tilt below which two-point contact comes too late to wedge: the two-point tilt at l = mu d
 (about c / mu). */
[[nodiscard]] double CalcWedgingTilt(const PegInHole& pair, double friction) noexcept;

/** What holds the peg: springs across and against tilt at a centre above its tip. */
struct CompliantSupport {
  double k_x{0};     ///< [N/m], > 0.
  double k_t{0};     ///< [N m/rad], > 0.
  double height{0};  ///< L_g, of the compliance centre above the tip [m].
};

/** Forces of a peg on the hole: normal, and its parts along and across the axis. NaN where the
 support or the friction lets no equilibrium exist. */
struct InsertionForce {
  double normal{0};
  double f_z{0};
  double f_x{0};
};

/** Crossing a chamfer at an angle from the hole's face, after descending z on it:
   A = cos a + mu sin a, B = sin a - mu cos a,
   f = K_x K_t (z / tan a) / ((K_x L_g^2 + K_t) B - K_x L_g r A),  F_z = A f,  F_x = B f.
 Needs tan a > mu. */
[[nodiscard]] InsertionForce CalcChamferForce(const CompliantSupport& support, double radius,
                                              double friction, double chamfer_angle,
                                              double descent) noexcept;

/** One side of the peg on the rim, for a first offset eps0' and tilt theta0 of the support:
   f = K_x K_t (eps0' + l theta0) / (K_t + K_x (L_g - l) (L_g - l - mu r)),  F_z = mu f. */
[[nodiscard]] InsertionForce CalcOnePointForce(const CompliantSupport& support, double radius,
                                               double friction, double offset, double tilt,
                                               double l) noexcept;

}  // namespace hvas::fits
