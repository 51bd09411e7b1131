// How exact contact is, N2: tests C, A, P and D of the contact study and seats on cones, spheres
// and tori. Truth is the analytic geometry of the parts, which are meshed to 1 um.

#include <cstdio>
#include <cstdlib>
#include <functional>

#include <gtest/gtest.h>

#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

constexpr double kHalfMicrometre = 0.5e-6;
constexpr double kStiffness = 1e3;  // [N/m], 1 N/mm as in the study.
constexpr double kStep = 50e-6;     // [m] that a contact moves in a millisecond at 50 mm/s.

constexpr double kCoarse = 10e-6;  // [m], of meshes that curve both ways: what counts is beneath.

/** A held part in one other, and how its queries answer along a path. */
class Pair {
 public:
  Pair(std::shared_ptr<const Shape> held, std::shared_ptr<const Shape> other)
      : held_(std::move(held)) {
    scene_.Add(std::move(other), {});
  }

  double Deepest(const Pose& X_WH) {
    scene_.Query(*held_, X_WH, {}, &work_);
    return work_.deepest();
  }

  Vec3 PooledForce(const Pose& X_WH) {
    Deepest(X_WH);
    return work_.layer().CalcWrench(kStiffness, X_WH.p()).f;
  }

  /** Where along `direction` the first contact is met, to 10 nm; from free to touching. */
  double Onset(const Pose& start, const Vec3& direction, double low, double high) {
    while (high - low > 10e-9) {
      const double middle = 0.5 * (low + high);
      const bool touches = Deepest(Pose(start.q(), start.p() + middle * direction)) < 0;
      (touches ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }

  [[nodiscard]] const QueryWorkspace& work() const { return work_; }

 private:
  std::shared_ptr<const Shape> held_;
  Scene scene_;
  QueryWorkspace work_;
};

struct Worst {
  double depth_error{0};   // [m]
  double force_change{0};  // [N] per step
};

/** The worst over `steps` poses, one a millisecond. */
Worst Follow(Pair* pair, int steps, double depth, const std::function<Pose(int)>& pose) {
  Worst worst;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    const Vec3 force = pair->PooledForce(pose(i));
    worst.depth_error = std::max(worst.depth_error, std::abs(-pair->work().deepest() - depth));
    if (i > 0) {
      worst.force_change = std::max(worst.force_change, (force - last).norm());
    }
    last = force;
  }
  ::testing::Test::RecordProperty("depth_error_nm", std::to_string(1e9 * worst.depth_error));
  ::testing::Test::RecordProperty("force_change_mn", std::to_string(1e3 * worst.force_change));
  if (std::getenv("HVAS_TOL_SCALE") != nullptr) {
    std::printf("  depth error %.1f nm, force change %.4f mN\n", 1e9 * worst.depth_error,
                1e3 * worst.force_change);
  }
  return worst;
}

Vec3 Radial(double length, double angle) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

const std::shared_ptr<const Shape>& Bore() {
  static const auto shape = Build(testing::GroovedBore(20e-3, 28e-3, 50e-3));
  return shape;
}

const std::shared_ptr<const Shape>& GroovedShaft() {
  static const auto shape = Build(testing::GroovedShaft(19.99e-3, 80e-3));
  return shape;
}

TEST(Accuracy, CShaftTurningInABore) {
  Pair pair(GroovedShaft(), Bore());
  const double step = kStep / 20e-3;
  const Worst worst = Follow(&pair, 1000, 100e-6, [&](int i) {
    return Pose(Radial(110e-6, step * i) + Vec3(0, 0, -15.3e-3));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
  EXPECT_LE(worst.force_change, 0.25e-3);
}

TEST(Accuracy, AShaftSlidingOverBothGrooves) {
  Pair pair(GroovedShaft(), Bore());
  const Worst worst = Follow(&pair, 700, 100e-6, [](int i) {
    return Pose(Radial(110e-6, 0.3) + Vec3(0, 0, 8e-3 - kStep * i));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
  EXPECT_LE(worst.force_change, 2e-3);
}

TEST(Accuracy, PPlateSlidingOnAHousing) {
  Pair pair(Build(testing::Frame({40e-3, 30e-3, 5e-3}, {25e-3, 15e-3})),
            Build(testing::Frame({45e-3, 38e-3, 10e-3}, {22e-3, 12e-3})));
  const Worst worst = Follow(&pair, 400, 100e-6, [](int i) {
    return Pose(Vec3(-6e-3 + 0.8 * kStep * i, 4e-3 - 0.6 * kStep * i, 15e-3 - 100e-6));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
  EXPECT_LE(worst.force_change, 0.05e-3);
}

TEST(Accuracy, DDowelInItsHole) {
  Pair pair(Build(testing::Shaft(2.99e-3, 20e-3)), Build(testing::Bushing(3e-3, 20e-3, 15e-3)));
  const Worst worst = Follow(&pair, 400, 100e-6, [](int i) {
    return Pose(Radial(110e-6, kStep / 3e-3 * i) + Vec3(0, 0, 2e-3));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
}

// H7/g6 on 6 mm at its tightest: hole 6.000, dowel 5.996, hence 2 um of clearance at the radius.
TEST(Accuracy, ClearanceOfAFittedDowelIsRightToHalfAMicrometre) {
  struct Fit {
    double hole, shaft;  // Radii [m].
  };

  for (const Fit fit : {Fit{3e-3, 2.998e-3}, {3.006e-3, 2.994e-3}, {20e-3, 19.9955e-3}}) {
    Pair pair(Build(testing::Shaft(fit.shaft, 30e-3)),
              Build(testing::Bushing(fit.hole, fit.hole + 10e-3, 20e-3)));
    for (int i = 0; i < 8; ++i) {
      const double onset = pair.Onset(Pose(Vec3(0, 0, 3e-3)), Radial(1, 0.83 * i), 0, 60e-6);
      EXPECT_NEAR(onset, fit.hole - fit.shaft, kHalfMicrometre) << fit.hole << " turn " << i;
    }
  }
}

// A taper in its seat, both of 7.13 degrees half angle: lowered by z it is in by z sin(angle), and
// on one side by e cos(angle) more when it is e off the axis.
TEST(Accuracy, TaperInItsConeSeat) {
  const double angle = std::atan2(5e-3, 40e-3);
  constexpr double kLength = 40e-3;
  Pair pair(Build(testing::Cone(15e-3, 10e-3, kLength)),
            Build(testing::ConeSeat(9e-3, 16e-3, 56e-3, 25e-3)));
  // The taper stands on its wide end; turned over, its tip of 10 mm fits where the seat is as wide.
  const Quat over = spatial::RotationFromVector({std::numbers::pi, 0, 0});
  const double seated = 1e-3 / std::tan(angle) + kLength;
  EXPECT_NEAR(pair.Onset({over, Vec3(0, 0, seated + 50e-6)}, {0, 0, -1}, 0, 100e-6), 50e-6,
              kHalfMicrometre / std::sin(angle));
  const double e = 60e-6;
  const double down = 200e-6;
  const double depth = down * std::sin(angle) + e * std::cos(angle);
  const Worst worst = Follow(&pair, 200, depth, [&](int i) {
    return Pose(over, Radial(e, kStep / 12e-3 * i) + Vec3(0, 0, seated - down));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
}

// A ball of 9.95 mm in a socket of 10 mm: the depth is how far it is off centre, less the
// clearance.
TEST(Accuracy, BallInItsSocket) {
  Pair pair(Build(testing::Ball(9.95e-3, kCoarse)), Build(testing::Socket(10e-3, 14e-3, kCoarse)));
  const Vec3 down(0.3, -0.2, -1);
  EXPECT_NEAR(pair.Onset({}, down.normalized(), 0, 100e-6), 50e-6, kHalfMicrometre);
  const Worst worst = Follow(&pair, 200, 100e-6, [](int i) {
    const double turn = kStep / 10e-3 * i;
    return Pose(150e-6 * Vec3(0.5 * std::cos(turn), 0.5 * std::sin(turn), -std::sqrt(0.75)));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
}

// A ring of 3 mm in a groove of 3.02 mm, both about 20 mm: the same along every direction of the
// half plane through the axis, at the foot of which they are nearest.
TEST(Accuracy, RingInItsTorusGroove) {
  Pair pair(Build(testing::Ring(20e-3, 3e-3, kCoarse)),
            Build(testing::RingGroove(20e-3, 3.02e-3, kCoarse)));
  EXPECT_NEAR(pair.Onset({}, {0, 0, -1}, 0, 50e-6), 20e-6, kHalfMicrometre);
  const Worst worst = Follow(&pair, 200, 100e-6, [](int i) {
    return Pose(spatial::RotationFromVector({0, 0, kStep / 20e-3 * i}), Vec3(0, 0, -120e-6));
  });
  EXPECT_LE(worst.depth_error, kHalfMicrometre);
  EXPECT_LE(worst.force_change, 0.25e-3);
  // Off to the side as well: at one place of the groove the ring lies off by both.
  const double e = 90e-6;
  const double depth = std::hypot(e, 120e-6) - 20e-6;
  EXPECT_NEAR(pair.Deepest(Pose(Radial(e, 0.4) + Vec3(0, 0, -120e-6))), -depth, kHalfMicrometre);
}

}  // namespace
}  // namespace hvas::contact
