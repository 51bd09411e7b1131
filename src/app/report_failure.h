#pragma once

#include "base/result.h"

namespace hvas::app {

/** Tells of an error on the standard error stream. @returns the exit status for it. */
int ReportFailure(const Error& error);

}  // namespace hvas::app
