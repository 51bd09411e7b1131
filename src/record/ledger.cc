#include "record/ledger.h"

#include <fmt/format.h>

#include "base/digest.h"

namespace hvas::record {
namespace {

constexpr std::size_t kDigits = 16;  // of a checksum

std::int64_t HashOf(std::span<const std::int64_t> numbers) {
  return static_cast<std::int64_t>(Checksum64(std::as_bytes(numbers)));
}

std::int64_t HashOf(std::string_view text) {
  return static_cast<std::int64_t>(Checksum64(std::as_bytes(std::span(text))));
}

void AppendEntries(const char* kind, const Ledger::Entries& entries, std::string* text) {
  for (const auto& [name, checksum] : entries) {
    *text += fmt::format("{:0{}x} {} \"{}\"\n", static_cast<std::uint64_t>(checksum), kDigits, kind,
                         name);
  }
}

/** Checksums by kind and name, as in PackEntries(). */
std::map<std::string, std::string> UnpackEntries(std::string_view text) {
  std::map<std::string, std::string> entries;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.size() > kDigits) {
      entries.emplace(line.substr(kDigits + 1), line.substr(0, kDigits));
    }
  }
  return entries;
}

}  // namespace

const char* ToString(RowTable table) noexcept {
  constexpr std::array kNames{"chunk", "event", "command", "frame"};
  return kNames[static_cast<std::size_t>(table)];
}

void Ledger::Add(RowTable table, std::span<const std::int64_t> row) {
  Rows& rows = rows_[static_cast<std::size_t>(table)];
  const std::array<std::int64_t, 2> both{rows.hash, HashOf(row)};
  rows.hash = HashOf(both);
  ++rows.count;
}

void Ledger::SetMeta(const std::string& key, std::string_view value) {
  meta_[key] = HashOf(value);
}

std::int64_t CalcHash(const Seal& seal, std::int64_t previous) {
  std::array<std::int64_t, 4 + 2 * kRowTables.size()> numbers{
      previous, seal.t_ns, seal.is_last ? 1 : 0, HashOf(seal.entries)};
  std::size_t at = 4;
  for (const Ledger::Rows& rows : seal.rows) {
    numbers[at++] = rows.count;
    numbers[at++] = rows.hash;
  }
  return HashOf(numbers);
}

std::string PackEntries(const Ledger& ledger) {
  std::string text;
  AppendEntries("meta entry", ledger.meta(), &text);
  AppendEntries("attachment", ledger.attachments(), &text);
  return text;
}

std::string NameDifference(std::string_view sealed, std::string_view found) {
  const auto was = UnpackEntries(sealed);
  const auto is = UnpackEntries(found);
  for (const auto& [name, checksum] : was) {
    const auto entry = is.find(name);
    if (entry == is.end()) {
      return fmt::format("its {} is missing", name);
    }
    if (entry->second != checksum) {
      return fmt::format("its {} was changed", name);
    }
  }
  for (const auto& [name, checksum] : is) {
    if (!was.contains(name)) {
      return fmt::format("its {} was added", name);
    }
  }
  return {};
}

}  // namespace hvas::record
