#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas study power`: how many participants a design needs, by simulation. */
void AddStudyPower(CLI::App* study, int* status);

}  // namespace hvas::app
