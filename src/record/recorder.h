#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "record/session_file.h"
#include "record/tick_record.h"

namespace hvas::record {

struct RecorderOptions {
  std::filesystem::path path;    ///< Empty: no file, only the digest.
  bool is_threaded{false};       ///< A thread of its own writes, so that AddTick() never waits.
  std::size_t ring_ticks{8192};  ///< Ticks that may wait for that thread.
  /** Bytes of frames that may wait for it; further ones are counted and lost. */
  std::size_t waiting_frame_bytes{std::size_t{64} << 20};
  std::int64_t max_file_bytes{0};  ///< The file stops growing here; 0: no limit.
  bool replaces{false};            ///< A finished record that is there.
  /** Called once, as soon as it is found that nothing can be written any more: the session goes on
   without a record. From any thread that adds or from the one that writes; may be null, must not
   throw or call the recorder. */
  std::function<void(const Error&)> on_error{};
};

/** Writes a session to an SQLite file as it happens.

 What is added is on disk at most half a second of session time (threaded: of real time, too)
 later, so that killing the process loses less than one second and never the file; threaded, a power
 cut loses no more. A command is never later there than a tick that was added after it. When the
 disk fails, the session goes on: error() tells, and the digest stays complete.

 Threaded, nothing but Finish() waits for the disk. All but AddTick() allocate and lock for a
 moment: any thread but the haptic one. */
class Recorder {
 public:
  /** Errors: kNotFound when the folder does not exist or may not be written, kInvalid when there is
   another kind of file, a record that may not be replaced or one that is being written,
   kOutOfResource when the disk is full. */
  static Result<std::unique_ptr<Recorder>> Create(const RecorderOptions& options, const Meta& meta);

  /** Finishes, if Finish() was not called. */
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /** Adds a tick. When threaded: RT-safe, from one thread, and a tick that finds the ring full is
   counted and lost (returns false). */
  bool AddTick(const TickRecord& tick) noexcept;

  void AddEvent(Event event);
  void AddCommand(Command command);
  /** Returns false for a frame that is counted and lost, as too many wait. */
  bool AddFrame(Frame frame);
  /** Takes the place of what had this name. */
  void AddAttachment(Attachment attachment);

  /** Writes what is left and closes the file. Nothing can be added afterwards.
   Errors: the first one that the disk gave since Create(). */
  Result<void> Finish();

  /** Digest of all so far (threaded: that the writer thread took; all after Finish()). */
  [[nodiscard]] std::string Digest() const;
  [[nodiscard]] std::int64_t tick_count() const;
  [[nodiscard]] std::uint64_t dropped_ticks() const;
  [[nodiscard]] std::uint64_t dropped_frames() const;
  /** What stopped the writing, if anything did. */
  [[nodiscard]] std::optional<Error> error() const;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hvas::record
