#pragma once

#include "product/ids.h"
#include "sequence/sequence.h"
#include "simulation/table_subassembly.h"
#include "studio/live_run.h"

namespace hvas::studio {

/** Finds the step of the sequence that a part's next move belongs to: the part's own, or that of
 the subassembly that it is a member of; kind kRemove for a part that is in its place (X16). Of
 parts that were put together on the table, all of them or the part alone (X1). */
[[nodiscard]] sequence::SequenceStep FindStep(const simulation::Model& model,
                                              const LiveState& state, product::OccurrenceId id,
                                              simulation::TakeExtent extent);

}  // namespace hvas::studio
