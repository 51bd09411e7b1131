#pragma once

#include <optional>
#include <vector>

#include "fits/elastic_parts.h"

namespace hvas::haptics {

/** How far a part gives along the straight way to its place, or lets another one pass, or is
 pressed together there, and what that takes. The curve of how far it gives is a quadratic B-spline,
 so its slope has no jumps. */
struct GivingCurve {
  /** Force across the way for each metre that it gives: of an arm, or of an open ring [N/m]. */
  double stiffness{0};
  std::optional<fits::ORing> squeezed;  ///< An O-ring, which has no constant stiffness.
  double friction{0};                   ///< mu of the surfaces that slide on each other.
  double spacing{1};                    ///< Distance of control points [m].
  /** Control points from its place outwards, >= 0 [m]; behind the first it stays the same, beyond
   the last it does not give. */
  std::vector<double> given;
  /** Force of a part that is pressed together along the way, at equal steps from no compression to
   that in its place [N]; linear between them. Empty: it gives across the way. */
  std::vector<double> pressed;
  double compression{0};  ///< How far it is pressed together in its place [m].

  /** Distance from its place to where it begins to give [m]. */
  [[nodiscard]] double length() const noexcept {
    return pressed.empty() ? (static_cast<double>(given.size()) + 0.5) * spacing : compression;
  }

  /** How far it gives, or is pressed together [m], at a distance from its place [m]. RT-safe. */
  [[nodiscard]] double CalcGiven(double travel) const noexcept;
};

/** Forces on the part along its way, in true newtons. */
struct GivingLoad {
  double spring{0};     ///< Elastic, positive outwards; of a potential [N].
  double stiffness{0};  ///< How much `spring` falls for each metre outwards [N/m].
  double in{0};         ///< Friction against going in, >= 0 [N].
  double out{0};        ///< Friction against coming out, >= 0 [N].

  GivingLoad& operator+=(const GivingLoad& other) noexcept;
};

/** Forces at a distance from its place [m].

 With P(y) across the way where it gives y, and m the rise of y per metre inwards, it takes
 P (mu + m) / (1 - mu m) to slide in (Bayer MaterialScience, Snap-Fit Joints for Plastics). That is
 the elastic part P m, which is the slope of the energy in it, and friction P mu (1 + m^2) / (1 - mu
 m); outwards m has the other sign. So friction always takes energy, and the elastic part gives back
 what it was given. What is pressed together along the way has m = 1 and no friction. RT-safe. */
[[nodiscard]] GivingLoad CalcGivingLoad(const GivingCurve& curve, double travel) noexcept;

/** Elastic energy in it at a distance from its place [J]; by Simpson's rule over how far it gives.
 */
[[nodiscard]] double CalcGivingEnergy(const GivingCurve& curve, double travel);

/** The largest forces on the whole way, in and out: elastic part and friction together [N]. */
struct GivingPeak {
  double in{0};
  double out{0};
};

[[nodiscard]] GivingPeak CalcGivingPeak(const GivingCurve& curve);

}  // namespace hvas::haptics
