#include "cad/worker.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>

#include "base/clock.h"
#include "base/descriptor.h"

extern char** environ;

namespace hvas::cad {
namespace {

namespace fs = std::filesystem;

constexpr int kPollMs = 20;                 // How late a request to stop may be noticed.
constexpr std::size_t kLongestLine = 4096;  // [bytes] of progress; what is longer is cut: a choice.

/** The same open file at a number that leaves room for the worker's; closed when there is none. */
Descriptor DuplicateAboveWorkerNumbers(const Descriptor& file) {
  return Descriptor(file.is_open() ? ::fcntl(file.value(), F_DUPFD_CLOEXEC, kOutputDescriptor + 1)
                                   : -1);
}

/** Takes the worker's lines apart; what is no such line is passed over. */
class Listener {
 public:
  Listener(WorkerRun* run, const ProgressFn* progress) : run_(run), progress_(progress) {}

  void Take(std::string_view text) {
    for (const char c : text) {
      if (c == '\n') {
        HandleLine(line_);
        line_.clear();
      } else if (line_.size() < kLongestLine) {
        line_.push_back(c);
      }
    }
  }

  /** Since when the worker has been at the same part, or the same stage without parts. */
  [[nodiscard]] std::int64_t since_ns() const { return since_ns_; }

 private:
  void HandleLine(std::string_view line) {
    const std::size_t first = line.find(' ');
    const std::size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
    if (second == std::string_view::npos) {
      return;
    }
    const std::string_view word = line.substr(0, first);
    const std::string_view number = line.substr(first + 1, second - first - 1);
    const std::string_view name = line.substr(second + 1);
    if (word == "stage") {
      Stage(number, name);
    } else if (word == "part") {
      std::uint32_t part = 0;
      const char* end = number.data() + number.size();
      if (std::from_chars(number.data(), end, part).ptr == end) {
        run_->part = part;
        run_->part_name = name;
        since_ns_ = MonotonicNs();
      }
    }
  }

  void Stage(std::string_view number, std::string_view name) {
    double fraction = 0;
    const char* end = number.data() + number.size();
    if (std::from_chars(number.data(), end, fraction).ptr != end || !(fraction >= 0)) {
      return;
    }
    if (run_->stage != name) {
      run_->stage = name;
      run_->part.reset();
      run_->part_name.clear();
      since_ns_ = MonotonicNs();
    }
    if (*progress_) {
      (*progress_)(name, std::min(fraction, 1.0));
    }
  }

  WorkerRun* run_;
  const ProgressFn* progress_;
  std::string line_;
  std::int64_t since_ns_{MonotonicNs()};
};

/** Starts a program in a process group of its own, with its files and the signals as they are by
 default. @returns 0 or the error's number. */
int Spawn(const WorkerCall& call, int output, int progress, pid_t* child) {
  std::vector<std::string> words{call.program.string()};
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  // Libraries talk; what matters comes by the other two.
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, progress, kProgressDescriptor);
  ::posix_spawn_file_actions_adddup2(&files, output, kOutputDescriptor);
  ::posix_spawn_file_actions_addclosefrom_np(&files, kOutputDescriptor + 1);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t none;
  sigset_t all;
  ::sigemptyset(&none);
  ::sigfillset(&all);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  const int error =
      ::posix_spawn(child, call.program.c_str(), &files, &attributes, argv.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return error;
}

/** Hands on all that is in the pipe. @returns false at its end. */
bool Drain(int pipe, Listener* listener) {
  std::array<char, 4096> buffer{};
  while (true) {
    const ssize_t size = ::read(pipe, buffer.data(), buffer.size());
    if (size > 0) {
      listener->Take({buffer.data(), static_cast<std::size_t>(size)});
    } else if (size == 0 || errno != EINTR) {
      return size != 0;
    }
  }
}

bool HasPartLimit(const WorkerRun& run) {
  return run.part.has_value() || run.stage == "tolerances";
}

/** Why the worker may not go on, if so. */
std::optional<WorkerFate> FindReasonToStop(const WorkerCall& call, const WorkerRun& run,
                                           const Listener& listener) {
  if (call.stop.stop_requested()) {
    return WorkerFate::kCancelled;
  }
  const std::int64_t now_ns = MonotonicNs();
  if (HasPartLimit(run) && now_ns - listener.since_ns() > call.part_limit_ns) {
    return WorkerFate::kPartTimeUp;
  }
  return now_ns > call.deadline_ns ? std::optional(WorkerFate::kTimeUp) : std::nullopt;
}

void ClassifyExit(int status, WorkerRun* run) {
  if (WIFSIGNALED(status)) {
    run->signal = WTERMSIG(status);
    // The kernel kills what takes the machine's last memory, and nobody else sends this.
    run->fate = run->signal == SIGKILL   ? WorkerFate::kNoMemory
                : run->signal == SIGXCPU ? WorkerFate::kTimeUp
                                         : WorkerFate::kCrashed;
    return;
  }
  run->status = WEXITSTATUS(status);
  run->fate = run->status == 0                 ? WorkerFate::kFinished
              : run->status == kWorkerNoMemory ? WorkerFate::kNoMemory
                                               : WorkerFate::kFailed;
}

/** Listens until the worker has ended, or makes an end of it. */
void Attend(const WorkerCall& call, pid_t child, int pipe, WorkerRun* run) {
  Listener listener(run, &call.progress);
  ::fcntl(pipe, F_SETFL, O_NONBLOCK);
  bool is_open = true;
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(child, &status, WNOHANG)) == 0) {
    pollfd wait{pipe, POLLIN, 0};
    // After the end of the pipe the process ends at once, as a rule.
    ::poll(&wait, is_open ? 1 : 0, is_open ? kPollMs : 1);
    is_open = is_open && Drain(pipe, &listener);
    if (const auto reason = FindReasonToStop(call, *run, listener)) {
      ::kill(-child, SIGKILL);
      ::waitpid(child, &status, 0);
      run->fate = *reason;
      return;
    }
  }
  Drain(pipe, &listener);
  ::kill(-child, SIGKILL);  // Nothing that it started outlives it.
  if (ended == child) {
    ClassifyExit(status, run);
  } else {  // This program leaves its children to nobody: how it ended is not known.
    run->fate = WorkerFate::kFailed;
  }
}

// The program or library that has this code; empty where that is not known.
fs::path FindOwnFile() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&RunWorker), &info) == 0 ||
      info.dli_fname == nullptr) {
    return {};
  }
  std::error_code error;
  const fs::path file = fs::canonical(info.dli_fname, error);
  return error ? fs::path() : file;
}

}  // namespace

Result<fs::path> FindWorker(const WorkerPlace& place) {
  const char* told = std::getenv(place.variable);
  if (told != nullptr && *told != '\0') {
    if (::access(told, X_OK) == 0) {
      return fs::path(told);
    }
    return Fail(ErrorCode::kNotFound,
                fmt::format("the program in {} cannot be started", place.variable), told,
                "correct or unset the variable");
  }
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / place.name;
  std::vector<fs::path> places{beside};
  // Of a library in lib or lib/<architecture>, or in a package of Python.
  const fs::path library = FindOwnFile().parent_path();
  for (fs::path folder = library; folder != library.root_path() && places.size() < 4;
       folder = folder.parent_path()) {
    places.push_back(folder / "bin" / place.name);
  }
  places.emplace_back(place.built);
  for (const fs::path& path : places) {
    if (::access(path.c_str(), X_OK) == 0) {
      return path;
    }
  }
  return Fail(ErrorCode::kNotFound, fmt::format("the program {} is missing", place.name),
              beside.string(),
              fmt::format("install it beside hvas, or set {} to its path", place.variable));
}

Result<fs::path> FindWorker() {
  return FindWorker({"hvas-cad", "HVAS_CAD_WORKER", HVAS_BUILT_CAD_WORKER});
}

std::string WorkerRun::Describe() const {
  switch (fate) {
    case WorkerFate::kFinished:
      return "ended well";
    case WorkerFate::kNotStarted:
      return fmt::format("could not be started ({})", ::strerrordesc_np(status));
    case WorkerFate::kCancelled:
      return "was stopped";
    case WorkerFate::kTimeUp:
      return "exceeded the time limit";
    case WorkerFate::kPartTimeUp:
      return "exceeded the time limit for a part";
    case WorkerFate::kNoMemory:
      return signal != 0 ? "was killed, probably for lack of memory" : "exceeded the memory limit";
    case WorkerFate::kCrashed:
      return fmt::format("crashed (signal {})", signal);
    case WorkerFate::kFailed:
      break;
  }
  return fmt::format("failed (exit status {})", status);
}

WorkerRun RunWorker(const WorkerCall& call) {
  WorkerRun run;
  int ends[2] = {-1, -1};
  const Descriptor output =
      DuplicateAboveWorkerNumbers(Descriptor(::memfd_create("hvas-cad", MFD_CLOEXEC)));
  if (!output.is_open() || ::pipe2(ends, O_CLOEXEC) != 0) {
    run.status = errno;
    return run;
  }
  const Descriptor from_worker(ends[0]);
  Descriptor to_us = DuplicateAboveWorkerNumbers(Descriptor(ends[1]));
  WorkerCall limited = call;
  limited.arguments.insert(limited.arguments.end(),
                           {"--parent", std::to_string(::getpid()), "--memory-limit",
                            std::to_string(call.memory), "--time-limit",
                            std::to_string(std::max<std::int64_t>(
                                (call.deadline_ns - MonotonicNs()) / kNsPerSecond, 1))});
  pid_t child = -1;
  run.status = Spawn(limited, output.value(), to_us.value(), &child);
  if (run.status != 0) {
    return run;
  }
  to_us.Close();
  Attend(call, child, from_worker.value(), &run);
  if (run.fate == WorkerFate::kFinished) {
    if (auto mapped = MappedFile::Open(output.value())) {
      run.output = std::move(*mapped);
    }
  }
  return run;
}

}  // namespace hvas::cad
