#pragma once

#include <vector>

#include "spatial/pose.h"

class TopoDS_Face;
class TopoDS_Shape;
class gp_Pnt;

namespace hvas::cad {

/** What a boundary encloses, and its faces. In millimetres, like the shapes. */
struct SolidMeasure {
  double volume_mm3{0};                ///< Negative where the boundary is inside out [mm^3].
  Vec3 first_mm4{Vec3::Zero()};        ///< Integral of the position from the point [mm^4].
  Mat3 inertia_mm5{Mat3::Zero()};      ///< About the point, at density 1 [mm^5].
  std::vector<double> face_areas_mm2;  ///< Areas in the order of TopExp_Explorer [mm^2].

  void Add(const SolidMeasure& other);
  void Negate();
};

/** Measures a solid (a shell, any shape with faces) about a point, as exactly as IntegrateFace
 does. Several faces at a time where it is threaded; they are added up in their order, so that it
 makes no difference. */
[[nodiscard]] SolidMeasure MeasureSolid(const TopoDS_Shape& solid, const gp_Pnt& about,
                                        bool is_threaded = false);

/** The area of a face [mm^2]. */
[[nodiscard]] double MeasureArea(const TopoDS_Face& face);

}  // namespace hvas::cad
