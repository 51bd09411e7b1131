#include "app/recording/recorded_path.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/assembly/poses.h"
#include "record/reader.h"

namespace hvas::app {

Result<TimedPath> ReadRecordedPath(const std::filesystem::path& record,
                                   const product::Product& product, product::OccurrenceId id,
                                   std::size_t hold) {
  const std::string name = record.filename().string();
  auto reader = record::Reader::Open(record);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const auto ids = MatchParts(reader->meta(), name, product);
  if (!ids) {
    return Unexpected(ids.error());
  }
  const auto number = std::find_if(ids->begin(), ids->end(),
                                   [id](const auto& entry) { return entry.second == id; });
  TimedPath path;
  std::size_t holds = 0;
  bool is_held = false;
  std::uint8_t hand = 0;
  const auto visited = reader->ForEachTick({}, [&](const record::TickRecord& tick) {
    const bool is_here = number != ids->end() && tick.held == number->first;
    if (is_here && !is_held) {
      if (holds == hold && hold > 0) {
        return false;
      }
      is_held = true;
      hand = tick.hand;
      ++holds;
      path = {};
    }
    if (is_held && tick.hand == hand) {
      is_held = is_here;
      if (is_here) {
        path.X_WB.push_back(tick.X_WD);
        path.t_ns.push_back(tick.t_ns);
      }
    }
    return true;
  });
  if (!visited) {
    return Unexpected(visited.error());
  }
  if (holds == 0 || holds < hold) {
    return Fail(ErrorCode::kNotFound,
                holds == 0 ? "no hand held this part in the session"
                           : fmt::format("this part was held {} times only", holds),
                fmt::format("{} in {}", product.occurrences[id.index()].path, name),
                holds == 0 ? "choose another part, or give --translate or --rotate"
                           : "choose a smaller --hold");
  }
  return path;
}

}  // namespace hvas::app
