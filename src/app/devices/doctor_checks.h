#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hvas::app {

/** One thing that decides whether a loop of 1 kHz keeps its promise on this machine. */
struct DoctorCheck {
  std::string name;
  std::string value;  ///< What was found; "unknown" where the system does not tell.
  bool is_good{true};
  std::string remedy;  ///< What to change and how; empty when it is good.
};

/** Looks at the kernel, limits, cores and clocks.
 @param root  Under which proc and sys are. */
[[nodiscard]] std::vector<DoctorCheck> CheckMachine(const std::filesystem::path& root);

}  // namespace hvas::app
