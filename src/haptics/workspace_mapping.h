#pragma once

#include "device/device.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** How the device's workspace lies in the scene (X5): its base frame D is put at X_WD, and lengths
 are multiplied by `scale`; angles are not, so the hand turns as the part does. */
struct WorkspaceMapping {
  spatial::Pose X_WD;
  double scale{1};                 ///< Scene length per device length, > 0.
  Quat q_index{Quat::Identity()};  ///< Offset of the hand from the handle, changed by clutching.
};

/** The hand H in the scene. */
struct Hand {
  spatial::Pose X_WH;
  spatial::Twist V_WH;
};

/** RT-safe. */
[[nodiscard]] inline Hand MapToScene(const WorkspaceMapping& mapping,
                                     const device::DeviceState& state) noexcept {
  const Quat& q_WD = mapping.X_WD.q();
  return {{(q_WD * state.X_DH.q() * mapping.q_index).normalized(),
           mapping.X_WD * Vec3(mapping.scale * state.X_DH.p())},
          {q_WD * state.V_DH.w, mapping.scale * (q_WD * state.V_DH.v)}};
}

/** Where the handle has to be for the hand to be at X_WH: the inverse of MapToScene. RT-safe. */
[[nodiscard]] inline spatial::Pose MapPoseToDevice(const WorkspaceMapping& mapping,
                                                   const spatial::Pose& X_WH) noexcept {
  const Quat q_DW = mapping.X_WD.q().conjugate();
  return {(q_DW * X_WH.q() * mapping.q_index.conjugate()).normalized(),
          q_DW * (X_WH.p() - mapping.X_WD.p()) / mapping.scale};
}

/** The wrench on the hand in the device's base frame. Forces are not scaled: what the scene's
 newtons become is the force map's business alone. RT-safe. */
[[nodiscard]] inline spatial::Wrench MapToDevice(const WorkspaceMapping& mapping,
                                                 const spatial::Wrench& F_H_W) noexcept {
  const Quat q_DW = mapping.X_WD.q().conjugate();
  return {q_DW * F_H_W.t, q_DW * F_H_W.f};
}

}  // namespace hvas::haptics
