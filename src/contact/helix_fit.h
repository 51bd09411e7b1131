#pragma once

#include <vector>

#include "contact/helix.h"
#include "contact/mesh.h"
#include "spatial/surface.h"

namespace hvas::contact {

/** Finds the threads that are modelled in a mesh. About each axis that a face of revolution has,
 the pitches of all triangles, -2 pi r n_phi / n_z with n the normal, are counted: those of a thread
 are equal, whatever its profile. Axis and pitch are then moved until vertices of the same height on
 the profile have the same radius. The profile is what the mesh's edges draw; the span of the thread
 is as far as they stay within a few per cent of its depth, chords of the mesh left aside.
 @param faces  Surface of each face of the mesh. @returns in the mesh's frame; mostly none. */
[[nodiscard]] std::vector<Helix> FindHelices(const Mesh& mesh,
                                             const std::vector<spatial::Surface>& faces);

}  // namespace hvas::contact
