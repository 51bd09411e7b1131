#include "spatial/pose.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "spatial/test/random_pose.h"

namespace hvas::spatial {
namespace {

double Difference(const Pose& X, const Pose& Y) {
  return std::max((X.p() - Y.p()).norm(), (X.R() - Y.R()).norm());
}

Eigen::Matrix4d Homogeneous(const Pose& X) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = X.R();
  T.topRightCorner<3, 1>() = X.p();
  return T;
}

// The matrix exponential by scaling and squaring of its series: no trigonometry in it.
Mat3 ExpBySeries(const Vec3& theta_u) {
  constexpr int kSquarings = 10;
  const Mat3 A = Skew(theta_u) / std::ldexp(1.0, kSquarings);
  Mat3 term = Mat3::Identity();
  Mat3 sum = term;
  for (int k = 1; k < 12; ++k) {
    term = term * A / k;
    sum += term;
  }
  for (int i = 0; i < kSquarings; ++i) {
    sum = (sum * sum).eval();
  }
  return sum;
}

TEST(Pose, ComposesAsHomogeneousMatricesDo) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Pose X_AB = RandomPose(&random, 2);
    const Pose X_BC = RandomPose(&random, 2);
    const Vec3 p_BQ = RandomVector(&random, 2);
    const Eigen::Matrix4d product = Homogeneous(X_AB) * Homogeneous(X_BC);
    EXPECT_LT((Homogeneous(X_AB * X_BC) - product).norm(), 1e-14 * 20);
    EXPECT_LT(((X_AB * p_BQ) - (X_AB.R() * p_BQ + X_AB.p())).norm(), 1e-14);
    EXPECT_LT(Difference(X_AB * X_AB.Inverse(), Pose()), 1e-14);
    EXPECT_LT(Difference(X_AB.Inverse() * X_AB, Pose()), 1e-14);
  }
}

TEST(Pose, StaysAUnitQuaternionOverAMillionProducts) {
  Random random(2);
  const Pose step(RotationFromVector({0.01, -0.02, 0.005}), Vec3::Zero());
  Pose X;
  for (int i = 0; i < 1000000; ++i) {
    X = X * step;
  }
  EXPECT_NEAR(X.q().norm(), 1, 1e-15);
}

TEST(RotationVector, ComesBackFromItsRotation) {
  Random random(3);
  const double angles[] = {0,
                           1e-300,
                           1e-16,
                           1e-12,
                           1e-9,
                           3e-9,
                           1e-8,
                           1e-6,
                           0.1,
                           1,
                           2,
                           3,
                           std::numbers::pi - 1e-6,
                           std::numbers::pi - 1e-9,
                           std::numbers::pi - 1e-12};
  for (const double angle : angles) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 theta_u = angle * RandomDirection(&random);
      const Vec3 back = RotationVector(RotationFromVector(theta_u));
      EXPECT_LT((back - theta_u).norm(), 1e-12) << angle;
      if (angle < 1e-3) {
        // Small rotations keep their relative precision, not only their absolute one.
        EXPECT_LE((back - theta_u).norm(), 1e-14 * angle) << angle;
      }
    }
  }
}

TEST(RotationVector, AtAHalfTurnIsPiAboutEitherEndOfTheAxis) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vec3 axis = RandomDirection(&random);
    const Vec3 vector = RotationVector(RotationFromVector(std::numbers::pi * axis));
    EXPECT_NEAR(vector.norm(), std::numbers::pi, 1e-12);
    EXPECT_NEAR(std::abs(vector.dot(axis)), std::numbers::pi, 1e-12);
  }
}

TEST(RotationVector, IsTheSameForBothSignsOfTheQuaternionAndNeverLongerThanPi) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Quat q = RandomRotation(&random);
    const Quat minus(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_EQ(RotationVector(q), RotationVector(minus));
    EXPECT_LE(RotationVector(q).norm(), std::numbers::pi + 1e-15);
    EXPECT_LT(
        (RotationFromVector(RotationVector(q)).toRotationMatrix() - q.toRotationMatrix()).norm(),
        1e-14);
  }
}

TEST(RotationFromVector, IsTheMatrixExponential) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Vec3 theta_u = RandomVector(&random, 3);
    EXPECT_LT((RotationFromVector(theta_u).toRotationMatrix() - ExpBySeries(theta_u)).norm(),
              1e-12);
  }
}

TEST(RotationBetween, IsExpressedInTheCommonFrame) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Quat q_AB1 = RandomRotation(&random);
    const Quat q_AB2 = RandomRotation(&random);
    const Vec3 theta_u_A = RotationBetween(q_AB1, q_AB2);
    EXPECT_LT(
        ((RotationFromVector(theta_u_A) * q_AB1).toRotationMatrix() - q_AB2.toRotationMatrix())
            .norm(),
        1e-14);
    // Seen from another frame, the same rotation has turned coordinates.
    const Quat q_WA = RandomRotation(&random);
    EXPECT_LT((RotationBetween(q_WA * q_AB1, q_WA * q_AB2) - q_WA * theta_u_A).norm(), 1e-12);
  }
}

TEST(Integrate, FollowsAConstantTwistExactly) {
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Pose X_WB = RandomPose(&random, 1);
    const Twist V_WB{RandomVector(&random, 1), RandomVector(&random, 1)};
    const double time = 0.8;
    Pose X = X_WB;
    for (int k = 0; k < 100; ++k) {
      X = Integrate(X, V_WB, time / 100);
    }
    // About a fixed axis in W the steps commute, so that many steps are one.
    EXPECT_LT(Difference(X, Integrate(X_WB, V_WB, time)), 1e-13);
    EXPECT_LT((X.R() - ExpBySeries(V_WB.w * time) * X_WB.R()).norm(), 1e-12);
    EXPECT_LT((X.p() - X_WB.p() - time * V_WB.v).norm(), 1e-13);
  }
}

// The definition of angular velocity: dR/dt = Skew(w) R.
TEST(Integrate, HasTheDerivativeThatTheTwistSays) {
  Random random(9);
  constexpr double kH = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const Pose X_WB = RandomPose(&random, 1);
    const Twist V_WB{RandomVector(&random, 2), RandomVector(&random, 2)};
    const Mat3 dR = (Integrate(X_WB, V_WB, kH).R() - Integrate(X_WB, V_WB, -kH).R()) / (2 * kH);
    EXPECT_LT((dR - Skew(V_WB.w) * X_WB.R()).norm(), 1e-8);
  }
}

TEST(RotationTaking, TakesOneDirectionToTheOtherTheShortWay) {
  Random random(10);
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = RandomDirection(&random);
    const Vec3 b = RandomDirection(&random);
    const Quat q = RotationTaking(a, b);
    EXPECT_LT((q * a - b).norm(), 1e-14);
    EXPECT_NEAR(RotationVector(q).norm(), std::atan2(a.cross(b).norm(), a.dot(b)), 1e-12);
    EXPECT_LT((RotationTaking(a, a) * b - b).norm(), 1e-14);
  }
}

TEST(RotationTaking, IsExactAtAndNearAHalfTurn) {
  Random random(13);
  for (const double tilt : {0.0, 1e-16, 1e-15, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
    SCOPED_TRACE(tilt);
    for (int i = 0; i < 50; ++i) {
      const Vec3 a = RandomDirection(&random);
      const Vec3 side = a.cross(RandomDirection(&random)).normalized();
      const Vec3 b = -std::cos(tilt) * a + std::sin(tilt) * side;
      const Quat q = RotationTaking(a, b);
      EXPECT_LT((q * a - b).norm(), 3e-15);
      EXPECT_NEAR(RotationVector(q).norm(), std::numbers::pi - tilt, 1e-14);
    }
  }
}

TEST(FrameFromZ, IsRightHandedWithTheGivenAxis) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const Vec3 zhat = i < 3 ? Vec3(Vec3::Unit(i)) : RandomDirection(&random);
    const Mat3 R = FrameFromZ(zhat).toRotationMatrix();
    EXPECT_LT((R.col(2) - zhat).norm(), 1e-14);
    EXPECT_LT((R * R.transpose() - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
  }
}

TEST(Skew, IsTheCrossProduct) {
  Random random(12);
  for (int i = 0; i < 50; ++i) {
    const Vec3 a = RandomVector(&random, 3);
    const Vec3 b = RandomVector(&random, 3);
    EXPECT_EQ(Vec3(Skew(a) * b), a.cross(b));
    EXPECT_EQ(Mat3(Skew(a).transpose()), Mat3(-Skew(a)));
  }
}

TEST(IsFinite, SeesASingleBadNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(IsFinite(Pose()));
  EXPECT_FALSE(IsFinite(Pose(Vec3(0, nan, 0))));
  EXPECT_FALSE(IsFinite(Pose(Vec3(0, 0, infinity))));
  EXPECT_FALSE(IsFinite(Pose(Quat(1, 0, nan, 0), Vec3::Zero())));
}

TEST(Wrench, AddsAndNegatesBothParts) {
  Wrench F{{1, 2, 3}, {4, 5, 6}};
  F += {{1, 1, 1}, {2, 2, 2}};
  EXPECT_EQ(F.t, Vec3(2, 3, 4));
  EXPECT_EQ(F.f, Vec3(6, 7, 8));
  EXPECT_EQ((-F).t, Vec3(-2, -3, -4));
  EXPECT_EQ((-F).f, Vec3(-6, -7, -8));
}

}  // namespace
}  // namespace hvas::spatial
