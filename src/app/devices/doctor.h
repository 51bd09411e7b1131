#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** `hvas doctor`: does this machine keep a loop of 1 kHz, and what would help it. */
void AddDoctor(CLI::App* app, int* status);

}  // namespace hvas::app
