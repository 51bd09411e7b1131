#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas dfa` to the command line; `status` receives its exit status. */
void AddDfa(CLI::App* app, int* status);

}  // namespace hvas::app
