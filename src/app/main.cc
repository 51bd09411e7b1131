#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "app/command_line.h"
#include "app/command_watch.h"
#include "base/crash_note.h"
#include "device/force_withdrawal.h"

namespace {

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

/** The command line, for the message of a crash. */
std::string JoinArguments(int argc, char** argv) {
  std::string text = "hvas";
  for (int i = 1; i < argc; ++i) {
    text += ' ';
    text += argv[i];
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  hvas::device::WithdrawForcesAtTheEnd();
  try {
    hvas::NoteWork(JoinArguments(argc, argv));
    hvas::app::CommandWatch& watch = hvas::app::CommandWatch::Get();
    return watch.Conclude(FlushOutput(hvas::app::RunCommandLine(argc, argv)));
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "hvas: %s\n", exception.what());  // Of memory, as a rule.
    return 1;
  }
}
