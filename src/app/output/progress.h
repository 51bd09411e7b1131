#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace hvas::app {

/** True where a person watches stderr: progress is for them only. */
[[nodiscard]] bool IsWatched();

/** One line on a terminal that is written over, and gone when the fraction reaches 1. Not written
 more often than the eye can follow. One thread at a time. */
void ShowProgress(std::string_view stage, double fraction);

/** Makes what notes the stages of the work for CommandWatch and for the message of a crash, and
 shows them to a person who watches. */
[[nodiscard]] std::function<void(std::string_view stage, double fraction)> MakeProgress(
    bool is_quiet);

/** Tells a person who watches how long something goes on whose end nobody knows: "reading the
 record, 3 s", from the first second on. The line is gone when the object is. No other progress may
 be shown meanwhile. */
class Busy {
 public:
  explicit Busy(std::string stage);
  ~Busy();
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  void Run();

  std::string stage_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_done_{false};
  std::thread thread_;
};

}  // namespace hvas::app
