#include "record/database.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include "base/regular_file.h"

namespace hvas::record {

/** Bounds the work that a file causes which is read. */
struct ReadGuard {
  /** Begins to count the steps of a statement. */
  void Begin() {
    // Reading a row takes some 20 steps of SQLite's machine, and no row has less than 10 bytes, so
    // that a sound file never comes near this; pages that lead to one another in a circle do.
    constexpr std::int64_t kStepsPerByte = 8;
    constexpr std::int64_t kLeastSteps = 10'000'000;  // A fifth of a second: a choice.
    std::int64_t bytes = 0;
    for (const std::string& file : {path, path + "-wal"}) {
      struct stat status {};

      if (::stat(file.c_str(), &status) == 0) {
        constexpr std::int64_t kBlock = 512;  // Of st_blocks: holes of a file have no rows.
        bytes += std::min<std::int64_t>(status.st_size, kBlock * status.st_blocks);
      }
    }
    steps_left = kLeastSteps + kStepsPerByte * bytes;
  }

  std::string path;
  std::int64_t steps_left{0};
};

namespace {

// SQLite asks this often whether a statement may go on: a thousandth of a second, a choice.
constexpr int kStepsBetweenCalls = 10'000;
// Reading the schema of a record takes some 200 steps: a choice.
constexpr std::int64_t kStepsOfSchema = 5 * kStepsBetweenCalls;

int CountSteps(void* guard) {
  std::int64_t& left = static_cast<ReadGuard*>(guard)->steps_left;
  left -= kStepsBetweenCalls;
  return left < 0 ? 1 : 0;
}

/** What a file may make SQLite do that is read. All are choices above what HVAS' own statements
 and tables need. */
constexpr std::array<std::pair<int, int>, 9> kReadLimits{{
    {SQLITE_LIMIT_LENGTH, 1 << 30},  // Bytes of a value: of an attachment.
    {SQLITE_LIMIT_SQL_LENGTH, 4096},
    {SQLITE_LIMIT_COLUMN, 32},
    {SQLITE_LIMIT_EXPR_DEPTH, 16},
    {SQLITE_LIMIT_FUNCTION_ARG, 4},
    {SQLITE_LIMIT_ATTACHED, 0},
    {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 16},
    {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
    {SQLITE_LIMIT_WORKER_THREADS, 0},
}};

constexpr std::array<std::pair<int, int>, 6> kReadSettings{{
    {SQLITE_DBCONFIG_DEFENSIVE, 1},
    {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
    {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
    {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
    {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
    {SQLITE_DBCONFIG_ENABLE_FTS3_TOKENIZER, 0},
}};

/** SQLite's type of the values of a column by its declaration; 0 where it has none. */
int TypeOf(const char* declared) {
  constexpr std::array<std::pair<std::string_view, int>, 4> kTypes{{{"INTEGER", SQLITE_INTEGER},
                                                                    {"REAL", SQLITE_FLOAT},
                                                                    {"TEXT", SQLITE_TEXT},
                                                                    {"BLOB", SQLITE_BLOB}}};
  for (const auto& [name, type] : kTypes) {
    if (declared != nullptr && name == declared) {
      return type;
    }
  }
  return 0;
}

/** What the file itself is the cause of. */
std::optional<Unexpected> FindFaultOfFile(int code, const std::string& reason,
                                          const std::string& path) {
  switch (code & 0xff) {
    case SQLITE_INTERRUPT:
      return Fail(ErrorCode::kUnreadable,
                  "the file is damaged: reading it takes more steps than a file of its size has "
                  "work for",
                  path, "restore the file from a copy");
    case SQLITE_ERROR:
    case SQLITE_TOOBIG:
    case SQLITE_MISMATCH:
    case SQLITE_CONSTRAINT:
    case SQLITE_AUTH:
    case SQLITE_FORMAT:
    case SQLITE_RANGE:
      return Fail(ErrorCode::kUnreadable, "the record is damaged: " + reason, path,
                  "restore the file from a copy");
    default:
      return std::nullopt;
  }
}

// Turns a result code into words that a person can act on.
Unexpected FailWith(sqlite3* database, int code, const std::string& path, const ReadGuard* guard) {
  const std::string reason = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  if (guard != nullptr) {
    if (auto fault = FindFaultOfFile(code, reason, path)) {
      return *std::move(fault);
    }
  }
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return Fail(ErrorCode::kUnreadable, "this is not a session record: " + reason, path,
                  "give a file that HVAS recorded");
    case SQLITE_CORRUPT:
      return Fail(ErrorCode::kUnreadable, "the record is damaged: " + reason, path,
                  "restore the file from a copy");
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY:
      return Fail(ErrorCode::kNotFound, "the record cannot be opened or written: " + reason, path,
                  "check that the folder exists and is writable");
    case SQLITE_FULL:
      return Fail(ErrorCode::kOutOfResource,
                  "the disk is full, or the record has reached its size limit", path,
                  "free disk space or raise the record's size limit");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Fail(ErrorCode::kOutOfResource, "another program has the record open: " + reason, path,
                  "close that program and try again");
    case SQLITE_NOMEM:
      return Fail(ErrorCode::kOutOfResource, "there is no memory for the record", path,
                  "make memory free");
    case SQLITE_IOERR:
      return Fail(ErrorCode::kOutOfResource, "writing the record failed: " + reason, path,
                  "check the disk and its free space");
    default:
      return Fail(ErrorCode::kInternal, "SQLite: " + reason, path);
  }
}

/** A name under which SQLite neither locks nor looks for a journal. */
std::string MakeUri(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' || c == '_') {
      uri += c;
    } else {
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    }
  }
  return uri + "?immutable=1";
}

/** Whether the files that SQLite opens beside one are regular files, as far as they are there. */
Result<void> CheckSideFiles(const std::filesystem::path& path) {
  for (const char* suffix : {"-wal", "-shm", "-journal"}) {
    auto checked = CheckRegularFile(path.string() + suffix);
    if (!checked && checked.error().code != ErrorCode::kNotFound) {
      return checked;
    }
  }
  return {};
}

bool HasJournal(const std::filesystem::path& path) {
  std::error_code failed;
  return std::filesystem::file_size(path.string() + "-wal", failed) > 0 && !failed;
}

}  // namespace

void Statement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, sqlite3_stmt* statement, std::string path, ReadGuard* guard)
    : database_(database), statement_(statement), path_(std::move(path)), guard_(guard) {
  for (int i = 0; guard_ != nullptr && i < sqlite3_column_count(statement); ++i) {
    types_.push_back(TypeOf(sqlite3_column_decltype(statement, i)));
  }
}

Statement& Statement::Bind(int index, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), index, value);
  return *this;
}

Statement& Statement::Bind(int index, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), index, text.data(), text.size(), SQLITE_TRANSIENT,
                      SQLITE_UTF8);
  return *this;
}

Statement& Statement::Bind(int index, std::span<const std::byte> blob) {
  sqlite3_bind_blob64(statement_.get(), index, blob.data(), blob.size(), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::BindReal(int index, double value) {
  sqlite3_bind_double(statement_.get(), index, value);
  return *this;
}

Statement& Statement::BindNull(int index) {
  sqlite3_bind_null(statement_.get(), index);
  return *this;
}

Result<bool> Statement::Step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    return FailWith(database_, code, path_, guard_);
  }
  if (code == SQLITE_ROW) {
    if (const auto checked = CheckTypes(); !checked) {
      return Unexpected(checked.error());
    }
  }
  return code == SQLITE_ROW;
}

Result<void> Statement::CheckTypes() const {
  for (std::size_t i = 0; i < types_.size(); ++i) {
    const auto column = static_cast<int>(i);
    if (types_[i] != 0 && sqlite3_column_type(statement_.get(), column) != types_[i]) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("the record is damaged: a value of \"{}\" is not of its type {}",
                              sqlite3_column_name(statement_.get(), column),
                              sqlite3_column_decltype(statement_.get(), column)),
                  path_, "restore the file from a copy");
    }
  }
  return {};
}

Result<void> Statement::Run() {
  const Result<bool> step = Step();
  sqlite3_reset(statement_.get());
  if (!step) {
    return Unexpected(step.error());
  }
  return {};
}

std::int64_t Statement::ReadInt(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::ReadReal(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::ReadText(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return text == nullptr
             ? std::string()
             : std::string(reinterpret_cast<const char*>(text), static_cast<std::size_t>(size));
}

std::span<const std::byte> Statement::ReadBlob(int column) const {
  const void* blob = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::byte*>(blob),
          blob == nullptr ? 0 : static_cast<std::size_t>(size)};
}

std::uint64_t Statement::CountBytes() const {
  std::uint64_t bytes = 0;
  for (int i = 0; i < sqlite3_column_count(statement_.get()); ++i) {
    const int type = sqlite3_column_type(statement_.get(), i);
    if (type == SQLITE_TEXT || type == SQLITE_BLOB) {
      bytes += static_cast<std::uint64_t>(sqlite3_column_bytes(statement_.get(), i));
    }
  }
  return bytes;
}

void Database::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void Database::GuardEnd::operator()(ReadGuard* guard) const {
  delete guard;
}

Result<Database> Database::OpenName(const std::string& name, int flags, std::string path) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &raw, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  Database database(raw, std::move(path));
  if (code != SQLITE_OK) {
    return FailWith(raw, code, database.path_, nullptr);
  }
  sqlite3_busy_timeout(raw, 1000);
  return database;
}

Result<Database> Database::Open(const std::filesystem::path& path, Mode mode) {
  return mode == Mode::kCreate
             ? OpenName(path.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, path.string())
             : OpenToRead(path);
}

Result<Database> Database::OpenToRead(const std::filesystem::path& path) {
  const auto file = RegularFile::Open(path);
  if (!file) {
    return Unexpected(file.error());
  }
  if (file->size() > kMostFileBytes) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the file has {} bytes, more than the {} that are read", file->size(),
                            kMostFileBytes),
                path.string(), "record the session in parts");
  }
  if (const auto checked = CheckSideFiles(path); !checked) {
    return Unexpected(checked.error());
  }
  if (!HasJournal(path)) {
    // Nobody writes: the file alone is everything.
    return OpenGuarded(MakeUri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, path);
  }
  auto database = OpenGuarded(path.string(), SQLITE_OPEN_READONLY, path);
  // The first access shows whether the files beside it, that a journal needs, can be made.
  return !database && database.error().code == ErrorCode::kNotFound ? OpenUnwritable(path)
                                                                    : std::move(database);
}

Result<Database> Database::OpenGuarded(const std::string& name, int flags,
                                       const std::filesystem::path& path) {
  auto database = OpenName(name, flags, path.string());
  if (!database) {
    return database;
  }
  if (const auto guarded = database->Guard(); !guarded) {
    return Unexpected(guarded.error());
  }
  return database;
}

Result<void> Database::Guard() {
  sqlite3* const raw = database_.get();
  for (const auto& [limit, most] : kReadLimits) {
    sqlite3_limit(raw, limit, most);
  }
  for (const auto& [setting, value] : kReadSettings) {
    sqlite3_db_config(raw, setting, value, nullptr);
  }
  guard_.reset(new ReadGuard{path_, kStepsOfSchema});
  sqlite3_progress_handler(raw, kStepsBetweenCalls, &CountSteps, guard_.get());
  // A mapped file that somebody makes shorter would end the program.
  auto done = Execute("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0");
  if (done) {
    done = Execute("SELECT count(*) FROM sqlite_master");  // Reads the schema.
  }
  return done;
}

Result<Database> Database::OpenInMemory() {
  return OpenName(":memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, "database in memory");
}

Result<std::string> Database::Serialize() const {
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(database_.get(), "main", &size, 0);
  if (bytes == nullptr) {
    return Fail(ErrorCode::kOutOfResource, "there is no memory for a copy of the database", path_,
                "make memory free, or the tables smaller");
  }
  std::string copy(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  sqlite3_free(bytes);
  return copy;
}

Result<Database> Database::OpenUnwritable(const std::filesystem::path& path) {
  std::error_code failed;
  const std::filesystem::path journal = path.string() + "-wal";
  auto folder = ScratchFolder::Make();
  if (!folder) {
    return Unexpected(folder.error());
  }
  const std::filesystem::path copy = folder->path() / "record";
  std::filesystem::copy_file(path, copy, failed);
  if (!failed) {
    std::filesystem::copy_file(journal, copy.string() + "-wal", failed);
  }
  if (failed) {
    return Fail(ErrorCode::kOutOfResource,
                "the folder of the record and its journal is not writable, and there is no space "
                "for a copy: " +
                    failed.message(),
                path.string(), "copy both files to a folder of your own");
  }
  auto database = OpenGuarded(copy.string(), SQLITE_OPEN_READONLY, path);
  if (database) {
    database->copy_ = std::move(*folder);
  }
  return database;
}

Result<void> Database::Execute(const std::string& sql) {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    return FailWith(database_.get(), code, path_, guard_.get());
  }
  return {};
}

Result<Statement> Database::Prepare(std::string_view sql) {
  if (guard_ != nullptr) {
    guard_->Begin();
  }
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &raw, nullptr);
  if (code != SQLITE_OK) {
    return FailWith(database_.get(), code, path_, guard_.get());
  }
  return Statement(database_.get(), raw, path_, guard_.get());
}

Result<std::int64_t> Database::QueryInt(std::string_view sql) {
  Result<Statement> statement = Prepare(sql);
  if (!statement) {
    return Unexpected(statement.error());
  }
  const Result<bool> row = statement->Step();
  if (!row) {
    return Unexpected(row.error());
  }
  if (!*row) {
    return Fail(ErrorCode::kUnreadable, "the record lacks an entry", path_);
  }
  return statement->ReadInt(0);
}

}  // namespace hvas::record
