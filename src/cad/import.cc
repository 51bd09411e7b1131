#include "cad/import.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/check.h"
#include "base/clock.h"
#include "cad/import_arguments.h"
#include "cad/import_cache.h"
#include "cad/import_result.h"
#include "cad/input_file.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

using product::Product;

// Parts that may be left out, as the worker died of them, until the file is refused: each costs its
// time. A choice.
constexpr std::size_t kMaxSkippedParts = 8;
constexpr double kPartShare = 0.2;  // Of the whole time.
constexpr double kLongest = 1e6;    // [s]

/** Attempts at one file until one succeeds or there is nothing left to do without. */
class Attempts {
 public:
  Attempts(std::filesystem::path worker, std::filesystem::path file, const ImportOptions& options,
           const ImportControl& control)
      : file_(std::move(file)), name_(file_.filename().string()), options_(options) {
    const ImportLimits& limits = control.limits;
    const double time = std::clamp(limits.time, 0.0, kLongest);
    const double part_time =
        limits.part_time > 0 ? std::min(limits.part_time, kLongest) : kPartShare * time;
    time_ = time;
    call_.program = std::move(worker);
    call_.deadline_ns =
        (limits.begin_ns != 0 ? limits.begin_ns : MonotonicNs()) + std::llround(1e9 * time);
    call_.part_limit_ns = std::llround(1e9 * part_time);
    const std::uint64_t memory = limits.memory > 0 ? limits.memory : DefaultMemoryLimit();
    call_.memory = ShareOfReader(memory);
    options_.max_bytes = ShareOfProduct(memory);
    call_.stop = control.stop;
    call_.progress = control.progress;
  }

  /** The result in bytes is of the last attempt, and has no warnings of this side. */
  Result<ImportResult> Run();

  /** Warnings about what had to be left out. */
  [[nodiscard]] const Diagnostics& omissions() const { return omissions_; }

  /** False where another run, with more time or memory, might leave less out. */
  [[nodiscard]] bool is_repeatable() const { return is_repeatable_; }

  [[nodiscard]] const MappedFile& output() const { return output_; }

 private:
  [[nodiscard]] std::vector<std::string> Arguments() const;
  bool LeaveOut(const WorkerRun& run);
  [[nodiscard]] Unexpected GiveUp(const WorkerRun& run) const;

  std::filesystem::path file_;
  std::string name_;
  ImportOptions options_;
  WorkerCall call_;
  double time_{0};  // [s]
  Diagnostics omissions_;
  bool is_repeatable_{true};
  MappedFile output_;
};

std::vector<std::string> Attempts::Arguments() const {
  std::vector<std::string> arguments = MakeArguments(options_);
  arguments.insert(arguments.begin(), {"import", file_.string()});
  return arguments;
}

/** Takes out of the next attempt what the last one died over; of several parts that were worked at
 at a time, it first finds out which. @returns false if that is not known,
 or has been tried. */
bool Attempts::LeaveOut(const WorkerRun& run) {
  const bool is_limit = run.fate == WorkerFate::kPartTimeUp || run.fate == WorkerFate::kNoMemory;
  if (!is_limit && run.fate != WorkerFate::kCrashed && run.fate != WorkerFate::kFailed) {
    return false;
  }
  if (run.part && options_.threads != 1) {
    options_.threads = 1;  // To know which one it was; or nothing is wrong with them one by one.
    return true;
  }
  if (run.stage == "tolerances" && options_.with_tolerances) {
    options_.with_tolerances = false;
    omissions_.Warn(
        "tolerances-skipped", name_,
        fmt::format("the reader {} while it read the tolerances; the product has no dimensions, "
                    "tolerances and stated fits",
                    run.Describe()),
        "give the fits in a side file or with --fit, or export the product without PMI");
  } else if (run.part && options_.skipped_parts.size() < kMaxSkippedParts &&
             std::find(options_.skipped_parts.begin(), options_.skipped_parts.end(), *run.part) ==
                 options_.skipped_parts.end()) {
    options_.skipped_parts.push_back(*run.part);
    omissions_.Warn(
        "part-skipped", run.part_name,
        fmt::format("the reader of {} {} while it processed this part; the part is omitted", name_,
                    run.Describe()),
        is_limit ? "raise --time-limit or --memory-limit, or simplify the part"
                 : "heal the part in the CAD system and export it again");
  } else {
    return false;
  }
  is_repeatable_ = is_repeatable_ && !is_limit;
  return true;
}

Unexpected Attempts::GiveUp(const WorkerRun& run) const {
  std::string at;
  if (run.part) {
    at = fmt::format(" while it processed the part \"{}\"", run.part_name);
  } else if (!run.stage.empty()) {
    at = fmt::format(" while it was at the stage \"{}\"", run.stage);
  }
  std::string message = fmt::format("the reader {}{}", run.Describe(), at);
  if (run.fate == WorkerFate::kCrashed) {
    message =
        fmt::format("the reader of CAD files crashed on this file (signal {}){}", run.signal, at);
  } else if (run.fate == WorkerFate::kTimeUp) {
    message = fmt::format("the reader exceeded the time limit of {:g} s{}", time_, at);
  }
  switch (run.fate) {
    case WorkerFate::kCancelled:
      return Fail(ErrorCode::kCancelled, "opening the file was cancelled", name_);
    case WorkerFate::kTimeUp:
    case WorkerFate::kPartTimeUp:
      return Fail(ErrorCode::kOutOfResource, message, name_,
                  "raise --time-limit, or export the product in parts");
    case WorkerFate::kNoMemory:
      return Fail(ErrorCode::kOutOfResource, message, name_,
                  "raise --memory-limit, or export the product in parts");
    case WorkerFate::kNotStarted:
      return Fail(ErrorCode::kNotFound, message, call_.program.string(),
                  "install hvas-cad beside hvas again");
    case WorkerFate::kFinished:
      return Fail(ErrorCode::kInternal, "the reader returned no product", name_,
                  "check that hvas and hvas-cad have the same version");
    case WorkerFate::kCrashed:
    case WorkerFate::kFailed:
      break;
  }
  return Fail(ErrorCode::kUnreadable, message, name_,
              "export the file again from the CAD system, if necessary in parts");
}

Result<ImportResult> Attempts::Run() {
  while (true) {
    call_.arguments = Arguments();
    WorkerRun run = RunWorker(call_);
    if (run.fate == WorkerFate::kFinished) {
      if (auto result = DeserialiseImportResult(run.output.bytes())) {
        output_ = std::move(run.output);
        return std::move(*result);
      }
      return GiveUp(run);
    }
    if (!LeaveOut(run)) {
      return GiveUp(run);
    }
  }
}

/** Hands a result over: first what this side has to say about it. */
Result<Product> Finish(ImportResult result, const ImportControl& control,
                       Diagnostics* diagnostics) {
  for (const Diagnostic& item : result.diagnostics.items()) {
    diagnostics->Add(item);
  }
  if (control.progress) {
    control.progress("done", 1);
  }
  return std::move(result.product);
}

}  // namespace

Result<Product> Import(const std::filesystem::path& file, const ImportOptions& options,
                       Diagnostics* diagnostics, const ImportControl& control) {
  HVAS_DEMAND(diagnostics != nullptr);
  auto path = CheckInput(file);
  if (!path) {
    return Unexpected(path.error());
  }
  auto worker = FindWorker();
  if (!worker) {
    return Unexpected(worker.error());
  }
  std::optional<ImportCache> cache;
  if (control.cache_directory) {
    cache.emplace(*control.cache_directory, *worker, *path, options);
    if (auto result = cache->Load()) {
      return Finish(std::move(*result), control, diagnostics);
    }
  }
  Attempts attempts(*worker, *path, options, control);
  auto result = attempts.Run();
  if (!result) {
    if (control.progress) {
      control.progress("done", 1);
    }
    for (const Diagnostic& item : attempts.omissions().items()) {
      diagnostics->Add(item);
    }
    return Unexpected(result.error());
  }
  const bool is_whole = attempts.omissions().items().empty();
  for (const Diagnostic& item : attempts.omissions().items()) {
    result->diagnostics.Add(item);
  }
  if (cache && result->product && attempts.is_repeatable()) {
    const bool is_kept =
        is_whole ? cache->Store(attempts.output().bytes()) : cache->Store(Serialise(*result));
    if (!is_kept) {
      result->diagnostics.Note(
          "cache-unwritable", control.cache_directory->string(),
          "the product cannot be cached on disk; the file will be read again next time",
          "free disk space there and make the folder writable, or set HVAS_CACHE=off");
    }
  }
  return Finish(std::move(*result), control, diagnostics);
}

}  // namespace hvas::cad
