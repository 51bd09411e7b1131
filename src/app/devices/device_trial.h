#pragma once

#include <string>

namespace hvas::app {

struct DeviceTrialOptions {
  std::string address;
  double seconds{15};
  double rate_hz{1000};
};

/** Opens a device and renders a horizontal floor in the middle of its workspace for a while: the
 first thing to try with a new device. Exit status: 0; 1 on an error. */
int RunDeviceTrial(const DeviceTrialOptions& options);

}  // namespace hvas::app
