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

/** Reads a recorded session, of this schema or an older one; every chunk and event is checked
 against its checksum. */
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

  /** False for a session that was cut short; what is there is still good. */
  [[nodiscard]] bool is_complete() const { return meta_.contains(kMetaDigest); }

  /** Of all hands. */
  [[nodiscard]] std::int64_t tick_count() const { return tick_count_; }

  /** Visits ticks in the order recorded until the visitor returns false.
   Errors: kUnreadable at the first damaged chunk; what came before was visited. */
  Result<void> ForEachTick(Span span, const std::function<bool(const TickRecord&)>& visit);
  Result<std::vector<TickRecord>> ReadTicks(Span span);
  Result<std::vector<Event>> ReadEvents();

  /** Reads everything and returns its digest.
   Errors: kUnreadable when a chunk or event is damaged, or a complete record has another digest
   than the one noted at its end. */
  Result<std::string> Verify();

 private:
  Reader(std::filesystem::path path, Database database)
      : path_(std::move(path)), database_(std::move(database)) {}

  using Bytes = std::span<const std::byte>;

  /** Visits packed ticks, as many bytes each as this file's schema has, in their order. */
  Result<void> ForEachPackedTick(Span span, const std::function<bool(Bytes)>& visit);
  [[nodiscard]] TickRecord UnpackOfThisFile(Bytes packed_tick) const;
  Result<void> CheckKind();
  Result<void> ReadMeta();

  std::filesystem::path path_;
  Database database_;
  Meta meta_;
  std::int64_t tick_count_{0};
  std::int64_t schema_{0};
};

}  // namespace hvas::record
