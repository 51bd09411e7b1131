#pragma once

#include <string>

#include "paths/surface.h"

namespace hvas::paths {

/** A mesh as a binary STL file, in millimetres, which is what readers of STL take it for. */
[[nodiscard]] std::string MakeStl(const SurfaceMesh& mesh);

}  // namespace hvas::paths
