#include "app/output/report_failure.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/command_watch.h"
#include "app/output/terminal.h"

namespace hvas::app {

namespace {

void PrintError(const Error& error) {
  fmt::print(stderr, "{} {}\n", Painted("hvas:", Style::kBad, stderr), error.ToString());
}

}  // namespace

int ReportFailure(const Error& error) {
  PrintError(CommandWatch::Get().Translate(error));
  return 1;
}

int ReportMisuse(const Error& error) {
  PrintError(error);
  return kMisused;
}

}  // namespace hvas::app
