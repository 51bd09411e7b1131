/** A worker for tests of its supervision: misbehaves as $HVAS_TEST_WORKER says, in words that name
 what and where, or else becomes the real one. Appends a line to $HVAS_TEST_LOG for every start. */

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spawn.h>

#include "cad/worker.h"

extern char** environ;

namespace {

using hvas::cad::kOutputDescriptor;
using hvas::cad::kProgressDescriptor;

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

void Tell(const std::string& text) {
  (void)!::write(kProgressDescriptor, text.data(), text.size());
}

bool Has(const std::vector<std::string>& arguments, const std::string& word) {
  return std::find(arguments.begin(), arguments.end(), word) != arguments.end();
}

/** Behaves badly in one of the ways that processes can. */
void End(const std::string& how) {
  if (how == "crash") {
    std::signal(SIGSEGV, SIG_DFL);  // Also where a sanitizer would make an exit status of it.
    std::raise(SIGSEGV);
  } else if (how == "hang") {
    while (true) {
      ::pause();
    }
  } else if (how == "killed") {  // As the kernel does when memory runs out.
    std::raise(SIGKILL);
  } else if (how == "memory") {
    ::_exit(hvas::cad::kWorkerNoMemory);
  }
  ::_exit(3);
}

void RunReal(char** argv) {
  pid_t child = -1;
  if (::posix_spawn(&child, HVAS_REAL_WORKER, nullptr, nullptr, argv, environ) == 0) {
    ::waitpid(child, nullptr, 0);
  }
}

/** Ways that do not depend on how far the work has come. */
void MisbehaveAtOnce(const std::string& how, char** argv) {
  if (how == "silent") {
    ::_exit(0);
  } else if (how == "garbage") {
    Tell("stage x y\npart 99999999999 z\n\xff\xfe\nstage nan parts\nstage 2.5 read\n");
    const std::string noise(100000, '\x5a');
    (void)!::write(kOutputDescriptor, noise.data(), noise.size());
    ::_exit(0);
  } else if (how == "truncate") {
    // The real one has to believe that this is the program that started it.
    for (char** word = argv; *word != nullptr; ++word) {
      if (std::string(*word) == "--parent") {
        *(word + 1) = ::strdup(std::to_string(::getpid()).c_str());
      }
    }
    RunReal(argv);
    const off_t size = ::lseek(kOutputDescriptor, 0, SEEK_END);
    (void)!::ftruncate(kOutputDescriptor, size - 100);
    ::_exit(0);
  } else if (how == "chatter") {
    const std::string noise(1 << 16, 'x');
    while (true) {
      Tell(noise);
    }
  } else if (how == "child") {  // Leaves somebody behind who holds the pipe.
    const pid_t child = ::fork();
    if (child == 0) {
      End("hang");
    }
    std::ofstream(Variable("HVAS_TEST_LOG"), std::ios::app) << child << '\n';
    ::_exit(0);
  }
}

void Misbehave(const std::vector<std::string>& arguments, char** argv) {
  const std::string told = Variable("HVAS_TEST_WORKER");  // "crash part 1", "hang tolerances", ...
  const std::size_t space = told.find(' ');
  const std::string how = told.substr(0, space);
  const std::string where = space == std::string::npos ? "" : told.substr(space + 1);
  MisbehaveAtOnce(how, argv);
  const auto threads = std::find(arguments.begin(), arguments.end(), "--threads");
  const bool is_alone = threads != arguments.end() && *(threads + 1) == "1";
  if (where == "start") {
    Tell("stage 0.250 read\n");
    End(how);
  } else if (where == "tolerances" && !Has(arguments, "--no-tolerances")) {
    Tell("stage 0.000 tolerances\n");
    End(how);
  } else if (where == "crowd" && !is_alone) {
    Tell("stage 0.000 parts\npart 0 plate\npart 1 pin\n");
    End(how);
  } else if (where == "every part") {
    Tell(fmt::format("stage 0.000 parts\npart {} any\n",
                     std::count(arguments.begin(), arguments.end(), "--skip-part")));
    End(how);
  } else if (where.rfind("part ", 0) == 0) {
    const std::string number = where.substr(5);
    const auto skip = std::find(arguments.begin(), arguments.end(), "--skip-part");
    if (skip == arguments.end() || *(skip + 1) != number) {
      Tell("stage 0.000 parts\npart " + number + " pin\n");
      End(how);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::ofstream(Variable("HVAS_TEST_LOG"), std::ios::app) << ::getpid() << '\n';
  Misbehave({argv + 1, argv + argc}, argv);
  ::execv(HVAS_REAL_WORKER, argv);
  return 127;
}
