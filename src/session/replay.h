#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "haptics/options.h"
#include "record/reader.h"
#include "simulation/model.h"

namespace hvas::session {

struct ReplayOptions {
  std::optional<haptics::Condition> condition;     ///< Takes the place of the recorded one.
  std::optional<haptics::ForceMapKind> force_map;  ///< Likewise.
  std::function<void(double fraction)> progress;   ///< May be null.
};

/** Where a replayed tick first is not the recorded one. */
struct FirstDifference {
  std::int64_t t_ns{0};  ///< Session time.
  std::size_t hand{0};
  std::string field;  ///< Ends with its unit.
};

/** What a part's holds amounted to, as recorded and as replayed. */
struct ReplayedPart {
  struct Outcome {
    double peak_true{0};  ///< [N]
    double peak_felt{0};  ///< [N]
    double depth{0};      ///< The deepest insertion [m].
    bool is_seated{false};
  };

  product::OccurrenceId occurrence;
  std::int64_t held_ns{0};
  Outcome recorded;
  Outcome replayed;
};

struct ReplayReport {
  std::int64_t stretches{0};
  std::int64_t ticks{0};            ///< That were run again.
  std::int64_t different_ticks{0};  ///< Those that differ in any bit of what they gave.
  std::int64_t unreachable_ticks{
      0};  ///< Those behind ticks that the record lacks, until a new stretch.
  std::optional<FirstDifference> first;
  double largest_felt_difference{0};  ///< [N]
  double rms_felt_difference{0};      ///< Root mean square of all ticks run again [N].
  double largest_way{0};              ///< Largest distance between the displayed parts [m].
  std::vector<ReplayedPart> parts;    ///< Those that were in a hand, in that order.
  std::int64_t session_ns{0};         ///< That was run again.
  std::int64_t wall_ns{0};            ///< That it took.

  /** All ticks came out again bit for bit, and there were some. */
  [[nodiscard]] bool is_exact() const {
    return ticks > 0 && different_ticks == 0 && unreachable_ticks == 0;
  }
};

/** Feeds a record's samples and commands through the same program again, tick by tick, and compares
 what comes out with what is recorded: without other parameters, bit for bit.
 Errors: kUnsupported for a record without commands (before schema 3), kUnreadable for a damaged
 one.
 @param model  As LoadModel() gives it. */
[[nodiscard]] Result<ReplayReport> Replay(record::Reader* reader,
                                          const std::shared_ptr<const simulation::Model>& model,
                                          const ReplayOptions& options);

}  // namespace hvas::session
