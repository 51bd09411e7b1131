#include "base/served_process.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>

namespace hvas {
namespace {

/** Takes "NAME NUMBER" out of the arguments. @returns 0 where it is not there. */
std::uint64_t TakeNumber(const std::string& name, std::vector<std::string>* arguments) {
  const auto found = std::find(arguments->begin(), arguments->end(), name);
  if (found == arguments->end() || found + 1 == arguments->end()) {
    return 0;
  }
  const std::uint64_t value = std::strtoull((found + 1)->c_str(), nullptr, 10);
  arguments->erase(found, found + 2);
  return value;
}

void Limit(int what, std::uint64_t value) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource>(what), &limit) == 0) {
    limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
    ::setrlimit(static_cast<__rlimit_resource>(what), &limit);
  }
}

void LimitMemory(std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // They reserve terabytes.
  if (bytes > 0) {
    Limit(RLIMIT_AS, bytes);
  }
#else
  static_cast<void>(bytes);
#endif
  // If the machine runs out of memory all the same, this is the process to end.
  std::ofstream("/proc/self/oom_score_adj") << 500;
}

[[noreturn]] void EndForLackOfMemory() {
  ::_exit(kWorkerNoMemory);
}

/** @returns false when the process that is to be served has ended already. */
bool FollowParent(std::uint64_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  return parent == 0 || static_cast<std::uint64_t>(::getppid()) == parent;
}

}  // namespace

int BeginServing(std::vector<std::string>* arguments, const char* about) {
  const std::uint64_t parent = TakeNumber("--parent", arguments);
  const std::uint64_t memory = TakeNumber("--memory-limit", arguments);
  const std::uint64_t time = TakeNumber("--time-limit", arguments);
  const bool is_served =
      ::fcntl(kProgressDescriptor, F_GETFD) >= 0 && ::fcntl(kOutputDescriptor, F_GETFD) >= 0;
  if (arguments->empty() || !is_served) {
    fmt::print(stderr, "{}\n", about);
    return kWorkerUsage;
  }
  if (!FollowParent(parent)) {
    return kWorkerNoOutput;
  }
  LimitMemory(memory);
  if (time > 0) {  // The parent looks at the clock; this is for when it cannot.
    const auto cores = static_cast<std::uint64_t>(std::max(::sysconf(_SC_NPROCESSORS_ONLN), 1L));
    Limit(RLIMIT_CPU, 2 * time * cores);
  }
  Limit(RLIMIT_CORE, 0);
  std::set_new_handler(EndForLackOfMemory);
  return 0;
}

}  // namespace hvas
