#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/diagnostics.h"
#include "product/product.h"

namespace hvas::app {

[[nodiscard]] const char* ToString(Severity severity);
[[nodiscard]] const char* ToString(product::MateKind kind);
[[nodiscard]] const char* ToString(product::FitKind kind);

/** The product as one JSON object: summary, parts, subassemblies, occurrences, mates, diagnostics.
 Keys carry their unit; keys keep this order. */
[[nodiscard]] nlohmann::ordered_json ToJson(const product::Product& product,
                                            const Diagnostics& diagnostics);

}  // namespace hvas::app
