#pragma once

#include <optional>

#include "base/result.h"
#include "simulation/model.h"
#include "studio/workbench.h"

namespace hvas::studio {

/** A face of a part, as a viewer picks it. */
struct PickedFace {
  product::OccurrenceId occurrence;
  product::FaceId face;
};

/** What there is to measure on one face, or between two, at the parts' present poses; from the
 exact surfaces, not from triangles (X16). The fields are those of docs/protocol.md; those that make
 no sense for the pair are left out. Parallel planes and axes have a distance, others an angle.
 Errors (kNotFound): there is no such face. */
[[nodiscard]] Result<Json> Measure(const simulation::Model& model, const LiveState& state,
                                   const PickedFace& a, const std::optional<PickedFace>& b);

}  // namespace hvas::studio
