#pragma once

#include <vector>

#include "product/product.h"
#include "product/recognition_limits.h"

namespace hvas::product {

/** Forms by which a tool turns a fastener. */
enum class DriveKind {
  kHexagon,  ///< Six flats at 60 degrees.
  kCross,    ///< Two slots that cross at a right angle.
  kSlot,     ///< Two facing flats across the axis.
};

/** A form that takes up or gives torque. A screw's socket and a ring spanner's opening are
 recesses; a screw's head and the end of a hexagon key are outside of the material. */
struct DriveForm {
  DriveKind kind{DriveKind::kHexagon};
  bool is_recess{false};
  bool is_through{false};       ///< Open at both ends.
  Vec3 origin_B{Vec3::Zero()};  ///< Point of the axis at the open end.
  Vec3 axis_B{Vec3::UnitZ()};   ///< Unit, from the open end along the flats: the way in which a
                                ///< counterpart is put on.
  Vec3 flat_B{Vec3::UnitX()};   ///< Unit, outward normal of the material of one of the flats.
  double width{0};              ///< Distance of opposite flats (across flats, width of a slot) [m].
  double span{0};   ///< Largest distance of opposite ends of a slot's flats [m]; hexagon: 0.
  double depth{0};  ///< Length of the flats along the axis that all of them have [m].
  std::vector<FaceId> faces;  ///< The flats.
};

/** Finds the drives of a part (requirement X16; docs/algorithms/tools.md). Hexagons are found by
 their flats alone; crosses and slots on the axes of the part's holes and shafts, as recesses.
 Hexalobular recesses, and recesses whose walls are not flat, are not recognised.
 @param tolerance Of positions [m]. @param limits Gets the limits that were reached. @pre `features`
 of the part are there. Deterministic; in the order of their first face. */
[[nodiscard]] std::vector<DriveForm> FindDriveForms(const Part& part, double tolerance,
                                                    RecognitionLimits* limits);

}  // namespace hvas::product
