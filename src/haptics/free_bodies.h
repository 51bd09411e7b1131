#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/scene.h"
#include "fits/friction.h"
#include "haptics/constraint_solver.h"
#include "haptics/rigid_group.h"

namespace hvas::haptics {

/** What the tick knows of a body of the scene besides its shape. */
struct BodyProperties {
  double mass{0};                ///< [kg]; 0: it never moves by itself.
  Vec3 p_BoBcm_B{Vec3::Zero()};  ///< [m]
  Mat3 I_BBcm_B{Mat3::Zero()};   ///< About Bcm [kg m2], positive definite.
  fits::FrictionSurface surface{fits::FrictionSurface::kUnknown};
};

/** A body that moves by itself: a part, or parts that are put together. */
struct FreeBody {
  contact::BodyId id;  ///< Leader of a group.
  spatial::Pose X_WB;
  spatial::Twist V;        ///< Velocity of the centre of mass, in W.
  double time_at_rest{0};  ///< [s]
  int index{-1};           ///< Index in this tick's solver.
  double clearance{0};     ///< Least distance before the step, or the margin of its query [m].
};

/** Loose parts that move: pushed by the held part or by each other, or let go. They are solved in
 the tick together with the held part, with the exact contact shapes; all others stand still. At
 most kMaxAwake move at once; further ones stand as if they were fixed.

 Everything but SetProperties is RT-safe. */
class FreeBodies {
 public:
  /** Besides what all hands hold, and two fasteners that a tool turns. */
  static constexpr std::size_t kMaxAwake = ConstraintSolver::kMaxBodies - kMaxHands - 2;

  /** A body that may move, once it is made loose. Not RT-safe: allocates. */
  void SetProperties(contact::BodyId id, const BodyProperties& properties);

  /** Null for a body nothing is known of. */
  [[nodiscard]] const BodyProperties* properties(contact::BodyId id) const noexcept {
    return id.is_valid() && id.index() < entries_.size() ? &entries_[id.index()].properties
                                                         : nullptr;
  }

  /** Loose: it moves when something touches it. What it was put together with comes apart. */
  void SetLoose(contact::BodyId id, bool is_loose) noexcept;

  /** Makes parts one body, which is loose. The group outlives its parts' being together. */
  void Join(const RigidGroup& group) noexcept;

  /** Lets a group that is loose stand still, as in a vice. */
  void HoldStill(const RigidGroup& group) noexcept;

  /** Makes a group loose that stands still since HoldStill(); false where it does not: a hand has
   taken of it, or it was put elsewhere. */
  bool LetLoose(const RigidGroup& group) noexcept;

  /** The parts that this one is put together with, and itself; null: it is by itself. */
  [[nodiscard]] const RigidGroup* group(contact::BodyId id) const noexcept {
    return id.is_valid() && id.index() < entries_.size() ? entries_[id.index()].group : nullptr;
  }

  /** Parts that a body consists of. */
  [[nodiscard]] std::size_t CountParts(contact::BodyId id) const noexcept {
    const RigidGroup* parts = group(id);
    return parts != nullptr ? parts->members.size() : 1;
  }

  /** Part i of a body that moves, and its pose. */
  [[nodiscard]] contact::BodyId PartOf(contact::BodyId id, std::size_t i) const noexcept {
    const RigidGroup* parts = group(id);
    return parts != nullptr ? parts->members[i].body : id;
  }

  [[nodiscard]] spatial::Pose PoseOfPart(contact::BodyId id, std::size_t i,
                                         const spatial::Pose& X_WB) const noexcept {
    return i == 0 ? X_WB : X_WB * group(id)->members[i].X_BS;
  }

  /** Bodies of its group; none of a part that is by itself. */
  [[nodiscard]] std::span<const contact::BodyId> ListTogether(contact::BodyId id) const noexcept {
    const RigidGroup* parts = group(id);
    return parts != nullptr ? std::span<const contact::BodyId>(parts->bodies)
                            : std::span<const contact::BodyId>();
  }

  /** The body that moves with this one: the leader of its group, or itself. */
  [[nodiscard]] contact::BodyId LeaderOf(contact::BodyId id) const noexcept {
    const RigidGroup* parts = group(id);
    return parts != nullptr ? parts->leader() : id;
  }

  /** Wakes a loose body where it is, at a velocity. False when it is not loose, or too many are
   awake. */
  bool Wake(contact::BodyId id, const spatial::Pose& X_WB, const spatial::Twist& V) noexcept;

  /** Wakes a body as Wake does; where too many are awake, the one that has been at rest for longest
 sleeps. */
  void WakeFirst(contact::BodyId id, const spatial::Pose& X_WB, const spatial::Twist& V) noexcept;

  [[nodiscard]] bool is_loose(contact::BodyId id) const noexcept {
    return id.is_valid() && id.index() < entries_.size() && entries_[id.index()].is_loose;
  }

  /** Null for one that does not move. */
  [[nodiscard]] FreeBody* FindAwake(contact::BodyId id) noexcept;

  [[nodiscard]] std::span<FreeBody> awake() noexcept { return {awake_.data(), count_}; }

  [[nodiscard]] std::span<const FreeBody> awake() const noexcept { return {awake_.data(), count_}; }

  /** Puts to sleep those that have been at rest for so long [s]. */
  void Sleep(double rest_time) noexcept;

  /** Description for the solver: in W, under gravity, turning as the body would by itself. */
  [[nodiscard]] ConstraintSolver::Body MakeSolverBody(const FreeBody& body, const Vec3& gravity_W,
                                                      double dt) const noexcept;

  /** Goes on by a share of dt with the velocity V at its centre of mass. */
  [[nodiscard]] spatial::Pose Move(const FreeBody& body, const spatial::Twist& V,
                                   double time) const noexcept;

 private:
  struct Entry {
    BodyProperties properties;
    const RigidGroup* group{nullptr};
    bool is_loose{false};
    bool is_held_still{false};
  };

  /** Mass properties of what moves as a body. */
  struct Inertia {
    double mass;
    const Vec3& p_BoBcm_B;
    const Mat3& I_BBcm_B;
  };

  [[nodiscard]] Inertia InertiaOf(contact::BodyId id) const noexcept;
  void SetTogether(const RigidGroup& group, bool is_loose) noexcept;

  std::vector<Entry> entries_;
  std::array<FreeBody, kMaxAwake> awake_;
  std::size_t count_{0};
};

/** A pose after a time at a velocity of a body's point Q, in W. */
[[nodiscard]] spatial::Pose MoveAbout(const spatial::Pose& X_WB, const Vec3& p_BQ,
                                      const spatial::Twist& V_Q, double time) noexcept;

}  // namespace hvas::haptics
