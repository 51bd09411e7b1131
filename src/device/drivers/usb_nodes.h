#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "device/driver.h"

namespace hvas::device {

/** A device on the machine's USB, as the kernel tells. */
struct UsbNode {
  std::string id;              ///< "1451:0402"
  std::string name;            ///< Its own, may be empty.
  std::filesystem::path node;  ///< Node in dev/bus/usb.
  bool has_node{false};
  bool is_accessible{false};  ///< This user may read and write it.
};

/** Devices of a vendor under a root with sys and dev. */
std::vector<UsbNode> FindUsbNodes(const std::filesystem::path& root, std::uint16_t vendor);

/** Notes those devices, or that there is none; and a problem, with the rule for udev that mends
 it, for each that this user may not use. */
void ProbeUsb(const Surroundings& surroundings, std::uint16_t vendor, const std::string& maker,
              ProbeReport* report);

}  // namespace hvas::device
