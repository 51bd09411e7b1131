#pragma once

#include "base/result.h"

namespace hvas {

/** The name of a code in protocols and in other languages: "not-found", "unreadable",
 "unsupported", "invalid", "out-of-resource", "cancelled" or "internal". */
[[nodiscard]] const char* NameOf(ErrorCode code);

}  // namespace hvas
