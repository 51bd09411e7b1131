#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/units.h"
#include "cad/triangles/segment.h"

namespace hvas::cad {

/** Triangles whose normals are nearer to each other than this may be of one curved face. */
inline const double kSmoothCosine = std::cos(units::FromDeg(40));

/** Finishes a first segmentation: joins neighbours on one surface, gives small leftovers to the
 surface that they lie on, dissolves scraps of curved surfaces amid a freeform face, and fits every
 surface once more to all of its corners.
 @param given  Of each triangle; segments of different given faces are never joined.
 @param label  Of each triangle: its segment. */
[[nodiscard]] std::vector<Segment> TidySegments(const WeldedMesh& mesh,
                                                const std::vector<std::uint32_t>& given,
                                                std::vector<std::uint32_t> label,
                                                std::vector<Segment> segments);

}  // namespace hvas::cad
