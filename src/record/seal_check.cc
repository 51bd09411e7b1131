#include "record/seal_check.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "record/ledger.h"

namespace hvas::record {
namespace {

struct TableQuery {
  RowTable table;
  const char* columns;  ///< The row's time, then the numbers that the ledger's Add() takes.
  int count;            ///< How many of these numbers there are.
};

constexpr std::array kQueries{
    TableQuery{RowTable::kChunk, "first_t_ns, first_t_ns, last_t_ns, count, checksum", 4},
    TableQuery{RowTable::kEvent, "t_ns, checksum", 1},
    TableQuery{RowTable::kCommand, "t_ns, checksum", 1},
    TableQuery{RowTable::kFrame, "t_ns, t_ns, checksum", 2},
};

class SealCheck {
 public:
  SealCheck(Database* database, std::string path) : database_(database), path_(std::move(path)) {}

  Result<void> Run() {
    Result<void> done = ReadSeals();
    if (done) {
      done = CheckEntries();
    }
    for (const TableQuery& query : kQueries) {
      if (done) {
        done = CheckRows(query);
      }
    }
    return done;
  }

 private:
  [[nodiscard]] Unexpected NotAsWritten(const std::string& what) const {
    return Fail(ErrorCode::kUnreadable, "the record was changed after it was written: " + what,
                path_, "restore the file from a copy");
  }

  static std::string AtTime(std::int64_t t_ns) {
    return fmt::format("at {:.3f} s", 1e-9 * static_cast<double>(t_ns));
  }

  Result<void> ReadSeals() {
    Result<Statement> rows = database_->Prepare(
        "SELECT id, t_ns, is_last, chunks, chunk_hash, events, event_hash, commands, command_hash, "
        "frames, frame_hash, entries, hash FROM seal ORDER BY id");
    if (!rows) {
      return Unexpected(rows.error());
    }
    std::int64_t previous = 0;
    Result<bool> step = rows->Step();
    for (; step && *step; step = rows->Step()) {
      Seal seal;
      seal.t_ns = rows->ReadInt(1);
      seal.is_last = rows->ReadInt(2) != 0;
      int column = 3;
      for (Ledger::Rows& of_table : seal.rows) {
        of_table.count = rows->ReadInt(column++);
        of_table.hash = rows->ReadInt(column++);
      }
      seal.entries = rows->ReadText(column++);
      seal.hash = rows->ReadInt(column);
      const auto number = static_cast<std::int64_t>(seals_.size()) + 1;
      if (rows->ReadInt(0) != number) {
        return NotAsWritten(fmt::format("seal {} is missing", number));
      }
      if (CalcHash(seal, previous) != seal.hash) {
        return NotAsWritten(fmt::format("seal {}, {}, was changed", number, AtTime(seal.t_ns)));
      }
      if (!seals_.empty() && seals_.back().is_last) {
        return NotAsWritten(fmt::format("seal {} was added after the last one", number));
      }
      previous = seal.hash;
      entries_ = seal.entries.empty() ? entries_ : std::move(seal.entries);
      seals_.push_back(std::move(seal));
    }
    if (!step) {
      return Unexpected(step.error());
    }
    return seals_.empty() ? NotAsWritten("all seals are missing") : Result<void>();
  }

  Result<void> CheckEntries() {
    Ledger found;
    Result<Statement> meta = database_->Prepare("SELECT key, value FROM meta");
    Result<Statement> attachments = database_->Prepare("SELECT name, checksum FROM attachment");
    if (!meta || !attachments) {
      return Unexpected(meta ? attachments.error() : meta.error());
    }
    Result<bool> step = meta->Step();
    for (; step && *step; step = meta->Step()) {
      found.SetMeta(meta->ReadText(0), meta->ReadText(1));
    }
    if (step) {
      step = attachments->Step();
    }
    for (; step && *step; step = attachments->Step()) {
      found.SetAttachment(attachments->ReadText(0), attachments->ReadInt(1));
    }
    if (!step) {
      return Unexpected(step.error());
    }
    const std::string difference = NameDifference(entries_, PackEntries(found));
    return difference.empty() ? Result<void>() : NotAsWritten(difference);
  }

  Result<void> CheckRows(const TableQuery& query) {
    const char* name = ToString(query.table);
    Result<Statement> rows =
        database_->Prepare(fmt::format("SELECT id, {} FROM {} ORDER BY id", query.columns, name));
    if (!rows) {
      return Unexpected(rows.error());
    }
    const auto sealed = [&](std::size_t seal) {
      return seals_[seal].rows[static_cast<std::size_t>(query.table)];
    };
    Ledger found;
    std::size_t next_seal = 0;
    std::int64_t unsealed_from = 1;  // The first row that no seal has been compared for.
    // Compares all seals that were written after as many rows as there are in `found` now.
    const auto compare = [&]() -> Result<void> {
      const Ledger::Rows& now = found.rows(query.table);
      for (; next_seal < seals_.size() && sealed(next_seal).count <= now.count; ++next_seal) {
        if (sealed(next_seal) != now) {
          return NotAsWritten(unsealed_from >= now.count
                                  ? fmt::format("{} {} was changed", name, now.count)
                                  : fmt::format("something of {} {} to {} was changed", name,
                                                unsealed_from, now.count));
        }
        unsealed_from = now.count + 1;
      }
      return {};
    };
    Result<void> done = compare();
    Result<bool> step = rows->Step();
    for (; done && step && *step; step = rows->Step()) {
      const std::int64_t number = found.rows(query.table).count + 1;
      if (rows->ReadInt(0) != number) {
        return NotAsWritten(fmt::format("{} {}, before the one {}, is missing", name, number,
                                        AtTime(rows->ReadInt(1))));
      }
      if (number > sealed(seals_.size() - 1).count) {
        return NotAsWritten(
            fmt::format("{} {}, {}, was added", name, number, AtTime(rows->ReadInt(1))));
      }
      std::array<std::int64_t, 4> numbers{};
      for (int k = 0; k < query.count; ++k) {
        numbers[static_cast<std::size_t>(k)] = rows->ReadInt(2 + k);
      }
      found.Add(query.table, std::span(numbers).first(static_cast<std::size_t>(query.count)));
      done = compare();
    }
    if (!step) {
      return Unexpected(step.error());
    }
    const std::int64_t count = found.rows(query.table).count;
    const std::int64_t written = sealed(seals_.size() - 1).count;
    if (done && count < written) {
      return NotAsWritten(written - count == 1 ? fmt::format("the last {} is missing", name)
                                               : fmt::format("the last {} of {} {}s are missing",
                                                             written - count, written, name));
    }
    return done;
  }

  Database* database_;
  std::string path_;
  std::vector<Seal> seals_;
  std::string entries_;  ///< Those of the last seal that has them.
};

}  // namespace

Result<void> CheckSeals(Database* database, const std::filesystem::path& path) {
  return SealCheck(database, path.string()).Run();
}

}  // namespace hvas::record
