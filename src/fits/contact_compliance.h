#pragma once

/** How much the surfaces of two parts give where they touch, by what the parts are made of. */
namespace hvas::fits {

/** An isotropic elastic body. */
struct Elasticity {
  double youngs_modulus{210e9};  ///< E [Pa]
  double poisson_ratio{0.3};     ///< nu
};

/** Reduced modulus E* of two bodies in contact, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2
 (Johnson, Contact Mechanics, 1985, eq. 4.20): each half of the contact gives by its own share [Pa].
 @pre Both moduli are above 0, and both ratios between -1 and 0.5. */
[[nodiscard]] double CalcReducedModulus(const Elasticity& a, const Elasticity& b) noexcept;

/** Compliance of a circular contact of radius `a` under a rigid flat punch, 1/(2 a E*) (Johnson
 1985, eq. 3.36) [m/N]. @pre radius > 0 [m], reduced_modulus > 0 [Pa]. */
[[nodiscard]] double CalcPunchCompliance(double radius, double reduced_modulus) noexcept;

/** Radius of the contact whose compliance is that of all contacts, 0.5 um/N, for steel on steel
 [m]: one contact point stands for so much of the surface. */
[[nodiscard]] double CalcContactRadius() noexcept;

/** Compliance of one contact point of two parts, by their moduli: that of a punch of
 CalcContactRadius(), so that steel on steel has 0.5 um/N [m/N]. */
[[nodiscard]] double CalcContactCompliance(const Elasticity& a, const Elasticity& b) noexcept;

}  // namespace hvas::fits
