#pragma once

#include <cstddef>
#include <span>

namespace hvas::cad {

/** How many nodes the scenes of a glTF 2 or GLB file have, those that several nodes hold counted as
 often as they are there. Takes any bytes; 0 where they hold no nodes. */
[[nodiscard]] double CountGltfNodes(std::span<const std::byte> bytes);

}  // namespace hvas::cad
