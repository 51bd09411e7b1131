#pragma once

#include <cmath>
#include <memory>

#include "fits/insertion.h"
#include "haptics/test/rig.h"

/** A peg with play in a hole, as a mate with a clearance fit has it, in a scripted hand. */
namespace hvas::haptics::testing {

using spatial::Pose;

inline constexpr double kHoleRadius = 5.2e-3;
inline constexpr double kPegRadius = 5e-3;
inline constexpr double kHoleDepth = 40e-3;  // From z = 0 to the mouth.
inline constexpr double kPegLength = 60e-3;
inline const fits::PegInHole kPair{2 * kHoleRadius, 2 * kPegRadius};

/** Surfaces as stiff as steel, and no weight. */
inline TickOptions HardAndWeightless() {
  TickOptions options;
  options.gravity_W.setZero();
  options.guidance.contact_in_holes = true;
  options.contact.compliance = 2e-8;
  options.guidance.attraction_force = 0;
  options.guidance.attraction_torque = 0;
  return options;
}

/** A peg upright in its hole, its tip at a depth under the mouth, as a mate has captured it. */
struct PegRig : HeldRig {
  /** Squeezed in its hole, as a mate holds it. */
  PegRig(double friction, const Pose& X_WB) : HeldRig(HardAndWeightless()) {
    Make(friction, X_WB);
    part.starts_in_place = true;
    options.coupling = {1, 0.01, 1e-4, 1e-6};
    Take();
  }

  PegRig(double depth, double friction) : HeldRig(HardAndWeightless()) {
    constexpr double kAbove = 2e-3;
    Make(friction, Pose(Vec3(0, 0, kHoleDepth + kAbove)));
    Take();
    hand->Wait(0.6);
    hand->MoveSoftly(Vec3(0, 0, -kAbove - depth), 0.6);
  }

  void Make(double friction, const Pose& X_WB) {
    static const auto hole = contact::testing::Build(
        contact::testing::Bushing(kHoleRadius, 3 * kHoleRadius, kHoleDepth, 20e-6));
    static const auto peg =
        contact::testing::Build(contact::testing::Shaft(kPegRadius, kPegLength, 20e-6));
    const contact::BodyId body = scene.Add(hole, Pose());
    Place(peg, X_WB);
    SetMass({{kPegRadius, 0, kPegLength}}, &part);
    fits::FitForceParameters p;
    p.nominal_diameter = 2 * kPegRadius;
    p.hole_diameter = 2 * kHoleRadius;
    p.shaft_diameter = 2 * kPegRadius;
    p.length = kHoleDepth;
    p.roughness = 0;
    p.friction = {friction, friction, friction, friction};
    HeldMate mate =
        MakeAxisMate(std::make_shared<const fits::FitForce>(*fits::FitForce::Make(p)), body);
    mate.capture = {product::MateKind::kAxisHole, 0, kHoleDepth, 0, kPegLength, 0};
    mate.radius = kHoleRadius;
    part.mates = {mate};
    part.X_WB_goal = Pose(Vec3(0, 0, -1));  // Far away: it never arrives.
  }

  /** Turns the hand about the point of the peg's axis in the mouth. */
  void Tilt(double angle, double time) {
    const Vec3 turn(0, angle, 0);
    const Vec3 p_WPivot(0, 0, kHoleDepth);
    hand->MoveSoftly(turn.cross(hand->pose().p() - p_WPivot), time, turn);
  }

  [[nodiscard]] double CalcTilt() const {
    const Vec3 axis = hand->last().X_WD.q() * Vec3::UnitZ();
    return std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
  }

  /** Depth of the middle of the tip under the mouth. */
  [[nodiscard]] double CalcTipDepth() const { return kHoleDepth - hand->last().X_WD.p().z(); }
};

}  // namespace hvas::haptics::testing
