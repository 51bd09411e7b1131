#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas campaign` with its commands. @param status  Gets the exit status. */
void AddCampaign(CLI::App* app, int* status);

}  // namespace hvas::app
