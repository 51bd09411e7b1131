#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace hvas {

/** A binary glTF 2.0 file: its document and, where there is one, the buffer that this speaks of
 (the specification's section on GLB). Errors (kOutOfResource): more than 4 GiB. */
[[nodiscard]] Result<std::string> PackGlb(std::string json, std::string_view binary);

}  // namespace hvas
