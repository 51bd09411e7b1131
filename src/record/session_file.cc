#include "record/session_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/digest.h"
#include "record/compression.h"
#include "record/session_digest.h"
#include "record/tick_coding.h"

namespace hvas::record {
namespace {

// Half a second at most is missing on disk (docs/record.md).
constexpr std::int64_t kCommitPeriodNs = kNsPerSecond / 2;
// A chunk of half a second takes a fifth of a page, so that little of it is left empty; of SQLite's
// usual page, of 4 kB, a quarter was.
constexpr std::int64_t kPageSize = 16384;
// How often the journal's content is moved into the file itself: often enough that a file without
// its journal has nearly all, and seldom enough that a run in virtual time does not wait for the
// disk.
constexpr std::int64_t kMovePeriodNs = 2 * kNsPerSecond / 5;

constexpr const char* kTablesOf1 = R"(
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

// What schema 3 added.
constexpr const char* kTablesOf3 = R"(
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

// What schema 4 added.
constexpr const char* kTablesOf4 = R"(
CREATE TABLE seal (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  is_last INTEGER NOT NULL,
  chunks INTEGER NOT NULL, chunk_hash INTEGER NOT NULL,
  events INTEGER NOT NULL, event_hash INTEGER NOT NULL,
  commands INTEGER NOT NULL, command_hash INTEGER NOT NULL,
  frames INTEGER NOT NULL, frame_hash INTEGER NOT NULL,
  entries TEXT NOT NULL,
  hash INTEGER NOT NULL);
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
constexpr const char* kInsertSeal =
    "INSERT INTO seal (t_ns, is_last, chunks, chunk_hash, events, event_hash, commands, "
    "command_hash, frames, frame_hash, entries, hash) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";

/** Begins the transaction in which a record comes to be, up to its tables. The first seal ends it:
 a process that is killed before leaves no record, and none without a seal. */
Result<void> BeginRecord(Database* database, const SessionFileOptions& options) {
  std::string sql = fmt::format(
      "PRAGMA page_size={}; PRAGMA journal_mode=WAL; PRAGMA synchronous={};"
      "PRAGMA application_id={};",
      kPageSize, options.outlives_power ? "FULL" : "NORMAL", kApplicationId);
  if (options.max_bytes > 0) {
    sql += fmt::format("PRAGMA max_page_count={};",
                       std::max<std::int64_t>(options.max_bytes / kPageSize, 1));
  }
  sql += "BEGIN;" + ListTables(kSchemaVersion) +
         fmt::format("INSERT INTO schema_version VALUES ({});", kSchemaVersion);
  return database->Execute(sql);
}

}  // namespace

std::string ListTables(std::int64_t schema) {
  return std::string(kTablesOf1) + (schema >= 3 ? kTablesOf3 : "") +
         (schema >= 4 ? kTablesOf4 : "");
}

Result<SessionFile> SessionFile::Create(const SessionFileOptions& options, const Meta& meta) {
  Result<WriteClaim> claim = WriteClaim::Make(options.path, options.replaces);
  if (!claim) {
    return Unexpected(claim.error());
  }
  Result<Database> database = Database::Open(options.path, Database::Mode::kCreate);
  if (!database) {
    return Unexpected(database.error());
  }
  Result<void> done = BeginRecord(&*database, options);
  if (!done) {
    return Unexpected(done.error());
  }
  Result<Statements> statements = Prepare(&*database);
  if (!statements) {
    return Unexpected(statements.error());
  }
  SessionFile file(std::move(*claim), std::move(*database), std::move(*statements));
  file.chunk_.reserve(kChunkTicks * kPackedTickSize);
  file.transaction_start_ns_ = 0;
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
  for (const char* sql : {kInsertMeta, kInsertChunk, kInsertEvent, kInsertCommand, kInsertFrame,
                          kInsertAttachment, kInsertSeal}) {
    Result<Statement> statement = database->Prepare(sql);
    if (!statement) {
      return Unexpected(statement.error());
    }
    made.push_back(std::move(*statement));
  }
  return Statements{std::move(made[0]), std::move(made[1]), std::move(made[2]), std::move(made[3]),
                    std::move(made[4]), std::move(made[5]), std::move(made[6])};
}

Result<void> SessionFile::AddMeta(const Meta& meta) {
  Result<void> done = BeginIfNeeded(0);
  for (auto it = meta.begin(); done && it != meta.end(); ++it) {
    ledger_.SetMeta(it->first, it->second);
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
  const auto checksum = static_cast<std::int64_t>(CalcChecksum(event));
  ledger_.Add(RowTable::kEvent, std::array{checksum});
  statement.Bind(1, event.t_ns).Bind(2, event.kind).Bind(4, event.json).Bind(5, checksum);
  if (event.occurrence == kNoOccurrence) {
    statement.BindNull(3);
  } else {
    statement.Bind(3, std::int64_t{event.occurrence});
  }
  return Insert(event.t_ns, &statement);
}

Result<void> SessionFile::Add(const Command& command) {
  const auto checksum = static_cast<std::int64_t>(CalcChecksum(command));
  ledger_.Add(RowTable::kCommand, std::array{checksum});
  statements_.command.Bind(1, command.t_ns)
      .Bind(2, command.number)
      .Bind(3, command.kind)
      .Bind(4, command.json)
      .Bind(5, checksum);
  return Insert(command.t_ns, &statements_.command);
}

Result<void> SessionFile::Add(const Frame& frame) {
  const std::span<const std::byte> bytes(frame.bytes);
  const auto checksum = static_cast<std::int64_t>(Checksum64(bytes));
  ledger_.Add(RowTable::kFrame, std::array{frame.t_ns, checksum});
  statements_.frame.Bind(1, frame.t_ns).Bind(2, checksum).Bind(3, bytes);
  return Insert(frame.t_ns, &statements_.frame);
}

Result<void> SessionFile::Add(const Attachment& attachment) {
  const std::vector<std::byte> block = Compress(attachment.bytes);
  const std::span<const std::byte> bytes(block);
  const auto checksum = static_cast<std::int64_t>(Checksum64(bytes));
  ledger_.SetAttachment(attachment.name, checksum);
  statements_.attachment.Bind(1, attachment.name).Bind(2, checksum).Bind(3, bytes);
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
  const std::vector<std::byte> block = EncodeTicks(chunk_);
  const std::span<const std::byte> bytes(block);
  const auto checksum = static_cast<std::int64_t>(Checksum64(bytes));
  ledger_.Add(RowTable::kChunk,
              std::array{chunk_first_ns_, chunk_last_ns_, chunk_ticks_, checksum});
  Result<void> done = statements_.chunk.Bind(1, chunk_first_ns_)
                          .Bind(2, chunk_last_ns_)
                          .Bind(3, chunk_ticks_)
                          .Bind(4, checksum)
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

Result<void> SessionFile::WriteSeal(bool is_last) {
  Seal seal;
  seal.t_ns = chunk_last_ns_;
  seal.is_last = is_last;
  Statement& statement = statements_.seal;
  statement.Bind(1, seal.t_ns).Bind(2, std::int64_t{is_last ? 1 : 0});
  int column = 3;
  for (const RowTable table : kRowTables) {
    const Ledger::Rows& rows = ledger_.rows(table);
    seal.rows[static_cast<std::size_t>(table)] = rows;
    statement.Bind(column++, rows.count);
    statement.Bind(column++, rows.hash);
  }
  std::string entries = PackEntries(ledger_);
  if (entries != sealed_entries_) {
    seal.entries = entries;
    sealed_entries_ = std::move(entries);
  }
  last_seal_ = CalcHash(seal, last_seal_);
  return statement.Bind(column, seal.entries).Bind(column + 1, last_seal_).Run();
}

Result<void> SessionFile::Commit(bool is_last) {
  if (!transaction_start_ns_.has_value()) {
    return claim_.CheckStillThere();
  }
  Result<void> done = claim_.CheckStillThere();
  if (done) {
    done = WriteChunk();
  }
  if (done) {
    done = WriteSeal(is_last);
  }
  if (!done) {
    return done;
  }
  transaction_start_ns_.reset();
  done = database_.Execute("COMMIT");
  return done ? MoveIntoFile() : done;
}

Result<void> SessionFile::MoveIntoFile() {
  const std::int64_t now_ns = MonotonicNs();
  if (moved_ns_ != 0 && now_ns - moved_ns_ < kMovePeriodNs) {
    return {};
  }
  moved_ns_ = now_ns;
  // This moves as much as no reader is in the way of; the rest stays in the journal.
  return database_.Execute("PRAGMA wal_checkpoint(PASSIVE)");
}

Result<void> SessionFile::Close(const Meta& meta) {
  Result<void> done = AddMeta(meta);
  if (done) {
    done = Commit(true);
  }
  if (done) {
    // All is on the disk by now; while somebody reads, it just stays in two files.
    static_cast<void>(database_.Execute("PRAGMA journal_mode=DELETE"));
  }
  return done;
}

}  // namespace hvas::record
