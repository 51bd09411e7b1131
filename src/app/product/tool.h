#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas tool FILE [--screw NAME] [--tool FILE]` to the command line; `status` receives the
 exit status: 0, 2 where the tool cannot turn the fastener without end, or 1 with an error on
 stderr. */
void AddTool(CLI::App* app, int* status);

}  // namespace hvas::app
