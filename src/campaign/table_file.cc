#include "campaign/table_file.h"

#include <optional>
#include <system_error>
#include <utility>

namespace hvas::campaign {

struct TableFile::State {
  std::filesystem::path file;
  std::filesystem::path unfinished;
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
  auto state = std::make_unique<State>();
  state->file = file;
  state->unfinished = file.string() + ".unfinished";
  std::error_code failed;
  std::filesystem::remove(state->unfinished, failed);
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
  return {};
}

}  // namespace hvas::campaign
