#include "haptics/workspace.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {
namespace {

/** How far a coordinate is into the border of [-half, half]: 0 inside, +-1 at the edge. */
double IntoBorder(double p, double half, double share) noexcept {
  if (!std::isfinite(half)) {
    return 0;
  }
  const double width = share * half;
  return std::copysign(std::clamp((std::abs(p) - (half - width)) / width, 0.0, 1.0), p);
}

}  // namespace

void Workspace::Index(const spatial::Pose& X_DH) noexcept {
  const Quat& q_WD = mapping_.X_WD.q();
  mapping_.q_index = (X_DH.q().conjugate() * q_WD.conjugate() * hand_.X_WH.q()).normalized();
  mapping_.X_WD = {q_WD, hand_.X_WH.p() - q_WD * (mapping_.scale * X_DH.p())};
}

Hand Workspace::Update(const device::DeviceState& state, double dt) noexcept {
  if (has_hand_ && (is_lost_ || state.is_clutching)) {
    Index(state.X_DH);
    hand_.V_WH = {};
    border_.setZero();
    drift_D_.setZero();
    is_lost_ = false;
    return hand_;
  }
  for (int k = 0; k < 3; ++k) {
    border_[k] = IntoBorder(state.X_DH.p()[k], 0.5 * options_.box[k], options_.border_share);
    drift_D_[k] = options_.border_speed * border_[k] * std::abs(border_[k]);
  }
  const Vec3 v_W = mapping_.X_WD.q() * drift_D_;
  if (is_in_border()) {
    mapping_.X_WD = {mapping_.X_WD.q(), mapping_.X_WD.p() + dt * v_W};
  }
  hand_ = MapToScene(mapping_, state);
  hand_.V_WH.v += v_W;
  has_hand_ = true;
  return hand_;
}

spatial::Wrench Workspace::ToDevice(const spatial::Wrench& F_H_W) const noexcept {
  spatial::Wrench F_H_D = MapToDevice(mapping_, F_H_W);
  F_H_D.f -= options_.border_force * border_;
  return F_H_D;
}

}  // namespace hvas::haptics
