#pragma once

#include <signal.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace hvas::app {

/** Takes SIGINT and SIGTERM for a program that ends in order, and ends it where that takes too
 long, whatever it is doing. */
class EndWatch {
 public:
  /** What the system gives a program, and then some. */
  static constexpr std::chrono::milliseconds kPatience{4000};

  /** Has to be made before any other thread begins: they inherit that the signals are not for them.
   @param patience  From the signal until this has to be gone; else the program ends at once, with
   exit status 1 and a word on standard error. */
  explicit EndWatch(std::chrono::milliseconds patience = kPatience);
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  /** Waits until the user or the system ends the program. */
  void Wait();

  /** Asks for a stop when the user or the system ends the program, or CommandWatch the command. */
  [[nodiscard]] std::stop_token stop() const { return stop_.get_token(); }

 private:
  void Watch(std::chrono::milliseconds patience);

  std::stop_source stop_;
  /** Asks for a stop when the command's time is over (CommandWatch). */
  std::stop_callback<std::function<void()>> out_of_time_;
  sigset_t before_{};  ///< Signals that were not for this thread before.
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_told_{false};  ///< It was told to end.
  bool is_over_{false};
  std::thread thread_;
};

}  // namespace hvas::app
