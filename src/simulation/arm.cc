#include "simulation/arm.h"

namespace hvas::simulation {

void AdvanceArm(const Arm& arm, const HandReference& reference, const spatial::Wrench& F_H_W,
                double dt, spatial::Pose* X_WH, spatial::Twist* V_WH) noexcept {
  const Vec3 f = arm.stiffness * (reference.X_WR.p() - X_WH->p()) +
                 arm.damping * (reference.v_R_W - V_WH->v) + F_H_W.f + reference.f_W;
  const Vec3 t = arm.turn_stiffness * spatial::RotationBetween(X_WH->q(), reference.X_WR.q()) -
                 arm.turn_damping * V_WH->w + F_H_W.t;
  V_WH->v += dt / arm.mass * f;
  V_WH->w += dt / arm.inertia * t;
  *X_WH = spatial::Integrate(*X_WH, *V_WH, dt);
}

}  // namespace hvas::simulation
