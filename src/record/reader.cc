#include "record/reader.h"

#include <system_error>

#include <fmt/format.h>

#include "base/digest.h"
#include "record/packing.h"
#include "record/session_digest.h"

namespace hvas::record {

Result<Reader> Reader::Open(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Fail(ErrorCode::kNotFound, "There is no such record.", path.string());
  }
  Result<Database> database = Database::Open(path, Database::Mode::kReadOnly);
  if (!database) {
    return Unexpected(database.error());
  }
  Reader reader(path, std::move(*database));
  for (const auto step : {&Reader::CheckKind, &Reader::ReadMeta}) {
    const Result<void> done = (reader.*step)();
    if (!done) {
      return Unexpected(done.error());
    }
  }
  return reader;
}

Result<void> Reader::CheckKind() {
  const Result<std::int64_t> id = database_.QueryInt("PRAGMA application_id");
  if (!id) {
    return Unexpected(id.error());
  }
  if (*id != kApplicationId) {
    return Fail(ErrorCode::kUnreadable, "This is not a session record.", path_.string(),
                "Name a file that HVAS recorded");
  }
  const Result<std::int64_t> version = database_.QueryInt("SELECT version FROM schema_version");
  if (!version) {
    return Unexpected(version.error());
  }
  if (*version > kSchemaVersion) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("The record has layout {}, newer than {}, the newest known here.",
                            *version, kSchemaVersion),
                path_.string(), "Open it with the version of HVAS that wrote it");
  }
  schema_ = *version;
  return {};
}

Result<void> Reader::ReadMeta() {
  Result<Statement> rows = database_.Prepare("SELECT key, value FROM meta");
  if (!rows) {
    return Unexpected(rows.error());
  }
  for (;;) {
    const Result<bool> row = rows->Step();
    if (!row) {
      return Unexpected(row.error());
    }
    if (!*row) {
      break;
    }
    meta_[rows->ReadText(0)] = rows->ReadText(1);
  }
  const Result<std::int64_t> count =
      database_.QueryInt("SELECT coalesce(sum(count), 0) FROM chunk");
  if (!count) {
    return Unexpected(count.error());
  }
  tick_count_ = *count;
  return {};
}

TickRecord Reader::UnpackOfThisFile(Bytes packed_tick) const {
  return schema_ == 1 ? Unpack1(packed_tick.first<kPackedTickSize1>())
                      : Unpack(packed_tick.first<kPackedTickSize>());
}

Result<void> Reader::ForEachPackedTick(Span span, const std::function<bool(Bytes)>& visit) {
  const std::size_t size = schema_ == 1 ? kPackedTickSize1 : kPackedTickSize;
  Result<Statement> rows = database_.Prepare(
      "SELECT id, count, checksum, ticks FROM chunk WHERE "
      "last_t_ns >= ? AND first_t_ns <= ? "
      "ORDER BY id");
  if (!rows) {
    return Unexpected(rows.error());
  }
  rows->Bind(1, span.first_ns).Bind(2, span.last_ns);
  for (;;) {
    const Result<bool> row = rows->Step();
    if (!row) {
      return Unexpected(row.error());
    }
    if (!*row) {
      return {};
    }
    const Bytes bytes = rows->ReadBlob(3);
    const auto count = static_cast<std::size_t>(rows->ReadInt(1));
    if (bytes.size() != count * size ||
        static_cast<std::int64_t>(Checksum64(bytes)) != rows->ReadInt(2)) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("Chunk {} of the record is damaged.", rows->ReadInt(0)),
                  path_.string(), "Restore the file from a copy");
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!visit(bytes.subspan(i * size, size))) {
        return {};
      }
    }
  }
}

Result<void> Reader::ForEachTick(Span span, const std::function<bool(const TickRecord&)>& visit) {
  return ForEachPackedTick(span, [&](Bytes packed_tick) {
    const TickRecord tick = UnpackOfThisFile(packed_tick);
    return tick.t_ns < span.first_ns || tick.t_ns > span.last_ns || visit(tick);
  });
}

Result<std::vector<TickRecord>> Reader::ReadTicks(Span span) {
  std::vector<TickRecord> ticks;
  const Result<void> done = ForEachTick(span, [&ticks](const TickRecord& tick) {
    ticks.push_back(tick);
    return true;
  });
  if (!done) {
    return Unexpected(done.error());
  }
  return ticks;
}

Result<std::vector<Event>> Reader::ReadEvents() {
  Result<Statement> rows = database_.Prepare(
      "SELECT id, t_ns, kind, occurrence, json, checksum "
      "FROM event ORDER BY id");
  if (!rows) {
    return Unexpected(rows.error());
  }
  std::vector<Event> events;
  for (;;) {
    const Result<bool> row = rows->Step();
    if (!row) {
      return Unexpected(row.error());
    }
    if (!*row) {
      return events;
    }
    Event event{rows->ReadInt(1), rows->ReadText(2), kNoOccurrence, rows->ReadText(4)};
    if (!rows->is_null(3)) {
      event.occurrence = static_cast<std::uint32_t>(rows->ReadInt(3));
    }
    if (static_cast<std::int64_t>(CalcChecksum(event)) != rows->ReadInt(5)) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("Event {} of the record is damaged.", rows->ReadInt(0)),
                  path_.string(), "Restore the file from a copy");
    }
    events.push_back(std::move(event));
  }
}

Result<std::string> Reader::Verify() {
  SessionDigest digest;
  const Result<void> done = ForEachPackedTick({}, [&digest](Bytes packed_tick) {
    digest.AddTick(packed_tick);
    return true;
  });
  if (!done) {
    return Unexpected(done.error());
  }
  const Result<std::vector<Event>> events = ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  for (const Event& event : *events) {
    digest.AddEvent(event);
  }
  const std::string hex = digest.Hex();
  if (is_complete() && meta_.at(kMetaDigest) != hex) {
    return Fail(ErrorCode::kUnreadable, "The record is not the one that was written.",
                path_.string(), "Restore the file from a copy");
  }
  return hex;
}

}  // namespace hvas::record
