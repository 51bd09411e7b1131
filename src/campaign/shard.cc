#include "campaign/shard.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/regular_file.h"
#include "campaign/row_table.h"
#include "record/database.h"
#include "record/table_check.h"

namespace hvas::campaign {
namespace {

constexpr int kShardFormat = 1;            // Of the tables; counts up with each change.
constexpr std::int64_t kPerFolder = 1000;  // Files that a file system lists at once: a choice.

std::string DigestRows(const std::vector<RunResult>& rows) {
  Digest digest;
  for (const RunResult& row : rows) {
    AddRow(row, &digest);
  }
  return digest.Hex();
}

constexpr const char* kCreateOrigin =
    "CREATE TABLE origin (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID";

Unexpected FailDamaged(const std::filesystem::path& file, const std::string& what) {
  return Fail(ErrorCode::kUnreadable, "the shard is damaged: " + what, file.string(),
              "run the campaign or the shard again: it is calculated anew");
}

/** The text of a key in the table of the shard's origin. */
Result<std::string> ReadOrigin(record::Database* database, std::string_view name) {
  auto statement = database->Prepare("SELECT value FROM origin WHERE name = ?");
  if (!statement) {
    return Unexpected(statement.error());
  }
  const auto row = statement->Bind(1, name).Step();
  if (!row) {
    return Unexpected(row.error());
  }
  return *row ? statement->ReadText(0) : std::string();
}

Result<void> FillShard(record::Database* database, const ShardKey& key,
                       const std::vector<RunResult>& rows) {
  auto done = database->Execute(std::string("BEGIN; ") + kCreateOrigin);
  if (!done) {
    return done;
  }
  auto origin = database->Prepare("INSERT INTO origin VALUES (?, ?)");
  if (!origin) {
    return Unexpected(origin.error());
  }
  for (const auto& [name, value] :
       {std::pair<std::string, std::string>("format", std::to_string(kShardFormat)),
        {"inputs", key.inputs},
        {"shard", std::to_string(key.shard)},
        {"rows_digest", DigestRows(rows)}}) {
    done = origin->Bind(1, std::string_view(name)).Bind(2, std::string_view(value)).Run();
    if (!done) {
      return done;
    }
  }
  auto table = RowTable::Create(database);
  if (!table) {
    return Unexpected(table.error());
  }
  for (const RunResult& row : rows) {
    done = table->Add(row);
    if (!done) {
      return done;
    }
  }
  return database->Execute("COMMIT");
}

}  // namespace

void AddRow(const RunResult& row, Digest* digest) {
  digest->AddInt(row.run);
  digest->AddInt(row.cell);
  digest->AddInt(row.seed);
  digest->AddInt(row.is_complete ? 1 : 0);
  digest->AddInt(static_cast<std::int64_t>(row.cause));
  digest->AddInt(row.entity);
  digest->AddDouble(row.utilisation);
  digest->AddDouble(row.force);
  digest->AddDouble(row.clearance);
  digest->AddDouble(row.pressure_share);
  digest->AddDouble(row.time);
}

std::filesystem::path NameShard(const ShardKey& key) {
  Digest digest;
  digest.AddText(key.inputs);
  digest.AddInt(key.shard);
  return std::filesystem::path("shards") / fmt::format("{:06d}", key.shard / kPerFolder) /
         fmt::format("{:09d}-{}.sqlite", key.shard, digest.Hex());
}

Result<void> WriteShard(const std::filesystem::path& file, const ShardKey& key,
                        const std::vector<RunResult>& rows) {
  auto database = record::Database::OpenInMemory();
  if (!database) {
    return Unexpected(database.error());
  }
  if (auto filled = FillShard(&*database, key, rows); !filled) {
    return filled;
  }
  const auto bytes = database->Serialize();
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) {
    return Fail(ErrorCode::kInvalid, "the folder cannot be made: " + failed.message(),
                file.parent_path().string(), "check the path, its permissions and the disk");
  }
  return WriteAtomically(file, *bytes);
}

Result<std::vector<RunResult>> ReadShard(const std::filesystem::path& file, const ShardKey& key) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) {
    return Fail(ErrorCode::kNotFound, "the shard is not there", file.string(),
                "run the campaign or the shard");
  }
  if (const auto checked = CheckRegularFile(file); !checked) {
    return FailDamaged(file, checked.error().message);
  }
  auto database = record::Database::Open(file, record::Database::Mode::kReadOnly);
  if (!database) {
    return FailDamaged(file, database.error().message);
  }
  const std::string tables = std::string(kCreateOrigin) + ";" + DescribeRowTable();
  if (const auto checked = record::CheckTables(&*database, tables); !checked) {
    return FailDamaged(file, checked.error().message);
  }
  const auto inputs = ReadOrigin(&*database, "inputs");
  const auto shard = ReadOrigin(&*database, "shard");
  const auto digest = ReadOrigin(&*database, "rows_digest");
  if (!inputs || !shard || !digest) {
    return FailDamaged(file, (!inputs ? inputs : !shard ? shard : digest).error().message);
  }
  if (*inputs != key.inputs || *shard != std::to_string(key.shard)) {
    return Fail(ErrorCode::kInvalid, "the shard is of another plan, product, program or number",
                file.string(), "remove it, and run the campaign again");
  }
  auto rows = ReadRows(&*database);
  if (!rows) {
    return FailDamaged(file, rows.error().message);
  }
  if (DigestRows(*rows) != *digest) {
    return FailDamaged(file, "its rows differ from their digest");
  }
  return rows;
}

}  // namespace hvas::campaign
