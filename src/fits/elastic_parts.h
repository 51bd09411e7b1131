#pragma once

/** Forces of parts that give elastically on their way: closed forms of snap hooks, O-rings,
 retaining rings, slit pins, sleeves of rubber and lip seals. What is pressed together along its way
 is in fits/pressed_parts.h. docs/algorithms/flexible.md compares them with published examples. */
namespace hvas::fits {

/** An arm of rectangular section that bends aside: a snap hook, a wall. */
struct SnapArm {
  double length{0};        ///< l, from its root to the hook [m].
  double width{0};         ///< b, across the way and the deflection [m].
  double thickness{0};     ///< h, at its root, along the deflection [m].
  double modulus{0};       ///< Secant modulus of its material [Pa].
  bool is_tapered{false};  ///< Its thickness falls to half of it at the hook.
};

/** Deflection of its end at which the root has a strain.
 y = 0.67 eps l^2 / h, tapered y = 1.09 eps l^2 / h.
 Source: Bayer MaterialScience, Snap-Fit Joints for Plastics, table 1, shapes 1 and 2. */
[[nodiscard]] double CalcArmDeflection(const SnapArm& arm, double strain);

/** Force across the arm for each metre of its deflection [N/m]: P = b h^2 / 6 Es eps / l.
 Source: as CalcArmDeflection(). */
[[nodiscard]] double CalcArmStiffness(const SnapArm& arm);

/** Force along the way for each newton across it, where one surface slides up another:
 (mu + m) / (1 - mu m); infinite where the two lock themselves.
 Source: Bayer MaterialScience, Snap-Fit Joints for Plastics, mating force.
 @param slope  m, rise of the surface over the way; negative: it slides down. */
[[nodiscard]] double CalcSlidingRatio(double friction, double slope);

/** An O-ring. */
struct ORing {
  double diameter{0};  ///< D, of the middle of its section [m].
  double section{0};   ///< d [m]
  double modulus{0};   ///< E of the rubber [Pa].
};

/** Force on the whole ring that is squeezed between two surfaces.
 F = pi D d E (1.25 C^1.5 + 50 C^6), C = squeeze / d.
 Source: Lindley, Load-compression relationships of rubber units, J. Strain Analysis 2 (1967), as
 Green and English (1994) quote it.
 @param squeeze  How much flatter the section becomes, 0 at least [m]. It is known up to half of the
 section; beyond, the force rises by the slope there. */
[[nodiscard]] double CalcSqueezeForce(const ORing& ring, double squeeze) noexcept;

/** Slope of CalcSqueezeForce() [N/m]. */
[[nodiscard]] double CalcSqueezeStiffness(const ORing& ring, double squeeze) noexcept;

/** Radial force on the whole ring that is stretched over a shaft, for each metre by which its
 radius grows [N/m]: 2 pi E A / r, A = pi d^2 / 4, r = D / 2; its hoop tension is E A y / r. Exact
 for small strains. Rubber softens where it is stretched further, which is not accounted
 for. */
[[nodiscard]] double CalcStretchStiffness(const ORing& ring);

/** An open ring of rectangular section that is spread, or closed, by uniform pressure. */
struct OpenRing {
  double radius{0};     ///< Radius of the middle of its section [m].
  double width{0};      ///< Radial width of its section [m].
  double thickness{0};  ///< Width of its section along the axis [m].
  double modulus{0};    ///< [Pa]
};

/** Radial force on the whole ring for each metre by which its radius grows [N/m]:
 4 pi E I / (3 r^3), I = thickness width^3 / 12. Uniform pressure opens the gap of a curved beam by
 3 pi p r^4 / (E I), a ring that stays round by 2 pi times the growth of its radius.
 Source: Castigliano's theorem for a thin curved beam, as Timoshenko, Strength of Materials II,
 has it for piston rings. */
[[nodiscard]] double CalcSpreadStiffness(const OpenRing& ring);

/** A slit tube that its hole closes: a slit (spring) pin. */
struct SlitPin {
  double diameter{0};  ///< Outer diameter with nothing on it [m].
  double wall{0};      ///< [m]
  double length{0};    ///< Length in the hole [m].
  double modulus{0};   ///< [Pa]
  double yield{0};     ///< [Pa]
};

/** Radial force on the whole pin whose radius its hole makes smaller [N]: that of an open ring
 (CalcSpreadStiffness()), but no more than pi sigma_y L w^2 / (4 r), at which the wall opposite of
 the slit yields all through: uniform pressure bends it there by 2 p r^2.
 Source: as CalcSpreadStiffness(); the plastic moment of a rectangle, sigma_y L w^2 / 4.
 @param squeeze  How much smaller the radius becomes, >= 0 [m]. */
[[nodiscard]] double CalcSlitPinForce(const SlitPin& pin, double squeeze);

/** A tube of rubber between a hole and a shaft: an elastic bushing, a grommet. */
struct RubberSleeve {
  double inner_radius{0};  ///< [m]
  double outer_radius{0};  ///< [m]
  double length{0};        ///< [m]
  double modulus{0};       ///< E of the rubber [Pa].
};

/** Radial force on the whole sleeve, on one side of which there is nothing, for each metre by which
 its radius changes [N/m]: 2 pi E A / r, A = L w, as of an O-ring (CalcStretchStiffness()). */
[[nodiscard]] double CalcSleeveHoopStiffness(const RubberSleeve& sleeve);

/** Radial force on the whole sleeve for each metre by which hole and shaft squeeze its wall [N/m]:
 E_c 2 pi r L / w, with w the wall, r its middle radius, and E_c = 4/3 E (1 + S^2), S = L / (2 w),
 of a long strip of rubber between surfaces on which it does not slide.
 Source: Gent and Lindley, The compression of bonded rubber blocks, Proc. IMechE 173 (1959), with
 the bulk modulus beside it as in CalcPadModulus(). */
[[nodiscard]] double CalcSleeveStiffness(const RubberSleeve& sleeve);

/** Force along its axis for each metre by which a hole and a shaft that hold a sleeve move against
 each other along it [N/m]: 2 pi G L / ln(b / a), G = E / 3.
 Source: Adkins and Gent, Load-deflexion relations of rubber bush mountings, Brit. J. Appl. Phys. 5
 (1954): the axial mode. */
[[nodiscard]] double CalcSleeveShearStiffness(const RubberSleeve& sleeve);

/** The lip of a shaft seal: a short tube of rubber that stands on a rigid ring. */
struct SealLip {
  double radius{0};     ///< Radius of its edge [m].
  double length{0};     ///< Length along the axis, from its root to its edge [m].
  double thickness{0};  ///< [m]
  double modulus{0};    ///< E of the rubber [Pa].
};

/** Radial force on the whole lip for each metre by which its shaft spreads its edge [N/m].
 Each strip of it bends like a cantilever, and the hoop holds it back like an elastic foundation:
 with k = E t / r^2, D = E t^3 / (12 (1 - nu^2)), nu = 0.5, b = (k / (4 D))^(1/4) and x = b l,
 2 pi r k / (2 b) (cosh^2 x + cos^2 x) / (sinh x cosh x - sin x cos x). A short lip has the force of
 the strips, 3 D / l^3, and a long one that of a tube, k / (2 b), for each metre around.
 Source: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, for the shell as a beam on
 an elastic foundation; Hetenyi, Beams on Elastic Foundation, for one of finite length that is held
 at one end and loaded at the other. What a garter spring adds is not in it. */
[[nodiscard]] double CalcLipStiffness(const SealLip& lip);

}  // namespace hvas::fits
