#pragma once

#include "base/result.h"

namespace hvas::app {

/** Tells of an error on the standard error stream. @returns the exit status for it. */
int ReportFailure(const Error& error);

/** The exit status where the command line is wrong, as sysexits(3) has it: EX_USAGE. */
inline constexpr int kMisused = 64;

/** The same of an error in what was asked for, which the words alone show. @returns kMisused. */
int ReportMisuse(const Error& error);

}  // namespace hvas::app
