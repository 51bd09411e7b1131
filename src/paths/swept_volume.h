#pragma once

#include <functional>
#include <stop_token>

#include "base/result.h"
#include "contact/shape.h"
#include "paths/path.h"
#include "paths/surface.h"

namespace hvas::paths {

struct SweepOptions {
  double resolution{0};  ///< Edge of a cell of the grid [m]; 0: chosen from part and path.
  /** Thinnest wall of the part [m], which a chosen resolution resolves as far as a grid has room;
   0: not known. */
  double thinnest_wall{0};
  unsigned threads{0};                            ///< 0: one a core. No matter for the result.
  std::function<void(double fraction)> progress;  ///< Called by the calling thread.
  std::stop_token stop;
};

/** All the space, in W, that a part needs on its way. */
struct SweptVolume {
  SurfaceMesh mesh;      ///< Stands in W; not empty.
  double volume{0};      ///< [m^3]
  double resolution{0};  ///< That was taken [m].
  /** No point of the mesh has a signed distance to the part at its nearest pose of a larger amount
   [m]. Walls of the part that are thinner than twice this may have holes. */
  double error{0};
};

/** Computes the space that a part sweeps. The distance of each node of a grid to the part, least
 over all poses, is taken where the surface may be, and the surface where it is zero. Between two
 poses that are less than half a cell apart the least is looked for along the way. The volume
 converges with the square of the resolution.
 Source: implicit swept volumes as in Sellan, Aigerman and Jacobson, Swept volumes via spacetime
 numerical continuation, ACM TOG 40(4), 2021, of which the definition; here time is searched whole.
 @param part  In B; closed, outward.
 Errors: kInvalid without triangles, poses or a positive resolution; kOutOfResource when the grid
 would be too large; kCancelled. */
[[nodiscard]] Result<SweptVolume> Sweep(const contact::ShapeSource& part, const Path& path,
                                        const SweepOptions& options);

}  // namespace hvas::paths
