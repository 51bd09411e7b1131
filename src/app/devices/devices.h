#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** `hvas devices`: which devices there are, and why others could not be started. */
void AddDevices(CLI::App* app, int* status);

}  // namespace hvas::app
