// The rig of W7 in a scripted hand: capture, insertion with all three fits, rest, extraction.

#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "haptics/force_map.h"
#include "haptics/haptic_tick.h"
#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::Above;
using testing::CalcDeepest;
using testing::CalcLargestJump;
using testing::kDt;
using testing::kLength;
using testing::MakeFit;
using testing::Rig;
using testing::Sample;

constexpr double kJumpLimit = 0.5;  // [N] from one millisecond to the next

/** Speed along the axis, upwards, between a sample and the one before [m/s]. */
double CalcRise(const std::vector<Sample>& samples, std::size_t i) {
  return (samples[i].out.X_WD.p().z() - samples[i - 1].out.X_WD.p().z()) / kDt;
}

/** Waits on the axis and goes all the way in at 20 mm/s, to the seat. */
void Insert(Rig* rig) {
  rig->hand->Wait(0.8);
  rig->hand->MoveEvenly(Vec3(0, 0, -68e-3), 3.4);
  rig->hand->Wait(0.5);
}

/** Half way in, at rest. */
void InsertHalfWay(Rig* rig) {
  rig->hand->Wait(0.8);
  rig->hand->MoveSoftly(Vec3(0, 0, -42e-3), 2.5);
  rig->hand->Wait(1.5);
}

// X8, X10, W7: from anywhere within the capture limits the shaft comes onto the axis, is not lost
// again on the way, and pulls the hand without a jump.
TEST(Guidance, X10CaptureBringsTheShaftOntoTheAxis) {
  double largest_jump = 0;
  double largest_overshoot = 0;
  double largest_rest = 0;
  double largest_offset = 0;
  for (int i = 0; i < 4; ++i) {
    for (const double offset : {0.0, 2.5e-3, 4.9e-3}) {
      for (const double angle_deg : {-9.9, -5.0, 0.0, 5.0, 9.9}) {
        const double heading = 0.25 * std::numbers::pi * i;
        const Quat q = spatial::RotationFromVector(Vec3(0, angle_deg * std::numbers::pi / 180, 0));
        Rig rig(MakeFit("H7/g6"), Pose(q, Vec3(offset * std::cos(heading),
                                               offset * std::sin(heading), kLength + 15e-3)));
        rig.hand->Wait(0.8);
        bool was_mating = false;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < rig.hand->samples.size(); ++k) {
          const Sample& s = rig.hand->samples[k];
          ASSERT_TRUE(s.out.state == HoldState::kCaptured || s.out.state == HoldState::kMating)
              << ToString(s.out.state) << " from " << offset << " m, " << angle_deg << " deg";
          ASSERT_TRUE(!was_mating || s.out.state == HoldState::kMating);
          was_mating = s.out.state == HoldState::kMating;
          // Offset and tilt together, each as a part of its limit.
          const MateGeometry g = CalcMateGeometry(rig.part.mates[0], s.out.X_WD);
          const double deviation = g.distance / rig.options.guidance.capture.axis_distance +
                                   g.angle / rig.options.guidance.capture.angle;
          largest_overshoot = std::max(largest_overshoot, deviation - least);
          least = std::min(least, deviation);
          if (static_cast<double>(k) * kDt > rig.options.guidance.ramp_time) {
            largest_rest = std::max(largest_rest, deviation);
          }
        }
        EXPECT_TRUE(was_mating);
        const MateGeometry g = CalcMateGeometry(rig.part.mates[0], rig.hand->last().X_WD);
        largest_offset = std::max(largest_offset, g.distance);
        EXPECT_LT(g.angle, 0.2e-3);
        largest_jump = std::max(largest_jump, CalcLargestJump(rig.hand->samples));
      }
    }
  }
  RecordProperty("largest_jump_n", std::to_string(largest_jump));
  RecordProperty("largest_overshoot", std::to_string(largest_overshoot));
  RecordProperty("largest_rest", std::to_string(largest_rest));
  RecordProperty("largest_offset_um", std::to_string(1e6 * largest_offset));
  EXPECT_LT(largest_jump, kJumpLimit);
  // The shaft's mass swings through the axis once, far within the limits of release.
  EXPECT_LT(largest_overshoot, 0.5);
  EXPECT_LT(largest_rest, 0.01);  // When the ramp has ended it is there.
  EXPECT_LT(largest_offset, 10e-6);
}

// W8, W9: while sliding, the true axial force is the fit's resistance at the depth, with the hand
// on the axis or 2 mm beside it.
TEST(Insertion, AxialForceIsTheFitsResistance) {
  for (const char* name : {"H7/k6", "H7/p6"}) {
    for (const double offset : {0.0, 2e-3}) {
      const auto fit = MakeFit(name);
      Rig rig(fit, Above(10e-3, offset));
      Insert(&rig);
      const auto& samples = rig.hand->samples;
      int compared = 0;
      double worst = 0;
      for (std::size_t i = 1; i < samples.size(); ++i) {
        const TickOutput& out = samples[i].out;
        const double expected = fit->CalcAxialResistance(out.insertion_depth);
        if (out.state != HoldState::kMating || CalcRise(samples, i) > -1e-3 || expected < 50) {
          continue;
        }
        ++compared;
        worst = std::max(worst, std::abs(out.axial_true / expected - 1));
      }
      EXPECT_LT(worst, 0.02) << name << " " << offset;
      EXPECT_GT(compared, 1000) << name << " " << offset;
      EXPECT_EQ(rig.hand->last().state, HoldState::kSeated);
      EXPECT_LT(CalcLargestJump(samples), kJumpLimit) << name;
    }
  }
}

/** The fit of a tongue of 30 mm by 40 mm, 50 mm deep, with this clearance of its width [m]. */
std::shared_ptr<const fits::FitForce> MakeFlatFit(double clearance) {
  fits::FitForceParameters p;
  p.nominal_diameter = p.shaft_diameter = 30e-3;
  p.hole_diameter = 30e-3 + clearance;
  p.hub_diameter = 60e-3;
  p.breadth = 40e-3;
  p.length = kLength;
  p.roughness = 0;
  return std::make_shared<const fits::FitForce>(*fits::FitForce::Make(p));
}

/** The rig's axis mate as that of a tongue whose walls are apart along `across_W`. */
HeldMate MakeTongueMate(const HeldMate& axis, std::shared_ptr<const fits::FitForce> fit,
                        const Vec3& across_W) {
  HeldMate mate = axis;
  mate.capture.kind = product::MateKind::kPrismatic;
  mate.capture.reach = mate.breadth = 40e-3;
  mate.radius = 15e-3;
  Mat3 R;
  R << Vec3::UnitZ(), across_W.cross(Vec3::UnitZ()), across_W;
  mate.X_WM = mate.X_BN = Pose(Quat(R), Vec3::Zero());
  mate.fit = std::move(fit);
  return mate;
}

// A block in a pocket, between two pairs of walls: pressed in, it resists with what slabs between
// walls give, mu 2 b l p of each pair.
TEST(Insertion, N4PressedBlockResistsWithTheClosedFormOfItsWalls) {
  Rig rig(nullptr, Above(10e-3, 2e-3));
  const HeldMate axis = rig.part.mates[0];
  rig.part.mates = {MakeTongueMate(axis, MakeFlatFit(-3e-6), Vec3::UnitX()),
                    MakeTongueMate(axis, MakeFlatFit(-1e-6), Vec3::UnitY()), rig.part.mates[1]};
  rig.Take();
  Insert(&rig);
  const auto& samples = rig.hand->samples;
  int compared = 0;
  double worst = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const TickOutput& out = samples[i].out;
    const double depth = out.insertion_depth;
    if (out.state != HoldState::kMating || CalcRise(samples, i) > -1e-3 || depth < 2e-3) {
      continue;
    }
    // 210 GPa / (1 - 0.3^2) over slabs of 30 mm and 30 mm, friction 0.15.
    const double expected = 0.15 * 2 * 40e-3 * depth * (210e9 / 0.91) * 4e-6 / 60e-3;
    ++compared;
    worst = std::max(worst, std::abs(out.axial_true / expected - 1));
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(compared, 1000);
  EXPECT_EQ(rig.hand->last().state, HoldState::kSeated);
  EXPECT_LT(CalcLargestJump(samples), kJumpLimit);
}

// A tongue with play is held by nothing within it, and by all the coupling can show beyond; drawn
// against one wall, it has all of its play to the other side.
TEST(Insertion, N4TongueRattlesWithinItsClearance) {
  for (const double shift : {0.0, 1.0}) {
    const auto fit = MakeFlatFit(40e-6);
    Rig rig(nullptr, Above(10e-3));
    HeldMate mate = MakeTongueMate(rig.part.mates[0], fit, Vec3::UnitX());
    mate.shift = shift;
    rig.part.mates = {mate, MakeTongueMate(rig.part.mates[0], MakeFlatFit(0), Vec3::UnitY()),
                      rig.part.mates[1]};
    rig.Take();
    InsertHalfWay(&rig);
    const double low = shift > 0 ? -40e-6 : -20e-6;
    const double high = shift > 0 ? 0 : 20e-6;
    const double k = rig.options.coupling.k_lin;
    const auto check = [&](double x) {
      const double f = k * std::max({0.0, x - high, low - x});
      EXPECT_NEAR(std::abs(rig.hand->last().F_felt_W.f.x()), f, 0.03 * f + 4e-3) << x;
    };
    rig.hand->MoveSoftly(Vec3(-15e-6, 0, 0), 0.3);
    rig.hand->Wait(0.5);
    check(-15e-6);
    rig.hand->MoveSoftly(Vec3(1.015e-3, 0, 0), 0.3);
    rig.hand->Wait(0.5);
    check(1e-3);
    rig.hand->MoveSoftly(Vec3(-2e-3, 0, 0), 0.3);
    rig.hand->Wait(0.5);
    check(-1e-3);
  }
}

// W4, W10: a clearance fit is felt as friction of the side that touches only, 0 to 0.3 N for a hand
// 2 mm beside the axis, and not at all on it.
TEST(Insertion, W4ClearanceFitIsLight) {
  for (const double offset : {0.0, 2e-3}) {
    Rig rig(MakeFit("H7/g6"), Above(10e-3, offset));
    Insert(&rig);
    const auto& samples = rig.hand->samples;
    int sliding = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const TickOutput& out = samples[i].out;
      if (out.state != HoldState::kMating || out.insertion_depth < 1e-3) {
        continue;
      }
      ++sliding;
      ASSERT_GE(out.axial_felt, -0.01);
      ASSERT_LE(out.axial_felt, 0.305);
      ASSERT_EQ(out.axial_true, out.axial_felt);
      // mu times what holds the shaft's side back, W(5).
      const double lateral = out.F_felt_W.f.head<2>().norm();
      ASSERT_NEAR(out.axial_felt, rig.options.contact.friction.kinetic_coefficient * lateral, 0.03);
    }
    EXPECT_GT(sliding, 1500);
    EXPECT_EQ(rig.hand->last().state, HoldState::kSeated);
    EXPECT_LT(CalcLargestJump(samples), kJumpLimit);
  }
}

/** Felt axial force over depth while sliding in, one value a tick. */
struct Curve {
  std::vector<double> depth, felt;
};

Curve CalcCurve(const std::vector<Sample>& samples) {
  Curve curve;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const TickOutput& out = samples[i].out;
    if (out.state == HoldState::kMating && out.insertion_depth > 0.2e-3 &&
        CalcRise(samples, i) < -1e-3) {
      curve.depth.push_back(out.insertion_depth);
      curve.felt.push_back(out.axial_felt);
    }
  }
  return curve;
}

// W5, W10: interference is smooth and grows with the depth, 0 to 7 N on this device.
TEST(Insertion, W5InterferenceFitRisesSmoothly) {
  Rig rig(MakeFit("H7/p6"), Above(10e-3));
  Insert(&rig);
  const Curve curve = CalcCurve(rig.hand->samples);
  ASSERT_GT(curve.felt.size(), 2000U);
  for (std::size_t i = 1; i < curve.felt.size(); ++i) {
    ASSERT_GT(curve.felt[i], curve.felt[i - 1]);
    ASSERT_LT(curve.felt[i] - curve.felt[i - 1], 0.2);
  }
  EXPECT_GT(curve.felt.back(), 6);
  EXPECT_LT(curve.felt.back(), rig.options.device.max_force);
}

// W6, W10: a transition fit goes in stairs: flat where S >= 0, rising where S < 0.
TEST(Insertion, W6TransitionFitRisesInStairs) {
  const auto fit = MakeFit("H7/k6");
  Rig rig(fit, Above(10e-3));
  Insert(&rig);
  const Curve curve = CalcCurve(rig.hand->samples);
  ASSERT_GT(curve.felt.size(), 1500U);
  int flat = 0;
  int rising = 0;
  int stairs = 0;
  bool was_flat = false;
  for (std::size_t i = 1; i < curve.felt.size(); ++i) {
    const double step = curve.felt[i] - curve.felt[i - 1];
    const bool is_clear =
        fit->CalcClearance(curve.depth[i]) >= 0 && fit->CalcClearance(curve.depth[i - 1]) >= 0;
    if (is_clear) {
      ++flat;
      ASSERT_NEAR(step, 0, 1e-9) << curve.depth[i];
    } else if (fit->CalcClearance(curve.depth[i]) < -0.1e-6) {
      ++rising;
      ASSERT_GT(step, 0) << curve.depth[i];
    }
    stairs += is_clear && !was_flat ? 1 : 0;
    was_flat = is_clear;
  }
  EXPECT_GT(flat, 500);
  EXPECT_GT(rising, 200);
  EXPECT_GE(stairs, 3);
  EXPECT_GT(curve.felt.back(), 3);
}

// A fit holds at rest and never pushes: the part stands still while the hand does, and when the
// hand lets go of its force.
TEST(Insertion, PressedShaftStaysWhereItIsLeft) {
  for (const char* name : {"H7/k6", "H7/p6"}) {
    const auto fit = MakeFit(name);
    Rig rig(fit, Above(10e-3));
    InsertHalfWay(&rig);
    const Vec3 p_rest = rig.hand->last().X_WD.p();
    rig.hand->Wait(0.5);
    EXPECT_LT((rig.hand->last().X_WD.p() - p_rest).norm(), 1e-6) << name;
    const std::size_t start = rig.hand->samples.size();
    rig.hand->LetGo(3);
    double farthest = 0;
    for (std::size_t i = start; i < rig.hand->samples.size(); ++i) {
      const TickOutput& out = rig.hand->samples[i].out;
      farthest = std::max(farthest, (out.X_WD.p() - p_rest).norm());
      // What the fit holds against is never more than what it could resist with.
      ASSERT_LE(std::abs(out.axial_true),
                fit->CalcAxialResistance(out.insertion_depth) * 1.001 + 0.1);
    }
    EXPECT_LT(farthest, 2e-6) << name;
    // The hand comes to rest, with nothing left to feel but what it carries.
    const TickOutput& out = rig.hand->last();
    EXPECT_LT(out.F_H_W.f.norm(), 0.01) << name;
    EXPECT_LT(CalcLargestJump(rig.hand->samples), kJumpLimit);
  }
}

// W4, N5: the engaged length holds nothing across and against tilt within its clearance, and all
// the coupling can show beyond it; a press fit has no such band.
TEST(Insertion, EngagedLengthHoldsBeyondItsClearance) {
  for (const char* name : {"H7/g6", "H7/p6"}) {
    const auto fit = MakeFit(name);
    Rig rig(fit, Above(10e-3));
    InsertHalfWay(&rig);
    const double depth = rig.hand->last().insertion_depth;
    const double play = fit->CalcRadialPlay(depth);
    const double tilt = 2 * play / std::max(depth, 2 * testing::kShaftRadius);
    EXPECT_EQ(play > 0, std::string_view(name) == "H7/g6");
    const CouplingGains& gains = rig.options.coupling;
    const auto check = [&](double across, double turned) {
      const TickOutput& out = rig.hand->last();
      const double f = gains.k_lin * std::max(0.0, across - play);
      const double t = gains.k_rot * std::max(0.0, turned - tilt);
      EXPECT_NEAR(out.F_felt_W.f.head<2>().norm(), f, 0.03 * f + 4e-3) << name << " " << across;
      // Pressed aside, above the middle of what is engaged, it tilts as far as it may.
      const double swing = across > 0 ? gains.k_rot * tilt : 0.0;
      EXPECT_NEAR(out.F_felt_W.t.head<2>().norm(), t, 0.03 * t + 4e-4 + swing)
          << name << " " << turned;
    };
    check(0, 0);
    rig.hand->MoveSoftly(Vec3(0.5 * play, 0, 0), 0.3);
    rig.hand->Wait(0.5);
    check(0.5 * play, 0);
    rig.hand->MoveSoftly(Vec3(-0.5 * play, 1e-3, 0), 0.3);
    rig.hand->Wait(0.5);
    check(1e-3, 0);
    rig.hand->MoveSoftly(Vec3(0, -1e-3, 0), 0.3, Vec3(0.03, 0, 0));
    rig.hand->Wait(0.5);
    check(0, 0.03);
  }
}

// N5: let go of in its hole, a shaft that the fit holds stays; one that it does not hold falls.
TEST(Insertion, ReleasedShaftStaysWhereItsFitHoldsIt) {
  for (const char* name : {"H7/g6", "H7/p6"}) {
    Rig rig(MakeFit(name), Above(10e-3));
    rig.part.falls_when_dropped = true;
    rig.tick->SetProperties(rig.part.body, {rig.part.mass, rig.part.p_BoBcm_B, rig.part.I_BBcm_B,
                                            fits::FrictionSurface::kSteel});
    InsertHalfWay(&rig);
    ASSERT_GT(rig.hand->last().insertion_depth, 20e-3);
    (void)rig.tick->Drop();
    rig.hand->Wait(0.2);
    EXPECT_EQ(rig.tick->awake().empty(), std::string_view(name) == "H7/p6") << name;
  }
}

// Drawing the shaft out again is resisted by the same force the other way round, down to none.
TEST(Insertion, ExtractionIsOpposed) {
  const auto fit = MakeFit("H7/k6");
  Rig rig(fit, Above(10e-3));
  InsertHalfWay(&rig);
  const std::size_t start = rig.hand->samples.size();
  rig.hand->MoveEvenly(Vec3(0, 0, 85e-3), 4.5);
  rig.hand->Wait(1);
  const auto& samples = rig.hand->samples;
  int compared = 0;
  double worst = 0;
  for (std::size_t i = start; i < samples.size(); ++i) {
    const TickOutput& out = samples[i].out;
    const double expected = -fit->CalcAxialResistance(out.insertion_depth);
    if (out.state == HoldState::kMating && CalcRise(samples, i) > 1e-3 && expected < -50) {
      ++compared;
      worst = std::max(worst, std::abs(out.axial_true / expected - 1));
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(CalcLargestJump(samples), kJumpLimit);
  EXPECT_EQ(rig.hand->last().state, HoldState::kNear);
  EXPECT_EQ(rig.hand->last().axial_felt, 0);
}

// N6: in and out again, on the axis or beside it, the hand never gets back more than it gave.
TEST(Insertion, ClosedLoopsGiveNoEnergy) {
  for (const char* name : {"H7/g6", "H7/k6", "H7/p6"}) {
    for (const double offset : {0.0, 4e-3}) {
      Rig rig(MakeFit(name), Above(45e-3, offset));
      rig.hand->Wait(2);
      ASSERT_EQ(rig.hand->last().state, HoldState::kNear);
      const std::size_t start = rig.hand->samples.size();
      rig.hand->MoveSoftly(Vec3(0, 0, -80e-3), 2.5);
      rig.hand->Wait(0.3);
      const double depth = rig.hand->last().insertion_depth;
      rig.hand->MoveSoftly(Vec3(0, 0, 80e-3), 2.5);
      rig.hand->Wait(1);
      double energy = 0;
      for (std::size_t i = start; i < rig.hand->samples.size(); ++i) {
        const Sample& s = rig.hand->samples[i];
        energy += kDt * (s.out.F_H_W.f.dot(s.hand.V_DH.v) + s.out.F_H_W.t.dot(s.hand.V_DH.w));
      }
      EXPECT_GT(depth, 20e-3) << name;
      EXPECT_LT(energy, 1e-3) << name << " " << offset;
      EXPECT_LT(CalcLargestJump(rig.hand->samples), kJumpLimit) << name << " " << offset;
      EXPECT_LT(CalcDeepest(rig.hand->samples), 50e-6) << name << " " << offset;
    }
  }
}

// X5, X9: the states follow each other in order, and the part ends exactly in its place.
TEST(Insertion, PassesThroughItsStatesToTheExactPose) {
  Rig rig(MakeFit("H7/k6"), Above(60e-3, 25e-3));
  auto& hand = *rig.hand;
  hand.Wait(0.3);
  hand.MoveSoftly(Vec3(-24e-3, 0, 0), 0.6);
  hand.MoveSoftly(Vec3(0, 0, -50e-3), 1.2);
  hand.Wait(0.4);
  hand.MoveEvenly(Vec3(-1e-3, 0, -66e-3), 3);
  hand.Wait(0.5);
  std::vector<HoldState> states;
  for (const Sample& s : hand.samples) {
    if (states.empty() || states.back() != s.out.state) {
      states.push_back(s.out.state);
    }
  }
  EXPECT_EQ(states,
            (std::vector<HoldState>{HoldState::kFree, HoldState::kNear, HoldState::kCaptured,
                                    HoldState::kMating, HoldState::kSeated}));
  EXPECT_LT(CalcLargestJump(hand.samples), kJumpLimit);
  EXPECT_LT(CalcDeepest(hand.samples), 50e-6);
  // The shaft on the shoulder, to the bit.
  EXPECT_EQ(hand.last().X_WD.p(), rig.part.X_WB_goal.p());
  const Pose X_WB = rig.tick->Drop().X_WB;
  EXPECT_EQ(X_WB.p(), rig.part.X_WB_goal.p());
  EXPECT_EQ(X_WB.q().coeffs(), rig.part.X_WB_goal.q().coeffs());
  // The empty hand's force fades by the gate.
  const double before = hand.last().F_H_W.f.norm();
  hand.Wait(0.05);
  const auto& samples = hand.samples;
  for (std::size_t i = samples.size() - 50; i < samples.size(); ++i) {
    EXPECT_LT((samples[i].out.F_H_W.f - samples[i - 1].out.F_H_W.f).norm(), 0.4 + 1e-9);
  }
  EXPECT_GT(before, 1);
  EXPECT_EQ(hand.last().F_H_W.f.norm(), 0);
}

// X14, N3: without mates there is contact only; without contact the mates still guide.
TEST(Insertion, ConditionsLeaveOutWhatTheyName) {
  TickOptions options;
  options.condition = Condition::kCollision;
  Rig collision(MakeFit("H7/p6"), Above(5e-3, 3e-3), options);
  collision.hand->Wait(0.5);
  collision.hand->MoveSoftly(Vec3(0, 0, -12e-3), 1);
  for (const Sample& s : collision.hand->samples) {
    ASSERT_EQ(s.out.state, HoldState::kFree);
  }
  EXPECT_GT(collision.hand->last().contact_count, 0);
  EXPECT_NEAR(collision.hand->last().X_WD.p().z(), kLength, 50e-6);  // Stands on the rim.

  options.condition = Condition::kConstraint;
  Rig constraint(MakeFit("H7/g6"), Above(10e-3, 3e-3), options);
  Insert(&constraint);
  EXPECT_EQ(constraint.hand->last().state, HoldState::kSeated);
  EXPECT_EQ(CalcDeepest(constraint.hand->samples), 0);
}

/** Bits of what a tick gives. */
std::vector<double> Flatten(const TickOutput& out) {
  std::vector<double> v;
  const auto add = [&v](const auto& x) { v.insert(v.end(), x.data(), x.data() + x.size()); };
  for (const spatial::Wrench* w : {&out.F_H_W, &out.F_true_W, &out.F_felt_W}) {
    add(w->f);
    add(w->t);
  }
  add(out.X_WD.p());
  add(out.X_WD.q().coeffs());
  add(out.p_WC);
  add(out.f_C_W);
  for (const double x : {out.insertion_depth, out.axial_true, out.axial_felt, out.deepest,
                         static_cast<double>(out.contact_count), static_cast<double>(out.state)}) {
    v.push_back(x);
  }
  return v;
}

// N7: the same hand gives the same forces, bit for bit, also with an object that was used before.
TEST(Insertion, RepeatsBitForBit) {
  const auto run = [](Rig* rig) {
    auto& hand = *rig->hand;
    hand.MoveSoftly(Vec3(-14e-3, 1e-3, -22e-3), 0.8);  // Touches the rim on the way.
    hand.MoveSoftly(Vec3(-5e-3, 0, 8e-3), 0.6, Vec3(0, 0.05, 0));
    hand.Wait(0.4);
    hand.MoveSoftly(Vec3(0, 0, -70e-3), 2);
    hand.Wait(0.3);
  };
  Rig first(MakeFit("H7/k6"), Above(20e-3, 20e-3));
  Rig second(MakeFit("H7/k6"), Above(20e-3, 20e-3));
  run(&first);
  run(&second);
  // Once more with the first one, which has a history now.
  first.tick->Drop();
  for (int i = 0; i < 30; ++i) {
    first.hand->Wait(kDt);  // The gate forgets.
  }
  first.hand = std::make_unique<testing::ScriptedHand>(
      first.tick.get(),
      Pose(first.part.X_WB_start.q(), first.part.X_WB_start * first.part.p_BoBcm_B));
  first.tick->Take(&first.part);
  const auto& reference = second.hand->samples;
  bool touched = false;
  std::size_t mating = 0;
  run(&first);
  ASSERT_EQ(first.hand->samples.size(), reference.size());
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto a = Flatten(first.hand->samples[i].out);
    const auto b = Flatten(reference[i].out);
    ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0) << i;
    touched = touched || reference[i].out.contact_count > 0;
    mating += reference[i].out.state == HoldState::kMating ? 1 : 0;
  }
  EXPECT_TRUE(touched);
  EXPECT_GT(mating, 100U);
}

}  // namespace
}  // namespace hvas::haptics
