#pragma once

#include <string>

#include "sweep/surface.h"

namespace hvas::sweep {

/** A mesh as a binary STL file, in millimetres, which is what readers of STL take it for. */
[[nodiscard]] std::string MakeStl(const SurfaceMesh& mesh);

}  // namespace hvas::sweep
