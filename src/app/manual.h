#pragma once

#include <string>

#include "app/command_tree.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** The manual page hvas(1), as man(7) has it. */
[[nodiscard]] std::string MakeManual(const CommandHelp& root, const std::string& version);

/** Adds `hvas man`. */
void AddManual(CLI::App* app, int* status);

}  // namespace hvas::app
