#pragma once

#include "spatial/surface.h"

class TopoDS_Face;

namespace hvas::cad {

/** The surface under a B-rep face, in the face's frame [m]. */
struct FaceSurface {
  spatial::Surface surface;   ///< Its sense is not set yet: see OrientSurface.
  bool is_recognised{false};  ///< Fitted to a surface that is not analytic in the file.
};

/** Reads an analytic surface, or recognises one within `tolerance` [m] from a grid of points over
 the face's parameter range; else kFreeform. */
[[nodiscard]] FaceSurface CalcFaceSurface(const TopoDS_Face& face, double tolerance);

}  // namespace hvas::cad
