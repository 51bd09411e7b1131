#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace hvas {

/** Does jobs one after the other, in the order in which they were posted, on a thread of its own.
 All functions may be called by any thread; Stop not by a job. */
class JobThread {
 public:
  /** Long jobs look at `stop` now and then. */
  using Job = std::function<void(const std::stop_token& stop)>;

  JobThread();
  ~JobThread();
  JobThread(const JobThread&) = delete;
  JobThread& operator=(const JobThread&) = delete;

  /** Does nothing after RequestStop.
   @param most_waiting  With so many jobs that have not begun, it refuses.
   @returns whether the job will be done. */
  [[nodiscard]] bool TryPost(Job job, std::size_t most_waiting);
  void Post(Job job);

  /** No job begins after it. */
  void RequestStop();

  /** Stops as RequestStop() does, and waits for the job that has begun; what waits is forgotten. */
  void Stop();

 private:
  void Work(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Job> jobs_;
  std::jthread thread_;  ///< The last member: the first that ends.
};

}  // namespace hvas
