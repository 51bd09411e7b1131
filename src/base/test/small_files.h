#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace hvas::testing {

/** Runs something where no file can grow beyond 4 kB, so that a write fails in the middle as on a
 full disk: in a process of its own, whose limit it stays. @returns what it returned. */
template <typename Function>
[[nodiscard]] bool RunWithSmallFiles(const Function& function) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(function() ? 0 : 1);
  }
  int status = 0;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

}  // namespace hvas::testing
