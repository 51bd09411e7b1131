#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas study analyse`: tests, intervals and figures of a table of results. */
void AddStudyAnalyse(CLI::App* study, int* status);

}  // namespace hvas::app
