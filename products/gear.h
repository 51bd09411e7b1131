#pragma once

#include "solid.h"

namespace hvas::products {

/** A spur gear with involute flanks (straight and radial below the base circle). */
struct GearShape {
  int teeth{14};
  double module{3};
  double pressure_angle{0.3490658503988659};  ///< 20 degrees.
  double tip_diameter{47.6};
  double root_diameter{34.5};
  double backlash{0.25};    ///< Taken off the tooth thickness at the pitch circle.
  double tip_chamfer{0.8};  ///< 45 degrees, at both ends.

  /** Half the angle that a tooth takes at radius `r` about the gear's axis. */
  [[nodiscard]] double CalcHalfToothAngle(double r) const;
};

/** The gear without a bore, on z from `z0` to `z1`, the middle of a tooth at `angle` from x. */
[[nodiscard]] Solid MakeGear(const GearShape& gear, double z0, double z1, double angle);

}  // namespace hvas::products
