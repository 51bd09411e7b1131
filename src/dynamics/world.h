#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "base/id.h"
#include "base/result.h"
#include "spatial/pose.h"

namespace hvas::dynamics {

using BodyId = Id<struct DynamicsBodyTag>;

/** Mass properties of a rigid body B with its centre of mass Bcm. */
struct MassProperties {
  double mass{0};                ///< [kg], > 0.
  Vec3 p_BoBcm_B{Vec3::Zero()};  ///< [m]
  Mat3 I_BBcm_B{Mat3::Zero()};   ///< About Bcm [kg m2], positive definite.
};

struct WorldOptions {
  double table_z{0};                ///< Height of the table, which has no edge [m].
  double gravity{9.81};             ///< Downwards [m/s2].
  double friction{0.3};             ///< Coulomb's coefficient between any two things.
  double rolling_resistance{5e-4};  ///< Arm of the normal force against rolling [m].
  double max_substep{1.0 / 240};    ///< Steps are cut into equal ones not longer than this [s].
};

/** Parts that nobody holds: they lie on a table, fall when dropped and can be pushed.

 A body is the convex hull of its vertices, so it is right for how parts lie and slide, and not for
 parts that go into one another: what is held or being assembled is the business of `contact`.
 Nothing bounces. Good for bodies of 1 mm to 1 m. One thread; equal calls give equal bits. */
class World {
 public:
  explicit World(const WorldOptions& options);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /** Adds a free body at rest; it is awake.
   Errors: kInvalid when there is no vertex, a number is not finite, or the mass is not positive. */
  Result<BodyId> AddBody(std::span<const Vec3> vertices_B, const MassProperties& properties,
                         const spatial::Pose& X_WB);
  /** Takes a body out for good and wakes what touched it. Its id is not used again. */
  void Remove(BodyId body);

  /** Kinematic: stays where it was put or moved to, whatever pushes it; others feel it. Otherwise
   it is free, and starts at rest. */
  void SetKinematic(BodyId body, bool is_kinematic);
  /** Puts a body somewhere, at rest, without pushing what is there; wakes it and its neighbours. */
  void SetPose(BodyId body, const spatial::Pose& X_WB);
  /** Moves a kinematic body there evenly in the course of the next Step(), pushing what is in its
   way. */
  void MoveTo(BodyId body, const spatial::Pose& X_WB);
  /** Hits a free body with an impulse [N s] at a point Q, both in W. */
  void ApplyImpulse(BodyId body, const Vec3& impulse_W, const Vec3& p_WQ);

  /** Goes on by dt [s], > 0. */
  void Step(double dt);
  /** Steps until every free body sleeps, at most max_time [s]; returns whether all do. */
  bool Settle(double max_time);

  /** Bit for bit what was set until the body moves. */
  [[nodiscard]] const spatial::Pose& pose(BodyId body) const;
  /** Velocity of Bo, in W. */
  [[nodiscard]] spatial::Twist CalcVelocity(BodyId body) const;
  [[nodiscard]] bool is_kinematic(BodyId body) const;
  /** True for a body at rest that nothing disturbs; a kinematic one is asleep between moves. */
  [[nodiscard]] bool is_asleep(BodyId body) const;
  /** Kinetic and potential (zero on the table) energy of all free bodies [J]. */
  [[nodiscard]] double CalcEnergy() const;
  /** Bodies that were not removed. */
  [[nodiscard]] std::size_t size() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hvas::dynamics
