#pragma once

#include <string>
#include <vector>

/** A program that another one starts for a piece of work that may fail, which then ends only this
 process. It gets its arguments, an open file for what it makes (kOutputDescriptor), and a pipe for
 lines about how it goes (kProgressDescriptor). It exits with 0 when the output is complete. */
namespace hvas {

// The first two that are free in a process that has input, output and errors.
inline constexpr int kProgressDescriptor = 3;
inline constexpr int kOutputDescriptor = 4;

/** Exit statuses of such a program, beside 0. */
inline constexpr int kWorkerUsage = 64;
inline constexpr int kWorkerNoMemory = 71;
inline constexpr int kWorkerNoOutput = 74;

/** Takes "--parent PID", "--memory-limit BYTES" and "--time-limit SECONDS" out of the arguments,
 and keeps this process to them: it ends with its parent, and when it takes more memory or processor
 time. Other users of the machine's memory outlive it. @returns 0, or the exit status with which the
 program ends at once: nobody has started it to be served, or that process has ended already.
 @param about  What the program is for, printed where a user has started it. */
[[nodiscard]] int BeginServing(std::vector<std::string>* arguments, const char* about);

}  // namespace hvas
