#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/loop_clock.h"
#include "studio/workbench.h"

namespace hvas::studio::testing {

/** Events of a workbench, in order, and the time of its sessions, which stands still unless the
 test waits here: a busy machine is only slow. Any thread may add events; the test's thread alone
 waits. */
class EventLog {
 public:
  /** Session time of one step of a wait [ns]: of an input of a page, at 100 a second. */
  static constexpr std::int64_t kStepNs = 10'000'000;

  void Add(Json event);

  /** Clock for WorkbenchOptions. */
  [[nodiscard]] SteeredClock* clock() { return &clock_; }

  /** Lets session time pass. */
  void Pass(double seconds);

  /** Lets session time pass until a condition holds. @returns false when the test hangs. */
  [[nodiscard]] bool AwaitTrue(const std::function<bool()>& holds);

  /** Finds the first event from index `start` on that fits. */
  [[nodiscard]] std::optional<Json> Find(const std::function<bool(const Json&)>& fits,
                                         std::size_t start = 0) const;

  /** Lets session time pass until there is an event from index `start` on that fits. @returns none
   when the test hangs. */
  std::optional<Json> Await(const std::function<bool(const Json&)>& fits, std::size_t start = 0);
  std::optional<Json> Await(const std::string& name, std::size_t start = 0);

  [[nodiscard]] std::size_t size() const;

 private:
  SteeredClock clock_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Json> events_;
};

/** Makes the options of a workbench on which every file is simulation::testing::PegInBlock:
 occurrence 0 is the block, 1 the peg; but "cap.step" is CappedCollarUnderClamp, "collar.step"
 PegInBlockInCollar, and a file named "missing" cannot be opened. Contact shapes are made once in a
 program; its recordings are deleted at its end.
 @param clock  Of the sessions. */
[[nodiscard]] WorkbenchOptions SmallBench(LoopClock* clock = &MachineClock());

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
