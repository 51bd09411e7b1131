// The rows that hold a part in its fits: stick, slip, memory, and what is felt of the true force.

#include "haptics/fit_rows.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/test/values.h"

namespace hvas::haptics {
namespace {

using testing::kDt;

constexpr double kShaftMass = 0.5;

/** A part of half a kilogram on a vertical axis, pulled at by a force. */
struct Slider {
  explicit Slider(ForceMapKind kind = ForceMapKind::kPublished) : rows(kind, device) {}

  FitForces Step(const FitLoad& load, double pull, double turn = 0) {
    solver.Begin(kShaftMass, 1e-3 * Mat3::Identity(), Vec3::Zero(), V, kDt);
    solver.AddWrench({Vec3(0, 0, turn), Vec3(0, 0, pull)});
    rows.Add(load, axis, &solver);
    V = solver.Solve(30);
    height += kDt * V.v.z();
    turned += kDt * V.w.z();
    return rows.Finish(solver);
  }

  device::DeviceProfile device;
  ForceMap map = MakeForceMap(device);
  FitAxis axis{Vec3::UnitZ(), Vec3::Zero(), 20e-3, 0};
  FitRows rows;
  ConstraintSolver solver;
  spatial::Twist V;
  double height{0};
  double turned{0};
};

// N5: up to the breakaway force it gives less than two micrometres, and stays there for a minute; a
// hundredth above it, it goes. Out and in differ.
TEST(FitRows, SticksUpToTheBreakawayForceAndNoFurther) {
  const FitLoad load{40e3, 20e3, 500, 0, 0};
  for (const double sign : {1.0, -1.0}) {
    Slider slider;
    const double limit = slider.map.Felt(sign > 0 ? load.out : load.in);
    for (int i = 0; i < 60'000; ++i) {
      const FitForces forces = slider.Step(load, sign * 0.99 * limit);
      ASSERT_LT(std::abs(slider.height), 2e-6);
      if (i > 100) {
        ASSERT_NEAR(forces.axial_felt, -sign * 0.99 * limit, 1e-6);
        ASSERT_LT(std::abs(forces.axial_true), sign > 0 ? load.out : load.in);
      }
    }
    for (int i = 0; i < 100; ++i) {
      const FitForces forces = slider.Step(load, sign * 1.01 * limit);
      if (i > 10) {
        ASSERT_NEAR(-sign * forces.axial_true, sign > 0 ? load.out : load.in, 1.0);
      }
    }
    EXPECT_GT(sign * slider.height, 0.4 * 0.01 * limit / kShaftMass * 0.1 * 0.1);  // a t^2 / 2
  }
}

// N5: let go, it comes to rest within the bristles' reach, with nothing left that pushes it.
TEST(FitRows, NothingPushesAtRest) {
  const FitLoad load{40e3, 40e3, 500, 0, 0};
  Slider slider;
  for (int i = 0; i < 500; ++i) {
    slider.Step(load, -5);
  }
  const double pressed = slider.height;
  FitForces forces;
  for (int i = 0; i < 500; ++i) {
    forces = slider.Step(load, 0);
  }
  EXPECT_LT(std::abs(slider.height - pressed), 1e-6);
  EXPECT_NEAR(forces.axial_felt, 0, 1e-9);
  EXPECT_NEAR(slider.V.v.z(), 0, 1e-12);
}

// N6: whatever the bounds do from tick to tick, and however it is pulled, the rows take energy: the
// part never has more than the pull gave it.
TEST(FitRows, NeverGiveEnergy) {
  Random random(3);
  for (int run = 0; run < 50; ++run) {
    Slider slider;
    double given = 0;
    double pull = 0;
    for (int i = 0; i < 2000; ++i) {
      pull += 0.3 * random.Normal() - 0.02 * pull;
      const FitLoad load{std::exp(random.Uniform(0, 11)), std::exp(random.Uniform(0, 11)), 10, 0,
                         0};
      const double before = slider.height;
      slider.Step(load, pull);
      given += pull * (slider.height - before);
      ASSERT_LE(0.5 * kShaftMass * slider.V.v.squaredNorm(), given + 1e-12) << run << " " << i;
    }
  }
}

// N4: out against its weight, the hand gives both, and feels the map of the sum; in with its
// weight, the fit's own map. The true force of the fit comes back from either.
TEST(FitRows, WeightAgainstTheMotionIsMappedTogetherWithTheFit) {
  const FitLoad load{5e3, 5e3, 50, 0, 0};
  Slider slider;
  slider.axis.weight_out = -30;  // [N]; downwards, into the hole
  FitForces forces;
  for (int i = 0; i < 200; ++i) {
    forces = slider.Step(load, 20);
  }
  EXPECT_NEAR(-forces.axial_felt, slider.map.Felt(5030) - slider.map.Felt(30), 1e-9);
  EXPECT_NEAR(forces.axial_true, -5e3, 1e-6);
  Slider down;
  down.axis.weight_out = -30;
  for (int i = 0; i < 200; ++i) {
    forces = down.Step(load, -20);
  }
  EXPECT_NEAR(forces.axial_felt, down.map.Felt(5e3), 1e-9);
  EXPECT_NEAR(forces.axial_true, 5e3, 1e-6);
}

// About the axis the device's torque has a map of its own.
TEST(FitRows, TurningIsFeltByTheMapOfTorque) {
  Slider slider;
  const ForceMap map = MakeTorqueMap(slider.device);
  const FitLoad load{5e3, 5e3, 80, 0, 0};
  FitForces forces;
  for (int i = 0; i < 50; ++i) {
    forces = slider.Step(load, 0, 0.9 * map.Felt(80));
  }
  EXPECT_LT(slider.turned, 1e-4);
  for (int i = 0; i < 50; ++i) {
    forces = slider.Step(load, 0, 1.1 * map.Felt(80));
  }
  EXPECT_GT(slider.turned, 1e-3);
  EXPECT_NEAR(forces.torque_felt, -map.Felt(80), 1e-9);
  EXPECT_NEAR(forces.torque_true, -80, 1e-6);
}

// W9, W10: with the paper's factors what is shown is what they make of it, within the device.
TEST(FitRows, PaperShowsItsOwnForces) {
  Slider slider(ForceMapKind::kPaper);
  FitForces forces;
  for (int i = 0; i < 100; ++i) {
    forces = slider.Step({40e3, 40e3, 500, 3.5, 3.5}, -20);
  }
  EXPECT_NEAR(forces.axial_felt, 3.5, 1e-9);
  EXPECT_NEAR(forces.axial_true, 40e3, 1e-6);
  for (int i = 0; i < 100; ++i) {
    forces = slider.Step({40e3, 40e3, 500, 35, 35}, -20);
  }
  EXPECT_NEAR(forces.axial_felt, kLargestFeltShare * slider.device.max_force, 1e-9);
}

// A device without torque turns freely, and nothing becomes not a number.
TEST(FitRows, DeviceWithoutTorqueFeelsNone) {
  const ForceMap map(kLargestTrueTorque, 0);
  for (const double torque : {0.0, 1e-9, 3.0, 5e3}) {
    EXPECT_EQ(map.Felt(torque), 0);
  }
}

}  // namespace
}  // namespace hvas::haptics
