#pragma once

#include <memory>
#include <span>

namespace CLI {
class App;
}

namespace hvas::app {

/** "0.1.0". */
[[nodiscard]] const char* Version();

struct ExitStatus {
  const char* status;
  const char* meaning;
};

/** What the exit statuses of the program mean. */
[[nodiscard]] std::span<const ExitStatus> ExitStatuses();

/** All commands and options. @param status  Gets the exit status of the command that is run;
 outlives the tree. */
[[nodiscard]] std::unique_ptr<CLI::App> MakeCommandLine(int* status);

/** Runs what the words ask for. @returns the exit status. */
[[nodiscard]] int RunCommandLine(int argc, char** argv);

}  // namespace hvas::app
