#pragma once

#include "device/device.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** How the device's workspace lies in the scene (X5): its base frame D is put at X_WD, and lengths
 are multiplied by `scale`; angles are not, so the hand turns as the part does. */
struct WorkspaceMapping {
  spatial::Pose X_WD;
  double scale{1};  ///< Scene length per device length, > 0.
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
  return {
      {(q_WD * state.X_DH.q()).normalized(), mapping.X_WD * Vec3(mapping.scale * state.X_DH.p())},
      {q_WD * state.V_DH.w, mapping.scale * (q_WD * state.V_DH.v)}};
}

/** The wrench on the hand in the device's base frame. Forces are not scaled: what the scene's
 newtons become is the force map's business alone. RT-safe. */
[[nodiscard]] inline spatial::Wrench MapToDevice(const WorkspaceMapping& mapping,
                                                 const spatial::Wrench& F_H_W) noexcept {
  const Quat q_DW = mapping.X_WD.q().conjugate();
  return {q_DW * F_H_W.t, q_DW * F_H_W.f};
}

}  // namespace hvas::haptics
