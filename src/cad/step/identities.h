#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "cad/step/step_text.h"
#include "product/identity.h"

/** The management data of a STEP file (ISO 10303-41): what it says of its products besides shape.
 */
namespace hvas::cad {

/** The identity of each PRODUCT_DEFINITION, by the number of its entity: id and description of its
 PRODUCT, id and description of its PRODUCT_DEFINITION_FORMATION, persons, organisations and the
 earliest date that are assigned to one of the three. Of persons and organisations those with the
 role "creator" or "design_owner" count, or "author"; where none has one of these, all do but
 approvers and classification officers. Takes any text: what cannot be read is left out. */
[[nodiscard]] std::map<std::uint64_t, product::Identity> ReadIdentities(const StepText& text);

/** The header section of ISO 10303-21 (FILE_DESCRIPTION, FILE_NAME, FILE_SCHEMA). Takes any text;
 what cannot be read is empty. */
[[nodiscard]] product::FileHeader ReadStepHeader(std::string_view step_text);

}  // namespace hvas::cad
