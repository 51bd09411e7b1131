#include <cerrno>
#include <cstdio>
#include <cstring>
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
#include "device/force_withdrawal.h"

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

/** Writes out what is still in buffers, and tells where it cannot be written: a disk is full, as a
 rule. A reader that has seen enough (a pipe that is closed) ends the program before.
 @param status  Of the command; stands where writing fails after a failure. */
int FlushOutput(int status) {
  const bool had_error = std::ferror(stdout) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !had_error) {
    return status;
  }
  std::fprintf(stderr, "hvas: the standard output cannot be written%s%s; make room on the disk\n",
               errno != 0 ? ": " : "", errno != 0 ? std::strerror(errno) : "");
  return status != 0 ? status : 1;
}

}  // namespace

int main(int argc, char** argv) {
  hvas::device::WithdrawForcesAtTheEnd();
  try {
    return FlushOutput(Run(argc, argv));
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "hvas: %s\n", exception.what());  // Of memory, as a rule.
    return 1;
  }
}
