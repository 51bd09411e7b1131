#pragma once

#include "device/profile.h"
#include "spatial/pose.h"

namespace hvas::device {

/** Part of a wrench that a profile allows, its direction kept; zero if it is not finite, and after
 WithdrawForces(). RT-safe. */
[[nodiscard]] spatial::Wrench LimitWrench(const spatial::Wrench& F,
                                          const DeviceProfile& profile) noexcept;

}  // namespace hvas::device
