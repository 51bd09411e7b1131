#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "studio/workbench.h"

namespace hvas::studio::testing {

/** What a workbench told, in order; filled and read by different threads. */
class EventLog {
 public:
  void Add(Json event);

  /** The first event from `start` on that fits, once it is there; none after so many seconds. */
  std::optional<Json> Await(const std::function<bool(const Json&)>& fits, std::size_t start = 0,
                            double seconds = 60);
  std::optional<Json> Await(const std::string& name, std::size_t start = 0, double seconds = 60);

  [[nodiscard]] std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Json> events_;
};

/** Of a workbench whose every file is simulation::testing::PegInBlock: occurrence 0 is the block,
 1 the peg. A file named "missing" cannot be opened. Shapes are made once in a program, and
 recordings are gone with it. */
[[nodiscard]] WorkbenchOptions SmallBench();

}  // namespace hvas::studio::testing
