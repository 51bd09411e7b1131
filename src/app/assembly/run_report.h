#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "assembly/run_assembly.h"
#include "haptics/options.h"
#include "simulation/model.h"

namespace hvas::app {

/** Everything that a command has to report of a run, whatever was done in it. */
struct SessionReport {
  assembly::RunOutcome run;
  std::int64_t preparation_ns{0};  ///< Reading, shapes, mates, order and layout.
  std::uint64_t seed{1};
  bool is_realtime{false};
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
};

/** A hand in words: "first hand". */
[[nodiscard]] std::string NameOfHand(std::size_t hand);

/** Path of a part; "empty hand" where there is none. */
[[nodiscard]] const std::string& PathOf(const simulation::Model& model, product::OccurrenceId id);

/** The product, the hands and the times of a run. Every number's name ends in its unit. */
[[nodiscard]] nlohmann::ordered_json MakeRunJson(const simulation::Model& model,
                                                 const SessionReport& report);

/** The part that is moved aside to let another one pass, which way and how far.
 @param aside  As FindAside() gives it. */
[[nodiscard]] nlohmann::ordered_json MakeAsideJson(const simulation::Model& model,
                                                   const sequence::SequenceStep& aside);

/** How a part fared in the hands: reason, time and forces. */
[[nodiscard]] nlohmann::ordered_json MakeHoldJson(const simulation::PartResult& part);

/** Prints a document on stdout. */
void PrintJson(const nlohmann::ordered_json& json);

/** Prints how long everything took, what was in the hands, and the digest.
 @param summary  "7 of 8 parts in place". */
void PrintRun(const simulation::Model& model, const SessionReport& report,
              const std::string& summary);

}  // namespace hvas::app
