#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "fits/press_stroke.h"

/** The assembly clearance space and the forces of a fit as functions of the insertion depth: paper
 W's equations (1) to (4) and (6) to (9), mended (a depth's force, not a sum over time). What the
 forces are is known to press_stroke.h alone; here they are put together for one pair of parts, so
 that the hand feels what `hvas fit` prints. */
namespace hvas::fits {

/** Coefficients of a joint that is pressed in, drawn out and turned; DIN 7190-1's letters. */
struct FitFriction {
  double in{0.15};       ///< mu_e, pressing in.
  double release{0.15};  ///< nu_ll, when it begins to slip outwards.
  double slip{0.15};     ///< nu_rl, while it slips outwards; no larger than `release`.
  double turning{0.15};  ///< nu_ru, about the axis.
};

/** A diameter that was measured at one place along the mating length. */
struct DiameterAtDepth {
  double depth{0};     ///< Depth from the mouth of the hole, parts in their place [m].
  double diameter{0};  ///< [m]
};

/** The diameter at a depth: linear between the places of measurement, constant beyond the first and
 the last (paper W, 2.1). @pre measured is not empty, and its depths ascend. */
[[nodiscard]] double InterpolateDiameter(std::span<const DiameterAtDepth> measured,
                                         double depth) noexcept;

/** A shaft and a hole as made. Defaults: steel, roughness Rz 6.3 um; W7's rig. */
struct FitForceParameters {
  double hole_diameter{0};   ///< D_h, actual [m], > 0.
  double shaft_diameter{0};  ///< d_s, actual [m], > 0.
  /** Diameters along the length, by ascending depth. Where they are given, they count in place of
   D_h and d_s, which are their means then. */
  std::vector<DiameterAtDepth> hole_diameters, shaft_diameters;
  double nominal_diameter{0};  ///< D_F [m], > 0.
  double length{0};            ///< L, mating length [m], > 0.
  double hub_diameter{0};      ///< D_aA, outside [m], > D_F; 0: twice the nominal, as in W7's rig.
  double shaft_bore{0};        ///< D_iI [m], < D_F.
  /** Breadth of flat walls across the way [m] (PressFitParameters::breadth); 0: round. Widths count
   as diameters, and S is the gap at each wall of a tongue in the middle. */
  double breadth{0};
  PressMaterial hub;
  PressMaterial shaft;
  double roughness{6.3e-6};  ///< Rz, mean of both surfaces [m], >= 0; B is within half of it.
  Smoothing smoothing{Smoothing::kNone};
  FitFriction friction;
  double lead_in_angle{0};  ///< Angle of the chamfer that leads in, from the axis [rad]; 0: none.
  int stations{20};         ///< N, the intervals of B along L, >= 1.
  std::uint64_t seed{0};    ///< Seed of B's random values.
};

/** S at the N + 1 stations of a pair. @pre the parameters are such as FitForce::Make takes. */
[[nodiscard]] std::vector<double> DrawClearances(const FitForceParameters& parameters);

/** Clearance, forces and stiffness of one pair of parts over its depth.

 With l_j = j L / N, j = 0 .. N and B(l_j) = (Rz / 2) random(-1, 1), linear between (W1); c_p is the
 pressure for each metre of diametral interference, G the smoothing loss (press_fit.h):
     W(4)  S(l) = (D_h(l) - d_s(l)) / 2 + B(l)         radial; negative: interference
     W(7)  p(l) = 2 c_p max(0, -S - G / 2)
     W(6)  N(l) = pi D_F integral_0^l p                normal force; flat walls: 2 b integral_0^l p
     W(8), W(9)  F_in(l) = mu_e N(l), and the run-in over a chamfer
                 F_out(l) = nu_ll N(l), then nu_rl N(l);  T(l) = nu_ru N(l) D_F / 2, flat: 0
 In true newtons; they are what has to be overcome to move, and the limits of what holds the shaft
 at rest. Where S >= 0, N does not grow: the stairs of a transition fit.

 Depths count from where the shaft's edge is at the mouth; a chamfer touches a little before that,
 at negative depths. The functions of depth are RT-safe. */
class FitForce {
 public:
  /** Builds the tables. Fails on parameters out of their range. */
  [[nodiscard]] static Result<FitForce> Make(const FitForceParameters& parameters);

  /** S(l), the radius of the clearance space at a depth within [0, L] [m]. */
  [[nodiscard]] double CalcClearance(double depth) const noexcept;

  /** How far the shaft's axis may lie beside the hole's when inserted to a depth: the least of
   max(0, S) up to there [m]. Never grows with depth. */
  [[nodiscard]] double CalcRadialPlay(double depth) const noexcept;

  /** p(l), the pressure between the parts at a depth [Pa]. */
  [[nodiscard]] double CalcPressure(double depth) const noexcept;

  /** N(l), the pressure over the engaged surface [N]. Never falls with depth. */
  [[nodiscard]] double CalcNormalForce(double depth) const noexcept;

  /** F_in(l) [N]. Without a chamfer it never falls with depth. */
  [[nodiscard]] double CalcAxialResistance(double depth) const noexcept;

  /** F_out(l) at a speed of slip [m/s]: what it takes to break loose at rest, falling to what it
   takes to keep it moving (Stribeck) [N]. */
  [[nodiscard]] double CalcReleaseForce(double depth, double speed = 0) const noexcept;

  /** T(l), to turn it [N m]. */
  [[nodiscard]] double CalcTorque(double depth) const noexcept;

  /** Stiffness of the engaged length beyond its play, across the axis [N/m] and against tilt
   [N m/rad]. Every ring is a bed of springs with the stiffness of its uniform pressure, 2 c_p for
   each metre of radius: k = pi D_F c_p l, k_t = k l^2 / 12; flat walls: k = 2 b c_p l. An estimate,
   of the right order. */
  [[nodiscard]] double CalcRadialStiffness(double depth) const noexcept;
  [[nodiscard]] double CalcTiltStiffness(double depth) const noexcept;

  /** F_in(L) [N]. */
  [[nodiscard]] double max_resistance() const noexcept { return CalcAxialResistance(length_); }

  /** The largest p(l) along the joint [Pa]. */
  [[nodiscard]] double max_pressure() const noexcept { return max_pressure_; }

  /** The pressure at which the weaker side begins to yield by von Mises, or a brittle hub breaks
   [Pa]; infinite where no strength is known. */
  [[nodiscard]] double elastic_limit() const noexcept { return elastic_limit_; }

  [[nodiscard]] double length() const noexcept { return length_; }

  /** S at the N + 1 stations from the mouth to L [m]. */
  [[nodiscard]] std::span<const double> clearances() const noexcept { return clearance_; }

  /** Coefficients of the pair, as they were given to Make(). */
  [[nodiscard]] const FitFriction& friction() const noexcept { return friction_; }

  /** d_s, actual [m]. */
  [[nodiscard]] double shaft_diameter() const noexcept { return shaft_diameter_; }

  /** (D_h - d_s) / 2 of the mean diameters, the clearance without roughness [m]; negative:
   interference. */
  [[nodiscard]] double mean_clearance() const noexcept { return mean_clearance_; }

 private:
  struct Place {
    std::size_t interval;  // Between stations `interval` and the next.
    double offset;         // From the first of them [m].
  };

  explicit FitForce(PressStroke forces) : forces_(std::move(forces)) {}

  [[nodiscard]] Place Locate(double depth) const noexcept;

  /** The pressure where the clearance is S [Pa]. */
  [[nodiscard]] double CalcPressureOf(double clearance) const noexcept;

  PressStroke forces_;
  FitFriction friction_;
  double length_{0};
  double step_{0};
  double outline_{0};        // pi D_F or 2 b [m].
  double torque_radius_{0};  // D_F / 2; 0 for flat walls [m].
  double mean_clearance_{0};
  double shaft_diameter_{0};
  double pressure_per_interference_{0};  // c_p [Pa/m].
  double smoothing_loss_{0};             // G [m].
  double max_pressure_{0};               // [Pa]
  double elastic_limit_{0};              // [Pa]
  std::vector<double> clearance_;        // S at the stations [m].
  std::vector<double> play_;             // Least of max(0, S) up to each station [m].
};

}  // namespace hvas::fits
