#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "base/job_thread.h"
#include "studio/access.h"

namespace hvas::studio {

/** Threads on which the server does what may take longer than a millisecond, so that the network
 thread never waits: forces off comes by it. What one client asks for delays others as little as
 possible: records have threads of their own, as anybody may have made them, and so have the owner,
 the viewers and all others.
 Any thread may call any function. */
class AnswerLanes {
 public:
  enum class Lane : std::size_t {
    kViewersScenes,
    kViewersRecords,
    kGuestsScenes,
    kGuestsRecords,
    kOwnersScenes,
    kOwnersRecords,
    kDisk,  ///< Reading and writing of some kilobytes at a time.
  };

  /** The lane of a request. */
  [[nodiscard]] static Lane Find(const Visitor& visitor, bool is_of_records) {
    if (visitor.is_owner) {
      return is_of_records ? Lane::kOwnersRecords : Lane::kOwnersScenes;
    }
    if (visitor.role == Role::kViewer) {
      return is_of_records ? Lane::kViewersRecords : Lane::kViewersScenes;
    }
    return is_of_records ? Lane::kGuestsRecords : Lane::kGuestsScenes;
  }

  /** @returns false when kMostWaiting wait already. */
  [[nodiscard]] bool TryPost(Lane lane, JobThread::Job job) {
    constexpr std::size_t kMostWaiting =
        32;  // Of 12 pages, which ask for two things or three: a choice.
    return threads_[static_cast<std::size_t>(lane)].TryPost(std::move(job), kMostWaiting);
  }

  /** Queues what is never refused: there is one such job for each connection at most. */
  void Post(Lane lane, JobThread::Job job) {
    threads_[static_cast<std::size_t>(lane)].Post(std::move(job));
  }

  /** Waits for the jobs that have begun; what waits is forgotten with this object. */
  void Stop() {
    for (JobThread& thread : threads_) {
      thread.RequestStop();
    }
    for (JobThread& thread : threads_) {
      thread.Stop();
    }
  }

 private:
  std::array<JobThread, 7> threads_;
};

}  // namespace hvas::studio
