#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/served_process.h"
#include "cad/import.h"
#include "cad/input_file.h"

/** `hvas-cad`, the program that holds everything that needs OpenCASCADE, seen from outside, and
 other programs that serve this one (base/served_process.h). The lines that they write about how it
 goes are "stage FRACTION NAME" and "part NUMBER NAME". */
namespace hvas::cad {

using hvas::kOutputDescriptor;
using hvas::kProgressDescriptor;
using hvas::kWorkerNoMemory;
using hvas::kWorkerNoOutput;
using hvas::kWorkerUsage;

/** Where a program is looked for that is installed beside this one. */
struct WorkerPlace {
  const char* name;      ///< Name of its file.
  const char* variable;  ///< Variable of the environment that may have its path.
  const char* built;     ///< Path in the build tree.
};

/** The path in the variable, else the file beside the running program, else in `bin` of the folder
 that the library of HVAS lies in, or of one of the two above it, else that of the build tree that
 this code was built in. Errors: kNotFound. */
[[nodiscard]] Result<std::filesystem::path> FindWorker(const WorkerPlace& place);

/** Finds hvas-cad; its variable is HVAS_CAD_WORKER. Errors: kNotFound. */
[[nodiscard]] Result<std::filesystem::path> FindWorker();

struct WorkerCall {
  std::filesystem::path program;
  std::vector<std::string> arguments;  ///< All words but the program's name.
  std::int64_t deadline_ns{0};         ///< Time of the monotonic clock.
  std::int64_t part_limit_ns{0};       ///< The longest that one part, or the tolerances, may take.
  std::uint64_t memory{0};             ///< Address space [bytes].
  std::stop_token stop;
  ProgressFn progress;
};

enum class WorkerFate {
  kFinished,
  kNotStarted,
  kCancelled,
  kTimeUp,
  kPartTimeUp,  ///< The stage or part that is named took too long.
  kNoMemory,
  kCrashed,  ///< A signal ended it.
  kFailed,   ///< It ended with an exit status that says no more.
};

/** How a worker ended, and at what. */
struct WorkerRun {
  WorkerFate fate{WorkerFate::kNotStarted};
  int signal{0};
  int status{0};
  std::string stage;  ///< The last one that it told of.
  std::optional<std::uint32_t> part;
  std::string part_name;
  MappedFile output;  ///< What one that finished has written.

  /** What happened, for people: "crashed (signal 11)". */
  [[nodiscard]] std::string Describe() const;
};

/** Starts the worker, passes on what it tells, and waits for its end; kills it, and whatever it has
 started, when it may not go on. It dies with the thread that called. */
[[nodiscard]] WorkerRun RunWorker(const WorkerCall& call);

}  // namespace hvas::cad
