#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas instructions` to the command line; `status` receives its exit status. */
void AddInstructions(CLI::App* app, int* status);

}  // namespace hvas::app
