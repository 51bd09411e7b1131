#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>

#include "base/result.h"

namespace hvas {

/** What all the work on one file may take, in this process and in those that it starts. */
struct WorkLimits {
  double time{120};         ///< [s]
  std::uint64_t memory{0};  ///< [bytes]; 0: DefaultMemoryLimit().
  /** Pairs of parts that are looked at, in all steps together. A choice: 16,384 parts that all
   touch one another have 1.3e8. */
  std::uint64_t pairs{1'000'000'000};
  std::int64_t begin_ns{0};  ///< When the work began, by MonotonicNs(); 0: with the watch.
};

/** 4 GiB, or three quarters of the machine's memory where that is less [bytes]. */
[[nodiscard]] std::uint64_t DefaultMemoryLimit();

/** Keeps loops whose length a file decides within the limits: they ask MayGoOn() in every turn, and
 are left when it says no; then the work fails with Explain(). For one thread. */
class WorkWatch {
 public:
  /** The work begins now, or at WorkLimits::begin_ns. Memory that is in use does not count. */
  explicit WorkWatch(const WorkLimits& limits, std::stop_token stop = {});

  /** False from the moment on when a limit is reached or a stop is asked for. Costs some 30 ns, and
   a look at the memory now and then. */
  [[nodiscard]] bool MayGoOn();

  /** MayGoOn(), for each pair of parts that is looked at. */
  [[nodiscard]] bool MayVisitPair();

  /** When the work began, by MonotonicNs(). */
  [[nodiscard]] std::int64_t begin_ns() const { return limits_.begin_ns; }

  /** @param work  What was being done: "finding the mates". @param where  The file.
   @pre MayGoOn() has said no. */
  [[nodiscard]] Error Explain(std::string_view work, std::string where) const;

 private:
  enum class Reason { kNone, kTime, kMemory, kPairs, kStop };

  WorkLimits limits_;
  std::stop_token stop_;
  std::int64_t deadline_ns_{0};
  std::int64_t next_look_ns_{0};  // When the memory is looked at again.
  std::uint64_t memory_before_;
  std::uint64_t pairs_{0};  // That were looked at.
  Reason reason_{Reason::kNone};
};

/** Whether work may go on that has no watch where it has no limits. */
[[nodiscard]] inline bool MayGoOn(WorkWatch* watch) {
  return watch == nullptr || watch->MayGoOn();
}

}  // namespace hvas
