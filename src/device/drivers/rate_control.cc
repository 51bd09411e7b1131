#include "device/drivers/rate_control.h"

#include <algorithm>

namespace hvas::device {
namespace {

// A cubic with so much of a straight line, fine in the middle and whole at the edge: a choice, not
// measured.
constexpr double kLinearShare = 0.3;
constexpr double kMaxStepTime = 0.05;  // after a pause nothing leaps

Vec3 SpeedShare(const Vec3& deflection) noexcept {
  const double norm = deflection.norm();
  return norm > 0 ? Vec3(RateControl::Response(norm) / norm * deflection) : Vec3::Zero();
}

}  // namespace

double RateControl::Response(double norm) noexcept {
  const double u = std::clamp((norm - kDeadZone) / (1 - kDeadZone), 0.0, 1.0);
  return kLinearShare * u + (1 - kLinearShare) * u * u * u;
}

void RateControl::Step(const Deflection& deflection, double dt) noexcept {
  const double step = std::clamp(dt, 0.0, kMaxStepTime);
  const spatial::Twist wanted{kMaxTurnRate * SpeedShare(deflection.turn),
                              kMaxSpeed * SpeedShare(deflection.move)};
  const Vec3 p = (X_DH_.p() + step * wanted.v).cwiseMax(-half_).cwiseMin(half_);
  V_DH_.v = step > 0 ? Vec3((p - X_DH_.p()) / step) : Vec3::Zero();
  V_DH_.w = wanted.w;
  X_DH_ = {spatial::Integrate(X_DH_, {wanted.w, Vec3::Zero()}, step).q(), p};
}

}  // namespace hvas::device
