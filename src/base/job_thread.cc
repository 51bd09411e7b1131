#include "base/job_thread.h"

#include <limits>
#include <utility>

namespace hvas {

JobThread::JobThread() : thread_([this](const std::stop_token& stop) { Work(stop); }) {}

JobThread::~JobThread() {
  Stop();
}

bool JobThread::TryPost(Job job, std::size_t most_waiting) {
  {
    const std::lock_guard lock(mutex_);
    if (jobs_.size() >= most_waiting || thread_.get_stop_token().stop_requested()) {
      return false;
    }
    jobs_.push_back(std::move(job));
  }
  changed_.notify_one();
  return true;
}

void JobThread::Post(Job job) {
  (void)TryPost(std::move(job), std::numeric_limits<std::size_t>::max());
}

void JobThread::RequestStop() {
  thread_.request_stop();
}

void JobThread::Stop() {
  RequestStop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void JobThread::Work(const std::stop_token& stop) {
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      (void)changed_.wait(lock, stop, [this] { return !jobs_.empty(); });
      if (stop.stop_requested()) {
        return;
      }
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job(stop);
  }
}

}  // namespace hvas
