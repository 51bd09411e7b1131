#include "campaign/table_file.h"

#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/file_lock.h"
#include "base/regular_file.h"

namespace hvas::campaign {

struct TableFile::State {
  std::filesystem::path file;
  std::filesystem::path unfinished;
  Descriptor claim;  // The unfinished file, locked: no other program writes to it.
  std::optional<record::Database> database;
  std::optional<RowTable> rows;  // Goes before the database.
};

namespace {

Result<void> WithName(Result<void> done, const std::filesystem::path& file) {
  if (done) {
    return done;
  }
  Error error = std::move(done.error());
  error.where = file.string();
  error.message = "the table of all runs cannot be written: " + error.message;
  return Unexpected(std::move(error));
}

/** Whether a table may take the place of what has this name: nothing, or a database of SQLite, as
 of a table before. Errors: kInvalid. */
Result<void> CheckPlace(const std::filesystem::path& file) {
  constexpr std::string_view kMagic = "SQLite format 3";  // Of https://sqlite.org/fileformat.html.
  std::error_code failed;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, failed))) {
    return {};
  }
  const auto begin = ReadFileHead(file, kMagic.size());
  if (begin && *begin == kMagic) {
    return {};
  }
  return Fail(ErrorCode::kInvalid, "the file is there, and is no table of runs", file.string(),
              "choose another name with --table, or delete the file");
}

}  // namespace

TableFile::TableFile(std::unique_ptr<State> state) : state_(std::move(state)) {}

TableFile::TableFile(TableFile&& other) noexcept = default;

TableFile::~TableFile() {
  if (state_) {
    state_->rows.reset();
    state_->database.reset();
    std::error_code ignored;
    std::filesystem::remove(state_->unfinished, ignored);
  }
}

Result<TableFile> TableFile::Create(const std::filesystem::path& file) {
  if (const auto place = CheckPlace(file); !place) {
    return Unexpected(place.error());
  }
  auto state = std::make_unique<State>();
  state->file = file;
  state->unfinished = file.string() + ".unfinished";
  int error = 0;
  state->claim = OpenLocked(state->unfinished, 0666, &error);
  if (error == EWOULDBLOCK) {
    return Fail(ErrorCode::kInvalid, "another program is writing this table", file.string(),
                "choose another name with --table, or wait for that program");
  }
  if (error != 0 || ::ftruncate(state->claim.value(), 0) != 0) {
    error = error != 0 ? error : errno;
    return Fail(error == ENOENT ? ErrorCode::kNotFound : ErrorCode::kInvalid,
                "cannot be written: " + std::error_code(error, std::generic_category()).message(),
                state->unfinished.string(), "check the path and its permissions");
  }
  auto database = record::Database::Open(state->unfinished, record::Database::Mode::kCreate);
  if (!database) {
    return Unexpected(database.error());
  }
  state->database.emplace(*std::move(database));
  TableFile table(std::move(state));
  // A table that is not finished is removed, so that it needs no journal.
  auto done = table.state_->database->Execute("PRAGMA journal_mode = OFF");
  done = done ? table.state_->database->Execute("BEGIN") : done;
  if (!done) {
    return Unexpected(WithName(std::move(done), file).error());
  }
  auto rows = RowTable::Create(&*table.state_->database);
  if (!rows) {
    return Unexpected(rows.error());
  }
  table.state_->rows.emplace(*std::move(rows));
  return table;
}

Result<void> TableFile::Add(const RunResult& row) {
  return WithName(state_->rows->Add(row), state_->file);
}

Result<void> TableFile::Finish() {
  auto done = WithName(state_->database->Execute("COMMIT"), state_->file);
  if (!done) {
    return done;
  }
  state_->rows.reset();
  state_->database.reset();
  std::error_code failed;
  std::filesystem::rename(state_->unfinished, state_->file, failed);
  if (failed) {
    return Fail(ErrorCode::kInvalid, "cannot be written: " + failed.message(),
                state_->file.string(), "choose another name");
  }
  state_.reset();  // Another program may have begun an unfinished file of this name by now.
  return {};
}

}  // namespace hvas::campaign
