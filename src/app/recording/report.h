#pragma once

#include <filesystem>

namespace CLI {
class App;
}

namespace hvas::app {

struct ReportOptions {
  std::filesystem::path record;
  std::filesystem::path output;  ///< .html or .pdf
  bool is_forced{false};         ///< Replaces a file that is there.
};

/** Writes the report of a recorded session.
 @returns The exit status: 0, or 1 on an error. */
[[nodiscard]] int RunReport(const ReportOptions& options);

/** Adds `hvas report` to the command line; `status` receives what RunReport returns. */
void AddReport(CLI::App* app, int* status);

}  // namespace hvas::app
