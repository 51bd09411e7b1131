#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas motions` to the command line; `status` receives its exit status. */
void AddMotions(CLI::App* app, int* status);

}  // namespace hvas::app
