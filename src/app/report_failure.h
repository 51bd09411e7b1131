#pragma once

#include "base/result.h"

namespace hvas::app {

/** Exit status of commands that did their work, on a record that is not as it was written. */
inline constexpr int kDamagedRecord = 2;

/** Tells of an error on the standard error stream. @returns the exit status for it. */
int ReportFailure(const Error& error);

}  // namespace hvas::app
