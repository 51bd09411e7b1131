#include "device/force_withdrawal.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <thread>

#include "base/crash_note.h"
#include "device/device.h"

namespace hvas::device {
namespace {

// More than one person has hands, for tests that open many.
constexpr std::size_t kMostDevices = 64;
// A wrench is handed on by loops of at least 1 kHz. They get many periods, each waited for by
// itself: one long wait would end at once after a pause of the whole machine, before any of them
// has run.
constexpr int kHandOnPeriods = 100;
constexpr std::chrono::milliseconds kHandOnPeriod{1};
constexpr std::array kCrashes{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV};
constexpr std::array kEnds{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
constexpr std::size_t kHandlerStack =
    64 * 1024;  // [bytes] A choice: the handler's frames are small.

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): the end of the process is
// global.
std::array<std::atomic<Device*>, kMostDevices> open_devices{};
std::atomic<bool> is_withdrawn{false};
std::terminate_handler terminate_before = nullptr;
// The handler runs here where the stack itself has overflowed.
std::array<std::byte, kHandlerStack> handler_stack{};

// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void LetOthersHandOn() noexcept {
  for (int period = 0; period < kHandOnPeriods; ++period) {
    std::this_thread::sleep_for(kHandOnPeriod);
  }
}

[[noreturn]] void OnTerminate() {
  WithdrawForces();
  if (terminate_before != nullptr) {
    terminate_before();
  }
  std::abort();
}

/** The handler is reset by then: raised again, the signal does what it does. */
void OnSignal(int signal) {
  WithdrawForces();
  if (std::find(kCrashes.begin(), kCrashes.end(), signal) != kCrashes.end()) {
    WriteCrashNote(signal);
  }
  static_cast<void>(std::raise(signal));
}

}  // namespace

bool AreForcesWithdrawn() noexcept {
  return is_withdrawn.load(std::memory_order_relaxed);
}

void WithdrawForces() noexcept {
  const bool has_devices = std::any_of(open_devices.begin(), open_devices.end(),
                                       [](const auto& slot) { return slot.load() != nullptr; });
  if (is_withdrawn.exchange(true) || !has_devices) {
    return;
  }
  // A haptic thread that is alive writes zero by itself; then this thread may write without it.
  LetOthersHandOn();
  for (const std::atomic<Device*>& slot : open_devices) {
    if (Device* const device = slot.load(); device != nullptr) {
      device->Write({});
    }
  }
  LetOthersHandOn();
}

void WithdrawForcesAtTheEnd() {
  terminate_before = std::set_terminate(&OnTerminate);

  struct sigaction action {};

  action.sa_handler = &OnSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_ONSTACK;
  const stack_t stack{handler_stack.data(), 0, handler_stack.size()};
  ::sigaltstack(&stack, nullptr);
  const auto handle = [&action](int signal) {
    struct sigaction present {};

    if (::sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_DFL) {
      ::sigaction(signal, &action, nullptr);
    }
  };
  std::for_each(kCrashes.begin(), kCrashes.end(), handle);
  std::for_each(kEnds.begin(), kEnds.end(), handle);
}

bool NoteOpenDevice(Device* device) noexcept {
  for (std::atomic<Device*>& slot : open_devices) {
    Device* none = nullptr;
    if (slot.compare_exchange_strong(none, device)) {
      return true;
    }
  }
  return false;
}

void ForgetDevice(const Device* device) noexcept {
  for (std::atomic<Device*>& slot : open_devices) {
    if (slot.load() == device) {
      slot.store(nullptr);
    }
  }
}

}  // namespace hvas::device
