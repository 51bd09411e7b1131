#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "campaign/run_result.h"
#include "record/database.h"

namespace hvas::campaign {

/** The table `runs` of a database, to which rows are added. */
class RowTable {
 public:
  /** Makes the table. Errors: those of the database. @param database  Outlives the table. */
  [[nodiscard]] static Result<RowTable> Create(record::Database* database);

  /** Adds a row. Errors: those of the database. */
  [[nodiscard]] Result<void> Add(const RunResult& row);

 private:
  explicit RowTable(record::Statement insert) : insert_(std::move(insert)) {}

  record::Statement insert_;
};

/** The statement that makes the table. */
[[nodiscard]] std::string DescribeRowTable();

/** Reads all rows of the table, in the order of their runs. Errors: those of the database;
 kUnsupported for more than ten million rows. */
[[nodiscard]] Result<std::vector<RunResult>> ReadRows(record::Database* database);

}  // namespace hvas::campaign
