#include "device/emulation/rate_person.h"

#include <algorithm>

namespace hvas::device {
namespace {

constexpr double kCloseTime = 0.1;  // the way that is left is covered in about this time

/** The norm of a deflection that has this share of the largest speed, found by halving. */
double DeflectionFor(double share) {
  double low = RateControl::kDeadZone;
  double high = 1;
  constexpr int kHalvings = 20;  // 2^-20 of the stick's way.
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (RateControl::Response(middle) < share ? low : high) = middle;
  }
  return high;
}

Vec3 Towards(const Vec3& way, double max_speed) {
  const double length = way.norm();
  const double share = std::min(1.0, length / kCloseTime / max_speed);
  constexpr double kLeast = 1e-3;  // below it the stick is let go of
  return share > kLeast ? Vec3(DeflectionFor(share) / length * way) : Vec3::Zero();
}

}  // namespace

Deflection RatePerson::Deflect(const spatial::Pose& X_DR) const {
  return {Towards(X_DR.p() - seen_.X_DH().p(), RateControl::kMaxSpeed),
          Towards(spatial::RotationBetween(seen_.X_DH().q(), X_DR.q()), RateControl::kMaxTurnRate)};
}

}  // namespace hvas::device
