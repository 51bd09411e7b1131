#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "fits/press_fit.h"

/** The force along the stroke of a press: several lands, roughness, and the chamfers that lead them
 in (N4, N5, W5, W6). */
namespace hvas::fits {

/** One fit of a pair of parts along their axis. */
struct StrokeLand {
  PressFitParameters press;  ///< `interference` counts where no clearances are given.
  double start{0};           ///< Depth of the shaft at which the land's edge is at the mouth [m].
  /** Angle of the chamfer that leads in, from the axis [rad], 0 < angle < pi / 2; 0: a sharp edge,
   that is none. */
  double lead_in_angle{0};
  /** S at equal steps from the mouth inwards, the ends included: radial, before smoothing, negative
   is interference [m]. Linear between. Empty: even. */
  std::vector<double> clearances;
};

/** S of a pair as made: (D_h - d_s) / 2 + B(l_j), B uniform within half of Rz either way (W1 to
 W4); Rz is the mean of both surfaces'. */
[[nodiscard]] std::vector<double> DrawClearances(double diametral_clearance, double rz,
                                                 int stations, std::uint64_t seed);

/** S where D_h - d_s differs along the length (paper W, 2.1): one diametral clearance for each
 station. Equal clearances and seeds give the same S as the function above. */
[[nodiscard]] std::vector<double> DrawClearances(std::span<const double> diametral_clearances,
                                                 double rz, std::uint64_t seed);

/** Forces at a depth, >= 0 as a rule [N]. */
struct StrokeForce {
  double normal{0};   ///< The pressure over the engaged surface, without the chamfers'.
  double in{0};       ///< Keeps pressing in.
  double release{0};  ///< Starts pulling out.
};

/** Forces over depth, exact: no steps in depth. With n(z) the interference of a land at the depth z
 of its hole, diametral and after smoothing, O the outline (PressFit::outline) and p / U of Lame's
 rings or flat walls:

     body   mu O (p / U) integral of n over the engaged length
     ramp   mu' O (p / U) integral of n over the chamfer, along which n falls to nothing over
            n / (2 tan a) in front of the edge;
            mu' = (mu + tan a) / (1 - mu tan a) inwards, (mu - tan a) / (1 + mu tan a) outwards

 Rings are independent of their neighbours. Without interference at the edge there is no ramp; past
 the land's end the ramp leaves the hole and the force is the closed form. */
class PressStroke {
 public:
  /** Errors: kInvalid, naming what is out of its range; a chamfer steeper than friction lets slide.
   */
  [[nodiscard]] static Result<PressStroke> Make(std::vector<StrokeLand> lands);

  [[nodiscard]] StrokeForce CalcForce(double depth) const noexcept;

  /** The depth at which the first chamfer touches; negative in front of the mouth [m]. */
  [[nodiscard]] double begin() const noexcept { return begin_; }

  /** The depth at which all lands are in [m]. */
  [[nodiscard]] double end() const noexcept { return end_; }

  /** Work to press in from begin() to end() [J], by Simpson's rule. */
  [[nodiscard]] double CalcWork() const noexcept;

 private:
  struct Land {
    double start;
    double length;
    double tan_lead_in;
    double friction_in;
    double friction_release;
    double force_per_area;  // O p / U, of the integral of diametral interference [N/m^2].
    double step;
    std::vector<double> s;         // Radial, smoothed [m].
    std::vector<double> integral;  // Of max(0, -s) up to each [m^2].
  };

  [[nodiscard]] static double InterferenceAt(const Land& land, double z) noexcept;
  [[nodiscard]] static double IntegrateTo(const Land& land, double z) noexcept;
  [[nodiscard]] static double IntegrateRamp(const Land& land, double z) noexcept;

  PressStroke() = default;

  std::vector<Land> lands_;
  double begin_{0};
  double end_{0};
};

}  // namespace hvas::fits
