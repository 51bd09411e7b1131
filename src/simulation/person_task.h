#pragma once

#include "product/ids.h"
#include "sequence/grip_way.h"
#include "spatial/pose.h"

namespace hvas::simulation {

/** A person who carries a part around the product begins at least this high above its centre, by
 the distance from there: what comes from the side is then carried over the product, and not
 through the table. A choice. */
inline constexpr double kLeastRiseAside = 0.3;

/** What an operator has been told about one part: where it lies, where it should go and which way
 in; or, for a part to be taken out, where it is, which way out and where to put it down. */
struct PersonTask {
  product::OccurrenceId occurrence;
  spatial::Pose
      X_WG_start;  ///< Grip frame, lying on the table: at the centre of mass, turned as the part.
  spatial::Pose X_WG_goal;  ///< Grip frame of the part in its place.
  /** The part is in its place: it is drawn out and put down at X_WG_start. */
  bool takes_out{false};
  /** The part is on its way already, within the product: it goes on along it from where it is, and
   stays where it sticks. */
  bool starts_on_way{false};
  Vec3 p_BG{Vec3::Zero()};           ///< The grip in the part.
  Vec3 extraction_W{Vec3::UnitZ()};  ///< Unit; the way out, that of the last piece of `way`.
  double engage_distance{0};         ///< [m] from the goal, where insertion begins.
  /** The way of the grip where it is not straight; outlives the task. Null: straight. */
  const sequence::GripWay* way{nullptr};
  bool is_threaded{
      false};  ///< The way is that of its thread: it is turned along it, and no slot found.
  /** It has play in its hole, and touches it there: it may stick in it tilted, and pressing harder
   wedges it. */
  bool has_play{false};
  /** Only planes guide it: what they leave free the eye has to find. */
  bool is_guided_by_planes{false};
  /** [m] from the goal, where it stops, rests, draws the part out again and brings it back;
   negative: it goes all the way in. */
  double turn_back{-1};
  Vec3 centre_W{Vec3::Zero()};  ///< The product's.
  double transfer_radius{0};    ///< [m] at which it may be carried around the product.
  double lift_height{0.05};     ///< [m] that clears the other parts on the table.

  /** Its way bends or turns, and not as a thread does. RT-safe. */
  [[nodiscard]] bool bends() const noexcept { return way != nullptr && !is_threaded; }

  /** Where the way has the grip, so far from the goal. RT-safe. */
  [[nodiscard]] spatial::Pose WayAt(double travel) const noexcept;

  /** How far from the goal along the way a grip is, looked for from `near` on [m]. RT-safe. */
  [[nodiscard]] double TravelOf(const spatial::Pose& X_WG, double near) const noexcept;

  /** sequence::Unit; the direction outward of the way there. RT-safe. */
  [[nodiscard]] Vec3 OutwardAt(double travel) const noexcept;

  /** Where the part is clear of the others on the table. RT-safe. */
  [[nodiscard]] Vec3 CalcLifted() const noexcept;

  /** Point over the table at which nothing is met, at this distance from the product's centre.
   RT-safe. */
  [[nodiscard]] Vec3 CalcPointAside(double distance) const noexcept;

  /** Distance from the goal at which the way in crosses the sphere on which nothing is met, and at
   least `least` [m]. RT-safe. */
  [[nodiscard]] double CalcWayToSphere(double least) const noexcept;
};

}  // namespace hvas::simulation
