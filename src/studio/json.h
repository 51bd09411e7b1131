#pragma once

#include <nlohmann/json.hpp>

namespace hvas::studio {

/** JSON whose fields keep the order in which they were added. */
using Json = nlohmann::ordered_json;

}  // namespace hvas::studio
