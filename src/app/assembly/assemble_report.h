#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/model.h"

namespace hvas::app {

/** The device that was in the hand of a run. */
struct DeviceInHand {
  std::string address;  ///< What was asked for; empty: none.
  std::string model;
  std::string profile;  ///< Id of the one that it is rendered by; may be empty.
  bool is_emulated{false};
  std::vector<std::string> notes;  ///< How it was rendered to.
};

/** Everything that `hvas assemble` has to tell about a run. */
struct AssemblyOutcome {
  std::vector<simulation::PartResult> parts;
  simulation::ExecutionReport execution;
  std::int64_t preparation_ns{0};  ///< Reading, shapes, mates, order and layout.
  std::uint64_t seed{1};
  bool is_realtime{false};
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
  std::size_t hands{1};
  std::vector<DeviceInHand> devices;  ///< One for each hand, or none.
  std::string digest;
  std::uint64_t dropped_ticks{0};
  std::optional<Error> record_error;  ///< Why the record was not written to its end.
};

/** "first hand", "second hand". */
[[nodiscard]] const char* NameOfHand(std::size_t hand);

/** One JSON document on stdout; every number's name ends in its unit. */
void PrintAssemblyJson(const simulation::Model& model, const AssemblyOutcome& outcome);

/** One line a part, what was left out and why, and how long everything took. */
void PrintAssemblyTable(const simulation::Model& model, const AssemblyOutcome& outcome);

}  // namespace hvas::app
