// How exact contact is, N2: tests C, A, P and D of the contact study and seats on cones, spheres
// and tori. Truth is the analytic geometry of the parts, which are meshed to 1 um (or 10 um).
// HVAS_TOL_SCALE=0 prints what is left.

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "contact/scene.h"
#include "contact/test/accuracy_cases.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::AccuracyCase;
using testing::Build;
using testing::Radial;

constexpr double kHalfMicrometre = 0.5e-6;
constexpr double kStiffness = 1e3;  // [N/m], 1 N/mm as in the study.

/** A held part in one other. */
class Pair {
 public:
  Pair(const ShapeSource& held, const ShapeSource& other) : held_(Build(held)) {
    scene_.Add(Build(other), {});
  }

  double Deepest(const Pose& X_WH) {
    scene_.Query(*held_, X_WH, {}, &work_);
    return work_.deepest();
  }

  [[nodiscard]] Vec3 PooledForce() const {
    return work_.layer().CalcWrench(kStiffness, Vec3::Zero()).f;
  }

  /** How far along `direction` the first contact is met, to 10 nm. */
  double Onset(const Pose& start, const Vec3& direction, double high) {
    double low = 0;
    while (high - low > 10e-9) {
      const double middle = 0.5 * (low + high);
      const bool touches = Deepest(Pose(start.q(), start.p() + middle * direction)) < 0;
      (touches ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  std::shared_ptr<const Shape> held_;
  Scene scene_;
  QueryWorkspace work_;
};

class AccuracyTest : public ::testing::TestWithParam<AccuracyCase> {};

TEST_P(AccuracyTest, DepthIsExactAndThePooledForceSmooth) {
  const AccuracyCase& test = GetParam();
  Pair pair(test.held(1e-6), test.other(1e-6));
  double depth_error = 0;
  double force_change = 0;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < test.steps; ++i) {
    depth_error = std::max(depth_error, std::abs(-pair.Deepest(test.pose(i)) - test.depth));
    const Vec3 force = pair.PooledForce();
    force_change = i > 0 ? std::max(force_change, (force - last).norm()) : 0;
    last = force;
  }
  if (std::getenv("HVAS_TOL_SCALE") != nullptr) {
    std::printf("  %s: depth error %.1f nm, force change %.4f mN\n", test.name.c_str(),
                1e9 * depth_error, 1e3 * force_change);
  }
  EXPECT_LE(depth_error, kHalfMicrometre);
  EXPECT_GT(last.norm(), 0.3 * kStiffness * test.depth);  // Two thirds on a line, all on a plane.
  if (test.force_limit > 0) {
    EXPECT_LE(force_change, test.force_limit);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, AccuracyTest, ::testing::ValuesIn(testing::AllAccuracyCases()),
                         [](const auto& item) { return item.param.name; });
INSTANTIATE_TEST_SUITE_P(Freeform, AccuracyTest,
                         ::testing::ValuesIn(testing::FreeformAccuracyCases()),
                         [](const auto& item) { return item.param.name; });

// H7/g6 on 6 mm at its tightest: hole 6.000, dowel 5.996, hence 2 um of clearance at the radius.
TEST(ClearanceOnset, OfAFittedDowelIsRightToHalfAMicrometre) {
  struct Fit {
    double hole, shaft;  // Radii [m].
  };

  for (const Fit fit : {Fit{3e-3, 2.998e-3}, {3.006e-3, 2.994e-3}, {20e-3, 19.9955e-3}}) {
    Pair pair(testing::Shaft(fit.shaft, 30e-3),
              testing::Bushing(fit.hole, fit.hole + 10e-3, 20e-3));
    for (int i = 0; i < 8; ++i) {
      const double onset = pair.Onset(Pose(Vec3(0, 0, 3e-3)), Radial(1, 0.83 * i), 60e-6);
      EXPECT_NEAR(onset, fit.hole - fit.shaft, kHalfMicrometre) << fit.hole << " turn " << i;
    }
  }
}

TEST(ClearanceOnset, OfATaperABallAndARingIsRightToHalfAMicrometre) {
  const auto pair_of = [](const AccuracyCase& test) {
    return Pair(test.held(1e-6), test.other(1e-6));
  };
  Pair taper = pair_of(testing::CaseCone());
  const Pose above(testing::TurnedOver(), Vec3(0, 0, testing::kConeSeated + 50e-6));
  EXPECT_NEAR(taper.Onset(above, {0, 0, -1}, 100e-6), 50e-6,
              kHalfMicrometre / std::sin(std::atan(testing::kConeSlope)));
  Pair ball = pair_of(testing::CaseSphere());
  EXPECT_NEAR(ball.Onset({}, Vec3(0.3, -0.2, -1).normalized(), 100e-6), 50e-6, kHalfMicrometre);
  Pair ring = pair_of(testing::CaseTorus());
  EXPECT_NEAR(ring.Onset({}, {0, 0, -1}, 50e-6), 20e-6, kHalfMicrometre);
  // Off to the side as well: at one place of the groove the ring lies off by both.
  EXPECT_NEAR(ring.Deepest(Pose(Radial(90e-6, 0.4) + Vec3(0, 0, -120e-6))), -130e-6,
              kHalfMicrometre);
}

}  // namespace
}  // namespace hvas::contact
