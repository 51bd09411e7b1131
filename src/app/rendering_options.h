#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "haptics/options.h"

namespace hvas::app {

/** Adds `--force-map published|paper` to a command.
 @param kind  Of haptics::ForceMapKind, or optional. */
template <typename Kind>
CLI::Option* AddForceMapOption(CLI::App* command, Kind* kind) {
  const std::map<std::string, haptics::ForceMapKind> kinds{
      {haptics::ToString(haptics::ForceMapKind::kPublished), haptics::ForceMapKind::kPublished},
      {haptics::ToString(haptics::ForceMapKind::kPaper), haptics::ForceMapKind::kPaper}};
  return command
      ->add_option("--force-map", *kind,
                   "How forces of fits are felt: published (one map for all), or paper (paper W's "
                   "factors k_r and k_s)")
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case));
}

/** Adds `--condition collision|constraint|hybrid` to a command.
 @param condition  Of haptics::Condition, or optional. */
template <typename Condition>
CLI::Option* AddConditionOption(CLI::App* command, Condition* condition) {
  const std::map<std::string, haptics::Condition> conditions{
      {"collision", haptics::Condition::kCollision},
      {"constraint", haptics::Condition::kConstraint},
      {"hybrid", haptics::Condition::kHybrid}};
  return command
      ->add_option("--condition", *condition,
                   "collision, constraint, or hybrid (both, and the force of the fit)")
      ->transform(CLI::CheckedTransformer(conditions, CLI::ignore_case));
}

}  // namespace hvas::app
