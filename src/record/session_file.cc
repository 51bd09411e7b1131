#include "record/session_file.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/digest.h"
#include "record/compression.h"
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
CREATE TABLE command (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  number INTEGER NOT NULL,
  kind TEXT NOT NULL,
  json TEXT NOT NULL,
  checksum INTEGER NOT NULL);
CREATE TABLE frame (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  bytes BLOB NOT NULL);
CREATE TABLE attachment (
  name TEXT PRIMARY KEY,
  checksum INTEGER NOT NULL,
  bytes BLOB NOT NULL);
)";

constexpr const char* kInsertMeta = "INSERT OR REPLACE INTO meta VALUES (?, ?)";
constexpr const char* kInsertChunk =
    "INSERT INTO chunk (first_t_ns, last_t_ns, count, checksum, ticks) VALUES (?, ?, ?, ?, ?)";
constexpr const char* kInsertEvent =
    "INSERT INTO event (t_ns, kind, occurrence, json, checksum) VALUES (?, ?, ?, ?, ?)";
constexpr const char* kInsertCommand =
    "INSERT INTO command (t_ns, number, kind, json, checksum) VALUES (?, ?, ?, ?, ?)";
constexpr const char* kInsertFrame = "INSERT INTO frame (t_ns, checksum, bytes) VALUES (?, ?, ?)";
constexpr const char* kInsertAttachment =
    "INSERT OR REPLACE INTO attachment (name, checksum, bytes) VALUES (?, ?, ?)";

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
    return Fail(ErrorCode::kInvalid, "what is there is not a session record and is kept",
                path.string(), "choose another name for the record");
  }
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::remove(path.string() + suffix, ignored);
  }
  return {};
}

Result<void> CreateSchema(Database* database, const SessionFileOptions& options) {
  std::string sql = fmt::format(
      "PRAGMA page_size={}; PRAGMA journal_mode=WAL; PRAGMA synchronous={};"
      "PRAGMA application_id={};",
      kPageSize, options.outlives_power ? "FULL" : "NORMAL", kApplicationId);
  if (options.max_bytes > 0) {
    sql += fmt::format("PRAGMA max_page_count={};",
                       std::max<std::int64_t>(options.max_bytes / kPageSize, 1));
  }
  sql += "BEGIN;" + std::string(kSchema) +
         fmt::format("INSERT INTO schema_version VALUES ({}); COMMIT;", kSchemaVersion);
  return database->Execute(sql);
}

}  // namespace

Result<SessionFile> SessionFile::Create(const SessionFileOptions& options, const Meta& meta) {
  Result<void> done = RemoveOldRecord(options.path);
  if (!done) {
    return Unexpected(done.error());
  }
  Result<Database> database = Database::Open(options.path, Database::Mode::kCreate);
  if (!database) {
    return Unexpected(database.error());
  }
  done = CreateSchema(&*database, options);
  if (!done) {
    return Unexpected(done.error());
  }
  Result<Statements> statements = Prepare(&*database);
  if (!statements) {
    return Unexpected(statements.error());
  }
  SessionFile file(std::move(*database), std::move(*statements));
  file.chunk_.reserve(kChunkTicks * kPackedTickSize);
  done = file.AddMeta(meta);
  if (done) {
    done = file.Commit();
  }
  if (!done) {
    return Unexpected(done.error());
  }
  return file;
}

Result<SessionFile::Statements> SessionFile::Prepare(Database* database) {
  std::vector<Statement> made;
  for (const char* sql :
       {kInsertMeta, kInsertChunk, kInsertEvent, kInsertCommand, kInsertFrame, kInsertAttachment}) {
    Result<Statement> statement = database->Prepare(sql);
    if (!statement) {
      return Unexpected(statement.error());
    }
    made.push_back(std::move(*statement));
  }
  return Statements{std::move(made[0]), std::move(made[1]), std::move(made[2]),
                    std::move(made[3]), std::move(made[4]), std::move(made[5])};
}

Result<void> SessionFile::AddMeta(const Meta& meta) {
  Result<void> done = BeginIfNeeded(0);
  for (auto it = meta.begin(); done && it != meta.end(); ++it) {
    done = statements_.meta.Bind(1, it->first).Bind(2, it->second).Run();
  }
  return done;
}

Result<void> SessionFile::Add(std::int64_t t_ns, std::span<const std::byte> packed_tick) {
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

Result<void> SessionFile::Add(const Event& event) {
  Statement& statement = statements_.event;
  statement.Bind(1, event.t_ns).Bind(2, event.kind).Bind(4, event.json);
  statement.Bind(5, static_cast<std::int64_t>(CalcChecksum(event)));
  if (event.occurrence == kNoOccurrence) {
    statement.BindNull(3);
  } else {
    statement.Bind(3, std::int64_t{event.occurrence});
  }
  return Insert(event.t_ns, &statement);
}

Result<void> SessionFile::Add(const Command& command) {
  statements_.command.Bind(1, command.t_ns)
      .Bind(2, command.number)
      .Bind(3, command.kind)
      .Bind(4, command.json)
      .Bind(5, static_cast<std::int64_t>(CalcChecksum(command)));
  return Insert(command.t_ns, &statements_.command);
}

Result<void> SessionFile::Add(const Frame& frame) {
  const std::span<const std::byte> bytes(frame.bytes);
  statements_.frame.Bind(1, frame.t_ns)
      .Bind(2, static_cast<std::int64_t>(Checksum64(bytes)))
      .Bind(3, bytes);
  return Insert(frame.t_ns, &statements_.frame);
}

Result<void> SessionFile::Add(const Attachment& attachment) {
  const std::vector<std::byte> block = Compress(attachment.bytes);
  const std::span<const std::byte> bytes(block);
  statements_.attachment.Bind(1, attachment.name)
      .Bind(2, static_cast<std::int64_t>(Checksum64(bytes)))
      .Bind(3, bytes);
  return Insert(transaction_start_ns_.value_or(0), &statements_.attachment);
}

Result<void> SessionFile::Insert(std::int64_t t_ns, Statement* statement) {
  Result<void> done = BeginIfNeeded(t_ns);
  if (done) {
    done = statement->Run();
  }
  return done ? CommitIfDue(t_ns) : done;
}

Result<void> SessionFile::WriteChunk() {
  if (chunk_ticks_ == 0) {
    return {};
  }
  const std::vector<std::byte> block = CompressTicks(chunk_, kPackedTickSize);
  const std::span<const std::byte> bytes(block);
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
  if (done) {
    // All is on the disk by now; while somebody reads, it just stays in two files.
    static_cast<void>(database_.Execute("PRAGMA journal_mode=DELETE"));
  }
  return done;
}

}  // namespace hvas::record
