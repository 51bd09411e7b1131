#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hvas::app {

/** Rounds the numbers of a document to what they mean, by the unit at the end of their names: _um
 to 1e-4, _mm to 1e-6, _n to 1e-3, _nm to 1e-4, _mpa to 1e-4, _c to 1e-2, _deg to 1e-6, any other to
 nine digits. Zero has no sign; whole numbers, texts and null stay. */
void RoundNumbers(nlohmann::ordered_json* json);

}  // namespace hvas::app
