#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `identify` to `hvas fit`; `status` receives its exit status. */
void AddFitIdentify(CLI::App* fit, int* status);

}  // namespace hvas::app
