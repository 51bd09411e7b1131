#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas licences`: the terms of HVAS, and of what others have written of it. */
void AddLicences(CLI::App* app, int* status);

}  // namespace hvas::app
