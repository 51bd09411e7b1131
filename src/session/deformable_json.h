#pragma once

#include <vector>

#include "base/result.h"
#include "record/reader.h"
#include "record/recorder.h"
#include "session/exact_json.h"
#include "simulation/deformation.h"

namespace hvas::session {

/** The forms of deformed parts, as a page draws them (docs/protocol.md): how far each is deformed
 comes with the frames. */
[[nodiscard]] Json MakeFormsJson(const std::vector<simulation::Deformable>& deformables);

/** Adds the deformed parts of a model to a record, with what deforms them, so that they follow from
 its poses without the model. Nothing where there are none. */
void AttachDeformables(const std::vector<simulation::Deformable>& deformables,
                       record::Recorder* recorder);

/** Reads the deformed parts of a record; none in older records. What is damaged, or does not belong
 to the product, is left out. Errors: those of the reader. */
[[nodiscard]] Result<std::vector<simulation::Deformable>> ReadDeformables(
    const product::Product& product, record::Reader* reader);

}  // namespace hvas::session
