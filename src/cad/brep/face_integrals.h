#pragma once

#include <optional>

#include "spatial/pose.h"

class TopoDS_Face;
class gp_Pnt;

namespace hvas::cad {

/** Integrals over a face and over the cone from a point to it. In millimetres, like the shapes. */
struct FaceIntegrals {
  double area_mm2{0};    ///< [mm^2]
  double volume_mm3{0};  ///< Volume of the cone; negative where the face looks at the point.
  Vec3 first_mm4{Vec3::Zero()};  ///< Integral of the position from the point over the cone [mm^4].
  Mat3 inertia_mm5{Mat3::Zero()};  ///< Inertia of the cone about the point, at density 1 [mm^5].
};

/** Integrates over a face by its boundary (Green's theorem in the parameters of its surface): along
 the edges by an adaptive Gauss rule, and across the face by a fixed one, which is exact on planes,
 cylinders, cones and extrusions. The error is about 1e-9 of the area times the greatest distance
 from the point. Edges that leave gaps in the parameters err by the area of the gaps.

 @returns nullopt for a face without edges (a whole sphere or torus) or without a surface. */
[[nodiscard]] std::optional<FaceIntegrals> IntegrateFace(const TopoDS_Face& face,
                                                         const gp_Pnt& about);

}  // namespace hvas::cad
