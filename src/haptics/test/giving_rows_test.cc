// Parts that give on their way: the published forces in the tick, energy, and who engages.

#include "haptics/giving_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"
#include "fits/pressed_parts.h"
#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::kDt;

const double kSlope = std::tan(30 * std::numbers::pi / 180);
constexpr double kUndercut = 2.4e-3;

/** The hook of Bayer's example: it is in at 0, slides down its return face of 45 degrees from its
 undercut, and up its mating face of 30 degrees before. */
GivingCurve MakeHook(double friction) {
  GivingCurve curve;
  curve.stiffness = 32.526 / kUndercut;
  curve.friction = friction;
  curve.spacing = 10e-6;
  constexpr double kLand = 1e-3;
  const double top = kUndercut + kLand;
  for (int i = 0;; ++i) {
    const double travel = i * curve.spacing;
    const double back = std::min(kUndercut, travel);
    const double front = kUndercut - kSlope * (travel - top);
    const double given = std::min(back, front);
    if (given <= 0 && i > 0) {
      return curve;
    }
    curve.given.push_back(std::max(0.0, given));
  }
}

TEST(GivingCurve, HasTheForcesOfThePublishedExample) {
  const GivingCurve curve = MakeHook(0.6);
  const GivingPeak peak = CalcGivingPeak(curve);
  EXPECT_NEAR(peak.in, 58.59, 0.6);
  // Its return face locks itself less than that of any steeper one: (0.6 + 1) / (1 - 0.6).
  EXPECT_NEAR(peak.out, 32.526 * 4, 1.3);
  EXPECT_EQ(CalcGivingLoad(curve, curve.length()).in, 0);
}

// The elastic part is the slope of the energy, and its stiffness the slope of it.
TEST(GivingCurve, IsOfAPotential) {
  GivingCurve hook = MakeHook(0.3);
  GivingCurve ring = hook;
  ring.squeezed = fits::ORing{50e-3, 3.53e-3, 5e6};
  constexpr double kStep = 1e-7;
  for (const GivingCurve& curve : {hook, ring}) {
    const int points = static_cast<int>(curve.given.size());
    for (int i = 0; i < points; ++i) {
      const double travel = curve.spacing * (i + 0.13);  // Its curvature jumps at each half.
      const double before = CalcGivingEnergy(curve, travel - kStep);
      const double after = CalcGivingEnergy(curve, travel + kStep);
      const GivingLoad load = CalcGivingLoad(curve, travel);
      ASSERT_NEAR(load.spring, (before - after) / (2 * kStep), 1e-4 * std::abs(load.spring) + 1e-3)
          << i;
      const double fall = (CalcGivingLoad(curve, travel - kStep).spring -
                           CalcGivingLoad(curve, travel + kStep).spring) /
                          (2 * kStep);
      ASSERT_NEAR(load.stiffness, fall, 0.01 * std::abs(fall) + 30) << i;
    }
  }
}

/** A disc spring of DIN 2093, A 20, in series with a coil spring, pressed by 2.2 mm in its place.
 */
GivingCurve MakePressed() {
  constexpr double kPressedBy = 2.2e-3;
  constexpr int kSteps = 128;
  const std::array<fits::PressedPart, 2> parts{
      fits::DiscSpring{20e-3, 10.2e-3, 1.1e-3, 0.45e-3, 206e9, 0.3},
      fits::CoilSpring{2e-3, 14e-3, 5, 79e9}};
  GivingCurve curve;
  curve.pressed = fits::MakePressTable(parts, kPressedBy, kSteps);
  curve.compression = kPressedBy;
  return curve;
}

TEST(GivingCurve, OfWhatIsPressedIsOfAPotentialAndHasNoFriction) {
  const GivingCurve curve = MakePressed();
  constexpr double kStep = 1e-7;
  EXPECT_EQ(curve.length(), curve.compression);
  EXPECT_EQ(CalcGivingLoad(curve, curve.length()).spring, 0);
  EXPECT_EQ(CalcGivingPeak(curve).in, curve.pressed.back());
  EXPECT_EQ(CalcGivingPeak(curve).out, 0);
  double last = CalcGivingLoad(curve, -0.1e-3).spring;
  EXPECT_GT(last, curve.pressed.back());  // Pushed beyond its place, it pushes harder.
  for (double travel = -0.1e-3; travel < 1.1 * curve.compression; travel += 3.7e-6) {
    const GivingLoad load = CalcGivingLoad(curve, travel);
    EXPECT_LE(load.spring, last);
    EXPECT_LT(last - load.spring, 1);  // It has no jump.
    last = load.spring;
    ASSERT_NEAR(
        load.spring,
        (CalcGivingEnergy(curve, travel - kStep) - CalcGivingEnergy(curve, travel + kStep)) /
            (2 * kStep),
        1e-3 * load.spring + 1e-2);
    EXPECT_EQ(load.in, 0);
    EXPECT_EQ(load.out, 0);
  }
}

/** A part on the way of what gives in no one's hand, pulled at by a force. */
struct PartOnWay {
  PartOnWay(double friction, double start) : PartOnWay(MakeHook(friction), start) {}

  PartOnWay(GivingCurve given, double start)
      : rows(MakeForceMap(device)), curve(std::make_shared<const GivingCurve>(std::move(given))) {
    part.mass = 0.05;
    part.gives = {{curve, kUndercut}};
    displayed.part = &part;
    displayed.X_WD = Pose(Vec3(0, 0, start));
    rows.Reset(false);
  }

  GivingRows::Forces Step(double pull) {
    solver.Begin(part.mass, 1e-5 * Mat3::Identity(), displayed.p_WCm(), displayed.V, kDt);
    solver.AddWrench({Vec3::Zero(), Vec3(0, 0, pull)});
    rows.Add(displayed, kDt, &solver);
    displayed.V = solver.Solve(30);
    displayed.X_WD = Pose(displayed.X_WD.p() + kDt * displayed.V.v);
    return rows.Finish(solver);
  }

  [[nodiscard]] double height() const { return displayed.X_WD.p().z(); }

  [[nodiscard]] double CalcKinetic() const { return 0.5 * part.mass * displayed.V.v.squaredNorm(); }

  device::DeviceProfile device;
  HeldPart part;
  DisplayedPart displayed;
  GivingRows rows;
  std::shared_ptr<const GivingCurve> curve;
  ConstraintSolver solver;
};

// L: energy out never exceeds energy in over a million ticks of random handling. The map of forces
// makes the elastic energy that is felt less than the true one, which bounds it.
TEST(GivingRows, NeverGiveMoreEnergyThanTheyTook) {
  Random random(5);
  PartOnWay slider(0.2, 0.02);
  double given = 0;
  double pull = 0;
  double most = -1;
  double worst = -1;
  int inside = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    pull += 0.1 * random.Normal() - 0.003 * pull - 2e-3 * (slider.height() - 4e-3);
    const double before = slider.height();
    slider.Step(pull);
    given += pull * (slider.height() - before);
    worst = std::max(worst, slider.CalcKinetic() - given);
    most = std::max(most, given);
    inside += slider.height() > 0 && slider.height() < slider.curve->length() ? 1 : 0;
    if (std::abs(slider.height()) > 0.05) {  // It is caught, and put back with what it has lost.
      slider.displayed.X_WD = Pose(Vec3(0, 0, 0.02));
      given -= slider.CalcKinetic();
      slider.displayed.V = {};
    }
  }
  EXPECT_GT(inside, 100'000);
  EXPECT_GT(most, 0);
  EXPECT_LT(worst, 1e-9);
}

// L: the same of springs that are pressed together along the way.
TEST(GivingRows, PressedSpringsNeverGiveMoreEnergyThanTheyTook) {
  Random random(7);
  PartOnWay slider(MakePressed(), 6e-3);
  double given = 0;
  double pull = 0;
  double worst = -1;
  int inside = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    pull += 0.1 * random.Normal() - 0.003 * pull - 2e-3 * (slider.height() - 1e-3);
    const double before = slider.height();
    slider.Step(pull);
    given += pull * (slider.height() - before);
    worst = std::max(worst, slider.CalcKinetic() - given);
    inside += slider.height() < slider.curve->length() ? 1 : 0;
    if (std::abs(slider.height()) > 0.05) {  // It is caught, and put back with what it has lost.
      slider.displayed.X_WD = Pose(Vec3(0, 0, 6e-3));
      given -= slider.CalcKinetic();
      slider.displayed.V = {};
    }
  }
  EXPECT_GT(inside, 100'000);
  EXPECT_LT(worst, 1e-9);
}

// Half way up its face, it stays where it is left, and does not creep.
TEST(GivingRows, StickWhereFrictionHolds) {
  PartOnWay slider(0.7, 4.5e-3);
  slider.rows.Reset(true);
  for (int i = 0; i < 100; ++i) {
    slider.Step(0);
  }
  EXPECT_NEAR(slider.height(), 4.5e-3, 5e-6);
  const double height = slider.height();
  for (int i = 0; i < 10'000; ++i) {
    slider.Step(0);
  }
  EXPECT_NEAR(slider.height(), height, 1e-9);
}

// With less friction than slope it comes out again, and beyond its undercut it snaps in.
TEST(GivingRows, SnapInBeyondTheUndercutAndOutBeforeIt) {
  PartOnWay before(0.1, 4e-3);
  PartOnWay beyond(0.1, 2e-3);
  for (PartOnWay* each : {&before, &beyond}) {
    each->rows.Reset(true);
    for (int i = 0; i < 300 && each->height() > 0 && each->height() < each->curve->length(); ++i) {
      each->Step(0);
    }
  }
  EXPECT_GE(before.height(), before.curve->length());
  EXPECT_LE(beyond.height(), 0);
}

TEST(GivingRows, APartThatComesFromAsideMeetsNone) {
  PartOnWay slider(0.3, 0.02);
  slider.Step(0);
  slider.displayed.X_WD = Pose(Vec3(0, 0.02, 0.02));
  slider.Step(0);
  slider.displayed.X_WD = Pose(Vec3(0, 0, 3e-3));
  slider.displayed.V = {};
  EXPECT_EQ(slider.Step(-1).truth, 0);
}

/** A hand that presses a block in against the hook, with nothing else in the scene. */
struct HookRig : testing::HeldRig {
  explicit HookRig(double friction) : HookRig(MakeHook(friction)) {}

  explicit HookRig(GivingCurve curve) : HeldRig(Weightless()) {
    static const auto block = contact::testing::Build(contact::testing::Shaft(5e-3, 20e-3, 20e-6));
    Place(block, Pose(Vec3(0, 0, 0.012)));
    testing::SetMass({{5e-3, 0, 20e-3}}, &part);
    part.X_WB_goal = Pose();
    part.lacks_partners = true;  // It goes through its place, and is not taken from the hand there.
    part.gives = {{std::make_shared<const GivingCurve>(std::move(curve)), kUndercut}};
    Take();
  }

  static TickOptions Weightless() {
    TickOptions options;
    options.gravity_W.setZero();
    return options;
  }
};

// In the tick, by a scripted hand: 58.59 N in and 130.1 N out are told as true forces, the device
// feels them by the map, and what is felt never jumps.
TEST(GivingRows, TheTickHasThePublishedForces) {
  HookRig rig(0.6);
  rig.hand->Wait(0.3);
  const ForceMap map = MakeForceMap(rig.options.device);
  const auto move = [&](double way, double time) {
    const std::size_t from = rig.hand->samples.size();
    rig.hand->MoveEvenly(Vec3(0, 0, way), time);
    std::pair<double, double> least_most{0, 0};
    int off = 0;
    for (std::size_t i = from; i < rig.hand->samples.size(); ++i) {
      const TickOutput& out = rig.hand->samples[i].out;
      least_most.first = std::min(least_most.first, out.axial_true);
      least_most.second = std::max(least_most.second, out.axial_true);
      // Within a step the map is followed by its slope: only where it snaps, one tick sees more of
      // the way than that.
      const double difference =
          std::abs(std::abs(out.axial_felt) - map.Felt(std::abs(out.axial_true)));
      off += difference > 0.1 ? 1 : 0;
    }
    EXPECT_LT(off, 0.005 * 1000 * time);
    return least_most;
  };
  const auto in = move(-0.02, 4.0);
  EXPECT_NEAR(in.second, 58.59, 0.6);
  EXPECT_LT(rig.hand->last().X_WD.p().z(), 0);
  const auto out = move(0.02, 4.0);
  EXPECT_NEAR(-out.first, 130.1, 1.5);
  EXPECT_GT(rig.hand->last().X_WD.p().z(), 8e-3);
}

// In the tick, by a scripted hand: a spring of 28.3 N/mm, the outer one of FOSSEE example 10.19,
// pushes by 56.5 N in its place, 2 mm in, and the device feels it by the map.
TEST(GivingRows, TheTickHasTheForceOfAPressedSpring) {
  constexpr double kPressedBy = 2e-3;
  GivingCurve curve;
  const std::array<fits::PressedPart, 1> spring{fits::CoilSpring{6e-3, 36e-3, 10, 81.37e9}};
  curve.pressed = fits::MakePressTable(spring, kPressedBy, 128);
  curve.compression = kPressedBy;
  HookRig rig(curve);
  rig.hand->Wait(0.3);
  const ForceMap map = MakeForceMap(rig.options.device);
  rig.hand->MoveEvenly(Vec3(0, 0, -0.015), 4.0);
  int off = 0;
  double in_place = 0;
  for (const auto& sample : rig.hand->samples) {
    const TickOutput& out = sample.out;
    const double z = out.X_WD.p().z();
    const double wanted = 28253.5 * std::max(0.0, kPressedBy - z);
    off += std::abs(std::abs(out.axial_true) - wanted) > 1 + 0.02 * wanted ? 1 : 0;
    off += std::abs(std::abs(out.axial_felt) - map.Felt(std::abs(out.axial_true))) > 0.1 ? 1 : 0;
    in_place = std::abs(z) < 20e-6 ? std::abs(out.axial_true) : in_place;
  }
  EXPECT_LT(off, 20);
  EXPECT_NEAR(in_place, 56.5, 1.5);
}

}  // namespace
}  // namespace hvas::haptics
