#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "base/result.h"
#include "base/work_watch.h"

namespace hvas::app {

/** The one watch over a command that works on a CAD file, from the start of the program to the last
 byte that it writes. Its stages are asked to stop when the time is over (stop()), and name
 themselves by NoteStage() (base/crash_note.h). What does not stop is ended with the program, so
 that no stage can go on for long. All its errors name the file, the stage, the limit and the
 option. */
class CommandWatch {
 public:
  /** The watch of this program. The time begins with the first call. */
  [[nodiscard]] static CommandWatch& Get();

  ~CommandWatch();
  CommandWatch(const CommandWatch&) = delete;
  CommandWatch& operator=(const CommandWatch&) = delete;

  /** Begins to watch. @param file  What the command works on. @param is_given  Whether the user has
   given the limits; else AllowLongWork() gives more time. */
  void Begin(const std::string& file, const WorkLimits& limits, bool is_given);

  /** Gives the time that preparing, planning and running a product may take, an hour, where the
   user has not limited it. */
  void AllowLongWork();

  /** Ends the watch: a person works from now on, with time of their own. */
  void End();

  /** Asks for a stop when the time is over. */
  [[nodiscard]] std::stop_token stop() const { return stop_.get_token(); }

  /** The limits of the command, and since when they count; those given where nothing is watched. */
  [[nodiscard]] WorkLimits LimitsOr(const WorkLimits& limits) const;

  /** The error to report in place of one that came of a stop: that the time is over, if it is. */
  [[nodiscard]] Error Translate(const Error& error) const;

  /** Ends the watch when all is written, and reports that the time was over, unless an error was
   reported by Translate(). @returns the exit status. */
  [[nodiscard]] int Conclude(int status);

 private:
  CommandWatch();

  void Watch();
  [[nodiscard]] Error Explain() const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::stop_source stop_;
  std::string file_;
  WorkLimits limits_;
  bool is_given_{false};
  bool is_watched_{false};
  bool is_over_{false};
  mutable bool is_reported_{false};
  std::thread thread_;
};

}  // namespace hvas::app
