#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "cad/step/step_text.h"
#include "product/product.h"

namespace hvas::cad {

/** Whether a STEP text may state dimensions or tolerances: a search for their names. */
[[nodiscard]] bool MayHoldTolerances(std::string_view step_text);

/** The ISO 286 code in a text: "G6", "g6", "H7/g6", also with '-' for the stroke;
 capitals are holes, small letters are shafts. Empty where the text is something else. */
[[nodiscard]] std::optional<std::string> NormaliseFitCode(std::string_view text);

/** Reads the dimensions, geometric tolerances and fits that a STEP text (AP242) states, and gives
 them to the parts that have their faces, by Face::entity; those without a face go to the part that
 others of the same shape go to, or to the only part.

 Values are scaled from the unit that each one names to SI. A diameter that is not that of its
 cylinder within 1 % is taken for one in another unit when inches, metres or their inverses explain
 it ("dimension-unit"). What is damaged is left out and noted; any text is taken. */
void ReadTolerances(const StepText& text, product::Product* product, Diagnostics* diagnostics);

}  // namespace hvas::cad
