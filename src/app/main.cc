#include <cstdio>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>

#include "app/assemble.h"
#include "app/devices.h"
#include "app/doctor.h"
#include "app/export.h"
#include "app/fit.h"
#include "app/inspect.h"
#include "app/mate.h"
#include "app/path.h"
#include "app/replay.h"
#include "app/report.h"
#include "app/studio.h"
#include "app/study.h"

namespace {

int Run(int argc, char** argv) {
  CLI::App app("hvas: assemble CAD products by hand, and feel it");
  app.require_subcommand(1);
  int status = 0;
  hvas::app::AddInspect(&app, &status);
  hvas::app::AddAssemble(&app, &status);
  hvas::app::AddMate(&app, &status);
  hvas::app::AddExport(&app, &status);
  hvas::app::AddPath(&app, &status);
  hvas::app::AddFit(&app, &status);
  hvas::app::AddDevices(&app, &status);
  hvas::app::AddDoctor(&app, &status);
  hvas::app::AddReplay(&app, &status);
  hvas::app::AddReport(&app, &status);
  hvas::app::AddStudio(&app, &status);
  hvas::app::AddStudy(&app, &status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Wrong usage is an error like any other; a request for help is none.
    return app.exit(error) == 0 ? 0 : 1;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc, argv);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "hvas: %s\n", exception.what());  // Of memory, as a rule.
    return 1;
  }
}
