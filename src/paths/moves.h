#pragma once

#include <vector>

#include "paths/probe.h"

namespace hvas::paths {

/** Directions in W that may lead out, the given ones first, each once: those of contact normals at
 the start and what is at right angles to two of them, axes of round faces, axes of the part. */
[[nodiscard]] std::vector<Vec3> ListDirections(Probe* probe);

/** Axes about which the part may turn, the given ones first: those of its round faces and of round
 faces near it, largest first, lines along the part's axes through its centre, and edges of contact
 at the start. */
[[nodiscard]] std::vector<ScrewAxis> ListAxes(Probe* probe);

}  // namespace hvas::paths
