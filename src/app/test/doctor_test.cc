#include <string>

#include <gtest/gtest.h>

#include "app/devices/doctor_checks.h"
#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;

constexpr const char* kLimits = "proc/self/limits";
constexpr const char* kStatus = "proc/self/status";
constexpr const char* kCpu = "sys/devices/system/cpu/";
constexpr const char* kRights = "Name:\thvas\nCapEff:\t0000000000804000\n";
constexpr const char* kNoRights = "Name:\thvas\nCapEff:\t0000000000000000\n";

std::string Limits(const std::string& priority, const std::string& memory) {
  return "Limit                     Soft Limit           Hard Limit           Units     \n"
         "Max locked memory         " +
         memory + "           " + memory + "           bytes     \nMax realtime priority     " +
         priority + "                    " + priority + "                    \n";
}

/** A machine as its kernel shows it: all is well, but for what a test changes. */
class Machine {
 public:
  Machine() {
    Put("proc/sys/kernel/ostype", "Linux");
    Put("proc/sys/kernel/osrelease", "6.1.0-rt");
    Put("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.1");
    Put("proc/sys/kernel/sched_rt_runtime_us", "950000");
    Put(kStatus, kNoRights);
    Put(kLimits, Limits("90", "unlimited"));
    Put("proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu vme de\n");
    Put(std::string(kCpu) + "cpu0/cpufreq/scaling_governor", "performance");
    Put(std::string(kCpu) + "cpu0/cpuidle/state0/latency", "0");
    Put(std::string(kCpu) + "cpu0/cpuidle/state1/latency", "2");
    Put(std::string(kCpu) + "online", "0-3");
    Put(std::string(kCpu) + "isolated", "3");
    Put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
  }

  void Put(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_ / file).parent_path());
    (void)folder_.Write(file, text + "\n");
  }

  void Remove(const std::string& file) const { std::filesystem::remove(folder_ / file); }

  [[nodiscard]] DoctorCheck Check(const std::string& name) const {
    for (const DoctorCheck& check : CheckMachine(folder_.path())) {
      if (check.name == name) {
        return check;
      }
    }
    ADD_FAILURE() << "no check is called " << name;
    return {};
  }

  void ExpectGood(const std::string& name, const std::string& value) const {
    const DoctorCheck check = Check(name);
    EXPECT_TRUE(check.is_good) << name << ": " << check.value;
    EXPECT_EQ(check.value, value);
    EXPECT_EQ(check.remedy, "");
  }

  void ExpectBad(const std::string& name, const std::string& value,
                 const std::string& remedy) const {
    const DoctorCheck check = Check(name);
    EXPECT_FALSE(check.is_good) << name << ": " << check.value;
    EXPECT_EQ(check.value, value);
    EXPECT_EQ(check.remedy, remedy);
  }

  [[nodiscard]] const std::filesystem::path& root() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST(DoctorTest, MachineInOrderHasNoRemedies) {
  const Machine machine;
  const std::vector<DoctorCheck> checks = CheckMachine(machine.root());
  EXPECT_EQ(checks.size(), 9U);
  for (const DoctorCheck& check : checks) {
    EXPECT_TRUE(check.is_good) << check.name << ": " << check.value;
    EXPECT_EQ(check.remedy, "") << check.name;
  }
}

TEST(DoctorTest, OrdinaryKernelIsToldWhichOneToInstall) {
  const Machine machine;
  machine.ExpectGood("kernel", "Linux 6.1.0-rt, PREEMPT_RT");
  machine.Put("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian 6.1");
  machine.ExpectBad("kernel", "Linux 6.1.0-rt",
                    "an ordinary kernel occasionally wakes a thread a millisecond or more late; on "
                    "Debian: apt install linux-image-rt-amd64, and boot that kernel");
  machine.Put("sys/kernel/realtime", "1");
  machine.ExpectGood("kernel", "Linux 6.1.0-rt, PREEMPT_RT");
}

TEST(DoctorTest, PriorityAndMemoryNeedALimitOrARight) {
  const Machine machine;
  machine.ExpectGood("real-time priority", "up to 90");
  machine.ExpectGood("locked memory", "unlimited");
  machine.Put(kLimits, Limits("0", "8388608"));
  machine.ExpectBad("real-time priority", "up to 0",
                    "put '@realtime - rtprio 90' and '@realtime - memlock unlimited' into "
                    "/etc/security/limits.d/hvas.conf, then: groupadd realtime; usermod -aG "
                    "realtime $USER; log in again");
  machine.ExpectBad("locked memory", "up to 8192 kB",
                    "as for the priority above: '@realtime - memlock unlimited'");
  // What root has on a machine of its own, but not always in a container.
  machine.Put(kStatus, kRights);
  machine.ExpectGood("real-time priority", "allowed");
  machine.ExpectGood("locked memory", "unlimited");
}

TEST(DoctorTest, RealtimeThreadsNeedAShareOfTheProcessor) {
  const Machine machine;
  constexpr const char* kShare = "share for real-time threads";
  constexpr const char* kRuntime = "proc/sys/kernel/sched_rt_runtime_us";
  machine.ExpectGood(kShare, "950000 us of each second");
  machine.Put(kRuntime, "-1");
  machine.ExpectGood(kShare, "all");
  machine.Put(kRuntime, "0");
  machine.ExpectBad(kShare, "0 us of each second", "sysctl -w kernel.sched_rt_runtime_us=950000");
  machine.Remove(kRuntime);
  machine.ExpectGood(kShare, "unknown");
}

TEST(DoctorTest, GovernorThatSavesPowerIsNamed) {
  const Machine machine;
  const std::string file = std::string(kCpu) + "cpu0/cpufreq/scaling_governor";
  machine.ExpectGood("frequency governor", "performance");
  machine.Put(file, "powersave");
  machine.ExpectBad("frequency governor", "powersave", "cpupower frequency-set -g performance");
  machine.Remove(file);
  machine.ExpectGood("frequency governor", "none (set by the firmware or the host)");
}

TEST(DoctorTest, CoreIsKeptFreeOfOtherWork) {
  const Machine machine;
  machine.ExpectGood("cores", "4, of which 3 is reserved");
  machine.Put(std::string(kCpu) + "isolated", "");
  machine.Put(std::string(kCpu) + "online", "0-5,7");
  machine.ExpectBad("cores", "7, none reserved for the haptic loop",
                    "reserve a core for the haptic loop: isolcpus=6 nohz_full=6 on the "
                    "kernel's command line");
  machine.Put(std::string(kCpu) + "online", "0");
  machine.ExpectBad("cores", "1, none reserved for the haptic loop",
                    "the haptic loop shares the only core with all other programs: use a machine "
                    "with two or more");
}

TEST(DoctorTest, DeepSleepOfACoreIsFoundUnlessItIsSwitchedOff) {
  const Machine machine;
  const std::string state = std::string(kCpu) + "cpu0/cpuidle/state2/";
  machine.ExpectGood("idle states", "the deepest sleep state takes 2 us to leave");
  machine.Put(state + "latency", "890");
  machine.ExpectBad("idle states", "the deepest sleep state takes 890 us to leave",
                    "deep sleep states delay the wake-up of a core: processor.max_cstate=1 "
                    "intel_idle.max_cstate=1 on the kernel's command line");
  machine.Put(state + "disable", "1");
  machine.ExpectGood("idle states", "the deepest sleep state takes 2 us to leave");
}

TEST(DoctorTest, VirtualMachineIsTold) {
  const Machine machine;
  machine.ExpectGood("machine", "real");
  machine.Put("proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu vme hypervisor lahf_lm\n");
  machine.ExpectBad("machine", "virtual",
                    "the host of a virtual machine suspends it for milliseconds, regardless of "
                    "settings here: use a physical machine for a force device");
}

TEST(DoctorTest, SlowClockIsTold) {
  const Machine machine;
  machine.ExpectGood("clock", "tsc");
  for (const char* slow : {"hpet", "acpi_pm", "jiffies"}) {
    machine.Put("sys/devices/system/clocksource/clocksource0/current_clocksource", slow);
    machine.ExpectBad("clock", slow,
                      "reading this clock takes microseconds: clocksource=tsc on the kernel's "
                      "command line");
  }
}

TEST(DoctorTest, MachineThatTellsNothingIsNoCrash) {
  const TemporaryFolder empty;
  const std::vector<DoctorCheck> checks = CheckMachine(empty.path());
  ASSERT_EQ(checks.size(), 9U);
  for (const DoctorCheck& check : checks) {
    EXPECT_NE(check.value, "") << check.name;
    EXPECT_EQ(check.is_good, check.remedy.empty()) << check.name;
  }
}

TEST(DoctorTest, JsonOfARealRunFitsItsSchema) {
  const testing::Ran ran = testing::RunHvas({"doctor", "--seconds", "0.2", "--json"});
  const json document = json::parse(ran.out, nullptr, false);
  ASSERT_FALSE(document.is_discarded()) << ran.out << ran.err;
  EXPECT_EQ(testing::Validate(testing::ReadSchema("doctor"), document), std::vector<std::string>{});
  EXPECT_EQ(document["checks"].size(), 9U);
  EXPECT_EQ(ran.status, document["punctual"].get<bool>() ? 0 : 2);
}

TEST(DoctorTest, TextTellsTheSameChecks) {
  const testing::Ran ran = testing::RunHvas({"doctor", "--seconds", "0.2"});
  EXPECT_EQ(ran.err, "");
  for (const DoctorCheck& check : CheckMachine("/")) {
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, check.name, ran.out);
  }
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "wakes up 1000 times a second, for 0.2 s", ran.out);
}

}  // namespace
}  // namespace hvas::app
