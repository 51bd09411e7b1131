#pragma once

#include <map>

#include <nlohmann/json.hpp>

#include "app/product/load_product.h"
#include "base/result.h"
#include "paths/path.h"
#include "product/product.h"

namespace hvas::app {

/** Calculates how near a part comes to others on its path: "clearances" of `hvas path --json`, the
 nearest part first, and "clearance_error_mm", by which a clearance can be less between two poses.
 @param others  Poses X_WN of the parts that stand beside the path.
 Errors: those of simulation::BuildShapes. */
[[nodiscard]] Result<nlohmann::ordered_json> DescribeClearances(
    const LoadOptions& load, const product::Product& product, product::OccurrenceId id,
    const paths::Path& path, const std::map<product::OccurrenceId, spatial::Pose>& others);

/** Prints what DescribeClearances() gives as a table. */
void PrintClearances(const nlohmann::ordered_json& described);

}  // namespace hvas::app
