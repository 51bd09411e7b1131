#include "exchange/test/exported.h"

#include <fmt/format.h>

namespace hvas::exchange::testing {

product::Product OpenPeg(double clearance_mm) {
  const hvas::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "peg_hole.step";
  std::filesystem::copy_file(kProducts / "peg_hole.step", file);
  folder.Write(
      "peg_hole.hvas.json",
      fmt::format(R"({{"format": "hvas-assignments-1", "fits": [{{"hole": "block", "shaft": "peg",
        "hole_diameter_mm": {}, "shaft_diameter_mm": 20}}]}})",
                  20 + clearance_mm));
  return Open(file);
}

}  // namespace hvas::exchange::testing
