#include "app/end_watch.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <string_view>

#include "app/command_watch.h"
#include "device/force_withdrawal.h"

namespace hvas::app {
namespace {

sigset_t EndSignals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGINT);
  ::sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace

EndWatch::EndWatch(std::chrono::milliseconds patience)
    : out_of_time_(CommandWatch::Get().stop(), [this] { stop_.request_stop(); }) {
  const sigset_t signals = EndSignals();
  ::pthread_sigmask(SIG_BLOCK, &signals, &before_);
  thread_ = std::thread([this, patience] { Watch(patience); });
}

EndWatch::~EndWatch() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  ::pthread_kill(thread_.native_handle(), SIGINT);  // ends the wait where no other has come
  thread_.join();
  // What has come besides was for this end, too.
  const sigset_t signals = EndSignals();
  constexpr timespec kNow{};
  while (::sigtimedwait(&signals, nullptr, &kNow) > 0) {
  }
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void EndWatch::Wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return is_told_; });
}

void EndWatch::Watch(std::chrono::milliseconds patience) {
  const sigset_t signals = EndSignals();
  int signal = 0;
  ::sigwait(&signals, &signal);
  std::unique_lock lock(mutex_);
  is_told_ = true;
  if (!is_over_) {
    stop_.request_stop();
  }
  changed_.notify_all();
  if (!changed_.wait_for(lock, patience, [this] { return is_over_; })) {
    constexpr std::string_view kWord =
        "hvas: stopping took too long, so the program was ended. Completed work is on disk.\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kWord.data(), kWord.size());
    device::WithdrawForces();
    ::_exit(1);
  }
}

}  // namespace hvas::app
