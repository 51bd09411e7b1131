#include "app/doctor_checks.h"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cctype>
#include <charconv>
#include <fstream>
#include <optional>

#include <fmt/format.h>

namespace hvas::app {
namespace {

namespace fs = std::filesystem;

/** First line of a file of the system; nothing when it cannot be read. */
std::optional<std::string> ReadLine(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) {
    return std::nullopt;
  }
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) {
    line.pop_back();
  }
  return line;
}

std::string OrUnknown(const std::optional<std::string>& text) {
  return text && !text->empty() ? *text : "unknown";
}

DoctorCheck CheckKernel(const fs::path& root) {
  utsname name{};
  ::uname(&name);
  const bool is_realtime = ReadLine(root / "sys/kernel/realtime") == "1" ||
                           std::string(name.version).find("PREEMPT_RT") != std::string::npos;
  return {"kernel",
          fmt::format("{} {}{}", name.sysname, name.release, is_realtime ? ", PREEMPT_RT" : ""),
          is_realtime,
          is_realtime ? ""
                      : "an ordinary kernel now and then wakes a thread late by a millisecond and "
                        "more; on Debian: apt install linux-image-rt-amd64, and start that one"};
}

DoctorCheck CheckPriority() {
  rlimit limit{};
  ::getrlimit(RLIMIT_RTPRIO, &limit);
  const bool is_root = ::geteuid() == 0;
  const bool is_good = is_root || limit.rlim_cur >= 80;
  return {"real-time priority",
          is_root ? "allowed (root)" : fmt::format("up to {}", limit.rlim_cur), is_good,
          is_good ? ""
                  : "put '@realtime - rtprio 90' and '@realtime - memlock unlimited' into "
                    "/etc/security/limits.d/hvas.conf, then: groupadd realtime; usermod -aG "
                    "realtime $USER; log in again"};
}

DoctorCheck CheckMemoryLock() {
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool is_good = ::geteuid() == 0 || limit.rlim_cur == RLIM_INFINITY;
  return {"locked memory",
          is_good ? "unlimited" : fmt::format("up to {} kB", limit.rlim_cur / 1024), is_good,
          is_good ? "" : "as for the priority: memlock unlimited"};
}

DoctorCheck CheckThrottling(const fs::path& root) {
  const auto runtime = ReadLine(root / "proc/sys/kernel/sched_rt_runtime_us");
  return {"share for real-time threads",
          runtime ? (*runtime == "-1" ? "all" : fmt::format("{} us of each second", *runtime))
                  : "unknown",
          true, ""};
}

DoctorCheck CheckGovernor(const fs::path& root) {
  const auto governor = ReadLine(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  const bool is_good = !governor || *governor == "performance";
  return {"frequency governor", governor ? *governor : "none (set by the firmware or the host)",
          is_good, is_good ? "" : "cpupower frequency-set -g performance"};
}

DoctorCheck CheckCores(const fs::path& root) {
  const auto isolated = ReadLine(root / "sys/devices/system/cpu/isolated");
  const bool is_good = isolated && !isolated->empty();
  const long cores = ::sysconf(_SC_NPROCESSORS_ONLN);
  return {"cores",
          fmt::format("{}{}", cores,
                      is_good ? fmt::format(", of which {} have no other work", *isolated)
                              : ", none kept free of other work"),
          is_good || cores < 2,
          is_good || cores < 2 ? ""
                               : fmt::format("give the haptic loop a core of its own: isolcpus={0} "
                                             "nohz_full={0} on the kernel's command line",
                                             cores - 1)};
}

DoctorCheck CheckIdleStates(const fs::path& root) {
  const fs::path latency = root / "dev/cpu_dma_latency";
  const auto state = ReadLine(root / "sys/devices/system/cpu/cpuidle/current_driver");
  const bool can_hold = ::access(latency.c_str(), W_OK) == 0;
  const bool is_good = !state || *state == "none" || can_hold;
  return {"idle states", OrUnknown(state), is_good,
          is_good ? ""
                  : "deep sleep of a core delays its waking: processor.max_cstate=1 on the "
                    "kernel's command line"};
}

DoctorCheck CheckHypervisor(const fs::path& root) {
  std::ifstream file(root / "proc/cpuinfo");
  std::string line;
  bool is_virtual = false;
  while (std::getline(file, line) && !is_virtual) {
    is_virtual = line.rfind("flags", 0) == 0 && line.find(" hypervisor") != std::string::npos;
  }
  return {"machine", is_virtual ? "virtual" : "real", !is_virtual,
          is_virtual ? "its host takes the processor away for milliseconds at a time, whatever is "
                       "set here: for a force device use a real machine"
                     : ""};
}

DoctorCheck CheckClock(const fs::path& root) {
  const auto source =
      ReadLine(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  const bool is_slow =
      source && (*source == "acpi_pm" || *source == "hpet" || *source == "jiffies");
  return {"clock", OrUnknown(source), !is_slow,
          is_slow
              ? "this clock takes microseconds to read: clocksource=tsc on the kernel's command "
                "line"
              : ""};
}

}  // namespace

std::vector<DoctorCheck> CheckMachine(const fs::path& root) {
  return {CheckKernel(root),     CheckPriority(),       CheckMemoryLock(),
          CheckThrottling(root), CheckGovernor(root),   CheckCores(root),
          CheckIdleStates(root), CheckHypervisor(root), CheckClock(root)};
}

}  // namespace hvas::app
