// Recognition, capture, guidance and release: X8, X10, W4, W5, W7.

#include "haptics/mate_guide.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/test/rig.h"
#include "mates/capture.h"
#include "mates/mate_kind.h"
#include "spatial/test/random_pose.h"

namespace hvas::haptics {
namespace {

using product::MateKind;
using spatial::Pose;
using spatial::RandomVector;
using testing::Above;
using testing::kDt;
using testing::kLength;
using testing::MakeAxisMate;
using testing::MakeFit;
using testing::MakeStopMate;

constexpr double kPegMass = 0.5;
const double kDegree = std::numbers::pi / 180;

Quat DrawRotation(Random* random) {
  return Quat(random->Normal(), random->Normal(), random->Normal(), random->Normal()).normalized();
}

Pose Tilted(const Vec3& turn, const Vec3& p) {
  return {spatial::RotationFromVector(turn), p};
}

HeldPart MakePart(std::vector<HeldMate> mates) {
  HeldPart part;
  part.mass = kPegMass;
  part.mates = std::move(mates);
  return part;
}

/** Runs the guide with the hand and the part at the same pose. */
void Hold(MateGuide* guide, const HeldPart& part, const GuidanceOptions& options, const Pose& X_WB,
          int ticks = 1) {
  for (int i = 0; i < ticks; ++i) {
    guide->Update(part, options, X_WB, X_WB, kDt);
  }
}

/** Force and torque of the guide's springs about the origin of a body, from a step so short that
 nothing moves. */
Vec6 CalcForce(MateGuide* guide, const HeldPart& part, const GuidanceOptions& options,
               const Pose& X_WB) {
  constexpr double kInstant = 1e-9;
  ConstraintSolver solver;
  solver.Begin(kPegMass, kPegMass * Mat3::Identity(), X_WB.p(), {}, kInstant);
  guide->AddSprings(part, options, &solver);
  const spatial::Twist V = solver.SolveUnconstrained();
  Vec6 out;
  out << V.w, V.v;
  return kPegMass / kInstant * out;
}

/** Stiffness that the solver gets, 6 x 6, found by probing its system matrix. */
Mat6 CalcStiffness(MateGuide* guide, const HeldPart& part, const GuidanceOptions& options,
                   const Pose& X_WB) {
  constexpr double kLong = 1;
  const auto solve = [&](const Vec6& V_0) {
    ConstraintSolver solver;
    solver.Begin(kPegMass, kPegMass * Mat3::Identity(), X_WB.p(), {V_0.head<3>(), V_0.tail<3>()},
                 kLong);
    guide->AddSprings(part, options, &solver);
    const spatial::Twist V = solver.SolveUnconstrained();
    Vec6 out;
    out << V.w, V.v;
    return out;
  };
  const Vec6 rest = solve(Vec6::Zero());
  Mat6 inverse;
  for (int k = 0; k < 6; ++k) {
    inverse.col(k) = (solve(Vec6::Unit(k)) - rest) / kPegMass;
  }
  return (inverse.inverse() - kPegMass * Mat6::Identity()) / (kLong * kLong);
}

// X(7), X(8): what guides is what was recognised, at any pose of both connectors.
TEST(CalcMateGeometry, AgreesWithRecognition) {
  Random random(5);
  double worst_angle = 0;
  double worst_distance = 0;
  for (int draw = 0; draw < 1000; ++draw) {
    for (const MateKind kind : product::kMateKinds) {
      HeldMate mate;
      mate.capture = {kind,
                      random.Uniform(-0.05, 0),
                      random.Uniform(0, 0.05),
                      random.Uniform(-0.05, 0),
                      random.Uniform(0, 0.05),
                      1};
      mate.X_WM = {DrawRotation(&random), RandomVector(&random, 1)};
      mate.X_BN = {DrawRotation(&random), RandomVector(&random, 0.1)};
      const Quat flip = kind == MateKind::kFaceFace ? Quat(0, 1, 0, 0) : Quat::Identity();
      const Quat q_MN = spatial::RotationFromVector(RandomVector(&random, 0.7)) * flip;
      const Pose X_WB = mate.X_WM * Pose(q_MN, RandomVector(&random, 0.1)) * mate.X_BN.Inverse();
      const MateGeometry g = CalcMateGeometry(mate, X_WB);
      const mates::MateDeviation deviation =
          mates::CalcDeviation(mate.capture, mate.X_WM, X_WB * mate.X_BN);
      worst_angle = std::max(worst_angle, std::abs(g.angle - deviation.angle));
      worst_distance = std::max(worst_distance, std::abs(g.distance - deviation.distance));

      if (mates::IsCentre(kind)) {
        EXPECT_EQ(g.tilt_W, Vec3::Zero());
        EXPECT_NEAR((g.p_WQ - g.offset_W - mate.X_WM.p()).norm(), 0, 1e-13);
        continue;
      }
      // The tilt takes the held axis to the placed one.
      const double sense = kind == MateKind::kFaceFace ? -1 : 1;
      const Vec3 held = X_WB.q() * (mate.X_BN.q() * Vec3(0, 0, sense));
      EXPECT_NEAR((spatial::RotationFromVector(g.tilt_W) * held - g.axis_W).norm(), 0, 1e-13);
      // The offset is across the axis, or along the normal, and ends on the held axis.
      if (mates::HoldsAcross(kind)) {
        EXPECT_NEAR(g.offset_W.dot(g.axis_W), 0, 1e-15);
        EXPECT_NEAR((g.p_WQ - g.offset_W - mate.X_WM.p()).cross(g.axis_W).norm(), 0, 1e-13);
        EXPECT_NEAR((g.p_WQ - X_WB * mate.X_BN.p()).cross(held).norm(), 0, 1e-13);
      } else {
        EXPECT_NEAR(g.offset_W.cross(g.axis_W).norm(), 0, 1e-15);
      }
    }
  }
  EXPECT_LT(worst_angle, 1e-14);
  EXPECT_LT(worst_distance, 1e-13);
}

// The insertion depth l of W(1) to W(9).
TEST(CalcMateGeometry, EngagedLengthIsTheInsertionDepth) {
  const HeldMate mate = MakeAxisMate(nullptr, contact::BodyId(0));
  for (const double depth : {-30e-3, -1e-6, 0.0, 1e-6, 10e-3, 49.9e-3, 50e-3}) {
    const MateGeometry g = CalcMateGeometry(mate, Above(-depth, 1e-3, 2e-3));
    EXPECT_NEAR(g.engaged, std::max(0.0, depth), 1e-16);
    EXPECT_NEAR(g.distance, std::hypot(1e-3, 2e-3), 1e-16);
    // Where it is engaged, recognition sees no gap, and the other way round.
    const auto deviation = mates::CalcDeviation(mate.capture, mate.X_WM, Above(-depth));
    EXPECT_NEAR(deviation.gap, std::max(0.0, -depth), 1e-16);
  }
}

// W7: captured at 5 mm and 10 degrees; released at half as much again.
TEST(MateGuide, X8CapturesAndReleasesWithHysteresis) {
  const GuidanceOptions options;
  const HeldPart part = MakePart({MakeAxisMate(nullptr, contact::BodyId(0))});
  const auto at_offset = [](double share) { return Above(5e-3, share * 5e-3); };
  const auto at_angle = [](double share) {
    // Turned about the tip, so that the offset there stays nothing.
    return Tilted(Vec3(share * 10 * kDegree, 0, 0), Vec3(0, 0, kLength + 5e-3));
  };
  const auto at_gap = [](double share) { return Above(share * 30e-3); };
  for (const std::function<Pose(double)>& at :
       {std::function<Pose(double)>(at_offset), std::function<Pose(double)>(at_angle),
        std::function<Pose(double)>(at_gap)}) {
    MateGuide guide;
    const auto is_captured = [&](double share) {
      Hold(&guide, part, options, at(share));
      return guide.is_captured(0);
    };
    EXPECT_FALSE(is_captured(1.4));
    EXPECT_FALSE(is_captured(1.01));
    EXPECT_TRUE(guide.is_near());
    EXPECT_TRUE(is_captured(0.99));
    EXPECT_TRUE(is_captured(1.2));
    EXPECT_TRUE(is_captured(1.49));
    EXPECT_FALSE(is_captured(1.51));
    EXPECT_FALSE(is_captured(1.2));  // Not again before 1.
    EXPECT_TRUE(is_captured(0.5));
    EXPECT_FALSE(is_captured(3.1));
    EXPECT_FALSE(guide.is_near());
  }
}

// X14's hand decides before the shaft is in, its axis once it is.
TEST(MateGuide, EngagedShaftIsOnlyDrawnOutAlongItsAxis) {
  const GuidanceOptions options;
  const HeldPart part = MakePart({MakeAxisMate(nullptr, contact::BodyId(0))});
  const Pose far = Above(0, 0.1);
  MateGuide guide;
  guide.Update(part, options, Above(1e-3), Above(1e-3), kDt);
  ASSERT_TRUE(guide.is_captured(0));
  guide.Update(part, options, Above(-1e-3), far, kDt);
  EXPECT_TRUE(guide.is_captured(0));
  guide.Update(part, options, Above(1e-3), far, kDt);
  EXPECT_FALSE(guide.is_captured(0));
}

// The ramp grows from nothing to the full stiffness in its time, and fades as it came.
TEST(MateGuide, StiffnessGrowsAndFadesWithoutAStep) {
  GuidanceOptions options;
  options.max_force = 1e9;
  const HeldPart part = MakePart({MakeAxisMate(nullptr, contact::BodyId(0))});
  const Pose inside = Above(5e-3, 1e-3);
  const Pose outside = Above(5e-3, 20e-3);
  MateGuide guide;
  const auto stiffness = [&](const Pose& X_WB) {
    Hold(&guide, part, options, X_WB);
    return CalcStiffness(&guide, part, options, inside)(3, 3);
  };
  std::vector<double> values;
  for (int i = 0; i < 300; ++i) {
    values.push_back(stiffness(inside));
  }
  EXPECT_LT(values.front(), 1.1);
  EXPECT_NEAR(values[249] / options.k_lin, 1, 1e-6);
  EXPECT_EQ(values[299], values[260]);
  for (int i = 0; i < 300; ++i) {
    values.push_back(stiffness(outside));
  }
  EXPECT_NEAR(values.back(), 0, 1e-9);
  for (std::size_t i = 1; i < values.size(); ++i) {
    // A factor of 10^6 in 250 steps, except for the first newton per metre.
    const double low = std::min(values[i], values[i - 1]);
    const double high = std::max(values[i], values[i - 1]);
    EXPECT_LT(high, std::max(1.1, 1.07 * low)) << i;
  }
}

/** A guide at full stiffness that answers at any pose near the start. */
struct FullGuide {
  explicit FullGuide(const HeldPart& the_part) : part(the_part) {
    options.max_force = 1e9;
    options.max_torque = 1e9;
  }

  Vec6 Force(const Pose& X_WB) {
    Hold(&guide, part, options, X_WB, 300);
    return CalcForce(&guide, part, options, X_WB);
  }

  Mat6 Stiffness(const Pose& X_WB) {
    Hold(&guide, part, options, X_WB, 300);
    return CalcStiffness(&guide, part, options, X_WB);
  }

  HeldPart part;
  GuidanceOptions options;
  MateGuide guide;
};

std::shared_ptr<const fits::FitForce> MakeClearance(double radial) {
  fits::FitForceParameters p;
  p.nominal_diameter = p.shaft_diameter = 0.04;
  p.hole_diameter = 0.04 + 2 * radial;
  p.length = kLength;
  p.roughness = 0;
  return std::make_shared<const fits::FitForce>(*fits::FitForce::Make(p));
}

// W4, W(5): free inside the clearance space.
TEST(MateGuide, W4ClearanceSpaceIsFree) {
  FullGuide full(MakePart({MakeAxisMate(MakeClearance(15e-6), contact::BodyId(0))}));
  for (const double r : {0.0, 5e-6, 14.9e-6}) {
    for (const double angle : {0.0, 1.0, 2.5}) {
      const Pose X_WB = Above(-20e-3, r * std::cos(angle), r * std::sin(angle));
      EXPECT_EQ(full.Force(X_WB).norm(), 0) << r;
      EXPECT_EQ(full.guide.lateral_force(), 0);
      EXPECT_LT(full.Stiffness(X_WB).norm(), 1e-6);
    }
  }
}

// W(5): F = -k (r - S) e_r outside it, with no jump where it begins.
TEST(MateGuide, W4SpringsAnswerBeyondTheClearanceSpace) {
  const double play = 15e-6;
  FullGuide full(MakePart({MakeAxisMate(MakeClearance(play), contact::BodyId(0))}));
  for (const double r : {15.01e-6, 20e-6, 100e-6}) {
    for (const double angle : {0.3, 1.7, 4.0}) {
      const Vec3 e(std::cos(angle), std::sin(angle), 0);
      const Vec6 F = full.Force(Pose(Vec3(0, 0, 30e-3) + r * e));
      const Vec3 expected = -full.options.k_lin * (r - play) * e;
      EXPECT_NEAR((F.tail<3>() - expected).norm(), 0, 1e-6 * expected.norm());
      EXPECT_NEAR(full.guide.lateral_force(), expected.norm(), 1e-9 * expected.norm());
    }
  }
}

// W5: an interference fit holds the shaft on its axis from the first micrometre.
TEST(MateGuide, W5InterferenceLeavesNoPlay) {
  FullGuide full(MakePart({MakeAxisMate(MakeClearance(-10e-6), contact::BodyId(0))}));
  const Vec6 F = full.Force(Above(-20e-3, 1e-6));
  EXPECT_NEAR(F[3], -full.options.k_lin * 1e-6, 1e-6);
}

// The stiffness is the Hessian of k (r - S)^2 / 2: finite differences of the force agree.
TEST(MateGuide, StiffnessIsTheDerivativeOfTheForce) {
  const double play = 15e-6;
  FullGuide full(MakePart({MakeAxisMate(MakeClearance(play), contact::BodyId(0))}));
  double worst = 0;
  for (const double r : {16e-6, 30e-6, 200e-6}) {
    for (const double angle : {0.0, 0.8, 3.0}) {
      const Vec3 p = Vec3(0, 0, 30e-3) + r * Vec3(std::cos(angle), std::sin(angle), 0);
      const Mat3 K = full.Stiffness(Pose(p)).bottomRightCorner<3, 3>();
      EXPECT_LT((K - K.transpose()).norm(), 1e-3);
      constexpr double kStep = 1e-9;
      for (int k = 0; k < 3; ++k) {
        const Vec3 d = kStep * Vec3::Unit(k);
        const Vec3 df = full.Force(Pose(p + d)).tail<3>() - full.Force(Pose(p - d)).tail<3>();
        worst = std::max(worst, (K.col(k) + df / (2 * kStep)).norm() / full.options.k_lin);
      }
    }
  }
  EXPECT_LT(worst, 1e-5);
}

// X(15): a tilted shaft is turned back; inside the play it may tilt as far as the hole lets it.
// What is engaged by less than a diameter is held as if it were one.
TEST(MateGuide, TiltIsFreeWithinThePlayAndHeldBeyond) {
  const double play = 50e-6;
  FullGuide full(MakePart({MakeAxisMate(MakeClearance(play), contact::BodyId(0))}));
  for (const double depth : {10e-3, 30e-3, 48e-3}) {
    const double free = 2 * play / std::max(depth, 2 * testing::kShaftRadius);
    const auto at = [&](double angle) {
      // Turned about the middle of the engagement, where guidance measures the offset.
      const Quat q = spatial::RotationFromVector(Vec3(angle, 0, 0));
      const Vec3 middle(0, 0, kLength - 0.5 * depth);
      return Pose(q, middle - q * Vec3(0, 0, 0.5 * depth));
    };
    EXPECT_EQ(full.Force(at(0.95 * free)).norm(), 0) << depth;
    const Vec6 F = full.Force(at(free + 1e-3));
    EXPECT_NEAR(F[0], -full.options.k_rot * 1e-3, 0.01 * full.options.k_rot * 1e-3) << depth;
    EXPECT_NEAR(F.tail<5>().norm(), 0, 1e-6);
  }
}

// A ball is pulled to the centre of its socket from any side and turns freely; the stiffness is the
// same in all directions, and what the socket's faces do is left to contact.
TEST(MateGuide, SphereSeatIsAPointThatTurnsFreely) {
  HeldMate mate = MakeAxisMate(nullptr, contact::BodyId(0));
  mate.capture = {MateKind::kSphereSeat, 0, 0, 0, 0, 0};
  FullGuide full(MakePart({mate}));
  Random random(8);
  for (int draw = 0; draw < 20; ++draw) {
    const Vec3 p = RandomVector(&random, 1e-3);
    const Pose X_WB(DrawRotation(&random), p);
    const Vec6 F = full.Force(X_WB);
    EXPECT_NEAR((F.tail<3>() + full.options.k_lin * p).norm(), 0, 1e-6 * full.options.k_lin * 1e-3);
    EXPECT_NEAR(F.head<3>().norm(), 0, 1e-6);
    const Mat6 K = full.Stiffness(X_WB);
    const Mat3 held = K.bottomRightCorner<3, 3>() / full.options.k_lin;
    EXPECT_NEAR((held - Mat3::Identity()).norm(), 0, 1e-6);
    EXPECT_NEAR((K.topLeftCorner<3, 3>().norm()), 0, 1e-3);
  }
  EXPECT_EQ(full.guide.lateral_force(), 0);
  std::array<contact::IgnoredPair, 2> pairs;
  Hold(&full.guide, full.part, full.options, Pose(), 300);
  EXPECT_TRUE(full.guide.is_aligned());
  EXPECT_EQ(full.guide.CollectIgnored(full.part, pairs), 0U);
}

// A taper is guided as a shaft is, but contact stays on: it alone stops the way in.
TEST(MateGuide, ConeSeatGuidesAcrossAndLeavesTheWayInToContact) {
  const HeldMate shaft = MakeAxisMate(nullptr, contact::BodyId(0));
  HeldMate taper = shaft;
  taper.capture.kind = MateKind::kConeSeat;
  FullGuide as_shaft(MakePart({shaft}));
  FullGuide as_taper(MakePart({taper}));
  for (const Pose& X_WB : {Above(5e-3, 1e-4, 2e-4), Above(-10e-3, 1e-5),
                           Tilted(Vec3(1e-3, 0, 0), Vec3(0, 0, kLength + 5e-3))}) {
    EXPECT_NEAR((as_taper.Force(X_WB) - as_shaft.Force(X_WB)).norm(), 0, 1e-9);
  }
  std::array<contact::IgnoredPair, 2> pairs;
  Hold(&as_taper.guide, as_taper.part, as_taper.options, Above(-10e-3), 300);
  EXPECT_TRUE(as_taper.guide.is_aligned());
  EXPECT_EQ(as_taper.guide.CollectIgnored(as_taper.part, pairs), 0U);
  EXPECT_EQ(as_taper.guide.insertion_depth(), 0);
}

// Guidance never pulls harder than it may, however far the part is.
TEST(MateGuide, X10PullIsBounded) {
  const GuidanceOptions options;
  const HeldPart part = MakePart({MakeAxisMate(nullptr, contact::BodyId(0))});
  MateGuide guide;
  for (const double offset : {1e-6, 1e-5, 1e-4, 1e-3, 5e-3}) {
    Hold(&guide, part, options, Above(5e-3, offset), 300);
    const Vec6 F = CalcForce(&guide, part, options, Above(5e-3, offset));
    EXPECT_NEAR(F.tail<3>().norm(), std::min(options.k_lin * offset, options.max_force), 1e-4);
    EXPECT_LT(F[3], 0);
  }
  for (const double angle : {1e-5, 1e-3, 0.1}) {
    const Pose X_WB = Tilted(Vec3(0, angle, 0), Vec3(0, 0, kLength + 5e-3));
    Hold(&guide, part, options, X_WB, 300);
    const Vec6 F = CalcForce(&guide, part, options, X_WB);
    EXPECT_LT(F.head<3>().norm(), options.max_torque + options.max_force * 0.1);
  }
}

// N3: contact of the mating faces is left to the fit only once the part is on its axis.
TEST(MateGuide, FacesAreIgnoredOnlyWhenAligned) {
  const GuidanceOptions options;
  const HeldPart part = MakePart(
      {MakeAxisMate(MakeFit("H7/g6"), contact::BodyId(4)), MakeStopMate(contact::BodyId(4))});
  std::array<contact::IgnoredPair, 2 * MateGuide::kMaxMates> pairs;
  MateGuide guide;
  const auto count = [&](const Pose& X_WB, int ticks) {
    Hold(&guide, part, options, X_WB, ticks);
    return guide.CollectIgnored(part, pairs);
  };
  EXPECT_EQ(count(Above(40e-3), 300), 0U);       // Too far.
  EXPECT_EQ(count(Above(5e-3, 2e-3), 300), 0U);  // Captured, but beside the axis.
  EXPECT_TRUE(guide.is_captured(0));
  EXPECT_FALSE(guide.is_aligned());
  EXPECT_EQ(count(Tilted(Vec3(0.05, 0, 0), Vec3(0, 0, kLength + 5e-3)), 300), 0U);
  ASSERT_EQ(count(Above(5e-3), 300), 2U);
  EXPECT_TRUE(guide.is_aligned());
  EXPECT_EQ(pairs[0].body, contact::BodyId(4));
  EXPECT_EQ(pairs[0].held_faces.size(), 1U);
  EXPECT_EQ(pairs[0].scene_faces.size(), 3U);
  EXPECT_EQ(pairs[1].held_faces.size(), 3U);
  EXPECT_EQ(pairs[1].scene_faces.size(), 1U);
  // At the stop the shoulder still meets the bushing: that is contact, not the axis' fit.
  EXPECT_EQ(count(Above(-kLength + 1e-3), 300), 2U);
  EXPECT_TRUE(guide.is_captured(1));
  // A full array is not overrun.
  EXPECT_EQ(guide.CollectIgnored(part, std::span(pairs).first(1)), 0U);

  // Before the ramp has ended nothing is aligned, however straight the part comes.
  guide.Reset();
  EXPECT_EQ(count(Above(5e-3), 200), 0U);
  EXPECT_EQ(count(Above(5e-3), 100), 2U);
}

// W8, W9: the axial resistance is that of the fit at the depth, and none without a fit.
TEST(MateGuide, W5AxialResistanceIsTheFitsAtTheDepth) {
  const GuidanceOptions options;
  const auto fit = MakeFit("H7/p6");
  const HeldPart part =
      MakePart({MakeAxisMate(fit, contact::BodyId(0)), MakeStopMate(contact::BodyId(0)),
                MakeAxisMate(nullptr, contact::BodyId(0))});
  MateGuide guide;
  Hold(&guide, part, options, Above(5e-3), 300);
  EXPECT_EQ(guide.CalcFitLoad(part, 0).in, 0);
  for (const double depth : {1e-3, 12.3e-3, 49e-3}) {
    Hold(&guide, part, options, Above(-depth));
    EXPECT_NEAR(guide.insertion_depth(), depth, 1e-15);
    EXPECT_NEAR(guide.CalcFitLoad(part, 0).in, fit->CalcAxialResistance(depth), 1e-6);
    EXPECT_GT(guide.CalcFitLoad(part, 0).in, 100);
  }
}

// More mates than there is room for: the first ones guide, none is written beyond.
TEST(MateGuide, CapacityIsKept) {
  const GuidanceOptions options;
  const HeldPart part = MakePart(
      std::vector<HeldMate>(MateGuide::kMaxMates + 5, MakeAxisMate(nullptr, contact::BodyId(0))));
  MateGuide guide;
  Hold(&guide, part, options, Above(5e-3), 300);
  EXPECT_EQ(guide.captured_count(), static_cast<int>(MateGuide::kMaxMates));
  std::array<contact::IgnoredPair, 2 * MateGuide::kMaxMates> pairs;
  EXPECT_EQ(guide.CollectIgnored(part, pairs), pairs.size());
}

}  // namespace
}  // namespace hvas::haptics
