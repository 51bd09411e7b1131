#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "record/session_file.h"
#include "record/tick_record.h"

namespace hvas::record {

struct RecorderOptions {
  std::filesystem::path path;      ///< Empty: no file, only the digest.
  bool is_threaded{false};         ///< A thread of its own writes, so that AddTick() never waits.
  std::size_t ring_ticks{8192};    ///< Ticks that may wait for that thread.
  std::int64_t max_file_bytes{0};  ///< The file stops growing here; 0: no limit.
};

/** Writes a session to an SQLite file as it happens.

 Ticks and events are on disk at most half a second of session time (threaded: of real time, too)
 after they were added, so that killing the process loses less than one second and never the file.
 When the disk fails, the session goes on: error() tells, and the digest stays complete. */
class Recorder {
 public:
  /** Errors: kNotFound when the folder does not exist or may not be written, kInvalid when there is
   another kind of file, kOutOfResource when the disk is full. */
  static Result<std::unique_ptr<Recorder>> Create(const RecorderOptions& options, const Meta& meta);

  /** Finishes, if Finish() was not called. */
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /** Adds a tick. When threaded: RT-safe, from one thread, and a tick that finds the ring full is
   counted and lost (returns false). */
  bool AddTick(const TickRecord& tick) noexcept;

  /** Adds an event; from any thread, but not from the haptic tick: it allocates and locks. */
  void AddEvent(const Event& event);

  /** Writes what is left and closes the file. Nothing can be added afterwards.
   Errors: the first one that the disk gave since Create(). */
  Result<void> Finish();

  /** Of all ticks and events so far (threaded: that the writer thread took; all after Finish()). */
  [[nodiscard]] std::string Digest() const;
  [[nodiscard]] std::int64_t tick_count() const;
  [[nodiscard]] std::uint64_t dropped_ticks() const;
  /** What stopped the writing, if anything did. */
  [[nodiscard]] std::optional<Error> error() const;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hvas::record
