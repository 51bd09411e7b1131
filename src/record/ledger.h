#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace hvas::record {

/** Tables whose rows follow one another and are never changed. */
enum class RowTable { kChunk, kEvent, kCommand, kFrame };

inline constexpr std::array kRowTables{RowTable::kChunk, RowTable::kEvent, RowTable::kCommand,
                                       RowTable::kFrame};

/** The table's name in the file. */
[[nodiscard]] const char* ToString(RowTable table) noexcept;

/** What a record holds: how many rows each table has, a hash that each of them went into in its
 order, and a checksum of each entry that has a name. The writer ends every transaction with a seal
 of its ledger; a reader makes the ledger again from what is there, and compares. Finds damage and
 carelessness, not a forger. */
class Ledger {
 public:
  struct Rows {
    std::int64_t count{0};
    std::int64_t hash{0};

    bool operator==(const Rows&) const = default;
  };

  /** Checksums by name. */
  using Entries = std::map<std::string, std::int64_t>;

  /** Adds a row that is told apart by these numbers, of which one is its checksum. */
  void Add(RowTable table, std::span<const std::int64_t> row);

  void SetMeta(const std::string& key, std::string_view value);

  void SetAttachment(const std::string& name, std::int64_t checksum) {
    attachments_[name] = checksum;
  }

  [[nodiscard]] const Rows& rows(RowTable table) const {
    return rows_[static_cast<std::size_t>(table)];
  }

  [[nodiscard]] const Entries& meta() const { return meta_; }

  [[nodiscard]] const Entries& attachments() const { return attachments_; }

 private:
  std::array<Rows, kRowTables.size()> rows_{};
  Entries meta_;
  Entries attachments_;
};

/** A row of the table of seals. */
struct Seal {
  std::int64_t t_ns{0};  ///< Session time of the newest tick before it.
  bool is_last{false};   ///< The recorder came to its end.
  std::array<Ledger::Rows, kRowTables.size()> rows{};
  std::string entries;   ///< What PackEntries() gives; empty: as at the seal before.
  std::int64_t hash{0};  ///< The hash of all that, and of the hash of the seal before.
};

/** The hash that belongs to a seal.
 @param previous  The hash of the seal before; 0 for the first one. */
[[nodiscard]] std::int64_t CalcHash(const Seal& seal, std::int64_t previous);

/** All entries with names as text, a line each. */
[[nodiscard]] std::string PackEntries(const Ledger& ledger);

/** The first entry by which two such texts differ, for people; empty: none.
 @param sealed  What was written.
 @param found  What is there. */
[[nodiscard]] std::string NameDifference(std::string_view sealed, std::string_view found);

}  // namespace hvas::record
