#include "record/reader.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/digest.h"
#include "record/compression.h"
#include "record/packing.h"
#include "record/seal_check.h"
#include "record/session_digest.h"
#include "record/table_check.h"
#include "record/tick_coding.h"

namespace hvas::record {
namespace {

bool IsWhole(std::span<const std::byte> bytes, std::int64_t checksum) {
  return static_cast<std::int64_t>(Checksum64(bytes)) == checksum;
}

/** What is read of a table at most; all are choices. */
struct TableLimits {
  const char* rows_name;  ///< What its rows are, for people.
  std::int64_t most_rows;
  std::uint64_t most_bytes;  ///< Of texts and blobs that are kept in memory together.
  bool has_ids;              ///< The first column is a number that grows from row to row.
};

constexpr std::uint64_t kMostText = std::uint64_t{1} << 30;                     // A choice.
constexpr std::uint64_t kAnyBytes = std::numeric_limits<std::uint64_t>::max();  // One at a time.
constexpr TableLimits kMetaLimits{"entries", 1000, kMostText / 4, false};
constexpr TableLimits kAttachmentLimits{"attachments", 100, kMostText / 1024, false};
constexpr TableLimits kOneAttachment{"attachments", 100, kAnyBytes, false};
// A session of a day has a chunk each half second for each two hands, and a frame 30 times a
// second.
constexpr TableLimits kChunkLimits{"chunks", 5'000'000, kAnyBytes, true};
constexpr TableLimits kFrameLimits{"frames", 5'000'000, kAnyBytes, true};
constexpr TableLimits kEventLimits{"events", 500'000, kMostText, true};
constexpr TableLimits kCommandLimits{"commands", 10'000'000, kMostText, true};

/** Checks the rows of a table one after the other. */
class RowCheck {
 public:
  RowCheck(const TableLimits& limits, const std::string& path) : limits_(limits), path_(path) {}

  Result<void> Check(const Statement& row) {
    count_ += 1;
    bytes_ += limits_.most_bytes == kAnyBytes ? 0 : row.CountBytes();
    if (count_ > limits_.most_rows) {
      return Fail(ErrorCode::kUnsupported,
                  fmt::format("the record has more than {} {}, the most that are read",
                              limits_.most_rows, limits_.rows_name),
                  path_, "record the session in parts");
    }
    if (bytes_ > limits_.most_bytes) {
      return Fail(
          ErrorCode::kUnsupported,
          fmt::format("the {} of the record have more than {} bytes, the most that are read",
                      limits_.rows_name, limits_.most_bytes),
          path_, "record the session in parts");
    }
    if (limits_.has_ids && row.ReadInt(0) <= last_id_) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("the {} of the record are damaged: number {} follows {}",
                              limits_.rows_name, row.ReadInt(0), last_id_),
                  path_, "restore the file from a copy");
    }
    last_id_ = limits_.has_ids ? row.ReadInt(0) : 0;
    return {};
  }

 private:
  const TableLimits& limits_;
  const std::string path_;
  std::int64_t count_{0};
  std::uint64_t bytes_{0};
  std::int64_t last_id_{std::numeric_limits<std::int64_t>::min()};
};

/** Visits the rows of a statement that is ready to run, until the visitor fails or returns false.
 Errors: those of the file; kUnsupported beyond the limits. */
Result<void> ForEachRow(Statement* rows, const TableLimits& limits, const std::string& path,
                        const std::function<Result<bool>(const Statement&)>& visit) {
  RowCheck check(limits, path);
  for (;;) {
    Result<bool> goes_on = rows->Step();
    if (goes_on && *goes_on) {
      const auto checked = check.Check(*rows);
      goes_on = checked ? visit(*rows) : Unexpected(checked.error());
    }
    if (!goes_on) {
      return Unexpected(goes_on.error());
    }
    if (!*goes_on) {
      return {};
    }
  }
}

}  // namespace

Result<Reader> Reader::Open(const std::filesystem::path& path) {
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
  // What a writer leaves that is killed before its first transaction ends, at whatever moment: an
  // empty file, or a database without tables.
  const Result<std::int64_t> tables = database_.QueryInt("SELECT count(*) FROM sqlite_master");
  if (!tables) {
    return Unexpected(tables.error());
  }
  if (*tables == 0) {
    return Fail(ErrorCode::kUnreadable,
                "the recording ended before its first second, and nothing of it was written",
                path_.string(), "record the session again");
  }
  const Result<std::int64_t> id = database_.QueryInt("PRAGMA application_id");
  if (!id) {
    return Unexpected(id.error());
  }
  if (*id != kApplicationId) {
    return Fail(ErrorCode::kUnreadable, "this is not a session record", path_.string(),
                "give a file that HVAS recorded");
  }
  const std::string newest = ListTables(kSchemaVersion);
  if (auto checked = CheckTable(&database_, newest, "schema_version"); !checked) {
    return checked;
  }
  const Result<std::int64_t> version = database_.QueryInt("SELECT version FROM schema_version");
  if (!version) {
    return Unexpected(version.error());
  }
  if (*version > kSchemaVersion) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the record has layout version {}, newer than {}, the newest that this "
                            "version of HVAS reads",
                            *version, kSchemaVersion),
                path_.string(), "open it with the version of HVAS that wrote it");
  }
  if (*version < 1) {
    return Fail(ErrorCode::kUnreadable, fmt::format("there is no layout version {}", *version),
                path_.string(), "restore the file from a copy");
  }
  schema_ = *version;
  return CheckTables(&database_, ListTables(schema_));
}

Result<void> Reader::ReadMeta() {
  meta_.clear();
  Result<Statement> rows = database_.Prepare("SELECT key, value FROM meta");
  if (!rows) {
    return Unexpected(rows.error());
  }
  Result<void> done =
      ForEachRow(&*rows, kMetaLimits, path_.string(), [this](const Statement& row) -> Result<bool> {
        meta_[row.ReadText(0)] = row.ReadText(1);
        return true;
      });
  if (!done) {
    return done;
  }
  // No chunk has more or less, whatever it says; UnpackChunk() names those that say so.
  const Result<std::int64_t> count = database_.QueryInt(
      fmt::format("SELECT coalesce(sum(max(0, min(count, {}))), 0) FROM chunk", kChunkTicks));
  if (!count) {
    return Unexpected(count.error());
  }
  tick_count_ = *count;
  return {};
}

Unexpected Reader::Damaged(const std::string& what) const {
  return Fail(ErrorCode::kUnreadable, fmt::format("{} of the record is damaged", what),
              path_.string(), "restore the file from a copy");
}

Result<std::vector<std::byte>> Reader::UnpackChunk(const Statement& row) const {
  const Bytes block = row.ReadBlob(3);
  const std::size_t size = PackedTickSize(schema_);
  const std::int64_t count = row.ReadInt(1);
  std::vector<std::byte> packed;
  if (count > 0 && count <= kChunkTicks && IsWhole(block, row.ReadInt(2))) {
    const auto ticks = static_cast<std::size_t>(count);
    packed = schema_ < 3   ? std::vector<std::byte>(block.begin(), block.end())
             : schema_ < 5 ? DecompressTicks(block, size, ticks)
                           : DecodeTicks(block, ticks, schema_);
  }
  if (packed.empty() || packed.size() != static_cast<std::size_t>(count) * size) {
    return Damaged(fmt::format("Chunk {}", row.ReadInt(0)));
  }
  return packed;
}

Result<void> Reader::ForEachPackedTick(Span span, const std::function<bool(Bytes)>& visit) {
  Result<Statement> rows = database_.Prepare(
      "SELECT id, count, checksum, ticks FROM chunk WHERE "
      "last_t_ns >= ? AND first_t_ns <= ? "
      "ORDER BY id");
  if (!rows) {
    return Unexpected(rows.error());
  }
  rows->Bind(1, span.first_ns).Bind(2, span.last_ns);
  const std::size_t size = PackedTickSize(schema_);
  return ForEachRow(&*rows, kChunkLimits, path_.string(),
                    [&](const Statement& row) -> Result<bool> {
                      const Result<std::vector<std::byte>> packed = UnpackChunk(row);
                      if (!packed) {
                        return Unexpected(packed.error());
                      }
                      for (std::size_t at = 0; at < packed->size(); at += size) {
                        if (!visit(Bytes(*packed).subspan(at, size))) {
                          return false;
                        }
                      }
                      return true;
                    });
}

Result<void> Reader::ForEachTick(Span span, const std::function<bool(const TickRecord&)>& visit) {
  return ForEachPackedTick(span, [&](Bytes packed_tick) {
    const TickRecord tick = Unpack(packed_tick, schema_);
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
      "SELECT id, t_ns, kind, coalesce(occurrence, -1), json, checksum "
      "FROM event ORDER BY id");
  if (!rows) {
    return Unexpected(rows.error());
  }
  std::vector<Event> events;
  const Result<void> done =
      ForEachRow(&*rows, kEventLimits, path_.string(), [&](const Statement& row) -> Result<bool> {
        Event event{row.ReadInt(1), row.ReadText(2), kNoOccurrence, row.ReadText(4)};
        constexpr std::int64_t kNone = -1;  // The query gives it for NULL.
        const std::int64_t occurrence = row.ReadInt(3);
        if (occurrence < kNone || occurrence >= std::int64_t{kNoOccurrence}) {
          return Damaged(fmt::format("Event {}", row.ReadInt(0)));
        }
        if (occurrence != kNone) {
          event.occurrence = static_cast<std::uint32_t>(occurrence);
        }
        if (static_cast<std::int64_t>(CalcChecksum(event)) != row.ReadInt(5)) {
          return Damaged(fmt::format("Event {}", row.ReadInt(0)));
        }
        events.push_back(std::move(event));
        return true;
      });
  if (!done) {
    return Unexpected(done.error());
  }
  return events;
}

Result<std::vector<Command>> Reader::ReadCommands() {
  std::vector<Command> commands;
  if (schema_ < 3) {
    return commands;
  }
  Result<Statement> rows = database_.Prepare(
      "SELECT id, t_ns, number, kind, json, checksum "
      "FROM command ORDER BY id");
  if (!rows) {
    return Unexpected(rows.error());
  }
  const Result<void> done =
      ForEachRow(&*rows, kCommandLimits, path_.string(), [&](const Statement& row) -> Result<bool> {
        Command command{row.ReadInt(1), row.ReadInt(2), row.ReadText(3), row.ReadText(4)};
        if (static_cast<std::int64_t>(CalcChecksum(command)) != row.ReadInt(5)) {
          return Damaged(fmt::format("Command {}", row.ReadInt(0)));
        }
        commands.push_back(std::move(command));
        return true;
      });
  if (!done) {
    return Unexpected(done.error());
  }
  return commands;
}

Result<void> Reader::ForEachFrame(Span span, const std::function<bool(const Frame&)>& visit) {
  if (schema_ < 3) {
    return {};
  }
  Result<Statement> rows = database_.Prepare(
      "SELECT id, t_ns, checksum, bytes FROM frame WHERE t_ns >= ? AND t_ns <= ? ORDER BY id");
  if (!rows) {
    return Unexpected(rows.error());
  }
  rows->Bind(1, span.first_ns).Bind(2, span.last_ns);
  return ForEachRow(&*rows, kFrameLimits, path_.string(),
                    [&](const Statement& row) -> Result<bool> {
                      const Bytes bytes = row.ReadBlob(3);
                      if (!IsWhole(bytes, row.ReadInt(2))) {
                        return Damaged(fmt::format("Frame {}", row.ReadInt(0)));
                      }
                      return visit({row.ReadInt(1), {bytes.begin(), bytes.end()}});
                    });
}

Result<std::vector<std::string>> Reader::ListAttachments() {
  std::vector<std::string> names;
  if (schema_ < 3) {
    return names;
  }
  Result<Statement> rows = database_.Prepare("SELECT name FROM attachment ORDER BY name");
  if (!rows) {
    return Unexpected(rows.error());
  }
  const Result<void> done = ForEachRow(&*rows, kAttachmentLimits, path_.string(),
                                       [&](const Statement& row) -> Result<bool> {
                                         names.push_back(row.ReadText(0));
                                         return true;
                                       });
  if (!done) {
    return Unexpected(done.error());
  }
  return names;
}

Result<std::vector<std::byte>> Reader::ReadAttachment(const std::string& name) {
  // An attachment has at most so many bytes, and so many for each that is stored beyond the first
  // ones: JSON and meshes go into a hundredth of their size at best. Choices.
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  constexpr std::size_t kMostOfSmall = std::size_t{64} << 20;
  constexpr std::size_t kMostRatio = 1000;
  std::optional<std::vector<std::byte>> found;
  if (schema_ >= 3) {
    Result<Statement> rows =
        database_.Prepare("SELECT checksum, bytes FROM attachment WHERE name = ?");
    if (!rows) {
      return Unexpected(rows.error());
    }
    rows->Bind(1, name);
    const Result<void> done = ForEachRow(
        &*rows, kOneAttachment, path_.string(), [&](const Statement& row) -> Result<bool> {
          const Bytes block = row.ReadBlob(1);
          if (!IsWhole(block, row.ReadInt(0))) {
            return Damaged(fmt::format("Attachment \"{}\"", name));
          }
          found = Decompress(block, std::min(kMostBytes, kMostOfSmall + kMostRatio * block.size()));
          if (found->empty() && !std::ranges::equal(block, Compress({}))) {
            return Damaged(fmt::format("Attachment \"{}\"", name));
          }
          return true;
        });
    if (!done) {
      return Unexpected(done.error());
    }
  }
  if (!found) {
    return Fail(ErrorCode::kNotFound, fmt::format("the record has no \"{}\"", name),
                path_.string());
  }
  return std::move(*found);
}

Result<void> Reader::CheckAttachments() {
  const Result<std::vector<std::string>> names = ListAttachments();
  if (!names) {
    return Unexpected(names.error());
  }
  for (const std::string& name : *names) {
    if (const auto bytes = ReadAttachment(name); !bytes) {
      return Unexpected(bytes.error());
    }
  }
  return {};
}

Result<std::string> Reader::CalcDigest() {
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
  const Result<std::vector<Command>> commands = ReadCommands();
  if (!commands) {
    return Unexpected(commands.error());
  }
  for (const Command& command : *commands) {
    digest.AddCommand(command);
  }
  return digest.Hex();
}

Result<std::string> Reader::Verify() {
  // One transaction: all of it as at one moment, whoever goes on writing.
  Result<void> done = database_.Execute("BEGIN");
  if (done) {
    done = ReadMeta();
  }
  if (done && schema_ >= 4) {
    done = CheckSeals(&database_, path_);
  }
  Result<std::string> hex = done ? CalcDigest() : Unexpected(done.error());
  if (hex) {
    done = ForEachFrame({}, [](const Frame&) { return true; });
  }
  if (hex && done) {
    done = CheckAttachments();
  }
  static_cast<void>(database_.Execute("COMMIT"));
  if (hex && !done) {
    return Unexpected(done.error());
  }
  if (hex && is_complete() && meta_.at(kMetaDigest) != *hex) {
    return Fail(ErrorCode::kUnreadable,
                "the record was changed after it was written: the digest of its ticks, events and "
                "commands differs",
                path_.string(), "restore the file from a copy");
  }
  return hex;
}

}  // namespace hvas::record
