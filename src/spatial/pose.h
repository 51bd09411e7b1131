#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hvas {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaterniond;

namespace spatial {

/** Rigid transform X_AB: takes coordinates in B to coordinates in A. Rotation as a unit quaternion
 (w, x, y, z when written out). */
class Pose {
 public:
  Pose() = default;

  Pose(const Quat& q_AB, const Vec3& p_AB) : q_(q_AB), p_(p_AB) {}

  explicit Pose(const Vec3& p_AB) : p_(p_AB) {}

  [[nodiscard]] const Quat& q() const { return q_; }

  [[nodiscard]] const Vec3& p() const { return p_; }

  [[nodiscard]] Mat3 R() const { return q_.toRotationMatrix(); }

  [[nodiscard]] Pose operator*(const Pose& X_BC) const {
    return {(q_ * X_BC.q_).normalized(), p_ + q_ * X_BC.p_};
  }

  [[nodiscard]] Vec3 operator*(const Vec3& p_BQ) const { return p_ + q_ * p_BQ; }

  [[nodiscard]] Pose Inverse() const { return {q_.conjugate(), -(q_.conjugate() * p_)}; }

 private:
  Quat q_{Quat::Identity()};
  Vec3 p_{Vec3::Zero()};
};

/** Velocity of a body: angular w [rad/s] and linear v [m/s] of its origin. */
struct Twist {
  Vec3 w{Vec3::Zero()};
  Vec3 v{Vec3::Zero()};
};

/** Torque t [N m] about a stated point and force f [N]. */
struct Wrench {
  Vec3 t{Vec3::Zero()};
  Vec3 f{Vec3::Zero()};

  Wrench& operator+=(const Wrench& other) {
    t += other.t;
    f += other.f;
    return *this;
  }

  [[nodiscard]] Wrench operator-() const { return {-t, -f}; }
};

/** Rotation vector theta u of q (|theta| <= pi), the logarithm of SO(3). */
[[nodiscard]] Vec3 RotationVector(const Quat& q);

/** The rotation whose rotation vector is given, the exponential of SO(3). */
[[nodiscard]] Quat RotationFromVector(const Vec3& theta_u);

/** Rotation vector, in A, that takes frame B1 to B2, both given in A. */
[[nodiscard]] Vec3 RotationBetween(const Quat& q_AB1, const Quat& q_AB2);

/** Moves X_WB by a twist given in W about B's origin: rotation exp(w dt), translation v dt. */
[[nodiscard]] Pose Integrate(const Pose& X_WB, const Twist& V_WB, double dt);

/** Shortest rotation that takes unit vector a to unit vector b; any half turn when antiparallel. */
[[nodiscard]] Quat RotationTaking(const Vec3& a, const Vec3& b);

/** A right-handed orthonormal frame whose z axis is the given unit vector. */
[[nodiscard]] Quat FrameFromZ(const Vec3& zhat);

/** Skew matrix: Skew(a) b = a x b. */
[[nodiscard]] Mat3 Skew(const Vec3& a);

[[nodiscard]] bool IsFinite(const Pose& X);

}  // namespace spatial
}  // namespace hvas
