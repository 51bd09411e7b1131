#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/product/selection.h"
#include "product/product.h"

/** The sections of `hvas inspect` that are shown on request only: identities, relations of parts,
 and relations of the surfaces of a part. */
namespace hvas::app {

/** Adds "header", "identities", "relations" and "surface_relations", as selected. */
void AddRequestedSections(const product::Product& product, const Selection& selection,
                          nlohmann::ordered_json* json);

/** Prints them for people. */
void PrintRequestedSections(const product::Product& product, const Selection& selection,
                            bool is_all);

}  // namespace hvas::app
