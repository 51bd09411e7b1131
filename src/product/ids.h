#pragma once

#include "base/id.h"

namespace hvas::product {

using SubassemblyId = Id<struct SubassemblyTag>;
using PartId = Id<struct PartTag>;              ///< A shape; shared by its occurrences.
using OccurrenceId = Id<struct OccurrenceTag>;  ///< A part at a place.
using FeatureId = Id<struct FeatureTag>;        ///< Index into Part::features.
using FaceId = Id<struct FaceTag>;              ///< Index into Part::faces (layer J).
using MateId = Id<struct MateTag>;

}  // namespace hvas::product
