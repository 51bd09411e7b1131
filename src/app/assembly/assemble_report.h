#pragma once

#include <cstddef>
#include <cstdint>

#include "assembly/run_assembly.h"
#include "haptics/options.h"
#include "simulation/model.h"

namespace hvas::app {

/** Everything that `hvas assemble` has to tell about a run. */
struct AssemblyReport {
  assembly::RunOutcome run;
  std::int64_t preparation_ns{0};  ///< Reading, shapes, mates, order and layout.
  std::uint64_t seed{1};
  bool is_realtime{false};
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
};

/** "first hand", "second hand". */
[[nodiscard]] const char* NameOfHand(std::size_t hand);

/** One JSON document on stdout; every number's name ends in its unit. */
void PrintAssemblyJson(const simulation::Model& model, const AssemblyReport& report);

/** One line a part, what was left out and why, and how long everything took. */
void PrintAssemblyTable(const simulation::Model& model, const AssemblyReport& report);

}  // namespace hvas::app
