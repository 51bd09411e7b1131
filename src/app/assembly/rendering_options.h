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
                   "How forces of fits are felt: published (one map for all), or paper (paper W's "
                   "factors k_r and k_s)");
}

/** Adds `--condition collision|constraint|hybrid` to a command.
 @param condition  Of haptics::Condition, or optional. */
template <typename Condition>
CLI::Option* AddConditionOption(CLI::App* command, Condition* condition) {
  const Choices<haptics::Condition> conditions{{"collision", haptics::Condition::kCollision},
                                               {"constraint", haptics::Condition::kConstraint},
                                               {"hybrid", haptics::Condition::kHybrid}};
  return AddChoice(command, "--condition", condition, conditions,
                   "What is felt; hybrid is both, and the force of the fit");
}

}  // namespace hvas::app
