#include "app/output/progress.h"

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "base/clock.h"
#include "base/crash_note.h"

namespace hvas::app {
namespace {

// The eye follows no faster: 20 times a second.
constexpr std::int64_t kOftenestNs = 50'000'000;

}  // namespace

bool IsWatched() {
  return isatty(STDERR_FILENO) != 0;
}

void ShowProgress(std::string_view stage, double fraction) {
  static std::string last_stage;
  static std::int64_t last_ns = 0;
  NoteStage(fraction < 1 ? stage : "");
  const std::int64_t now_ns = MonotonicNs();
  if (fraction >= 1) {
    last_stage.clear();
    fmt::print(stderr, "\r\033[K");
  } else if (stage != last_stage || now_ns - last_ns >= kOftenestNs) {
    last_stage = stage;
    last_ns = now_ns;
    constexpr std::size_t kPercent = 7;  // Columns of " 100 %", and one free.
    fmt::print(stderr, "\r\033[K{} {:.0f} %", Shorten(stage, CountColumns() - kPercent),
               100 * fraction);
  } else {
    return;
  }
  std::fflush(stderr);
}

std::function<void(std::string_view stage, double fraction)> MakeProgress(bool is_quiet) {
  return [is_shown = !is_quiet && IsWatched()](std::string_view stage, double fraction) {
    NoteStage(fraction < 1 ? stage : "");
    if (is_shown) {
      ShowProgress(stage, fraction);
    }
  };
}

Busy::Busy(std::string stage) : stage_(std::move(stage)) {
  if (IsWatched()) {
    thread_ = std::thread([this] { Run(); });
  }
}

Busy::~Busy() {
  if (!thread_.joinable()) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    is_done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Busy::Run() {
  constexpr std::chrono::seconds kStep{1};  // Numbers are shown once a second.
  std::unique_lock lock(mutex_);
  int passed_s = 0;
  while (!changed_.wait_for(lock, kStep, [this] { return is_done_; })) {
    constexpr std::size_t kSeconds = 9;  // Columns of ", 99999 s", and one free.
    fmt::print(stderr, "\r\033[K{}, {} s", Shorten(stage_, CountColumns() - kSeconds), ++passed_s);
    std::fflush(stderr);
  }
  if (passed_s > 0) {
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  }
}

}  // namespace hvas::app
