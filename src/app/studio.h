#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** `hvas studio`: the live assembly, for people with a browser. */
void AddStudio(CLI::App* app, int* status);

}  // namespace hvas::app
