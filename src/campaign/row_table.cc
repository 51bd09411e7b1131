#include "campaign/row_table.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace hvas::campaign {
namespace {

// The columns of the table in their order. Numbers stay in SI units, so that they are the bits that
// were calculated.
constexpr const char* kCreateRuns =
    "CREATE TABLE runs (run INTEGER PRIMARY KEY, cell INTEGER NOT NULL, seed INTEGER NOT NULL, "
    "complete INTEGER NOT NULL, cause TEXT NOT NULL, entity INTEGER NOT NULL, "
    "utilisation REAL NOT NULL, force_n REAL NOT NULL, clearance_m REAL NOT NULL, "
    "pressure_share REAL NOT NULL, time_s REAL NOT NULL)";

Cause FindCause(std::string_view word) {
  const auto found = std::find(kCauses.begin(), kCauses.end(), word);
  return found == kCauses.end() ? Cause::kNone : static_cast<Cause>(found - kCauses.begin());
}

}  // namespace

std::string DescribeRowTable() {
  return kCreateRuns;
}

Result<RowTable> RowTable::Create(record::Database* database) {
  if (const auto made = database->Execute(kCreateRuns); !made) {
    return Unexpected(made.error());
  }
  auto insert = database->Prepare("INSERT INTO runs VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  return insert ? Result<RowTable>(RowTable(*std::move(insert))) : Unexpected(insert.error());
}

Result<void> RowTable::Add(const RunResult& row) {
  return insert_.Bind(1, row.run)
      .Bind(2, row.cell)
      .Bind(3, row.seed)
      .Bind(4, static_cast<std::int64_t>(row.is_complete))
      .Bind(5, kCauses[static_cast<std::size_t>(row.cause)])
      .Bind(6, row.entity)
      .BindReal(7, row.utilisation)
      .BindReal(8, row.force)
      .BindReal(9, row.clearance)
      .BindReal(10, row.pressure_share)
      .BindReal(11, row.time)
      .Run();
}

Result<std::vector<RunResult>> ReadRows(record::Database* database) {
  auto select = database->Prepare("SELECT * FROM runs ORDER BY run");
  if (!select) {
    return Unexpected(select.error());
  }
  constexpr std::size_t kMostRows = 10'000'000;  // Some gigabytes of memory: a choice.
  std::vector<RunResult> rows;
  while (rows.size() <= kMostRows) {
    const auto has_row = select->Step();
    if (!has_row) {
      return Unexpected(has_row.error());
    }
    if (!*has_row) {
      return rows;
    }
    RunResult row;
    row.run = select->ReadInt(0);
    row.cell = select->ReadInt(1);
    row.seed = select->ReadInt(2);
    row.is_complete = select->ReadInt(3) != 0;
    row.cause = FindCause(select->ReadText(4));
    row.entity = select->ReadInt(5);
    row.utilisation = select->ReadReal(6);
    row.force = select->ReadReal(7);
    row.clearance = select->ReadReal(8);
    row.pressure_share = select->ReadReal(9);
    row.time = select->ReadReal(10);
    rows.push_back(row);
  }
  return Fail(ErrorCode::kUnsupported, fmt::format("there are more than {} rows", kMostRows),
              database->path(), "make the campaign's shards smaller");
}

}  // namespace hvas::campaign
