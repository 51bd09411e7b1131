#include "app/report_failure.h"

#include <cstdio>

#include <fmt/format.h>

namespace hvas::app {

int ReportFailure(const Error& error) {
  fmt::print(stderr, "hvas: {}\n", error.ToString());
  return 1;
}

}  // namespace hvas::app
