#include "app/command_watch.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/crash_note.h"
#include "device/force_withdrawal.h"

namespace hvas::app {
namespace {

constexpr double kLongWork = 3600;  // [s]: preparing large products takes minutes. A choice.
constexpr double kLongest = 1e6;    // [s]: what a clock can add to its time. A choice.
// Stages that look at the time themselves say more of it, and end this much before [s]: a choice.
constexpr double kToStages = 0.1;
// From the request to stop until the program is ended [s]: a choice.
constexpr std::chrono::milliseconds kPatience{700};

}  // namespace

CommandWatch& CommandWatch::Get() {
  static CommandWatch watch;
  return watch;
}

CommandWatch::CommandWatch() {
  limits_.begin_ns = MonotonicNs();
}

CommandWatch::~CommandWatch() {
  End();
}

void CommandWatch::Begin(const std::string& file, const WorkLimits& limits, bool is_given) {
  End();
  const std::int64_t begin_ns = limits_.begin_ns;
  limits_ = limits;
  limits_.begin_ns = begin_ns;
  file_ = file;
  is_given_ = is_given;
  is_watched_ = true;
  // Signals are for the threads of the command.
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread([this] { Watch(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void CommandWatch::AllowLongWork() {
  const std::lock_guard lock(mutex_);
  if (!is_given_) {
    limits_.time = std::max(limits_.time, kLongWork);
  }
}

void CommandWatch::End() {
  {
    const std::lock_guard lock(mutex_);
    is_watched_ = false;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

WorkLimits CommandWatch::LimitsOr(const WorkLimits& limits) const {
  const std::lock_guard lock(mutex_);
  return is_watched_ ? limits_ : limits;
}

Error CommandWatch::Translate(const Error& error) const {
  const std::lock_guard lock(mutex_);
  is_reported_ = is_reported_ || is_over_;
  return is_over_ && error.code == ErrorCode::kCancelled ? Explain() : error;
}

int CommandWatch::Conclude(int status) {
  End();
  const bool is_silent = is_over_ && !is_reported_;
  if (is_silent) {
    fmt::print(stderr, "hvas: {}\n", Explain().ToString());
  }
  return is_silent ? 1 : status;
}

void CommandWatch::Watch() {
  std::unique_lock lock(mutex_);
  while (is_watched_) {
    const double left = std::min(limits_.time, kLongest) + kToStages -
                        1e-9 * static_cast<double>(MonotonicNs() - limits_.begin_ns);
    if (left <= 0) {
      break;
    }
    // The limit may be raised meanwhile.
    changed_.wait_for(lock, std::chrono::duration<double>(std::min(left, 1.0)));
  }
  if (!is_watched_) {
    return;
  }
  is_over_ = true;
  lock.unlock();
  stop_.request_stop();
  lock.lock();
  if (!changed_.wait_for(lock, kPatience, [this] { return !is_watched_; })) {
    if (!is_reported_) {
      const std::string text = fmt::format("hvas: {}\n", Explain().ToString());
      [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    }
    device::WithdrawForces();
    ::_exit(1);
  }
}

Error CommandWatch::Explain() const {
  const std::string stage = NotedStage();
  return {ErrorCode::kOutOfResource,
          fmt::format("the command took longer than the {:g} s that it may take{}", limits_.time,
                      stage.empty() ? "" : fmt::format(", at the stage \"{}\"", stage)),
          file_, "raise --time-limit, or export the product in parts"};
}

}  // namespace hvas::app
