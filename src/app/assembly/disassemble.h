#pragma once

#include <string>

#include "app/assembly/run_command.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct DisassembleOptions : RunCommandOptions {
  std::string part;  ///< The part to get out, by name, path or id; empty: all of them.
};

/** Lets a simulated person, or whoever has the device, take a product apart, or get one part out of
 it. Prints a table, or one JSON document, on stdout.
 @returns The exit status: 0 when every part of the plan has come out, 1 on an error, 2 when one has
 not. */
[[nodiscard]] int RunDisassemble(const DisassembleOptions& options);

/** Adds `hvas disassemble` to the command line; `status` receives what RunDisassemble returns. */
void AddDisassemble(CLI::App* app, int* status);

}  // namespace hvas::app
