#include "base/parallel.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace hvas {
namespace {

constexpr std::chrono::milliseconds kNowAndThen(250);

void RunAlone(std::size_t count, const std::function<void(std::size_t)>& work,
              const std::function<void(std::size_t)>& progress) {
  for (std::size_t i = 0; i < count; ++i) {
    if (progress) {
      progress(i);
    }
    work(i);
  }
}

/** Hands indices out to threads and keeps the account. */
class Crew {
 public:
  Crew(std::size_t count, const std::function<void(std::size_t)>& work)
      : count_(count), work_(work) {}

  void Run(std::size_t size, const std::function<void(std::size_t)>& progress) {
    std::vector<std::thread> threads;
    threads.reserve(size);
    for (std::size_t i = 0; i < size; ++i) {
      threads.emplace_back([this] { Work(); });
    }
    Watch(size, progress);
    for (std::thread& thread : threads) {
      thread.join();
    }
    if (failure_) {
      std::rethrow_exception(failure_);
    }
  }

 private:
  void Work() {
    std::unique_lock lock(mutex_);
    while (next_ < count_ && !failure_) {
      const std::size_t index = next_++;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work_(index);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      ++done_;
      if (failure && (!failure_ || index < failed_)) {
        failure_ = failure;
        failed_ = index;
      }
      changed_.notify_one();
    }
    ++ended_;
    changed_.notify_one();
  }

  void Watch(std::size_t size, const std::function<void(std::size_t)>& progress) {
    std::unique_lock lock(mutex_);
    while (ended_ < size) {
      changed_.wait_for(lock,
                        kNowAndThen);  // one index may take long, and work has news of its own
      if (progress) {
        const std::size_t done = done_;
        lock.unlock();
        progress(done);
        lock.lock();
      }
    }
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_{0};
  std::size_t done_{0};
  std::size_t ended_{0};
  std::exception_ptr failure_;
  std::size_t failed_{0};
};

}  // namespace

void ForEachIndex(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work,
                  const std::function<void(std::size_t)>& progress) {
  const std::size_t wanted = threads > 0 ? threads : std::thread::hardware_concurrency();
  const std::size_t size = std::min(wanted, count);
  if (size <= 1) {
    RunAlone(count, work, progress);
  } else {
    Crew(count, work).Run(size, progress);
  }
}

}  // namespace hvas
