#include <string>

#include <CLI/CLI.hpp>

#include "app/assemble.h"
#include "app/inspect.h"

int main(int argc, char** argv) {
  CLI::App app("hvas: assemble CAD products by hand, and feel it");
  app.require_subcommand(1);
  int status = 0;
  hvas::app::AddInspect(&app, &status);
  hvas::app::AddAssemble(&app, &status);
  CLI11_PARSE(app, argc, argv);
  return status;
}
