#pragma once

#include <cstddef>
#include <span>

#include "cad/scene/placed_parts.h"

namespace hvas::cad {

/** The nodes of the scenes of a glTF 2 or GLB file, those that several nodes hold counted as often
 as they are there. Takes any bytes; nothing where they hold no nodes. */
[[nodiscard]] PlacedTree ExamineGltfNodes(std::span<const std::byte> bytes);

}  // namespace hvas::cad
