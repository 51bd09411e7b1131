#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "study/analysis.h"

namespace hvas::app {

/** data/schemas/study_analysis.schema.json; null is what the data do not define. */
[[nodiscard]] nlohmann::ordered_json ToJson(const study::Analysis& analysis,
                                            const std::vector<std::string>& notes);

/** data/schemas/study_identification.schema.json */
[[nodiscard]] nlohmann::ordered_json ToJson(const study::Identification& identification,
                                            const std::vector<std::string>& notes);

}  // namespace hvas::app
