#include "app/devices/doctor_checks.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string_view>

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

std::optional<std::int64_t> ToNumber(std::string_view text, int base = 10) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end != text.data() ? std::optional(number) : std::nullopt;
}

/** What follows a key at the beginning of a line; empty where there is no such line. */
std::string ReadValue(const fs::path& path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key)) {
      const std::size_t first = line.find_first_not_of(" \t", key.size());
      return first == std::string::npos ? "" : line.substr(first);
    }
  }
  return "";
}

/** Whether this process has a capability of Linux, by its number. */
bool HasCapability(const fs::path& root, unsigned number) {
  const auto mask = ToNumber(ReadValue(root / "proc/self/status", "CapEff:"), 16);
  return mask && ((static_cast<std::uint64_t>(*mask) >> number) & 1U) != 0;
}

DoctorCheck CheckKernel(const fs::path& root) {
  const fs::path kernel = root / "proc/sys/kernel";
  const bool is_realtime =
      ReadLine(root / "sys/kernel/realtime") == "1" ||
      ReadLine(kernel / "version").value_or("").find("PREEMPT_RT") != std::string::npos;
  return {"kernel",
          fmt::format("{} {}{}", OrUnknown(ReadLine(kernel / "ostype")),
                      OrUnknown(ReadLine(kernel / "osrelease")), is_realtime ? ", PREEMPT_RT" : ""),
          is_realtime,
          is_realtime ? ""
                      : "an ordinary kernel occasionally wakes a thread a millisecond or more "
                        "late; on Debian: apt install linux-image-rt-amd64, and boot that kernel"};
}

DoctorCheck CheckPriority(const fs::path& root) {
  constexpr unsigned kSysNice = 23;  // CAP_SYS_NICE of linux/capability.h.
  constexpr int kWanted = 80;        // What the haptic thread asks for (realtime_thread.cc).
  const std::string limit = ReadValue(root / "proc/self/limits", "Max realtime priority");
  const bool has_right = HasCapability(root, kSysNice) || limit.starts_with("unlimited");
  const bool is_good = has_right || ToNumber(limit).value_or(0) >= kWanted;
  return {"real-time priority",
          has_right ? "allowed" : fmt::format("up to {}", ToNumber(limit).value_or(0)), is_good,
          is_good ? ""
                  : "put '@realtime - rtprio 90' and '@realtime - memlock unlimited' into "
                    "/etc/security/limits.d/hvas.conf, then: groupadd realtime; usermod -aG "
                    "realtime $USER; log in again"};
}

DoctorCheck CheckMemoryLock(const fs::path& root) {
  constexpr unsigned kIpcLock = 14;  // CAP_IPC_LOCK of linux/capability.h.
  const std::string limit = ReadValue(root / "proc/self/limits", "Max locked memory");
  const bool is_good = HasCapability(root, kIpcLock) || limit.starts_with("unlimited");
  return {"locked memory",
          is_good ? "unlimited" : fmt::format("up to {} kB", ToNumber(limit).value_or(0) / 1024),
          is_good, is_good ? "" : "as for the priority above: '@realtime - memlock unlimited'"};
}

DoctorCheck CheckThrottling(const fs::path& root) {
  const auto runtime = ReadLine(root / "proc/sys/kernel/sched_rt_runtime_us");
  const bool is_good = runtime != "0";
  return {"share for real-time threads",
          !runtime || runtime == "-1" ? (runtime ? "all" : "unknown")
                                      : fmt::format("{} us of each second", *runtime),
          is_good, is_good ? "" : "sysctl -w kernel.sched_rt_runtime_us=950000"};
}

DoctorCheck CheckGovernor(const fs::path& root) {
  const auto governor = ReadLine(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  const bool is_good = !governor || *governor == "performance";
  return {"frequency governor", governor ? *governor : "none (set by the firmware or the host)",
          is_good, is_good ? "" : "cpupower frequency-set -g performance"};
}

/** Cores in a list as Linux writes it, as in "0-3,6". */
int CountCores(std::string_view list) {
  int count = 0;
  while (!list.empty()) {
    const std::string_view item = list.substr(0, list.find(','));
    list.remove_prefix(std::min(item.size() + 1, list.size()));
    const std::size_t dash = item.find('-');
    const auto first = ToNumber(item);
    const auto last = dash == item.npos ? first : ToNumber(item.substr(dash + 1));
    count += first && last ? static_cast<int>(*last - *first) + 1 : 0;
  }
  return count;
}

DoctorCheck CheckCores(const fs::path& root) {
  const fs::path folder = root / "sys/devices/system/cpu";
  const std::string isolated = ReadLine(folder / "isolated").value_or("");
  const int cores = CountCores(ReadLine(folder / "online").value_or(""));
  const bool is_good = !isolated.empty();
  std::string remedy;
  if (!is_good) {
    remedy = cores > 1 ? fmt::format(
                             "reserve a core for the haptic loop: isolcpus={0} nohz_full={0} on "
                             "the kernel's command line",
                             cores - 1)
                       : "the haptic loop shares the only core with all other programs: use a "
                         "machine with two or more";
  }
  return {"cores",
          fmt::format("{}, {}", cores > 0 ? std::to_string(cores) : "unknown number",
                      is_good ? fmt::format("of which {} is reserved", isolated)
                              : "none reserved for the haptic loop"),
          is_good, remedy};
}

DoctorCheck CheckIdleStates(const fs::path& root) {
  constexpr std::int64_t kLongestUs = 100;  // a tenth of the tick
  std::int64_t longest_us = 0;
  std::error_code ignored;
  for (fs::directory_iterator state(root / "sys/devices/system/cpu/cpu0/cpuidle", ignored), end;
       state != end; state.increment(ignored)) {
    const bool is_disabled = ReadLine(state->path() / "disable") == "1";
    const auto latency_us = ToNumber(ReadLine(state->path() / "latency").value_or(""));
    longest_us = std::max(longest_us, is_disabled ? 0 : latency_us.value_or(0));
  }
  const bool is_good = longest_us <= kLongestUs;
  return {"idle states",
          longest_us > 0 ? fmt::format("the deepest sleep state takes {} us to leave", longest_us)
                         : "none with a wake-up delay",
          is_good,
          is_good ? ""
                  : "deep sleep states delay the wake-up of a core: processor.max_cstate=1 "
                    "intel_idle.max_cstate=1 on the kernel's command line"};
}

DoctorCheck CheckHypervisor(const fs::path& root) {
  const std::string flags = ReadValue(root / "proc/cpuinfo", "flags");
  const bool is_virtual = flags.find(" hypervisor") != std::string::npos;
  return {"machine", is_virtual ? "virtual" : "real", !is_virtual,
          is_virtual ? "the host of a virtual machine suspends it for milliseconds, regardless of "
                       "settings here: use a physical machine for a force device"
                     : ""};
}

DoctorCheck CheckClock(const fs::path& root) {
  const auto source =
      ReadLine(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  const bool is_slow =
      source && (*source == "acpi_pm" || *source == "hpet" || *source == "jiffies");
  return {
      "clock", OrUnknown(source), !is_slow,
      is_slow
          ? "reading this clock takes microseconds: clocksource=tsc on the kernel's command line"
          : ""};
}

}  // namespace

std::vector<DoctorCheck> CheckMachine(const fs::path& root) {
  return {CheckKernel(root),     CheckPriority(root),   CheckMemoryLock(root),
          CheckThrottling(root), CheckGovernor(root),   CheckCores(root),
          CheckIdleStates(root), CheckHypervisor(root), CheckClock(root)};
}

}  // namespace hvas::app
