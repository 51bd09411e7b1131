#pragma once

#include <vector>

#include "product/product.h"
#include "product/recognition_limits.h"

namespace hvas::product {

/** What flats around an axis make. */
enum class PolygonKind {
  kRegular,  ///< Equal flats at equal angles: square, hexagon, octagon.
  kFlatted,  ///< A round with one flat, or with two parallel ones: D and double D.
  kSpline,   ///< Equal teeth with flat, parallel flanks (ISO 14).
};

/** Flats of a part around an axis: what turns with it has their counterpart. Pockets, bores and
 sockets are recesses; shafts and heads are outside of the material. */
struct PolygonForm {
  PolygonKind kind{PolygonKind::kRegular};
  int sides{0};  ///< Number of flats; teeth of a spline.
  bool is_recess{false};
  bool is_through{false};       ///< Open at both ends.
  Vec3 origin_B{Vec3::Zero()};  ///< Point of the axis at the open end.
  Vec3 axis_B{Vec3::UnitZ()};   ///< Unit, from the open end along the flats: the way in which a
                                ///< counterpart is put on.
  Vec3 flat_B{Vec3::UnitX()};   ///< Unit, outward normal of the material of one of the flats.
  double width{0};     ///< Distance of opposite flats; D: of the flat from the round behind it;
                       ///< spline: width of a tooth [m].
  double diameter{0};  ///< Diameter of the round of flatted and splined ones [m]; else 0.
  double depth{0};     ///< Length along the axis that all flats have [m].
  std::vector<FaceId> faces;  ///< The flats, ascending.
};

/** Finds regular polygons with 4, 6 or 8 sides by their flats alone, and D forms and splines about
 the axes of the part's holes and shafts. @param tolerance Of positions [m]. @param limits Gets the
 limits that were reached. @pre `features` of the part are there. Deterministic; in the order of
 their first face. */
[[nodiscard]] std::vector<PolygonForm> FindPolygons(const Part& part, double tolerance,
                                                    RecognitionLimits* limits);

/** Finds the regular ones alone, with this even number of sides. */
[[nodiscard]] std::vector<PolygonForm> FindRegularPolygons(const Part& part, int sides,
                                                           double tolerance,
                                                           RecognitionLimits* limits);

}  // namespace hvas::product
