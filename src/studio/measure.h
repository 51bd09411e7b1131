#pragma once

#include <optional>

#include "base/result.h"
#include "simulation/model.h"
#include "studio/json.h"
#include "studio/live_run.h"

namespace hvas::studio {

/** A face of an occurrence that a client has picked. */
struct PickedFace {
  product::OccurrenceId occurrence;
  product::FaceId face;
};

/** Measures one face, or a pair of faces, at the parts' present poses, on the exact surfaces
 instead of their triangles (X16). The fields are those of docs/protocol.md; fields without meaning
 for the pair are omitted. Parallel planes and axes have a distance, others an angle. Errors:
 kNotFound for a face that the part does not have. */
[[nodiscard]] Result<Json> Measure(const simulation::Model& model, const LiveState& state,
                                   const PickedFace& a, const std::optional<PickedFace>& b);

}  // namespace hvas::studio
