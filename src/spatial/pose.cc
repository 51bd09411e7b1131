#include "spatial/pose.h"

#include <cmath>

namespace hvas::spatial {

Vec3 RotationVector(const Quat& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Vec3 v = sign * q.vec();
  const double s = v.norm();
  const double w = sign * q.w();
  // atan2 stays accurate near 0 and near pi, where acos does not.
  return s < 1e-12 ? Vec3(2 * v) : Vec3(2 * std::atan2(s, w) / s * v);
}

Quat RotationFromVector(const Vec3& theta_u) {
  const double theta = theta_u.norm();
  const double half = 0.5 * theta;
  const double scale = theta < 1e-9 ? 0.5 : std::sin(half) / theta;
  return Quat(std::cos(half), scale * theta_u.x(), scale * theta_u.y(), scale * theta_u.z())
      .normalized();
}

Vec3 RotationBetween(const Quat& q_AB1, const Quat& q_AB2) {
  return RotationVector(q_AB2 * q_AB1.conjugate());
}

Pose Integrate(const Pose& X_WB, const Twist& V_WB, double dt) {
  return {(RotationFromVector(V_WB.w * dt) * X_WB.q()).normalized(), X_WB.p() + V_WB.v * dt};
}

Quat RotationTaking(const Vec3& a, const Vec3& b) {
  // Half the sum and half the difference are the cosine and the sine of half the angle; with them
  // the result is exact to rounding at every angle, where 1 + a.b cancels near a half turn.
  constexpr double kTiny = 1e-15;
  const Vec3 sum = a + b;
  const Vec3 difference = a - b;
  const double s = sum.norm();
  const double d = difference.norm();
  if (d < kTiny) {
    return Quat::Identity();
  }
  const Vec3 mhat = difference / d;
  const Vec3 hhat =
      s < kTiny ? Vec3(FrameFromZ(mhat) * Vec3::UnitX()) : Vec3((sum - sum.dot(mhat) * mhat) / s);
  const Vec3 v = 0.5 * d * mhat.cross(hhat).normalized();
  return Quat(0.5 * s, v.x(), v.y(), v.z()).normalized();
}

Quat FrameFromZ(const Vec3& zhat) {
  const Vec3 helper = std::abs(zhat.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 xhat = (helper - helper.dot(zhat) * zhat).normalized();
  Mat3 R;
  R.col(0) = xhat;
  R.col(1) = zhat.cross(xhat);
  R.col(2) = zhat;
  return Quat(R).normalized();
}

Mat3 Skew(const Vec3& a) {
  Mat3 S;
  S << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return S;
}

bool IsFinite(const Pose& X) {
  return X.p().allFinite() && X.q().coeffs().allFinite();
}

}  // namespace hvas::spatial
