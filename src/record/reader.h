#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "record/session_file.h"
#include "record/tick_record.h"

namespace hvas::record {

/** Reads a recorded session, of this schema or an older one, also while it is being recorded;
 everything is checked against its checksum. */
class Reader {
 public:
  /** A span of session time, ends included; all of it by default. */
  struct Span {
    std::int64_t first_ns{std::numeric_limits<std::int64_t>::min()};
    std::int64_t last_ns{std::numeric_limits<std::int64_t>::max()};
  };

  /** Errors: kNotFound for no such file, kUnreadable when it is not a record, kUnsupported when a
   newer HVAS wrote it. */
  static Result<Reader> Open(const std::filesystem::path& path);

  [[nodiscard]] const Meta& meta() const { return meta_; }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  [[nodiscard]] std::int64_t schema() const { return schema_; }

  /** Takes in how far a session that is being recorded has come: meta() and tick_count(). The
   other functions always read what is there when they are called. */
  Result<void> Refresh() { return ReadMeta(); }

  /** False for a session that was cut short, or goes on; what is there is still good. */
  [[nodiscard]] bool is_complete() const { return meta_.contains(kMetaDigest); }

  /** Ticks of all hands, when it was opened or refreshed. */
  [[nodiscard]] std::int64_t tick_count() const { return tick_count_; }

  /** Session time of the last tick that is there [ns]; 0 for none. */
  [[nodiscard]] Result<std::int64_t> ReadLength() {
    return database_.QueryInt("SELECT coalesce(max(last_t_ns), 0) FROM chunk");
  }

  /** Visits ticks in the order recorded until the visitor returns false.
   Errors: kUnreadable at the first damaged chunk; what came before was visited. */
  Result<void> ForEachTick(Span span, const std::function<bool(const TickRecord&)>& visit);
  Result<std::vector<TickRecord>> ReadTicks(Span span);
  Result<std::vector<Event>> ReadEvents();
  /** Commands in the order given. None in a record of before schema 3. */
  Result<std::vector<Command>> ReadCommands();

  /** Visits frames of a span in the order recorded until the visitor returns false. */
  Result<void> ForEachFrame(Span span, const std::function<bool(const Frame&)>& visit);

  /** Errors: kNotFound for one that the record does not have. */
  Result<std::vector<std::byte>> ReadAttachment(const std::string& name);
  [[nodiscard]] Result<std::vector<std::string>> ListAttachments();

  /** Reads everything, as it is at one moment, and returns its digest.
   Errors: kUnreadable when anything is damaged, or a complete record has another digest than the
   one noted at its end. */
  Result<std::string> Verify();

 private:
  Reader(std::filesystem::path path, Database database)
      : path_(std::move(path)), database_(std::move(database)) {}

  using Bytes = std::span<const std::byte>;

  [[nodiscard]] Unexpected Damaged(const std::string& what) const;
  Result<std::vector<std::byte>> UnpackChunk(const Statement& row) const;
  Result<std::string> CalcDigest();
  Result<void> CheckAttachments();

  /** Visits packed ticks, as many bytes each as this file's schema has, in their order. */
  Result<void> ForEachPackedTick(Span span, const std::function<bool(Bytes)>& visit);
  Result<void> CheckKind();
  Result<void> ReadMeta();

  std::filesystem::path path_;
  Database database_;
  Meta meta_;
  std::int64_t tick_count_{0};
  std::int64_t schema_{0};
};

}  // namespace hvas::record
