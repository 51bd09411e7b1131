#include "record/session_file.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/digest.h"
#include "record/packing.h"
#include "record/session_digest.h"

namespace hvas::record {
namespace {

constexpr std::int64_t kCommitPeriodNs = kNsPerSecond / 2;
constexpr std::int64_t kPageSize = 4096;

constexpr const char* kSchema = R"(
CREATE TABLE schema_version (version INTEGER NOT NULL);
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE chunk (
  id INTEGER PRIMARY KEY,
  first_t_ns INTEGER NOT NULL,
  last_t_ns INTEGER NOT NULL,
  count INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  ticks BLOB NOT NULL);
CREATE TABLE event (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  kind TEXT NOT NULL,
  occurrence INTEGER,
  json TEXT NOT NULL,
  checksum INTEGER NOT NULL);
)";

// A record, or an empty file, may be replaced; anything else is somebody's work.
Result<void> RemoveOldRecord(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) {
    return {};
  }
  bool is_ours = false;
  if (std::filesystem::is_regular_file(status)) {
    is_ours = std::filesystem::file_size(path, ignored) == 0;
    if (!is_ours) {
      Result<Database> old = Database::Open(path, Database::Mode::kReadOnly);
      is_ours = old && old->QueryInt("PRAGMA application_id").value_or(0) == kApplicationId;
    }
  }
  if (!is_ours) {
    return Fail(ErrorCode::kInvalid, "What is there is not a session record and is kept.",
                path.string(), "Choose another name for the record");
  }
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::remove(path.string() + suffix, ignored);
  }
  return {};
}

Result<void> CreateSchema(Database* database, std::int64_t max_bytes) {
  std::string sql = fmt::format(
      "PRAGMA page_size={}; PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;"
      "PRAGMA application_id={};",
      kPageSize, kApplicationId);
  if (max_bytes > 0) {
    sql +=
        fmt::format("PRAGMA max_page_count={};", std::max<std::int64_t>(max_bytes / kPageSize, 1));
  }
  sql += "BEGIN;" + std::string(kSchema) +
         fmt::format("INSERT INTO schema_version VALUES ({}); COMMIT;", kSchemaVersion);
  return database->Execute(sql);
}

}  // namespace

Result<SessionFile> SessionFile::Create(const std::filesystem::path& path, const Meta& meta,
                                        std::int64_t max_bytes) {
  Result<void> done = RemoveOldRecord(path);
  if (!done) {
    return Unexpected(done.error());
  }
  Result<Database> database = Database::Open(path, Database::Mode::kCreate);
  if (!database) {
    return Unexpected(database.error());
  }
  done = CreateSchema(&*database, max_bytes);
  if (!done) {
    return Unexpected(done.error());
  }
  Result<Statement> meta_in = database->Prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)");
  Result<Statement> chunk_in = database->Prepare(
      "INSERT INTO chunk (first_t_ns, last_t_ns, count, "
      "checksum, ticks) VALUES (?, ?, ?, ?, ?)");
  Result<Statement> event_in = database->Prepare(
      "INSERT INTO event (t_ns, kind, occurrence, json, "
      "checksum) VALUES (?, ?, ?, ?, ?)");
  for (const Result<Statement>* statement : {&meta_in, &chunk_in, &event_in}) {
    if (!*statement) {
      return Unexpected(statement->error());
    }
  }
  SessionFile file(std::move(*database),
                   Statements{std::move(*meta_in), std::move(*chunk_in), std::move(*event_in)});
  file.chunk_.reserve(kChunkTicks * kPackedTickSize);
  done = file.AddMeta(meta);
  if (!done) {
    return Unexpected(done.error());
  }
  done = file.Commit();
  if (!done) {
    return Unexpected(done.error());
  }
  return file;
}

Result<void> SessionFile::AddMeta(const Meta& meta) {
  Result<void> done = BeginIfNeeded(0);
  for (auto it = meta.begin(); done && it != meta.end(); ++it) {
    done = statements_.meta.Bind(1, it->first).Bind(2, it->second).Run();
  }
  return done;
}

Result<void> SessionFile::AddTick(std::int64_t t_ns, std::span<const std::byte> packed_tick) {
  Result<void> done = BeginIfNeeded(t_ns);
  if (!done) {
    return done;
  }
  if (chunk_ticks_ == 0) {
    chunk_first_ns_ = t_ns;
  }
  chunk_last_ns_ = t_ns;
  chunk_.insert(chunk_.end(), packed_tick.begin(), packed_tick.end());
  ++chunk_ticks_;
  if (chunk_ticks_ == kChunkTicks) {
    done = WriteChunk();
  }
  return done ? CommitIfDue(t_ns) : done;
}

Result<void> SessionFile::AddEvent(const Event& event) {
  Result<void> done = BeginIfNeeded(event.t_ns);
  if (!done) {
    return done;
  }
  Statement& statement = statements_.event;
  statement.Bind(1, event.t_ns).Bind(2, event.kind).Bind(4, event.json);
  statement.Bind(5, static_cast<std::int64_t>(CalcChecksum(event)));
  if (event.occurrence == kNoOccurrence) {
    statement.BindNull(3);
  } else {
    statement.Bind(3, std::int64_t{event.occurrence});
  }
  done = statement.Run();
  return done ? CommitIfDue(event.t_ns) : done;
}

Result<void> SessionFile::WriteChunk() {
  if (chunk_ticks_ == 0) {
    return {};
  }
  const std::span<const std::byte> bytes(chunk_);
  Result<void> done = statements_.chunk.Bind(1, chunk_first_ns_)
                          .Bind(2, chunk_last_ns_)
                          .Bind(3, chunk_ticks_)
                          .Bind(4, static_cast<std::int64_t>(Checksum64(bytes)))
                          .Bind(5, bytes)
                          .Run();
  chunk_.clear();
  chunk_ticks_ = 0;
  return done;
}

Result<void> SessionFile::BeginIfNeeded(std::int64_t t_ns) {
  if (transaction_start_ns_.has_value()) {
    return {};
  }
  transaction_start_ns_ = t_ns;
  return database_.Execute("BEGIN");
}

Result<void> SessionFile::CommitIfDue(std::int64_t t_ns) {
  return std::llabs(t_ns - transaction_start_ns_.value_or(t_ns)) >= kCommitPeriodNs
             ? Commit()
             : Result<void>();
}

Result<void> SessionFile::Commit() {
  if (!transaction_start_ns_.has_value()) {
    return {};
  }
  Result<void> done = WriteChunk();
  if (!done) {
    return done;
  }
  transaction_start_ns_.reset();
  return database_.Execute("COMMIT");
}

Result<void> SessionFile::Close(const Meta& meta) {
  Result<void> done = AddMeta(meta);
  if (done) {
    done = Commit();
  }
  return done ? database_.Execute("PRAGMA journal_mode=DELETE") : done;
}

}  // namespace hvas::record
