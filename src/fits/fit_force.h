#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"

/** The assembly clearance space and the axial force of a fit as functions of the insertion depth:
 paper W's equations (1) to (4) and (6) to (9), mended (a depth's force, not a sum over time). */
namespace hvas::fits {

/** A shaft and a hole as made, of one material. Defaults: steel, roughness Rz 6.3 um; W7's rig. */
struct FitForceParameters {
  double hole_diameter{0};       ///< D_h, actual [m], > 0.
  double shaft_diameter{0};      ///< d_s, actual [m], > 0.
  double nominal_diameter{0};    ///< 2 R [m], > 0.
  double length{0};              ///< L, mating length [m], > 0.
  double radius_ratio{0.5};      ///< c_0 = R / r_0, r_0 the hub's outer radius; 0 <= c_0 < 1.
  double youngs_modulus{210e9};  ///< E [Pa], > 0.
  double friction{0.15};         ///< mu, >= 0.
  double roughness{6.3e-6};      ///< Rz [m], >= 0; B lies within half of it either way.
  int stations{20};              ///< N, the intervals of B along L, >= 1.
  std::uint64_t seed{0};         ///< Of B's random values.
};

/** Clearance and axial resistance of one pair of parts, tabulated over its depth.

 With l_j = j L / N, j = 0 .. N and B(l_j) = (Rz / 2) random(-1, 1), linear between (W1):
     W(4)  S(l) = (D_h - d_s) / 2 + B(l)                             radial; negative: interference
     W(7)  p(l) = E max(0, -S(l)) (1 - c_0^2) / (2 R)                Lame, solid shaft
     W(8), W(9)  F(l) = mu pi E (1 - c_0^2) integral_0^l max(0, -S)  as W(6) with W(7)
 S is linear between stations, so the integral is exact: quadratic pieces, cut where S changes sign.
 F is in true newtons; it is what has to be overcome to keep moving either way at depth l, and the
 limit of what holds the shaft at rest. Where S >= 0 it does not grow: the steps of a transition
 fit.

 The functions of depth are RT-safe; depths are clamped to [0, L]. */
class FitForce {
 public:
  /** Builds the tables. Fails on parameters out of their range. */
  [[nodiscard]] static Result<FitForce> Make(const FitForceParameters& parameters);

  /** S(l), the radius of the clearance space at a depth [m]. */
  [[nodiscard]] double CalcClearance(double depth) const noexcept;

  /** How far the shaft's axis may lie beside the hole's when inserted to a depth: the least of
   max(0, S) up to there [m]. Never grows with depth. */
  [[nodiscard]] double CalcRadialPlay(double depth) const noexcept;

  /** F(l), the axial resistance [N]. Never falls with depth. */
  [[nodiscard]] double CalcAxialResistance(double depth) const noexcept;

  /** p(l), the pressure between the parts at a depth [Pa]. */
  [[nodiscard]] double CalcPressure(double depth) const noexcept;

  /** F(L) [N]. */
  [[nodiscard]] double max_resistance() const noexcept { return resistance_.back(); }

  [[nodiscard]] double length() const noexcept { return length_; }

  [[nodiscard]] double friction() const noexcept { return friction_; }

  /** S at the N + 1 stations from the mouth to L [m]. */
  [[nodiscard]] std::span<const double> clearances() const noexcept { return clearance_; }

  /** d_s, actual [m]. */
  [[nodiscard]] double shaft_diameter() const noexcept { return shaft_diameter_; }

  /** (D_h - d_s) / 2, the clearance without roughness [m]; negative: interference. */
  [[nodiscard]] double mean_clearance() const noexcept { return mean_clearance_; }

 private:
  struct Place {
    std::size_t interval;  // Between stations `interval` and the next.
    double offset;         // From the first of them [m].
  };

  FitForce() = default;
  [[nodiscard]] Place Locate(double depth) const noexcept;

  double length_{0};
  double step_{0};
  double friction_{0};
  double mean_clearance_{0};
  double shaft_diameter_{0};
  double force_scale_{0};           // mu pi E (1 - c_0^2) [N/m^2].
  double pressure_scale_{0};        // E (1 - c_0^2) / (2 R) [Pa/m].
  std::vector<double> clearance_;   // S at the stations [m].
  std::vector<double> play_;        // Least of max(0, S) up to each station [m].
  std::vector<double> resistance_;  // F at the stations [N].
};

}  // namespace hvas::fits
