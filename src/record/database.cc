#include "record/database.h"

#include <cctype>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

namespace hvas::record {
namespace {

// Turns a result code into words that a person can act on.
Unexpected FailWith(sqlite3* database, int code, const std::string& path) {
  const std::string reason = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code);
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

}  // namespace

void Statement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
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
  if (code == SQLITE_ROW || code == SQLITE_DONE) {
    return code == SQLITE_ROW;
  }
  return FailWith(database_, code, path_);
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

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

void Database::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

Result<Database> Database::OpenName(const std::string& name, int flags, std::string path) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &raw, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  Database database(raw, std::move(path));
  if (code != SQLITE_OK) {
    return FailWith(raw, code, database.path_);
  }
  sqlite3_busy_timeout(raw, 1000);
  return database;
}

Result<Database> Database::Open(const std::filesystem::path& path, Mode mode) {
  if (mode == Mode::kCreate) {
    return OpenName(path.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, path.string());
  }
  auto database = OpenName(path.string(), SQLITE_OPEN_READONLY, path.string());
  if (!database) {
    return database;
  }
  // The first access tells whether the files beside it, that a journal needs, can be made.
  const auto accessed = database->QueryInt("SELECT count(*) FROM sqlite_master");
  if (!accessed && accessed.error().code == ErrorCode::kNotFound) {
    return OpenUnwritable(path);
  }
  return database;
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
  const auto journal_bytes = std::filesystem::file_size(journal, failed);
  if (failed || journal_bytes == 0) {
    // Nobody writes: the file alone is everything.
    return OpenName(MakeUri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, path.string());
  }
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
  auto database = OpenName(copy.string(), SQLITE_OPEN_READONLY, path.string());
  if (database) {
    database->copy_ = std::move(*folder);
  }
  return database;
}

Result<void> Database::Execute(const std::string& sql) {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    return FailWith(database_.get(), code, path_);
  }
  return {};
}

Result<Statement> Database::Prepare(std::string_view sql) {
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &raw, nullptr);
  if (code != SQLITE_OK) {
    return FailWith(database_.get(), code, path_);
  }
  return Statement(database_.get(), raw, path_);
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
