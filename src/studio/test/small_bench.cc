#include "studio/test/small_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/test/temporary_folder.h"
#include "simulation/test/small_models.h"

namespace hvas::studio::testing {
namespace {

/** Shapes and recordings of this program's run, gone with it. */
struct FilesOfThisRun {
  hvas::testing::TemporaryFolder folder;
  hvas::testing::TemporaryFolder recordings;
  std::shared_ptr<contact::ShapeCache> cache{std::make_shared<contact::ShapeCache>(folder.path())};
};

}  // namespace

void EventLog::Add(Json event) {
  {
    const std::lock_guard lock(mutex_);
    events_.push_back(std::move(event));
  }
  changed_.notify_all();
}

void EventLog::Pass(double seconds) {
  const std::int64_t end_ns = clock_.NowNs() + std::llround(1e9 * seconds);
  while (clock_.NowNs() < end_ns) {
    clock_.Advance(std::min(kStepNs, end_ns - clock_.NowNs()));
  }
}

bool EventLog::AwaitTrue(const std::function<bool()>& holds) {
  constexpr std::chrono::minutes kHang(4);      // no claim: below ctest's limit, to say what hangs
  constexpr std::chrono::milliseconds kNap(1);  // for the threads that do not wait by the clock
  const auto end = std::chrono::steady_clock::now() + kHang;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    clock_.Advance(kStepNs);
    std::unique_lock lock(mutex_);
    (void)changed_.wait_for(lock, kNap);
  }
  return true;
}

std::optional<Json> EventLog::Find(const std::function<bool(const Json&)>& fits,
                                   std::size_t start) const {
  const std::lock_guard lock(mutex_);
  const auto begin = events_.begin() + static_cast<std::ptrdiff_t>(std::min(start, events_.size()));
  const auto found = std::find_if(begin, events_.end(), fits);
  return found != events_.end() ? std::optional(*found) : std::nullopt;
}

std::optional<Json> EventLog::Await(const std::function<bool(const Json&)>& fits,
                                    std::size_t start) {
  std::optional<Json> found;
  (void)AwaitTrue([&] {
    found = Find(fits, start);
    return found.has_value();
  });
  return found;
}

std::optional<Json> EventLog::Await(const std::string& name, std::size_t start) {
  return Await([&name](const Json& event) { return event["event"] == name; }, start);
}

std::size_t EventLog::size() const {
  const std::lock_guard lock(mutex_);
  return events_.size();
}

WorkbenchOptions SmallBench(LoopClock* clock) {
  static const FilesOfThisRun files;
  WorkbenchOptions options;
  options.clock = clock;
  options.scenes.shape_cache = files.cache;
  options.recordings_folder = files.recordings.path();
  options.scenes.load = [](const std::filesystem::path& file, const cad::ProgressFn& progress,
                           std::stop_token stop, Diagnostics*) -> Result<product::Product> {
    progress("read", 0.5);
    if (file.filename() == "missing") {
      return Fail(ErrorCode::kNotFound, "there is no such file", file.string(), "name another");
    }
    if (stop.stop_requested()) {
      return Fail(ErrorCode::kCancelled, "stopped", file.string(), "");
    }
    if (file.filename() == "collar.step") {
      return simulation::testing::PegInBlockInCollar();
    }
    return file.filename() == "cap.step" ? simulation::testing::CappedCollarUnderClamp()
                                         : simulation::testing::PegInBlock();
  };
  return options;
}

LoggedBench::LoggedBench(const std::filesystem::path& work_file)
    : bench([this, &work_file] {
        WorkbenchOptions options = SmallBench(log.clock());
        options.work_file = work_file;
        return options;
      }()) {
  bench.on_event = [this](Json event) { log.Add(std::move(event)); };
}

}  // namespace hvas::studio::testing
