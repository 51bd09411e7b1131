#include "studio/test/small_bench.h"

#include <chrono>
#include <utility>

#include "base/test/temporary_folder.h"
#include "simulation/test/small_products.h"

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

std::optional<Json> EventLog::Await(const std::function<bool(const Json&)>& fits, std::size_t start,
                                    double seconds) {
  std::unique_lock lock(mutex_);
  std::optional<Json> found;
  std::size_t next = start;
  (void)changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
    for (; next < events_.size() && !found; ++next) {
      if (fits(events_[next])) {
        found = events_[next];
      }
    }
    return found.has_value();
  });
  return found;
}

std::optional<Json> EventLog::Await(const std::string& name, std::size_t start, double seconds) {
  return Await([&name](const Json& event) { return event["event"] == name; }, start, seconds);
}

std::size_t EventLog::size() const {
  const std::lock_guard lock(mutex_);
  return events_.size();
}

WorkbenchOptions SmallBench() {
  static const FilesOfThisRun files;
  WorkbenchOptions options;
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
    : bench([&work_file] {
        WorkbenchOptions options = SmallBench();
        options.work_file = work_file;
        return options;
      }()) {
  bench.on_event = [this](Json event) { log.Add(std::move(event)); };
}

}  // namespace hvas::studio::testing
