#pragma once

#include "product/product.h"
#include "simulation/sequence.h"
#include "studio/live_run.h"

namespace hvas::studio {

/** The step that a part's next move belongs to: of the part itself, or of the subassembly that it
 is a member of; kRemove for a part that is in its place (X16). */
[[nodiscard]] simulation::SequenceStep FindStep(const simulation::Model& model,
                                                const LiveState& state, product::OccurrenceId id);

}  // namespace hvas::studio
