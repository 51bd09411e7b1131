// Contact on CAD surfaces, N2: depth and onset on meshes whose truth is the analytic surface.

#include <numeric>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

constexpr double kHalfMicrometre = 0.5e-6;

// Parts that several tests share, built once.
const std::shared_ptr<const Shape>& FittedBushing() {
  static const auto shape = Build(testing::Bushing(20e-3, 30e-3, 80e-3));
  return shape;
}

const std::shared_ptr<const Shape>& FittedShaft() {
  static const auto shape = Build(testing::Shaft(19.99e-3, 100e-3));
  return shape;
}

const std::shared_ptr<const Shape>& PlateWithDowelHole() {
  static const auto shape = Build(testing::Bushing(3e-3, 30e-3, 15e-3));
  return shape;
}

const std::shared_ptr<const Shape>& SmallBall() {
  static const auto shape = Build(testing::Ball(5e-3, 30e-6));
  return shape;
}

class QueryTest : public ::testing::Test {
 protected:
  double Deepest(const Scene& scene, const Shape& held, const Pose& X_WH) {
    scene.Query(held, X_WH, options_, &work_);
    return work_.deepest();
  }

  bool HasContactWith(std::uint32_t held_face, std::uint32_t scene_face) const {
    for (const Contact& c : work_.contacts()) {
      if (c.held_face == held_face && c.scene_face == scene_face) {
        return true;
      }
    }
    return false;
  }

  QueryOptions options_;
  QueryWorkspace work_;
};

Vec3 InPlane(double length, double angle) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

Quat RandomRotation(Random* random) {
  return Quat(random->Normal(), random->Normal(), random->Normal(), random->Normal()).normalized();
}

// Test C of the contact study: a shaft pressed 0.1 mm into a bore, the direction turning.
TEST_F(QueryTest, X6ShaftInBoreHasTheExactDepthAndNormal) {
  Scene scene;
  scene.Add(FittedBushing(), {});
  const auto shaft = FittedShaft();
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.261 * i;
    const double depth = Deepest(scene, *shaft, Pose(InPlane(110e-6, angle) + Vec3(0, 0, -10e-3)));
    EXPECT_NEAR(depth, -100e-6, kHalfMicrometre) << "angle " << angle;
    for (const Contact& c : work_.contacts()) {
      EXPECT_TRUE(c.is_exact);
      EXPECT_EQ(c.held_face, 1U);
      EXPECT_EQ(c.scene_face, 3U);
      // The two axes are 110 um apart, hence up to 5.5 mrad between the radial directions.
      EXPECT_NEAR(c.nhat_W.dot(Vec3(c.p_WC.x(), c.p_WC.y(), 0).normalized()), -1, 2e-5);
    }
  }
}

// Test D: a dowel of 5.98 mm in a hole of 6 mm begins to touch at 10 um of eccentricity.
TEST_F(QueryTest, DowelBeginsToTouchAtItsClearance) {
  Scene scene;
  scene.Add(PlateWithDowelHole(), {});
  const auto dowel = Build(testing::Shaft(2.99e-3, 20e-3));
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.53 * i;
    EXPECT_GT(Deepest(scene, *dowel, Pose(InPlane(9.5e-6, angle) + Vec3(0, 0, 5e-3))), 0);
    EXPECT_LT(Deepest(scene, *dowel, Pose(InPlane(10.5e-6, angle) + Vec3(0, 0, 5e-3))), 0);
  }
}

// Test P: flat on flat, in every direction, with the four corners of the overlap kept.
TEST_F(QueryTest, PlateOnPlateKeepsTheCornersOfTheOverlap) {
  Scene scene;
  const auto block = Build(testing::Block({50e-3, 40e-3, 10e-3}));
  scene.Add(block, {});
  const Vec3 shift(13e-3, 17e-3, 20e-3 - 30e-6);
  EXPECT_NEAR(Deepest(scene, *block, Pose(shift)), -30e-6, kHalfMicrometre);
  for (const double x : {-37e-3, 50e-3}) {
    for (const double y : {-23e-3, 40e-3}) {
      double nearest = 1;
      for (const Contact& c : work_.contacts()) {
        EXPECT_NEAR(c.distance, -30e-6, kHalfMicrometre);
        EXPECT_NEAR(c.nhat_W.z(), 1, 1e-12);
        nearest = std::min(nearest, (c.p_WC.head<2>() - Eigen::Vector2d(x, y)).norm());
      }
      EXPECT_LT(nearest, 1e-3) << "corner " << x << ", " << y;
    }
  }
}

// The meshes of the round faces are off by 30 um: what counts is the surface under them.
// Truth: for a ball against any solid, the distance of its centre less its radius.
struct BallCase {
  const char* name;
  ShapeSource solid;
  Vec3 centre;  // Of the ball, just above the face meant, by its radius less 20 um.
  std::uint32_t face;
};

TEST_F(QueryTest, X6BallMeetsEveryKindOfFaceAtTheExactDepth) {
  const double r = 5e-3;
  const double out = r - 20e-6;
  const double slope = std::atan2(10e-3, 30e-3);
  const Vec3 on_cone = Vec3(15e-3, 0, 15e-3) + out * Vec3(std::cos(slope), 0, std::sin(slope));
  const std::vector<BallCase> cases = {
      {"plane", testing::Block({30e-3, 30e-3, 5e-3}), Vec3(3.3e-3, 1.7e-3, 5e-3 + out), 5},
      {"cylinder", testing::Shaft(20e-3, 60e-3, 30e-6),
       InPlane(20e-3 + out, 0.4) + Vec3(0, 0, 31e-3), 1},
      {"bore", testing::Bushing(20e-3, 30e-3, 60e-3, 30e-6),
       InPlane(20e-3 - out, 0.4) + Vec3(0, 0, 31e-3), 3},
      {"cone", testing::Cone(20e-3, 10e-3, 30e-3, 30e-6), on_cone, 1},
      {"sphere", testing::Ball(10e-3, 30e-6), (10e-3 + out) * Vec3(0.48, 0.6, 0.64), 0},
      {"torus", testing::Ring(20e-3, 5e-3, 30e-6),
       InPlane(20e-3, 0.7) + (5e-3 + out) * (InPlane(0.6, 0.7) + Vec3(0, 0, 0.8)), 0},
  };
  const auto ball = SmallBall();
  for (const BallCase& c : cases) {
    const auto solid = Build(c.solid);
    Scene scene;
    scene.Add(solid, {});
    EXPECT_NEAR(Deepest(scene, *ball, Pose(c.centre)), -20e-6, kHalfMicrometre) << c.name;
    ASSERT_FALSE(work_.contacts().empty()) << c.name;
    EXPECT_EQ(work_.contacts().front().scene_face, c.face) << c.name;
    // The same the other way round.
    Scene other;
    other.Add(ball, Pose(c.centre));
    EXPECT_NEAR(Deepest(other, *solid, {}), -20e-6, kHalfMicrometre) << c.name << " held";
  }
}

TEST_F(QueryTest, DoesNotDependOnTheWorldFrame) {
  const auto bushing = FittedBushing();
  const auto shaft = FittedShaft();
  const Pose X_SH(spatial::RotationFromVector({2e-4, -1e-4, 0.3}), Vec3(8e-6, 3e-6, -10e-3));
  Scene here;
  here.Add(bushing, {});
  const double expected = Deepest(here, *shaft, X_SH);
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(::testing::Message() << "draw " << i);
    const Pose X_WS(RandomRotation(&random), Vec3(random.Normal(), random.Normal(), 0.3));
    Scene scene;
    scene.Add(bushing, X_WS);
    EXPECT_NEAR(Deepest(scene, *shaft, X_WS * X_SH), expected, 50e-9);
  }
}

TEST_F(QueryTest, ActionEqualsReactionWhenTheRolesAreSwapped) {
  const auto plate = PlateWithDowelHole();
  const auto block = Build(testing::Block({5e-3, 4e-3, 3e-3}));
  Random random(11);
  int touching = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(::testing::Message() << "draw " << i);
    const Pose X_WB(RandomRotation(&random),
                    Vec3(random.Uniform(-5e-3, 5e-3), random.Uniform(-5e-3, 5e-3),
                         random.Uniform(18e-3, 22e-3)));
    Scene a;
    a.Add(plate, {});
    const double first = Deepest(a, *block, X_WB);
    Scene b;
    b.Add(block, X_WB);
    const double second = Deepest(b, *plate, {});
    // Beyond the margin a contact may be seen from one side only.
    if (std::min(first, second) < 0 && std::min(first, second) > -1e-3) {
      ++touching;
      EXPECT_NEAR(first, second, 20e-6 + 0.1 * std::abs(first));
    }
  }
  EXPECT_GT(touching, 20);
}

TEST_F(QueryTest, GroundHoldsTheLowestPoints) {
  Scene scene;
  scene.SetGround(0.1);
  const auto block = Build(testing::Block({50e-3, 40e-3, 10e-3}));
  EXPECT_NEAR(Deepest(scene, *block, Pose(Vec3(1, 2, 0.11 - 5e-6))), -5e-6, 1e-8);
  ASSERT_GE(work_.contacts().size(), 4U);
  for (const Contact& c : work_.contacts()) {
    EXPECT_FALSE(c.body.is_valid());
    EXPECT_EQ(c.held_face, 4U);
    EXPECT_EQ(c.nhat_W, Vec3::UnitZ());
  }
  // A cylinder on its side rolls on a line whatever way its samples are turned.
  const auto shaft = Build(testing::Shaft(20e-3, 60e-3, 30e-6));
  for (int i = 0; i < 20; ++i) {
    const Quat q = spatial::RotationFromVector({0.5 * std::numbers::pi, 0, 0}) *
                   spatial::RotationFromVector({0, 0, 0.0123 * i});
    EXPECT_NEAR(Deepest(scene, *shaft, Pose(q, Vec3(0, 0, 0.12 - 5e-6))), -5e-6, 0.1e-6);
  }
}

TEST_F(QueryTest, IgnoredFacesLeaveTheOthers) {
  const auto cup = Build(testing::Cup(3e-3, 20e-3, 5e-3, 20e-3));
  const auto dowel = Build(testing::Shaft(3.005e-3, 20e-3));  // An interference of 5 um.
  Scene scene;
  const BodyId body = scene.Add(cup, {});
  const std::vector<std::uint32_t> held{1};
  const std::vector<std::uint32_t> bore{3};
  const IgnoredPair pair{body, held, bore};
  options_.ignored = {&pair, 1};
  EXPECT_EQ(Deepest(scene, *dowel, Pose(Vec3(2e-6, 1e-6, 8e-3))),
            std::numeric_limits<double>::infinity());
  // At the floor: reported with its own depth, also where the wall is nearer.
  EXPECT_NEAR(Deepest(scene, *dowel, Pose(Vec3(2e-6, 1e-6, 5e-3 + 20e-6))), 20e-6, 0.1e-6);
  EXPECT_TRUE(HasContactWith(0, 4));
  EXPECT_NEAR(Deepest(scene, *dowel, Pose(Vec3(2e-6, 1e-6, 5e-3 - 20e-6))), -20e-6, 0.1e-6);
  for (const Contact& c : work_.contacts()) {
    EXPECT_EQ(c.scene_face, 4U);
    EXPECT_NEAR(c.nhat_W.z(), 1, 1e-9);
  }
  options_.ignored = {};
  EXPECT_NEAR(Deepest(scene, *dowel, Pose(Vec3(2e-6, 0, 8e-3))), -7e-6, kHalfMicrometre);
}

TEST_F(QueryTest, AThreadDrawnAtItsOuterDiameterIsNotMetByTheRimOfItsCoreHole) {
  const auto core = Build(testing::Cup(4.2e-3, 20e-3, 5e-3, 20e-3));
  const auto thread = Build(testing::Shaft(5e-3, 20e-3));
  Scene scene;
  const BodyId body = scene.Add(core, {});
  const std::vector<std::uint32_t> held{0, 1, 2};
  const std::vector<std::uint32_t> hole{2, 3};
  const IgnoredPair pair{body, held, hole};
  options_.ignored = {&pair, 1};
  for (int i = 1; i < 60; ++i) {
    const Quat q = spatial::RotationFromVector({0, 0, 0.11 * i});
    EXPECT_EQ(Deepest(scene, *thread, Pose(q, Vec3(0, 0, 6e-3 + 0.23e-3 * i))),
              std::numeric_limits<double>::infinity())
        << i;
  }
}

TEST_F(QueryTest, SkipsDisabledBodiesAndItself) {
  const auto block = Build(testing::Block({10e-3, 10e-3, 10e-3}));
  Scene scene;
  const BodyId a = scene.Add(block, {});
  const BodyId b = scene.Add(block, Pose(Vec3(0, 0, 20e-3 - 1e-6)));
  EXPECT_FALSE(scene.IsFree(*block, Pose(Vec3(0, 0, 1e-3)), 1e-6, options_, &work_));
  options_.self = a;
  EXPECT_NEAR(Deepest(scene, *block, {}), -1e-6, 0.1e-6);
  EXPECT_TRUE(scene.IsFree(*block, {}, 2e-6, options_, &work_));
  scene.SetEnabled(b, false);
  EXPECT_EQ(Deepest(scene, *block, {}), std::numeric_limits<double>::infinity());
  scene.SetEnabled(b, true);
  scene.SetPose(b, Pose(Vec3(1, 0, 0)));
  EXPECT_EQ(Deepest(scene, *block, {}), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(Deepest(scene, *block, Pose(Vec3(1, 0, 20e-3 + 5e-6))), 5e-6, 0.1e-6);
}

TEST_F(QueryTest, AShaftSlidingPastARimIsNotHeldBackByIt) {
  Scene scene;
  scene.Add(FittedBushing(), {});
  const auto shaft = FittedShaft();
  for (int i = 0; i < 40; ++i) {
    Deepest(scene, *shaft, Pose(Vec3(9e-6, 0, -10e-3 - 37e-6 * i)));
    for (const Contact& c : work_.contacts()) {
      EXPECT_LT(std::abs(c.nhat_W.z()), 0.05);
    }
  }
}

TEST_F(QueryTest, MarginReachesBeyondTheNarrowBand) {
  Scene scene;
  scene.Add(Build(testing::Block({20e-3, 20e-3, 5e-3})), {});
  const auto ball = SmallBall();
  options_.margin = 3e-3;
  // Speculative only: a tenth of the coarse cell is good enough out there.
  EXPECT_NEAR(Deepest(scene, *ball, Pose(Vec3(0, 0, 12.5e-3))), 2.5e-3, 0.2e-3);
  EXPECT_FALSE(work_.contacts().empty());
}

TEST_F(QueryTest, FindsBodiesInALargeSceneAsInASmallOne) {
  const auto block = Build(testing::Block({10e-3, 10e-3, 10e-3}));
  Scene scene;
  Random random(3);
  std::vector<Vec3> centres;
  for (int i = 0; i < 400; ++i) {
    centres.emplace_back(random.Uniform(0, 0.6), random.Uniform(0, 0.6), random.Uniform(0, 0.6));
    scene.Add(block, Pose(Vec3::Zero()));
  }
  for (std::size_t i = 0; i < centres.size(); ++i) {
    scene.SetPose(BodyId{i}, Pose(centres[i]));
  }
  options_.margin = 0;
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(random.Uniform(0, 0.6), random.Uniform(0, 0.6), random.Uniform(0, 0.6));
    bool is_free = true;
    for (const Vec3& c : centres) {
      is_free = is_free && ((p - c).cwiseAbs().array() > 20e-3).any();
    }
    met += is_free ? 0 : 1;
    EXPECT_EQ(scene.IsFree(*block, Pose(p), 0, options_, &work_), is_free)
        << "draw " << i << " deepest " << work_.deepest();
  }
  EXPECT_GT(met, 20);
  EXPECT_LT(met, 250);
}

}  // namespace
}  // namespace hvas::contact
