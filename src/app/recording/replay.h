#pragma once

#include <optional>

#include "app/recording/record_options.h"
#include "haptics/options.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct ReplayArguments {
  RecordOptions record;
  bool is_verified{false};  ///< Only the same bits are good.
  bool is_json{false};
  std::optional<haptics::Condition> condition;
  std::optional<haptics::ForceMapKind> force_map;
};

/** Runs a recorded session again and prints how what comes out differs from the record.
 @returns The exit status: 0, 1 on an error, 2 when --verify found a difference. */
[[nodiscard]] int RunReplay(const ReplayArguments& arguments);

/** Adds `hvas replay` to the command line; `status` receives what RunReplay returns. */
void AddReplay(CLI::App* app, int* status);

}  // namespace hvas::app
