#pragma once

#include <optional>
#include <string>

#include "app/product/load_product.h"
#include "app/product/selection.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct InspectOptions {
  LoadOptions load;
  SelectionOptions selection;
  bool is_json{false};
  bool is_all{false};                            ///< Lists are not cut short.
  std::optional<std::string> write_assignments;  ///< File to write; empty: beside the CAD file.
  bool is_forced{false};                         ///< That file may be replaced.
};

/** Opens a CAD file and prints what HVAS makes of it: the product tree, the parts with their
 masses, features, mates, joints, fits, tolerances, and what was odd about the file. Text or one
 JSON document on stdout; progress (on a terminal only) and errors on stderr. With write_assignments
 it writes a side file with the present fits instead.
 @returns The exit status: 0, or 1 with an error on stderr. */
[[nodiscard]] int RunInspect(const InspectOptions& options);

/** Adds `hvas inspect` to the command line; `status` receives what RunInspect returns. */
void AddInspect(CLI::App* app, int* status);

}  // namespace hvas::app
