#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/product/selection.h"
#include "base/diagnostics.h"
#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::app {

/** The schema of the JSON that ToJson makes: data/schemas/inspect.schema.json. */
inline constexpr std::string_view kInspectFormat = "hvas-inspect-2";

struct ToleranceCounts {
  std::size_t dimensions{0};
  std::size_t geometric{0};
  std::size_t fits{0};  ///< Dimensions with a fit.
};

[[nodiscard]] ToleranceCounts CountTolerances(const product::Product& product);

/** Lists what is odd: severity, code, entity, message and remedy of each. */
[[nodiscard]] nlohmann::ordered_json DiagnosticsToJson(const Diagnostics& diagnostics);

/** The product as one JSON object: format, summary (always of the whole product) and the sections
 that are selected. Keys carry their unit; keys keep this order.
 @param watch  What it ends is incomplete. */
[[nodiscard]] nlohmann::ordered_json ToJson(const product::Product& product,
                                            const Diagnostics& diagnostics,
                                            const Selection& selection, WorkWatch* watch);

/** What is known of a mate beyond its fit; the keys are those of the side file. */
[[nodiscard]] nlohmann::ordered_json ConditionsToJson(const product::Mate& mate);

/** Mates as in the section "mates". */
[[nodiscard]] nlohmann::ordered_json MatesToJson(const std::vector<product::Mate>& mates);

/** Adds "meshes": vertices and triangles of the selected parts. */
void AddMeshes(const product::Product& product, const Selection& selection, bool is_fine,
               nlohmann::ordered_json* json);

}  // namespace hvas::app
