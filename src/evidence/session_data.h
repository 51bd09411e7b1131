#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "product/ids.h"
#include "record/reader.h"

/** What exports and the report take out of a record. */
namespace hvas::evidence {

/** A number of each tick, SI. */
struct Column {
  const char* name;  ///< Ends with its unit.
  const char* unit;
  const char* description;
  double (*get)(const record::TickRecord&);
};

/** All that a tick has, times first. */
[[nodiscard]] std::span<const Column> TickColumns();

/** Which hand a tick is of, below haptics::kMaxHands also where the record is damaged. */
[[nodiscard]] std::size_t HandOf(const record::TickRecord& tick);

/** Which ticks are taken. */
struct Selection {
  record::Reader::Span span;
  std::int64_t every{1};  ///< Takes only every so many-th tick of each hand, >= 1.
};

/** Visits the ticks of a selection, in their order. */
Result<void> ForEachSelected(record::Reader* reader, const Selection& selection,
                             const std::function<void(const record::TickRecord&)>& visit);

/** Names of the occurrences by their id, as the record's meta has them; empty where it has none. */
[[nodiscard]] std::vector<std::string> ReadPaths(const record::Reader& reader);

/** A name for people: the path's last part that is known, or "o12". */
[[nodiscard]] std::string NameOf(const std::vector<std::string>& paths, std::uint32_t occurrence);

}  // namespace hvas::evidence
