#pragma once

#include <cstddef>

#include <nlohmann/json_fwd.hpp>

#include "base/diagnostics.h"
#include "product/product.h"

namespace hvas::app {

[[nodiscard]] const char* ToString(Severity severity);
[[nodiscard]] const char* ToString(product::MateKind kind);
[[nodiscard]] const char* ToString(product::FitKind kind);
[[nodiscard]] const char* ToString(product::DimensionKind kind);
[[nodiscard]] const char* ToString(product::GeometricToleranceKind kind);

struct ToleranceCounts {
  std::size_t dimensions{0};
  std::size_t geometric{0};
  std::size_t fits{0};  ///< Dimensions with a fit.
};

[[nodiscard]] ToleranceCounts CountTolerances(const product::Product& product);

/** The product as one JSON object: summary, parts, subassemblies, occurrences, mates, diagnostics.
 Keys carry their unit; keys keep this order. */
[[nodiscard]] nlohmann::ordered_json ToJson(const product::Product& product,
                                            const Diagnostics& diagnostics);

}  // namespace hvas::app
