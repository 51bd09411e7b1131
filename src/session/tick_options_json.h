#pragma once

#include "base/result.h"
#include "haptics/options.h"
#include "session/exact_json.h"

namespace hvas::session {

/** All options of a tick, by name with units, exact. */
[[nodiscard]] Json MakeTickOptionsJson(const haptics::TickOptions& options);

/** Errors: kUnreadable, naming the field that is missing or has no such value. */
[[nodiscard]] Result<haptics::TickOptions> ParseTickOptions(const Json& json);

}  // namespace hvas::session
