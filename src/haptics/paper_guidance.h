#pragma once

#include <optional>

#include "haptics/options.h"

namespace hvas::haptics {

// Bounds of the constants, so that a typing error is refused. K1 cannot attract with more than the
// device's peak force; K2 is between a hand that floats and more than any device of the profiles
// couples with; at K3 = 100 the peak torque is reached at an angle of 1.8 degrees.
inline constexpr double kLargestK1 = 1;
inline constexpr double kSmallestK2 = 50;
inline constexpr double kLargestK2 = 5000;
inline constexpr double kLargestK3 = 100;

/** Constants of paper X's guidance, and where it ends, in place of those of TickOptions. With F_max
 and T_max the peak force and torque of the rendered device:

 | constant | equation | sets |
 |---|---|---|
 | K1 | X(9): F = K1 d_i / d_0 F_max | GuidanceOptions::attraction_force = K1 F_max |
 | K2 | X(12): F = K2 (P_t - P_d) | CouplingGains::k_lin = K2: the part is held on the axis, and the
 hand is drawn to it by the coupling | | K3 | X(14): T = K3 theta / pi T_max | CouplingGains::k_rot
 = K3 T_max / pi |
 */
struct PaperGuidance {
  std::optional<double> k1;  ///< 0 to kLargestK1.
  std::optional<double> k2;  ///< kSmallestK2 to kLargestK2 [N/m].
  std::optional<double> k3;  ///< 0 to kLargestK3.
  /** Attraction goes on inside a fitted hole, as in paper X. Otherwise the fit takes over. */
  bool attracts_in_fits{false};
  /** A shaft with play touches its hole where the two are. Otherwise its mate holds it on the axis
   inside the hole, too, as in papers X and W. */
  bool contact_in_holes{false};
  /** GuidanceOptions::threads_turn; neither paper has threads. */
  bool threads_turn{false};
};

/** @param tick  Of the device that renders. The coupling gets no stiffer than it is already: that
 is the limit of the device. */
void Apply(const PaperGuidance& guidance, TickOptions* tick);

}  // namespace hvas::haptics
