#pragma once

#include <cmath>

#include "spatial/pose.h"

/** The steps in which sessions are recorded. They are powers of two, so that rounded numbers are
 exact, and far below what a device resolves or a hand feels. Samples of devices are rounded before
 the tick gets them, so that a replay gets the same ones. */
namespace hvas::spatial {

inline constexpr double kLengthStep = 0x1p-30;      ///< 0.93 nm [m].
inline constexpr double kQuaternionStep = 0x1p-30;  ///< Each of the four numbers.
inline constexpr double kVelocityStep = 0x1p-24;    ///< 60 nm/s [m/s], and [rad/s].
inline constexpr double kForceStep = 0x1p-17;       ///< 7.6 uN [N].
inline constexpr double kTorqueStep = 0x1p-21;      ///< 0.48 uN m [N m].

/** The nearest multiple of a power of two. What is not finite, or beyond 2^52 steps, stays; zero is
 positive. RT-safe. */
[[nodiscard]] inline double RoundTo(double step, double value) noexcept {
  constexpr double kMostSteps = 0x1p52;  // From here on all numbers are multiples.
  const bool has_fraction = std::abs(value) < kMostSteps * step;
  return has_fraction ? std::nearbyint(value / step) * step + 0.0 : value;
}

[[nodiscard]] inline Vec3 RoundTo(double step, const Vec3& v) noexcept {
  return {RoundTo(step, v.x()), RoundTo(step, v.y()), RoundTo(step, v.z())};
}

/** The quaternion stays of unit length to within 2e-9. */
[[nodiscard]] inline Pose Rounded(const Pose& X) noexcept {
  const auto round = [](double value) { return RoundTo(kQuaternionStep, value); };
  const Quat& q = X.q();
  return {Quat(round(q.w()), round(q.x()), round(q.y()), round(q.z())),
          RoundTo(kLengthStep, X.p())};
}

[[nodiscard]] inline Twist Rounded(const Twist& V) noexcept {
  return {RoundTo(kVelocityStep, V.w), RoundTo(kVelocityStep, V.v)};
}

[[nodiscard]] inline Wrench Rounded(const Wrench& F) noexcept {
  return {RoundTo(kTorqueStep, F.t), RoundTo(kForceStep, F.f)};
}

}  // namespace hvas::spatial
