#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "campaign/row_table.h"
#include "campaign/run_result.h"
#include "record/database.h"

namespace hvas::campaign {

/** An SQLite file with the rows of a whole campaign. It is written under another name, and has its
 own when it is finished; without that, nothing stays behind. */
class TableFile {
 public:
  /** Errors: kNotFound where the folder is not there; kInvalid where it is not writable, or
   another program is writing the same table. */
  [[nodiscard]] static Result<TableFile> Create(const std::filesystem::path& file);

  TableFile(TableFile&& other) noexcept;
  TableFile& operator=(TableFile&&) = delete;
  ~TableFile();

  /** Adds a row. Errors: kOutOfResource on a full disk; those of the database. */
  [[nodiscard]] Result<void> Add(const RunResult& row);

  /** Writes the rest, and gives the file its name. Errors: as Add(). */
  [[nodiscard]] Result<void> Finish();

 private:
  struct State;

  explicit TableFile(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace hvas::campaign
