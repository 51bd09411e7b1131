#pragma once

#include <array>
#include <string_view>

#include "base/result.h"
#include "fits/materials.h"

/** Interference fits of two elastic cylinders: DIN 7190-1 in its notation, derived from Lame's
 thick ring in plane stress with uniform pressure over the joint (N4, W6, W7). Lengths in metres,
 stresses in pascals, forces in newtons. */
namespace hvas::fits {

/** How much of the interference the roughness takes: G = k (Rz_A + Rz_I). */
enum class Smoothing {
  kNone,     ///< None, as in paper W.
  kDin2001,  ///< k = 0.8, DIN 7190:2001.
  kDin2017,  ///< k = 0.4, DIN 7190-1:2017.
};

[[nodiscard]] double GetSmoothingFactor(Smoothing edition) noexcept;

/** Calculates the radial clearance that is left where the peaks are flat [m]: S + G / 2.
 @param clearance  S between the peaks [m], negative: interference.
 @param smoothing_loss  G, of the diametral interference [m]. */
[[nodiscard]] constexpr double CalcSmoothedClearance(double clearance,
                                                     double smoothing_loss) noexcept {
  return clearance + 0.5 * smoothing_loss;
}

/** Elastic constants and strength of one side. */
struct PressMaterial {
  double youngs_modulus{210e9};     ///< E [Pa], > 0.
  double poisson_ratio{0.3};        ///< nu, 0 to 0.5.
  double yield_strength{0};         ///< Re [Pa]; 0: unknown, or none (brittle).
  double tensile_strength{0};       ///< Rm [Pa]; limits a brittle hub. 0: unknown.
  double thermal_expansion{11e-6};  ///< alpha [1/K].
};

/** Strength, without a yield strength where the group is brittle, as of grey iron, whose stated one
 is a proof stress. */
[[nodiscard]] PressMaterial ToPressMaterial(const Material& material) noexcept;

/** A hub A outside, a shaft I inside, joined at the diameter D_F. */
struct PressFitParameters {
  double joint_diameter{0};  ///< D_F [m], > 0.
  double hub_diameter{0};    ///< D_aA, outside [m], > D_F.
  double shaft_bore{0};      ///< D_iI [m], 0 for a solid shaft, < D_F.
  double length{0};          ///< l_F, of the joint [m], > 0.
  /** Flat walls, as of a tongue in a slot: their breadth b across the way [m]. The diameters are
   widths then: D_F of the joint, D_aA with both walls, and there is no bore. 0: round. */
  double breadth{0};
  double interference{0};     ///< U, diametral, before smoothing [m]; <= 0: none.
  double hub_roughness{0};    ///< Rz_A [m], >= 0.
  double shaft_roughness{0};  ///< Rz_I [m], >= 0.
  Smoothing smoothing{Smoothing::kNone};
  PressMaterial hub;
  PressMaterial shaft;
  double friction_in{0.15};       ///< mu_e, pressing in.
  double friction_release{0.15};  ///< nu_ll, when it begins to slip along the axis.
  double friction_torque{0.15};   ///< nu_ru, when it begins to slip about it.
};

/** Principal stresses at a free or loaded surface in plane stress (the axial one is zero) [Pa]. */
struct RingStress {
  double hoop{0};
  double radial{0};

  [[nodiscard]] double von_mises() const noexcept;
  [[nodiscard]] double tresca() const noexcept;
};

/** The pressure at which a side begins to yield [Pa]; infinite where its strength is unknown. */
struct ElasticLimit {
  double von_mises{0};
  double tresca{0};
};

/** What a press fit amounts to. Without interference all but the geometry is zero. */
struct PressFit {
  double smoothing_loss{0};             ///< G [m].
  double effective_interference{0};     ///< U_w = max(0, U - G), diametral [m].
  double pressure{0};                   ///< p [Pa].
  double pressure_per_interference{0};  ///< p / U_w [Pa/m], of the geometry alone.
  double outline{0};                    ///< Length of the joint across its way [m]: pi D_F, or 2 b.
  double hub_expansion{0};              ///< Diametral, of the hub's bore [m].
  double shaft_contraction{0};  ///< Diametral, of the shaft's outside [m]; the two make U_w.
  RingStress hub_bore;
  RingStress shaft_surface;    ///< Equals the inside of a solid shaft.
  RingStress shaft_governing;  ///< Stress at the bore of a hollow shaft, anywhere in a solid one.
  ElasticLimit hub_limit;      ///< Where the hoop stress of a brittle hub is its tensile strength.
  ElasticLimit shaft_limit;
  bool is_hub_brittle{false};
  double press_in_force{0};  ///< F_e, at full depth [N].
  double push_out_force{0};  ///< F_ll, to start it back [N].
  double torque{0};          ///< T, to start it turning [N m].

  /** Least ratio of a limit to the pressure; below 1 the fit yields, and the elastic figures above
   are no longer true. Infinite without pressure or strength. */
  [[nodiscard]] double margin_von_mises() const noexcept;
  [[nodiscard]] double margin_tresca() const noexcept;

  /** The margin of one side by von Mises; of a brittle hub against fracture. */
  [[nodiscard]] double margin_hub() const noexcept;
  [[nodiscard]] double margin_shaft() const noexcept;
};

/** Against fracture of a brittle hub, which has nothing to yield: handbooks ask for 2 to 3. */
inline constexpr double kBrittleSafety = 3;

/** Whether a brittle hub has less than this safety. */
[[nodiscard]] bool IsFracturing(const PressFit& fit) noexcept;

/** The largest pressure that a joint is to have [Pa]: both sides elastic by von Mises, a brittle
 hub with its safety. */
[[nodiscard]] double CalcLargestPressure(const PressFit& fit) noexcept;

/** Lame's ring:
     Q_A = D_F / D_aA, Q_I = D_iI / D_F,
     K_A = (1 + Q_A^2) / (1 - Q_A^2) + nu_A,  K_I = (1 + Q_I^2) / (1 - Q_I^2) - nu_I,
     p = (U_w / D_F) / (K_A / E_A + K_I / E_I),  F = mu pi D_F l_F p,  T = nu pi D_F^2 l_F p / 2.
 Flat walls: slabs that are pressed across in plane strain, w of the tongue and t of both walls,
     p = U_w / (w / E_I' + t / E_A'),  E' = E / (1 - nu^2),  F = mu 2 b l_F p,
 with w = D_F, t = D_aA - D_F (Johnson, Contact Mechanics, 1985, 4.3 with a free edge). The walls
 are held from behind: legs of a slot that bend give more way, so that this force is an upper bound.
 Errors: kInvalid, naming the parameter out of its range. */
[[nodiscard]] Result<PressFit> CalcPressFit(const PressFitParameters& parameters);

/** The interference that gives a pressure, before smoothing: the way back from p to U [m]. */
[[nodiscard]] Result<double> CalcInterferenceFor(double pressure,
                                                 const PressFitParameters& parameters);

/** The pressure that a joint needs for loads along (F [N]) and about (T [N m]) its axis at once,
 with a safety against slip [Pa]:  p = S sqrt(F^2 + (2 T / D_F)^2) / (pi D_F l_F nu). */
[[nodiscard]] double CalcRequiredPressure(const PressFitParameters& parameters, double axial_load,
                                          double torque_load, double safety) noexcept;

}  // namespace hvas::fits
