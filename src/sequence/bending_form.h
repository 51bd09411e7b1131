#pragma once

#include <optional>
#include <vector>

#include "product/product.h"

namespace hvas::sequence {

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

/** Where two parts meet sideways on a straight way, deeper than they may. */
struct SideMeeting {
  product::OccurrenceId moved;  ///< The one on its way; the other is where it is drawn.
  product::OccurrenceId other;
  Vec3 p_W{Vec3::Zero()};      ///< Place of contact.
  Vec3 nhat_W{Vec3::UnitX()};  ///< Normal of contact, out of `other`.
  Vec3 way_W{Vec3::UnitZ()};   ///< Unit, along which `moved` goes.
  double travelled{0};         ///< How far it has gone there [m].
  double width{0};             ///< How far one of the two has to bend [m].
};

/** A part that bends where two parts meet. */
struct WhatBends {
  product::OccurrenceId part;
  Bending bending;
  double inward_sign{1};  ///< 1 where the normal of contact points into the part, else -1.
};

/** A wall that would bear to bend, but has no room behind it. */
struct NoRoom {
  product::OccurrenceId part;     ///< What would bend.
  product::OccurrenceId against;  ///< What it would come to.
  double needed{0};               ///< [m]
  double free{0};                 ///< How far it can bend [m].
};

/** What comes of it where two parts meet sideways. */
struct BendingAnswer {
  std::optional<WhatBends> bends;  ///< The one with the least strain; none: neither bears it.
  std::optional<NoRoom> no_room;   ///< Where none bends: what would, with the most room.
};

/** Finds which of two parts that meet sideways bends aside: one that is not stated to be rigid, is
 a wall there (FindBending), bears the strain (product::FindBearableStrain), and has one and a half
 times the room that it needs behind it, before any part that is present.
 @param is_present  By occurrence. */
[[nodiscard]] BendingAnswer FindWhatBends(const product::Product& product,
                                          const SideMeeting& meeting,
                                          const std::vector<bool>& is_present);

}  // namespace hvas::sequence
