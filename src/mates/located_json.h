#pragma once

#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/result.h"

namespace hvas::mates {

/** A JSON document that knows on which line each of its elements begins. */
struct LocatedJson {
  nlohmann::ordered_json root;
  std::map<std::string, int> lines;  ///< One for each JSON pointer: "", "/fits", "/fits/0/fit".

  /** Line of the element, or of what holds it; the first line is 1. */
  [[nodiscard]] int LineOf(std::string pointer) const;
};

/** Reads JSON that people write. On top of what JSON forbids, a key that stands twice in one object
 is an error (kInvalid), and so are numbers that no double holds, nesting deeper than 32 and objects
 of more than 1000 keys.
 Error::where is "FILE:LINE".
 @param file  Only for the messages. */
[[nodiscard]] Result<LocatedJson> ParseLocatedJson(std::string_view text, const std::string& file);

}  // namespace hvas::mates
