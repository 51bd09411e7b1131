#pragma once

#include <limits>

namespace hvas::haptics::testing {

inline constexpr double kDt = 1e-3;  ///< The period of the haptic loop [s].
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();

/** Profiles of devices that differ most in stiffness, damping and force. */
inline constexpr const char* kProfiles[] = {"touch", "touch_x", "sigma7", "inverse3", "virtuose"};

}  // namespace hvas::haptics::testing
