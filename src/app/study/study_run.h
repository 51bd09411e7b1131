#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `check`, `run`, `list`, `export`, `delete` and `report` to `hvas study`; `status` receives
 the exit status. */
void AddStudyRun(CLI::App* study, int* status);

}  // namespace hvas::app
