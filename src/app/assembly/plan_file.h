#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "product/product.h"
#include "sequence/sequence.h"

namespace hvas::app {

/** What a plan needs so that it can be followed later: the parts by their paths, and all steps to
 the last bit. */
[[nodiscard]] nlohmann::ordered_json MakeFollowedPlan(
    const product::Product& product, const std::vector<sequence::SequenceStep>& steps);

/** Reads the steps of a plan that `hvas plan -o` has written.
 Errors: as ReadRegularFile; kUnreadable for what is no plan, kInvalid for the plan of another
 product. */
[[nodiscard]] Result<std::vector<sequence::SequenceStep>> ReadPlan(
    const std::filesystem::path& file, const product::Product& product);

}  // namespace hvas::app
