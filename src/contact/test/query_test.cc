// Contact on CAD surfaces, N2: depth and onset on meshes whose truth is the analytic surface.

#include <gtest/gtest.h>

#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

constexpr double kHalfMicrometre = 0.5e-6;

class QueryTest : public ::testing::Test {
 protected:
  double Deepest(const Scene& scene, const Shape& held, const Pose& X_WH) {
    scene.Query(held, X_WH, options_, &work_);
    return work_.deepest();
  }

  QueryOptions options_;
  QueryWorkspace work_;
};

Vec3 InPlane(double length, double angle) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

// Test C of the contact study: a shaft pressed 0.1 mm into a bore, the direction turning.
TEST_F(QueryTest, ShaftInBoreHasTheExactDepthAndNormal) {
  Scene scene;
  scene.Add(Build(testing::Bushing(20e-3, 30e-3, 80e-3)), {});
  const auto shaft = Build(testing::Shaft(19.99e-3, 100e-3));
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.261 * i;
    const double depth = Deepest(scene, *shaft, Pose(InPlane(110e-6, angle) + Vec3(0, 0, -10e-3)));
    EXPECT_NEAR(depth, -100e-6, kHalfMicrometre) << "angle " << angle;
    for (const Contact& c : work_.contacts()) {
      EXPECT_TRUE(c.is_exact);
      EXPECT_EQ(c.scene_face, 3U);
      EXPECT_NEAR(c.nhat_W.dot(Vec3(c.p_WC.x(), c.p_WC.y(), 0).normalized()), -1, 2e-5);
    }
  }
}

// Test D: a dowel of 5.98 mm in a hole of 6 mm begins to touch at 10 um of eccentricity.
TEST_F(QueryTest, DowelBeginsToTouchAtItsClearance) {
  Scene scene;
  scene.Add(Build(testing::Bushing(3e-3, 30e-3, 15e-3)), {});
  const auto dowel = Build(testing::Shaft(2.99e-3, 20e-3));
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.53 * i;
    EXPECT_GT(Deepest(scene, *dowel, Pose(InPlane(9.5e-6, angle) + Vec3(0, 0, 5e-3))), 0);
    EXPECT_LT(Deepest(scene, *dowel, Pose(InPlane(10.5e-6, angle) + Vec3(0, 0, 5e-3))), 0);
  }
}

}  // namespace
}  // namespace hvas::contact
