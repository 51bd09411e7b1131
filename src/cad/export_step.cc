#include "cad/export_step.h"

#include <sys/mman.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/descriptor.h"
#include "cad/import_arguments.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

constexpr double kNsPerSecond = 1e9;  // A definition.

/** Motions in memory, under a name by which a process started from here can read them. */
class MotionFile {
 public:
  explicit MotionFile(const PartMotions& motions)
      : memory_(::memfd_create("hvas-motions", MFD_CLOEXEC)) {
    std::ofstream stream(name());
    for (const auto& [path, X_W] : motions) {
      const Quat& q = X_W.q();
      const Vec3& p = X_W.p();
      stream << fmt::format("{} {} {} {} {} {} {} {}\n", q.w(), q.x(), q.y(), q.z(), p.x(), p.y(),
                            p.z(), path);
    }
  }

  [[nodiscard]] std::string name() const {
    return fmt::format("/proc/{}/fd/{}", ::getpid(), memory_.value());
  }

 private:
  Descriptor memory_;
};

Unexpected Explain(const WorkerRun& run, const std::string& name) {
  const std::string message = fmt::format("the writer {}", run.Describe());
  switch (run.fate) {
    case WorkerFate::kCancelled:
      return Fail(ErrorCode::kCancelled, "the export was cancelled", name);
    case WorkerFate::kTimeUp:
    case WorkerFate::kPartTimeUp:
      return Fail(ErrorCode::kOutOfResource, message, name, "raise --time-limit");
    case WorkerFate::kNoMemory:
      return Fail(ErrorCode::kOutOfResource, message, name, "raise --memory-limit");
    default:
      return Fail(ErrorCode::kUnreadable, message, name, "export the product as .glb instead");
  }
}

}  // namespace

Result<MappedFile> ExportStep(const std::filesystem::path& file, const ImportOptions& options,
                              const ImportControl& control, const PartMotions& motions) {
  const Result<std::filesystem::path> path = CheckInputFile(file);
  if (!path) {
    return Unexpected(path.error());
  }
  const Result<std::filesystem::path> worker = FindWorker();
  if (!worker) {
    return Unexpected(worker.error());
  }
  WorkerCall call;
  call.program = *worker;
  call.arguments = MakeArguments(options);
  call.arguments.insert(call.arguments.begin(), {"export-step", path->string()});
  const MotionFile motion_file(motions);
  if (!motions.empty()) {
    call.arguments.insert(call.arguments.begin() + 2, {"--motions", motion_file.name()});
  }
  const auto limit_ns = static_cast<std::int64_t>(control.limits.time * kNsPerSecond);
  call.deadline_ns = MonotonicNs() + limit_ns;
  call.part_limit_ns = limit_ns;
  call.memory = control.limits.memory > 0 ? control.limits.memory : DefaultMemoryLimit();
  call.stop = control.stop;
  call.progress = control.progress;
  WorkerRun run = RunWorker(call);
  if (control.progress) {
    control.progress("done", 1);
  }
  const std::string name = file.filename().string();
  if (run.fate != WorkerFate::kFinished) {
    return Explain(run, name);
  }
  const auto bytes = run.output.bytes();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with("ISO-10303-21")) {
    return Fail(ErrorCode::kUnreadable, std::string(text.substr(0, text.find('\n'))), name,
                "export the product as .glb instead");
  }
  return std::move(run.output);
}

}  // namespace hvas::cad
