#include "device/drivers/usb_nodes.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>

namespace hvas::device {
namespace {

namespace fs = std::filesystem;

std::string ReadLine(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

}  // namespace

std::vector<UsbNode> FindUsbNodes(const fs::path& root, std::uint16_t vendor) {
  std::vector<UsbNode> nodes;
  std::error_code ignored;
  for (fs::directory_iterator entry(root / "sys/bus/usb/devices", ignored), end; entry != end;
       entry.increment(ignored)) {
    const fs::path& folder = entry->path();
    const std::string id = ReadLine(folder / "idVendor");
    if (id != fmt::format("{:04x}", vendor)) {
      continue;
    }
    UsbNode node;
    node.id = id + ":" + ReadLine(folder / "idProduct");
    node.name = ReadLine(folder / "product");
    node.node = root / fmt::format("dev/bus/usb/{:03}/{:03}",
                                   std::atoi(ReadLine(folder / "busnum").c_str()),
                                   std::atoi(ReadLine(folder / "devnum").c_str()));
    node.has_node = fs::exists(node.node, ignored);
    node.is_accessible = ::faccessat(AT_FDCWD, node.node.c_str(), R_OK | W_OK, AT_EACCESS) == 0;
    nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const UsbNode& a, const UsbNode& b) { return a.node < b.node; });
  return nodes;
}

void ProbeUsb(const Surroundings& surroundings, std::uint16_t vendor, const std::string& maker,
              ProbeReport* report) {
  const std::vector<UsbNode> nodes = FindUsbNodes(surroundings.root, vendor);
  if (nodes.empty()) {
    report->looked_for.push_back({fmt::format("USB device {:04x}:* of {}", vendor, maker),
                                  (surroundings.root / "sys/bus/usb/devices").string(), false, ""});
  }
  for (const UsbNode& node : nodes) {
    const char* permission = node.is_accessible ? "may be used"
                             : node.has_node    ? "may not be used by this user"
                                                : "has no device file";
    report->looked_for.push_back({"USB device " + node.id, node.node.string(), true,
                                  node.name.empty() ? permission : node.name + ", " + permission});
    if (!node.is_accessible) {
      report->problems.push_back(
          {ErrorCode::kOutOfResource,
           fmt::format("USB device {} of {} {}", node.id, maker, permission), node.node.string(),
           fmt::format("as root, put the line SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{:04x}\", "
                       "MODE=\"0666\" into /etc/udev/rules.d/60-hvas-{:04x}.rules, run \"udevadm "
                       "control --reload\", and connect the device again",
                       vendor, vendor)});
    }
  }
}

}  // namespace hvas::device
