#include "record/table_check.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace hvas::record {
namespace {

/** A row of sqlite_master, but for the page on which its content begins. */
struct Entry {
  std::string name;
  std::string type;
  std::string table;
  std::string sql;  ///< Empty for an index that SQLite makes for a key.

  [[nodiscard]] auto AsTuple() const { return std::tie(name, type, table, sql); }
};

/** Lists the schema by name. Errors: kUnreadable for more than HVAS writes by far. */
Result<std::vector<Entry>> ListEntries(Database* database) {
  constexpr std::size_t kMostEntries = 64;  // A record has ten: a choice.
  auto rows = database->Prepare(
      "SELECT coalesce(name, ''), coalesce(type, ''), "
      "coalesce(tbl_name, ''), coalesce(sql, '') FROM sqlite_master");
  if (!rows) {
    return Unexpected(rows.error());
  }
  std::vector<Entry> entries;
  auto step = rows->Step();
  for (; step && *step && entries.size() <= kMostEntries; step = rows->Step()) {
    entries.push_back({rows->ReadText(0), rows->ReadText(1), rows->ReadText(2), rows->ReadText(3)});
  }
  if (!step) {
    return Unexpected(step.error());
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.AsTuple() < b.AsTuple(); });
  return entries;
}

/** Lists what the statements make. */
Result<std::vector<Entry>> ListMade(const std::string& statements) {
  auto database = Database::OpenInMemory();
  if (!database) {
    return Unexpected(database.error());
  }
  const auto made = database->Execute(statements);
  return made ? ListEntries(&*database) : Unexpected(made.error());
}

Unexpected FailForEntry(const Database& database, const char* problem, const Entry& entry) {
  constexpr std::size_t kLongestName = 60;  // Letters of a message: a choice.
  return Fail(ErrorCode::kUnreadable,
              fmt::format("the file is not as HVAS writes it: the {} \"{}\" {}", entry.type,
                          entry.name.substr(0, kLongestName), problem),
              database.path(), "restore the file from a copy that HVAS wrote");
}

Result<void> Compare(const Database& database, const std::vector<Entry>& expected,
                     const std::vector<Entry>& found) {
  const auto is_in = [](const std::vector<Entry>& entries, const auto& fits) {
    return std::any_of(entries.begin(), entries.end(), fits);
  };
  for (const Entry& entry : expected) {
    if (is_in(found, [&](const Entry& one) { return one.AsTuple() == entry.AsTuple(); })) {
      continue;
    }
    const bool differs = is_in(found, [&](const Entry& one) { return one.name == entry.name; });
    return FailForEntry(database, differs ? "is another" : "is missing", entry);
  }
  for (const Entry& entry : found) {
    if (!is_in(expected, [&](const Entry& one) { return one.AsTuple() == entry.AsTuple(); })) {
      return FailForEntry(database, "does not belong into it", entry);
    }
  }
  return {};
}

Result<void> CheckEntries(Database* database, const std::string& statements,
                          const std::string& only) {
  auto expected = ListMade(statements);
  auto found = ListEntries(database);
  if (!expected || !found) {
    return Unexpected((expected ? found : expected).error());
  }
  if (!only.empty()) {
    for (auto* entries : {&*expected, &*found}) {
      std::erase_if(*entries, [&](const Entry& entry) { return entry.name != only; });
    }
  }
  return Compare(*database, *expected, *found);
}

}  // namespace

Result<void> CheckTables(Database* database, const std::string& statements) {
  return CheckEntries(database, statements, "");
}

Result<void> CheckTable(Database* database, const std::string& statements,
                        const std::string& name) {
  return CheckEntries(database, statements, name);
}

}  // namespace hvas::record
