#pragma once

#include <filesystem>

#include "app/recording/record_options.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct ReportOptions {
  RecordOptions record;
  double reasons_s{0};           ///< How long parts without a way are looked into [s]; 0: not.
  std::filesystem::path output;  ///< .html or .pdf
  bool is_forced{false};         ///< Replaces a file that is there.
};

/** Writes the report of a recorded session.
 @returns The exit status: 0, or 1 on an error. */
[[nodiscard]] int RunReport(const ReportOptions& options);

/** Adds `hvas report` to the command line; `status` receives what RunReport returns. */
void AddReport(CLI::App* app, int* status);

}  // namespace hvas::app
