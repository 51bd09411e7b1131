#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "studio/workbench.h"

namespace hvas::studio::testing {

/** Events of a workbench, in order; any thread may fill and read it. */
class EventLog {
 public:
  void Add(Json event);

  /** Waits for the first event from index `start` on that fits; none after so many seconds. */
  std::optional<Json> Await(const std::function<bool(const Json&)>& fits, std::size_t start = 0,
                            double seconds = 60);
  std::optional<Json> Await(const std::string& name, std::size_t start = 0, double seconds = 60);

  [[nodiscard]] std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Json> events_;
};

/** Makes the options of a workbench on which every file is simulation::testing::PegInBlock:
 occurrence 0 is the block, 1 the peg; but "cap.step" is CappedCollarUnderClamp, "collar.step"
 PegInBlockInCollar, and a file named "missing" cannot be opened. Contact shapes are made once in a
 program; its recordings are deleted at its end. */
[[nodiscard]] WorkbenchOptions SmallBench();

/** Such a workbench with its events, which keeps its work in a file; empty: it keeps none. */
struct LoggedBench {
  explicit LoggedBench(const std::filesystem::path& work_file);

  ~LoggedBench() { bench.Stop(); }

  LoggedBench(const LoggedBench&) = delete;
  LoggedBench& operator=(const LoggedBench&) = delete;

  EventLog log;
  Workbench bench;
};

}  // namespace hvas::studio::testing
