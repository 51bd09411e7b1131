#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "base/test/temporary_folder.h"
#include "device/driver.h"

namespace hvas::device::testing {

/** A folder that stands for a whole machine: what a test puts there, and nothing else. */
class ProbeFolder {
 public:
  ProbeFolder() {
    // Also for other users than the one who runs the tests.
    std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
    surroundings_.root = folder_.path();
  }

  void Put(const std::string& file, const std::string& content) const {
    folder_.Write(file, content);
  }

  /** A device as the kernel shows it, with the file that programs open. */
  void AddUsb(const std::string& port, const std::string& vendor, const std::string& product,
              const std::string& name, int bus, int number) const {
    const std::string folder = "sys/bus/usb/devices/" + port + "/";
    Put(folder + "idVendor", vendor + "\n");
    Put(folder + "idProduct", product + "\n");
    Put(folder + "product", name + "\n");
    Put(folder + "busnum", std::to_string(bus) + "\n");
    Put(folder + "devnum", std::to_string(number) + "\n");
    char node[64];
    std::snprintf(node, sizeof(node), "dev/bus/usb/%03d/%03d", bus, number);
    Put(node, "");
  }

  [[nodiscard]] std::string Path(const std::string& file) const {
    return (folder_ / file).string();
  }

  [[nodiscard]] const Surroundings& surroundings() const { return surroundings_; }

 private:
  hvas::testing::TemporaryFolder folder_;
  Surroundings surroundings_;
};

inline bool HasFinding(const ProbeReport& report, const std::string& what, bool is_found) {
  return std::any_of(report.looked_for.begin(), report.looked_for.end(),
                     [&](const Finding& f) { return f.what == what && f.is_found == is_found; });
}

}  // namespace hvas::device::testing
