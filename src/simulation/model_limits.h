#pragma once

#include "base/diagnostics.h"
#include "simulation/model.h"

namespace hvas::simulation {

/** Reports what of a model is beyond the limits of docs/limits.md: mates of what is held
 ("limit-mates"), pairs of faces that mates take out of contact ("limit-face-pairs"), and light
 parts ("limit-mass"). One diagnostic for each part and limit, and one for all light parts. */
void ReportModelLimits(const Model& model, Diagnostics* diagnostics);

}  // namespace hvas::simulation
