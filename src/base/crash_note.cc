#include "base/crash_note.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>

namespace hvas {
namespace {

struct Text {
  std::array<char, 512> bytes{};
  volatile std::size_t size{0};

  void Set(std::string_view text) noexcept {
    size = 0;
    const std::size_t kept = std::min(text.size(), bytes.size());
    std::copy_n(text.data(), kept, bytes.data());
    size = kept;
  }
};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): a signal handler reaches nothing
// else.
Text noted_work;
Text noted_stage;
Text noted_record;

// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void Write(std::string_view text) noexcept {
  [[maybe_unused]] const ssize_t count = ::write(STDERR_FILENO, text.data(), text.size());
}

void WriteLine(std::string_view before, const Text& text, std::string_view after) noexcept {
  if (text.size > 0) {
    Write(before);
    Write({text.bytes.data(), text.size});
    Write(after);
  }
}

std::string_view NameOf(int signal) noexcept {
  switch (signal) {
    case SIGABRT:
      return "SIGABRT, a check of its own state failed";
    case SIGBUS:
      return "SIGBUS, a file that it reads became shorter, or a disk is full";
    case SIGFPE:
      return "SIGFPE, an integer was divided by zero";
    case SIGILL:
      return "SIGILL, the processor does not know an instruction";
    case SIGSEGV:
      return "SIGSEGV, it reached for memory that is not its own";
    default:
      return "a signal";
  }
}

}  // namespace

void NoteWork(std::string_view work) noexcept {
  noted_work.Set(work);
}

void NoteStage(std::string_view stage) noexcept {
  noted_stage.Set(stage);
}

std::string NotedStage() {
  return {noted_stage.bytes.data(), noted_stage.size};
}

void NoteRecord(std::string_view path) noexcept {
  noted_record.Set(path);
}

void WriteCrashNote(int signal) noexcept {
  Write("\nhvas: the program crashed (");
  Write(NameOf(signal));
  Write("). This is a defect of hvas, not of your file; please report it with these lines.\n");
  WriteLine("  it was doing: ", noted_work, "\n");
  WriteLine("  at this stage: ", noted_stage, "\n");
  WriteLine("  the session up to its last second is in: ", noted_record,
            " (hvas replay, hvas report)\n");
}

}  // namespace hvas
