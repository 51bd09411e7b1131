#pragma once

namespace CLI {
class App;
}

namespace hvas::app {

/** Adds `hvas fit`: the card of a fit, and tables of limits, press fits and insertions. */
void AddFit(CLI::App* app, int* status);

}  // namespace hvas::app
