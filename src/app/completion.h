#pragma once

#include <string>

#include "app/command_tree.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** Scripts that complete commands, options and their words, for shells to source. */
[[nodiscard]] std::string MakeBashCompletion(const CommandHelp& root);
[[nodiscard]] std::string MakeZshCompletion(const CommandHelp& root);
[[nodiscard]] std::string MakeFishCompletion(const CommandHelp& root);

/** Adds `hvas completion`. @param app  The program, with all of its commands once it runs. */
void AddCompletion(CLI::App* app, int* status);

}  // namespace hvas::app
