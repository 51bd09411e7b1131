#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace hvas::app::testing {

/** Checks a document against a JSON Schema (draft 2020-12) of the keywords that the schemas of HVAS
 use; a keyword that it does not know is an error itself. @returns what is wrong, by JSON pointer.
 */
[[nodiscard]] std::vector<std::string> Validate(const nlohmann::json& schema,
                                                const nlohmann::json& document);

/** data/schemas/NAME.schema.json */
[[nodiscard]] nlohmann::json ReadSchema(const std::string& name);

}  // namespace hvas::app::testing
