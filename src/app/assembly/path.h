#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas path FILE --part NAME ... -o X.csv|.json|.stl|.glb` to the command line; `status`
 receives the exit status: 0, or 1 with an error on stderr and no file written. */
void AddPath(CLI::App* app, int* status);

}  // namespace hvas::app
