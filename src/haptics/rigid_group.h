#pragma once

#include <vector>

#include "contact/scene.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** Parts that are put together and move as one body (X1). Immutable: other parts are another group.
 The first member leads: poses and mass properties are given in its frame. */
struct RigidGroup {
  struct Member {
    contact::BodyId body;
    spatial::Pose X_BS;  ///< Pose in the frame of the first member; its own is the identity.
  };

  std::vector<Member> members;          ///< Never empty.
  std::vector<contact::BodyId> bodies;  ///< Bodies of all members, in their order.
  double mass{0};                       ///< Sum over all members [kg].
  Vec3 p_BoBcm_B{Vec3::Zero()};         ///< Their common centre of mass [m].
  Mat3 I_BBcm_B{Mat3::Zero()};          ///< About the common centre of mass [kg m2].

  [[nodiscard]] contact::BodyId leader() const noexcept { return bodies.front(); }
};

}  // namespace hvas::haptics
