#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "app/output/choice.h"
#include "haptics/options.h"

namespace hvas::app {

/** Adds `--force-map published|paper` to a command.
 @param kind  Of haptics::ForceMapKind, or optional. */
template <typename Kind>
CLI::Option* AddForceMapOption(CLI::App* command, Kind* kind) {
  const Choices<haptics::ForceMapKind> kinds{
      {haptics::ToString(haptics::ForceMapKind::kPublished), haptics::ForceMapKind::kPublished},
      {haptics::ToString(haptics::ForceMapKind::kPaper), haptics::ForceMapKind::kPaper}};
  return AddChoice(command, "--force-map", kind, kinds,
                   "Force map of fits: published (one map for all fits), or paper (factors k_r and "
                   "k_s of paper W)");
}

/** Adds `--condition collision|constraint|hybrid` to a command.
 @param condition  Of haptics::Condition, or optional. */
template <typename Condition>
CLI::Option* AddConditionOption(CLI::App* command, Condition* condition) {
  const Choices<haptics::Condition> conditions{{"collision", haptics::Condition::kCollision},
                                               {"constraint", haptics::Condition::kConstraint},
                                               {"hybrid", haptics::Condition::kHybrid}};
  return AddChoice(command, "--condition", condition, conditions,
                   "Rendering: contact, mates, or hybrid (both, and the force of the fit)");
}

}  // namespace hvas::app
