#pragma once

#include "device/profile.h"
#include "haptics/options.h"

namespace hvas::haptics {

/** The stiffest coupling that a device shows without trembling, by the rule of
 docs/algorithms/stability.md: half of what its maker allows (the practice of SAI and CHAI3D); no
 more than sampling and delay let the friction of mechanism and hand pay for (Colgate and Schenkel,
 J. Robotic Systems 14, 1997, extended by the delay); no more than the encoders' steps allow
 (Abbott and Okamura, IEEE Trans. Robotics 21, 2005); and damping within what is left.

 Gains are of the scene, whose lengths are `scale` times the device's, as forces are not scaled. A
 motion that the device shows no force or torque for gets the gains of the simulated device: there
 the coupling only drags the part, and its stability is the solver's, which is implicit.
 @param scale  Scene length per device length, > 0.
 @param dt  Of the haptic tick [s]; a device with slower samples counts with theirs. */
[[nodiscard]] CouplingGains ChooseCoupling(const device::DeviceProfile& profile, double scale,
                                           double dt) noexcept;

}  // namespace hvas::haptics
