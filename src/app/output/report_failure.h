#pragma once

#include "base/result.h"

namespace hvas::app {

/** Exit status of commands that did their work, on a record that is not as it was written. */
inline constexpr int kDamagedRecord = 2;

/** Tells of an error on the standard error stream. @returns the exit status for it. */
int ReportFailure(const Error& error);

/** The exit status where the command line is wrong, as sysexits(3) has it: EX_USAGE. */
inline constexpr int kMisused = 64;

/** Tells of an error in what was asked for, which the words alone show. @returns kMisused. */
int ReportMisuse(const Error& error);

}  // namespace hvas::app
