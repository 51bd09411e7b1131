// Pooled force and stiffness of contacts: closed forms, central differences, invariance.

#include "contact/pool.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

constexpr double kStiffness = 1e6;  // [N/m]

Vec3 RandomVector(Random* random, double size) {
  return size * Vec3(random->Normal(), random->Normal(), random->Normal());
}

Vec6 ToVector(const spatial::Wrench& F) {
  Vec6 out;
  out << F.t, F.f;
  return out;
}

/** Contacts of points fixed in a part with planes fixed in the world, after the part has moved by
 (rotation vector about p_WQ, translation). */
std::vector<Contact> Moved(std::vector<Contact> contacts, const Vec3& p_WQ, const Vec6& x) {
  const Quat turn = spatial::RotationFromVector(x.head<3>());
  for (Contact& c : contacts) {
    const Vec3 p = p_WQ + x.tail<3>() + turn * (c.p_WC - p_WQ);
    c.distance += c.nhat_W.dot(p - c.p_WC);
    c.p_WC = p;
  }
  return contacts;
}

std::vector<Contact> RandomContacts(Random* random, int count, double depth) {
  std::vector<Contact> contacts(static_cast<std::size_t>(count));
  for (Contact& c : contacts) {
    c.p_WC = RandomVector(random, 20e-3);
    c.nhat_W = RandomVector(random, 1).normalized();
    c.distance = -depth * random->Uniform(0.5, 1);
  }
  return contacts;
}

/** -dF/dx by central differences. */
template <typename Force>
Mat6 Differentiate(const Force& force, double angle, double length) {
  Mat6 K;
  for (int i = 0; i < 6; ++i) {
    const double h = i < 3 ? angle : length;
    Vec6 x = Vec6::Zero();
    x[i] = h;
    K.col(i) = (ToVector(force(Vec6(-x))) - ToVector(force(x))) / (2 * h);
  }
  return K;
}

TEST(PooledWrench, StiffnessIsTheDerivativeOfTheForce) {
  Random random(5);
  for (int draw = 0; draw < 50; ++draw) {
    SCOPED_TRACE(::testing::Message() << "draw " << draw);
    const Vec3 p_WQ = RandomVector(&random, 10e-3);
    const auto contacts = RandomContacts(&random, 12, 0.2e-6);
    const Mat6 K = CalcPooledWrench(contacts, p_WQ, kStiffness).K;
    const Mat6 differences = Differentiate(
        [&](const Vec6& x) {
          // About the point of the part that was at p_WQ.
          return CalcPooledWrench(Moved(contacts, p_WQ, x), p_WQ + x.tail<3>(), kStiffness).F_W;
        },
        1e-7, 1e-9);
    const auto block_error = [&](int i, int j) {
      const Mat3 reference = differences.block<3, 3>(i, j);
      return (K.block<3, 3>(i, j) - reference).norm() / reference.norm();
    };
    EXPECT_LT(block_error(0, 0), 1e-4);
    EXPECT_LT(block_error(0, 3), 1e-4);
    EXPECT_LT(block_error(3, 0), 1e-4);
    EXPECT_LT(block_error(3, 3), 1e-4);
  }
}

TEST(PooledWrench, StiffnessIsSymmetricAndPositiveSemidefinite) {
  Random random(6);
  for (int draw = 0; draw < 50; ++draw) {
    const auto contacts = RandomContacts(&random, draw % 8, 1e-3);
    const Mat6 K = CalcPooledWrench(contacts, RandomVector(&random, 1), kStiffness).K;
    EXPECT_EQ(K, K.transpose());
    const Vec6 values = Eigen::SelfAdjointEigenSolver<Mat6>(K).eigenvalues();
    EXPECT_GE(values.minCoeff(), -1e-9 * std::max(1.0, values.maxCoeff()));
  }
}

// A ball of 5 mm in a plane by d: F = k d n at its foot, no torque about its centre, and K = k n
// n^T.
TEST(PooledWrench, OfABallInAPlaneIsTheClosedForm) {
  const auto ball = Build(testing::Ball(5e-3, 5e-6));
  Scene scene;
  scene.Add(Build(testing::Block({20e-3, 20e-3, 5e-3})), {});
  QueryWorkspace work;
  constexpr double kDepth = 0.2e-6;
  const Vec3 centre(1.3e-3, -2.1e-3, 10e-3 - kDepth);
  const auto pool = [&](const Vec6& x) {
    const Pose X_WH(spatial::RotationFromVector(x.head<3>()), centre + x.tail<3>());
    scene.Query(*ball, X_WH, {}, &work);
    return CalcPooledWrench(work.contacts(), X_WH.p(), kStiffness);
  };
  const PooledWrench at_rest = pool(Vec6::Zero());
  EXPECT_NEAR(at_rest.F_W.f.z(), kStiffness * kDepth, 1e-4 * kStiffness * kDepth);
  EXPECT_LT(at_rest.F_W.f.head<2>().norm(), 1e-9);
  EXPECT_LT(at_rest.F_W.t.norm(), 1e-6 * kStiffness * kDepth);
  Mat6 expected = Mat6::Zero();
  expected(5, 5) = kStiffness;
  EXPECT_LT(Mat3(at_rest.K.block(3, 3, 3, 3) - expected.block(3, 3, 3, 3)).norm(),
            1e-9 * kStiffness);
  EXPECT_LT(at_rest.K.block(0, 0, 3, 3).norm(), 1e-9 * kStiffness * 5e-3 * 5e-3);
  // The query itself, moved: the samples change, what they say does not.
  const Mat6 differences = Differentiate([&](const Vec6& x) { return pool(x).F_W; }, 1e-3, 20e-9);
  EXPECT_LT(Mat3(differences.block(3, 3, 3, 3) - expected.block(3, 3, 3, 3)).norm(),
            1e-4 * kStiffness);
}

TEST(PooledWrench, ContactsThatDoNotTouchGiveNothing) {
  Random random(8);
  auto contacts = RandomContacts(&random, 4, 1e-6);
  for (Contact& c : contacts) {
    c.distance = -c.distance;
  }
  const PooledWrench pooled = CalcPooledWrench(contacts, Vec3::Zero(), kStiffness);
  EXPECT_EQ(ToVector(pooled.F_W), Vec6(Vec6::Zero()));
  EXPECT_EQ(pooled.K, Mat6(Mat6::Zero()));
  EXPECT_EQ(ToVector(ContactLayer().CalcWrench(kStiffness, Vec3::UnitX())), Vec6(Vec6::Zero()));
}

// A block pressed flat by d onto a larger one: K d, through the middle of the overlap, whatever the
// number of samples and wherever the pair is in the world.
TEST(ContactLayer, FlatContactPressesInItsMiddle) {
  constexpr double kDepth = 10e-6;
  const auto plate = Build(testing::Block({40e-3, 40e-3, 5e-3}));
  Random random(9);
  for (const double spacing : {0.7e-3, 1.4e-3}) {
    ShapeOptions options;
    options.point_spacing = spacing;
    const auto block = Build(testing::Block({12e-3, 8e-3, 5e-3}), options);
    const Pose X_WS(spatial::RotationFromVector(RandomVector(&random, 1)),
                    RandomVector(&random, 0.1));
    const Pose X_WH = X_WS * Pose(Vec3(2e-3, -3e-3, 10e-3 - kDepth));
    Scene scene;
    scene.Add(plate, X_WS);
    QueryWorkspace work;
    scene.Query(*block, X_WH, {}, &work);
    const spatial::Wrench F_W = work.layer().CalcWrench(kStiffness, X_WH.p());
    const Vec3 f_S = X_WS.q().conjugate() * F_W.f;
    EXPECT_NEAR(f_S.z(), kStiffness * kDepth, 1e-3 * kStiffness * kDepth);
    EXPECT_LT(f_S.head<2>().norm(), 1e-9 * kStiffness * kDepth);
    const Vec3 t_S = X_WS.q().conjugate() * F_W.t;
    EXPECT_LT(t_S.norm(), spacing * F_W.f.norm());
  }
}

}  // namespace
}  // namespace hvas::contact
