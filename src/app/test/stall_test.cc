// Processes that stand still while a force acts, as by SIGSTOP or on a machine that has no time for
// them (N6): what their devices are given then. States are judged, and no durations.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/await_true.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ReadText;
using testing::StartHvas;

/** A write to the device. */
struct Note {
  double t_s{0};
  double force{0};  ///< [N]
};

/** A running program with the noting plug-in as its device. */
class NotedProcess {
 public:
  explicit NotedProcess(std::vector<std::string> arguments) {
    for (std::string& argument : arguments) {
      argument = argument == "DEVICE" ? "plugin:" HVAS_NOTING_PLUGIN "?" + file_ : argument;
    }
    process_ = StartHvas(arguments);
  }

  NotedProcess(const NotedProcess&) = delete;
  NotedProcess& operator=(const NotedProcess&) = delete;

  ~NotedProcess() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }

  [[nodiscard]] std::vector<Note> ReadNotes() const {
    const std::string bytes = ReadText(file_);
    std::vector<Note> notes(bytes.size() / sizeof(Note));
    std::memcpy(notes.data(), bytes.data(), notes.size() * sizeof(Note));
    return notes;
  }

  /** Waits until the device has a force of this size at least; false where it never comes. */
  [[nodiscard]] bool WaitForForce(double least) const {
    return WaitUntil([least](const std::vector<Note>& notes) {
      return !notes.empty() && notes.back().force >= least;
    });
  }

  /** Lets the process stand still for a while, and then write some times more. */
  [[nodiscard]] bool Stall(std::chrono::milliseconds gap) const {
    ::kill(process_, SIGSTOP);
    int status = 0;
    if (::waitpid(process_, &status, WUNTRACED) != process_ || !WIFSTOPPED(status)) {
      return false;
    }
    std::this_thread::sleep_for(gap);  // What is tested: for so long it does stand still.
    const std::size_t before = ReadNotes().size();
    ::kill(process_, SIGCONT);
    constexpr std::size_t kMore = 100;
    return WaitUntil(
        [before](const std::vector<Note>& notes) { return notes.size() >= before + kMore; });
  }

 private:
  template <typename Holds>
  [[nodiscard]] bool WaitUntil(Holds holds) const {
    return hvas::testing::AwaitTrue(
        [&] { return ::access(file_.c_str(), R_OK) == 0 && holds(ReadNotes()); });
  }

  TemporaryFolder folder_;
  std::string file_{(folder_ / "notes").string()};
  pid_t process_{-1};
};

/** Expects that after each gap in the writes the force grows from zero, by what a soft start allows
 in the time that a late write may count for: 50 N/s, 2 ms. */
std::size_t ExpectSoftStarts(const std::vector<Note>& notes) {
  constexpr double kGap = 0.025;  // [s]: somewhat more than what is no gap yet.
  constexpr double kMostStep = 50 * 2e-3;
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < notes.size(); ++i) {
    if (notes[i].t_s - notes[i - 1].t_s <= kGap) {
      continue;
    }
    ++gaps;
    double before = 0;
    for (std::size_t k = i; k < notes.size() && k < i + 50; ++k) {
      EXPECT_LE(notes[k].force, before + kMostStep + 1e-9)
          << "write " << k - i << " after a gap of " << notes[i].t_s - notes[i - 1].t_s << " s";
      before = notes[k].force;
    }
  }
  return gaps;
}

TEST(ProcessStallReleaseTest, DeviceIsGivenNoForceOfBefore) {
  constexpr double kLeast = 1;  // [N] that acts when it stands still.
  const NotedProcess process({"devices", "--try", "DEVICE", "--seconds", "600"});
  std::size_t stalls = 0;
  for (const int gap_ms : {50, 100, 300, 1000, 5000}) {
    ASSERT_TRUE(process.WaitForForce(kLeast)) << gap_ms;
    ASSERT_TRUE(process.Stall(std::chrono::milliseconds(gap_ms)));
    ++stalls;
  }
  EXPECT_GE(ExpectSoftStarts(process.ReadNotes()), stalls);
}

}  // namespace
}  // namespace hvas::app
