#pragma once

#include "base/result.h"
#include "simulation/model.h"

namespace hvas::simulation {

/** Gives the product its table, and every part its place on it: the height of the table below the
 product (`table_z`), how far from its centre parts are carried around it (`transfer_radius`), the
 places of subassemblies that are put together first, and the poses in which the loose parts lie in
 rows, turned as drawn and come to rest. Small parts lie in front, larger ones behind; those of a
 size in the order in which they come. Deterministic.
 @return An error where a part's mesh cannot be made a body. */
[[nodiscard]] Result<void> LayOutParts(Model* model);

}  // namespace hvas::simulation
