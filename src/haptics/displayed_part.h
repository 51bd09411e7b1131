#pragma once

#include "haptics/held_part.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** The held part as it is displayed: it stays outside the others, wherever the hand is (X7). */
struct DisplayedPart {
  const HeldPart* part{nullptr};  ///< Null while the hand is empty.
  spatial::Pose X_WD;
  spatial::Twist V;  ///< Velocity of the part's centre of mass, in W.
  double reach{0};   ///< Largest distance of a point of the part from its centre of mass [m].

  [[nodiscard]] Vec3 p_WCm() const noexcept { return X_WD * part->p_BoBcm_B; }
};

/** The held part where the hand has it, with nothing in its way. */
struct TrackedPart {
  spatial::Pose X_WT;
  spatial::Twist V;  ///< Velocity of the part's centre of mass, in W.
};

}  // namespace hvas::haptics
