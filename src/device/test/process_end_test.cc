// How a process that has force on a hand comes to its end (N6, N8). The sanitizers handle the
// signals of a process and the end of its threads themselves, so that this test is of none of their
// labels.

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/crash_note.h"
#include "device/force_withdrawal.h"
#include "device/test/live_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

class ProcessEndTest : public ::testing::TestWithParam<const LibraryCase*> {};

INSTANTIATE_TEST_SUITE_P(Drivers, ProcessEndTest,
                         ::testing::Values(&kOpenHaptics, &kForceDimension, &kVirtuose),
                         [](const auto& entry) { return entry.param->name; });

/** How the process that has a device in somebody's hand can come to its end. */
enum class End { kTerminate, kTick, kAbort, kSegmentationFault, kInterrupt, kTermination };

void Come(End end) {
  switch (end) {
    case End::kTerminate:
      std::thread([] { throw std::runtime_error("of a thread that catches nothing"); }).join();
      break;
    case End::kTick:
      std::terminate();  // as where a tick that is noexcept throws
    case End::kAbort:
      std::abort();
    case End::kSegmentationFault:
      static_cast<void>(std::raise(SIGSEGV));
      break;
    case End::kInterrupt:
      static_cast<void>(std::raise(SIGINT));
      break;
    case End::kTermination:
      static_cast<void>(std::raise(SIGTERM));
      break;
  }
}

/** A process with force on a hand that comes to an end, and what is seen of its device. */
class EndingProcess {
 public:
  /** Starts it. Its haptic thread goes on or stands still when the end comes. */
  EndingProcess(const LibraryCase& which, End end, bool has_loop) : end_(end), has_loop_(has_loop) {
    void* memory =
        ::mmap(nullptr, sizeof(Seen), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    seen_ = new (memory) Seen;
    child_ = ::fork();
    if (child_ == 0) {
      Run(which);
    }
  }

  ~EndingProcess() { ::munmap(seen_, sizeof(Seen)); }

  EndingProcess(const EndingProcess&) = delete;
  EndingProcess& operator=(const EndingProcess&) = delete;

  /** Waits for the end, and returns the force that the device was given last [N]; NaN when there
   was none before. */
  double LastForce() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it ends as it would have";
    return seen_->before > 0.4 ? seen_->last.load() : std::nan("");
  }

  [[nodiscard]] std::string Describe() const {
    return "end " + std::to_string(static_cast<int>(end_)) +
           (has_loop_ ? ", with a haptic loop" : ", without a haptic loop");
  }

 private:
  struct Seen {
    std::atomic<double> before{0};
    std::atomic<double> last{0};
  };

  [[noreturn]] void Run(const LibraryCase& which) {
    WithdrawForcesAtTheEnd();
    const auto emulator = StartLive(which);
    auto device = OpenDevice(emulator->address(), emulator->surroundings());
    if (!device || !TickUntil(**device, Condition::kReady)) {
      ::_exit(1);
    }
    const auto force = [&] { return emulator->device().truth().command.f.norm(); };
    const auto tick = [&] {
      static_cast<void>((*device)->Read());
      (*device)->Write({Vec3::Zero(), Vec3(0.5, 0, 0)});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    for (int k = 0; k < kMostTicks && force() < 0.4; ++k) {
      tick();
    }
    seen_->before = force();
    seen_->last = force();
    // The observer of the motors pauses between looks: it must not keep their mutex from others.
    std::thread([&] {
      for (;;) {
        seen_->last = force();
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    }).detach();
    if (has_loop_) {
      std::thread([&] {
        for (;;) {
          tick();
        }
      }).detach();
    }
    Come(end_);
    ::_exit(2);
  }

  const End end_;
  const bool has_loop_;
  Seen* seen_;
  pid_t child_;
};

TEST_P(ProcessEndTest, NoEndOfTheProcessLeavesAForceOnTheHand) {
  std::vector<std::unique_ptr<EndingProcess>> processes;
  for (const End end : {End::kTerminate, End::kTick, End::kAbort, End::kSegmentationFault,
                        End::kInterrupt, End::kTermination}) {
    for (const bool has_loop : {true, false}) {
      processes.push_back(std::make_unique<EndingProcess>(*GetParam(), end, has_loop));
    }
  }
  for (const auto& process : processes) {
    EXPECT_EQ(process->LastForce(), 0) << process->Describe();
  }
}

[[noreturn]] void CrashWithNotes(int signal) {
  WithdrawForcesAtTheEnd();
  NoteWork("hvas assemble pump.step");
  NoteStage("contact shapes");
  NoteRecord("/records/pump.hvas");
  static_cast<void>(std::raise(signal));
  ::_exit(0);
}

// Uses up the stack; the compiler cannot tell that it never comes back.
int Recurse(const volatile int* before) {
  const volatile int here = *before + 1;
  return here < 0 ? 0 : Recurse(&here) + here;
}

TEST(CrashNoteTest, CrashSaysWhatWasDoneAndWhereTheRecordIs) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) {
    EXPECT_EXIT(CrashWithNotes(signal), ::testing::KilledBySignal(signal),
                "the program crashed \\(SIG.*a defect of hvas, not of your file"
                "[^$]*it was doing: hvas assemble pump.step"
                "[^$]*at this stage: contact shapes"
                "[^$]*is in: /records/pump.hvas");
  }
}

TEST(CrashNoteTest, OverflowOfTheStackIsReportedAsACrash) {
  const auto overflow = [] {
    WithdrawForcesAtTheEnd();
    NoteWork("hvas inspect deep.step");
    const volatile int start = 0;
    ::_exit(Recurse(&start));
  };
  EXPECT_EXIT(overflow(), ::testing::KilledBySignal(SIGSEGV),
              "it was doing: hvas inspect deep.step");
}

TEST(CrashNoteTest, EndByASignalOfTheUserIsNoCrash) {
  EXPECT_EXIT(CrashWithNotes(SIGTERM), ::testing::KilledBySignal(SIGTERM), "^$");
}

TEST(CrashNoteTest, NotesLongerThanTheirRoomAreCut) {
  const auto crash = [] {
    WithdrawForcesAtTheEnd();
    NoteWork(std::string(100'000, 'x') + "end");
    std::abort();
  };
  EXPECT_EXIT(crash(), ::testing::KilledBySignal(SIGABRT), "it was doing: x{400,600}\n");
}

}  // namespace
}  // namespace hvas::device
