#pragma once

#include "app/load_product.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct InspectOptions {
  LoadOptions load;
  bool is_json{false};
};

/** Opens a CAD file and prints what HVAS makes of it: the product tree, the parts with their
 masses, the mates with their fits, and what was odd about the file. Text or one JSON document on
 stdout; progress (on a terminal only) and errors on stderr.
 @returns The exit status: 0, or 1 with an error on stderr. */
[[nodiscard]] int RunInspect(const InspectOptions& options);

/** Adds `hvas inspect` to the command line; `status` receives what RunInspect returns. */
void AddInspect(CLI::App* app, int* status);

}  // namespace hvas::app
