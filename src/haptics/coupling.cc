#include "haptics/coupling.h"

#include <algorithm>

namespace hvas::haptics {
namespace {

constexpr double kMaxCouplingShare = 0.9;  // of the device's force; more than fits are felt with
constexpr double kLeastTorque = 0.2;       // [N m]; turns the part where no torque is shown

}  // namespace

const TrackedPart& Coupling::Track(const Hand& hand, const DisplayedPart& displayed) noexcept {
  if (!has_grip_) {
    X_HB_ = hand.X_WH.Inverse() * displayed.X_WD;
    has_grip_ = true;
  }
  const spatial::Pose X_WT = hand.X_WH * X_HB_;
  const Vec3 r = X_WT * displayed.part->p_BoBcm_B - hand.X_WH.p();
  tracked_ = {X_WT, {hand.V_WH.w, hand.V_WH.v + hand.V_WH.w.cross(r)}};
  return tracked_;
}

void Coupling::AddTo(const DisplayedPart& displayed, ConstraintSolver* solver) const noexcept {
  // X(1), X(2), with the damper's sign mended, and never more than the device can give.
  const Stretch stretch = CalcStretch(displayed);
  const CouplingGains& now = stretch.gains;
  const Vec3 p_WCm = displayed.p_WCm();
  solver->AddPointSpring(p_WCm, now.k_lin * stretch.e_W, now.k_lin * Mat3::Identity());
  solver->AddPointDamper(p_WCm, tracked_.V.v, now.b_lin);
  solver->AddAngularSpring(now.k_rot * stretch.theta_W, now.k_rot * Mat3::Identity());
  solver->AddAngularDamper(tracked_.V.w, now.b_rot);
}

Coupling::Stretch Coupling::CalcStretch(const DisplayedPart& displayed) const noexcept {
  const CouplingGains& gains = options_.coupling;
  Stretch stretch;
  stretch.e_W = tracked_.X_WT * displayed.part->p_BoBcm_B - displayed.p_WCm();
  stretch.theta_W = spatial::RotationBetween(displayed.X_WD.q(), tracked_.X_WT.q());
  const double max_force = kMaxCouplingShare * options_.device.max_force;
  const double max_torque = kMaxCouplingShare * std::max(kLeastTorque, options_.device.max_torque);
  const auto saturate = [](double k, double stretched, double most) {
    return stretched * k > most ? most / stretched : k;
  };
  CouplingGains& now = stretch.gains;
  now.k_lin = saturate(gains.k_lin, stretch.e_W.norm(), max_force);
  now.k_rot = saturate(gains.k_rot, stretch.theta_W.norm(), max_torque);
  now.b_lin = gains.b_lin * now.k_lin / gains.k_lin;
  now.b_rot = gains.b_rot * now.k_rot / gains.k_rot;
  return stretch;
}

spatial::Wrench Coupling::CalcWrench(const DisplayedPart& displayed) const noexcept {
  const Stretch stretch = CalcStretch(displayed);
  const CouplingGains& now = stretch.gains;
  return {now.b_rot * (displayed.V.w - tracked_.V.w) - now.k_rot * stretch.theta_W,
          now.b_lin * (displayed.V.v - tracked_.V.v) - now.k_lin * stretch.e_W};
}

double Coupling::CalcEnergy(const DisplayedPart& displayed) const noexcept {
  const Vec3 e = tracked_.X_WT * displayed.part->p_BoBcm_B - displayed.p_WCm();
  return 0.5 * options_.coupling.k_lin * e.squaredNorm();
}

double Coupling::CalcTurningEnergy(const DisplayedPart& displayed) const noexcept {
  const Vec3 theta = spatial::RotationBetween(displayed.X_WD.q(), tracked_.X_WT.q());
  return 0.5 * options_.coupling.k_rot * theta.squaredNorm();
}

}  // namespace hvas::haptics
