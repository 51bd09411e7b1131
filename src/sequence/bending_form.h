#pragma once

#include <optional>

#include "product/product.h"

namespace hvas::sequence {

/** Strain that the root of a wall or an arm of plastic bears once: polycarbonate; most others bear
 more. Source: Bayer MaterialScience, Snap-Fit Joints for Plastics, table of permissible strains. */
inline constexpr double kBearableStrain = 0.04;

/** A wall or an arm of a part that has to bend aside. */
struct Bending {
  double strain{0};             ///< Strain at its root.
  double length{0};             ///< [m]
  double thickness{0};          ///< [m]
  Vec3 p_back_W{Vec3::Zero()};  ///< Where its far side is, as drawn [m].
};

/** Estimates what a part bears that would have to bend aside: a cantilever of constant section, as
 thick as the part is at the point, and as long as the part is along the way.
 Strain = y h / (0.67 l^2). None where it is thicker than a third of its length, and so no wall
 that bends.
 Source: Bayer MaterialScience, Snap-Fit Joints for Plastics, permissible deflection of shape 1.
 @param p_W  On the part, or in its material. @param inward_W  Unit; into the material.
 @param way_W  Unit. @param deflection  y [m]. */
[[nodiscard]] std::optional<Bending> FindBending(const product::Product& product,
                                                 product::OccurrenceId id, const Vec3& p_W,
                                                 const Vec3& inward_W, const Vec3& way_W,
                                                 double deflection);

/** Whether another part leaves a wall the room to bend into: within one and a half times the
 deflection of its far side, nothing of the other part is met.
 @param p_back_W  Far side of the wall, with the other part as drawn. @param inward_W  Unit. */
[[nodiscard]] bool HasRoomToBend(const product::Product& product, product::OccurrenceId other,
                                 const Vec3& p_back_W, const Vec3& inward_W, double deflection);

}  // namespace hvas::sequence
