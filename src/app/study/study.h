#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas study`, the group of commands for experiments with people. */
void AddStudy(CLI::App* app, int* status);

}  // namespace hvas::app
