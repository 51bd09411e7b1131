#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "contact/test/parts.h"
#include "fits/iso286.h"
#include "haptics/haptic_tick.h"
#include "haptics/test/values.h"

/** The bushing rig of W7 and a hand that follows a script. */
namespace hvas::haptics::testing {

inline constexpr double kShaftRadius = 20e-3;
inline constexpr double kHubRadius = 40e-3;
inline constexpr double kLength = 50e-3;
inline constexpr double kShoulderRadius = 30e-3;
inline constexpr double kShoulderLength = 20e-3;
inline constexpr double kSteel = 7850;  // [kg/m^3]

/** Mass properties of a turned part about the z axis, from its cylinders stacked along z. */
struct Cylinder {
  double radius, low, high;
};

inline void SetMass(const std::vector<Cylinder>& cylinders, HeldPart* part) {
  part->mass = 0;
  double moment = 0;
  const auto mass = [](const Cylinder& c) {
    return kSteel * std::numbers::pi * c.radius * c.radius * (c.high - c.low);
  };
  for (const Cylinder& c : cylinders) {
    part->mass += mass(c);
    moment += mass(c) * 0.5 * (c.low + c.high);
  }
  const double z = moment / part->mass;
  part->p_BoBcm_B = Vec3(0, 0, z);
  part->I_BBcm_B.setZero();
  for (const Cylinder& c : cylinders) {
    const double m = mass(c);
    const double across = m * (c.radius * c.radius / 4 + std::pow(c.high - c.low, 2) / 12 +
                               std::pow(0.5 * (c.low + c.high) - z, 2));
    part->I_BBcm_B += Vec3(across, across, 0.5 * m * c.radius * c.radius).asDiagonal();
  }
}

/** A fit of W7's rig with sizes in the middle of their zones. */
inline std::shared_ptr<const fits::FitForce> MakeFit(std::string_view name,
                                                     double roughness = 6.3e-6,
                                                     std::uint64_t seed = 1) {
  const fits::FitClass fit = *fits::ParseFit(name);
  const fits::Limits hole = *fits::CalcLimits(fit.hole, 2 * kShaftRadius);
  const fits::Limits shaft = *fits::CalcLimits(fit.shaft, 2 * kShaftRadius);
  fits::FitForceParameters p;
  p.nominal_diameter = 2 * kShaftRadius;
  p.hole_diameter = p.nominal_diameter + 0.5 * (hole.lower + hole.upper);
  p.shaft_diameter = p.nominal_diameter + 0.5 * (shaft.lower + shaft.upper);
  p.length = kLength;
  p.hub_diameter = 2 * kHubRadius;
  p.roughness = roughness;
  p.seed = seed;
  return std::make_shared<const fits::FitForce>(*fits::FitForce::Make(p));
}

inline std::shared_ptr<const MateFaces> Faces(std::vector<std::uint32_t> mating,
                                              std::vector<std::uint32_t> all) {
  return std::make_shared<const MateFaces>(MateFaces{std::move(mating), std::move(all)});
}

inline const std::shared_ptr<const contact::Shape>& BushingShape() {
  static const auto shape =
      contact::testing::Build(contact::testing::Bushing(kShaftRadius, kHubRadius, kLength, 20e-6));
  return shape;
}

/** Faces: 0 tip, 1 side, 2 shoulder, 3 head, 4 top. The origin is the middle of the tip. */
inline const std::shared_ptr<const contact::Shape>& ShaftShape() {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  constexpr double kTop = kLength + kShoulderLength;
  static const auto shape = contact::testing::Build(contact::testing::Lathe(
      {{{{0, 0}, {kShaftRadius, 0}}, PlaneAt(0, -1)},
       {{{kShaftRadius, 0}, {kShaftRadius, kLength}}, CylinderZ(kShaftRadius, 1)},
       {{{kShaftRadius, kLength}, {kShoulderRadius, kLength}}, PlaneAt(kLength, -1)},
       {{{kShoulderRadius, kLength}, {kShoulderRadius, kTop}}, CylinderZ(kShoulderRadius, 1)},
       {{{kShoulderRadius, kTop}, {0, kTop}}, PlaneAt(kTop, 1)}},
      contact::testing::Segments(kShoulderRadius, 20e-6)));
  return shape;
}

/** The axis mate of the rig: bushing from z = 0 to 50 mm on W's z axis, the shaft's own origin at
 its tip. The insertion depth is 50 mm less the tip's height. */
inline HeldMate MakeAxisMate(std::shared_ptr<const fits::FitForce> fit, contact::BodyId body) {
  HeldMate mate;
  mate.id = product::MateId(0);
  mate.capture = {product::MateKind::kAxisHole, 0, kLength, 0, kLength, 0};
  mate.radius = kShaftRadius;
  mate.fit = std::move(fit);
  mate.body = body;
  mate.held_faces = Faces({1}, {0, 1, 2});
  mate.placed_faces = Faces({3}, {0, 2, 3});
  return mate;
}

/** The shoulder on the bushing's top: the end of the insertion. */
inline HeldMate MakeStopMate(contact::BodyId body) {
  HeldMate mate;
  mate.id = product::MateId(1);
  mate.X_WM = spatial::Pose(Vec3(0, 0, kLength));
  mate.X_BN = {Quat(0, 1, 0, 0), Vec3(0, 0, kLength)};
  mate.capture = {product::MateKind::kFaceFace, 0, 0, 0, 0, 0};
  mate.capture.reach = std::sqrt(kShoulderRadius * kShoulderRadius - kShaftRadius * kShaftRadius);
  mate.is_stop = true;
  mate.body = body;
  mate.held_faces = Faces({2}, {1, 2, 3});
  mate.placed_faces = Faces({2}, {1, 2, 3});
  return mate;
}

/** One moment of a run. */
struct Sample {
  device::DeviceState hand;
  TickOutput out;
};

/** A hand that goes from place to place without turning unless told, and what it felt. */
class ScriptedHand {
 public:
  explicit ScriptedHand(HapticTick* tick, const spatial::Pose& X_WH) : tick_(tick), X_WH_(X_WH) {}

  /** Moves by a displacement and a rotation vector in a time, with constant speed. */
  void MoveEvenly(const Vec3& d, double time, const Vec3& turn = Vec3::Zero()) {
    Move(d, turn, time, [](double s) { return std::pair(s, 1.0); });
  }

  /** Moves along a minimum-jerk path. */
  void MoveSoftly(const Vec3& d, double time, const Vec3& turn = Vec3::Zero()) {
    Move(d, turn, time, [](double s) {
      return std::pair(s * s * s * (10 + s * (-15 + 6 * s)), 30 * s * s * (1 - s) * (1 - s));
    });
  }

  /** One tick: to a place at once, turning at a rate [rad/s]. */
  void LeadTo(const Vec3& p, const Vec3& w) {
    const Vec3 v = (p - X_WH_.p()) / kDt;
    X_WH_ = {(spatial::RotationFromVector(kDt * w) * X_WH_.q()).normalized(), p};
    Tick({w, v});
  }

  void Wait(double time) { MoveEvenly(Vec3::Zero(), time); }

  /** Follows a force instead of a path: a light hand that gives way, with nothing in its arm but a
   mass of 0.3 kg and some damping. The hand is let go. */
  void LetGo(double time) {
    constexpr double kHandMass = 0.3;
    constexpr double kHandDamping = 3;
    spatial::Twist V;
    for (int i = 0, n = Count(time); i < n; ++i) {
      const Vec3 f = samples.empty() ? Vec3(Vec3::Zero()) : samples.back().out.F_H_W.f;
      V.v += kDt / kHandMass * (f - kHandDamping * V.v);
      X_WH_ = {X_WH_.q(), X_WH_.p() + kDt * V.v};
      Tick(V);
    }
  }

  void Tick(const spatial::Twist& V, bool is_valid = true) {
    device::DeviceState state;
    state.t_ns = static_cast<std::int64_t>(samples.size()) * 1'000'000;
    state.X_DH = X_WH_;
    state.V_DH = V;
    state.is_valid = is_valid;
    samples.push_back({state, tick_->Tick(state)});
  }

  [[nodiscard]] const spatial::Pose& pose() const { return X_WH_; }

  [[nodiscard]] const TickOutput& last() const { return samples.back().out; }

  std::vector<Sample> samples;

 private:
  static int Count(double time) { return static_cast<int>(std::lround(time / kDt)); }

  void Move(const Vec3& d, const Vec3& turn, double time,
            const std::function<std::pair<double, double>(double)>& path) {
    const spatial::Pose X_start = X_WH_;
    for (int i = 1, n = Count(time); i <= n; ++i) {
      const auto [s, rate] = path(static_cast<double>(i) / n);
      X_WH_ = {(spatial::RotationFromVector(s * turn) * X_start.q()).normalized(),
               X_start.p() + s * d};
      Tick({rate / time * turn, rate / time * d});
    }
  }

  HapticTick* tick_;
  spatial::Pose X_WH_;
};

/** A part in a scene, the tick that holds it, and the hand that leads it. */
struct HeldRig {
  explicit HeldRig(TickOptions the_options) : options(std::move(the_options)) {}

  /** Places the part, as the second of the product. */
  void Place(std::shared_ptr<const contact::Shape> shape, const spatial::Pose& X_WB_start) {
    part.occurrence = product::OccurrenceId(1);
    part.body = scene.Add(shape, X_WB_start);
    part.bodies = {part.body};
    part.shape = std::move(shape);
    part.X_WB_start = X_WB_start;
  }

  /** Takes it at its centre of mass. */
  void Take() {
    const spatial::Pose& X_WB = part.X_WB_start;
    tick = std::make_unique<HapticTick>(options, &scene);
    hand =
        std::make_unique<ScriptedHand>(tick.get(), spatial::Pose(X_WB.q(), X_WB * part.p_BoBcm_B));
    tick->Take(&part);
  }

  TickOptions options;
  contact::Scene scene;
  HeldPart part;
  std::unique_ptr<HapticTick> tick;
  std::unique_ptr<ScriptedHand> hand;
};

/** The rig with a shaft in the hand, its tip a little above the bushing. */
struct Rig : HeldRig {
  explicit Rig(std::shared_ptr<const fits::FitForce> fit, const spatial::Pose& X_WB_start,
               TickOptions the_options = {})
      : HeldRig(std::move(the_options)) {
    const contact::BodyId bushing = scene.Add(BushingShape(), spatial::Pose());
    Place(ShaftShape(), X_WB_start);
    SetMass({{kShaftRadius, 0, kLength}, {kShoulderRadius, kLength, kLength + kShoulderLength}},
            &part);
    part.mates = {MakeAxisMate(std::move(fit), bushing), MakeStopMate(bushing)};
    Take();
  }
};

/** A part without mates over a block with its top at z = 0, for contact alone. */
struct BlockRig : HeldRig {
  BlockRig(std::shared_ptr<const contact::Shape> shape, double mass,
           const spatial::Pose& X_WB_start, TickOptions the_options = {})
      : HeldRig(std::move(the_options)) {
    static const auto block =
        contact::testing::Build(contact::testing::Block(Vec3(0.1, 0.1, 0.02)));
    scene.Add(block, spatial::Pose(Vec3(0, 0, -0.02)));
    Place(std::move(shape), X_WB_start);
    part.mass = mass;
    part.I_BBcm_B = 0.4 * mass * 4e-4 * Mat3::Identity();
    part.X_WB_goal = spatial::Pose(Vec3(1, 1, 1));
    Take();
  }
};

/** Largest change of the felt force from one tick to the next, before the gate [N]. */
inline double CalcLargestJump(const std::vector<Sample>& samples) {
  double largest = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    largest = std::max(largest, (samples[i].out.F_felt_W.f - samples[i - 1].out.F_felt_W.f).norm());
  }
  return largest;
}

/** Deepest contact of a run [m]. */
inline double CalcDeepest(const std::vector<Sample>& samples) {
  double deepest = 0;
  for (const Sample& s : samples) {
    deepest = std::max(deepest, -s.out.deepest);
  }
  return deepest;
}

/** The shaft upright with its tip at a height over the bushing's top. */
inline spatial::Pose Above(double height, double x = 0, double y = 0) {
  return spatial::Pose(Vec3(x, y, kLength + height));
}

}  // namespace hvas::haptics::testing
