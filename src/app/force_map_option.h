#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "haptics/options.h"

namespace hvas::app {

/** Adds `--force-map published|paper` to a command. */
inline void AddForceMapOption(CLI::App* command, haptics::ForceMapKind* kind) {
  const std::map<std::string, haptics::ForceMapKind> kinds{
      {haptics::ToString(haptics::ForceMapKind::kPublished), haptics::ForceMapKind::kPublished},
      {haptics::ToString(haptics::ForceMapKind::kPaper), haptics::ForceMapKind::kPaper}};
  command
      ->add_option("--force-map", *kind,
                   "How forces of fits are felt: published (one map for all), or paper (paper W's "
                   "factors k_r and k_s)")
      ->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case));
}

}  // namespace hvas::app
