#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas export FILE -o X.glb|.json|.step` to the command line; `status` receives the exit
 status: 0, or 1 with an error on stderr and no file written. */
void AddExport(CLI::App* app, int* status);

}  // namespace hvas::app
