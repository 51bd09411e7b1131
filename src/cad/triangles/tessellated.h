#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/process/read_cad.h"
#include "cad/step/step_text.h"
#include "product/product.h"

namespace hvas::cad {

/** Whether a STEP text may hold tessellated shapes: a search for their names. */
[[nodiscard]] bool MayHoldTessellation(std::string_view step_text);

/** Reads the tessellated shapes of a STEP text (AP242, ISO 10303-42 tessellated_shape_model):
 solids, shells and sets of triangulated faces in their unit, with the colours of the faces, names,
 and the assembly. The faces are those of the file; a surface that the file gives for one is taken
 when its triangles lie on it, else one is fitted (cad/segment.h). Takes any text.

 @param product  Has its name and source.
 Errors: kUnreadable when there is no triangle. */
[[nodiscard]] Result<void> ReadTessellated(const StepText& text, const ImportOptions& options,
                                           const ReadWatch& watch, product::Product* product,
                                           Diagnostics* diagnostics);

}  // namespace hvas::cad
