#pragma once

#include <string>

namespace hvas::app {

struct DeviceTrialOptions {
  std::string address;
  double seconds{15};    ///< Long enough to feel the floor some times: a choice [s].
  double rate_hz{1000};  ///< X4 asks for 1 kHz.
};

/** Opens a device and renders a horizontal floor in the middle of its workspace for a while: the
 first thing to try with a new device. Exit status: 0; 1 on an error. */
int RunDeviceTrial(const DeviceTrialOptions& options);

}  // namespace hvas::app
