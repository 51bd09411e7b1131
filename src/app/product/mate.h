#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas mate add|remove|restore|list` (X12) to the command line: the user defines a mate from
 two surfaces, or does away with one. All edit the side file, whole or not at all, and only when a
 product with it opens. `status` receives the exit status: 0, or 1 with an error on stderr. */
void AddMate(CLI::App* app, int* status);

}  // namespace hvas::app
