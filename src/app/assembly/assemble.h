#pragma once

#include <string>
#include <vector>

#include "app/assembly/run_command.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct AssembleOptions : RunCommandOptions {
  OrderChoice order;
  std::string second_device;  ///< Address for the other hand; empty: there is no other hand.
  double reasons_s{0};        ///< How long parts without a way are looked into [s]; 0: not.
};

/** Lays the parts of a product out on a table and lets a simulated person, or two, or whoever has
 the devices, assemble them one by one.
 Prints a table, or one JSON document, on stdout.
 @returns The exit status: 0 when every part is in its place, 1 on an error, 2 when one is not. */
[[nodiscard]] int RunAssemble(const AssembleOptions& options);

/** Adds `hvas assemble` to the command line; `status` receives what RunAssemble returns. */
void AddAssemble(CLI::App* app, int* status);

}  // namespace hvas::app
