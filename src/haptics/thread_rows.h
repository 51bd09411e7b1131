#pragma once

#include "haptics/constraint_solver.h"
#include "haptics/displayed_part.h"
#include "haptics/force_map.h"
#include "haptics/mate_guide.h"
#include "haptics/options.h"

namespace hvas::haptics {

/** What a thread does to the held part in one tick, along and about the way out of it. */
struct ThreadForces {
  double torque_true{0};  ///< Torque of friction and clamped parts, counter-clockwise [N m].
  double torque_felt{0};
  double preload{0};  ///< Force in the screw behind its head at the end of the step [N].
};

/** A thread in the hand: it goes in by turning, a lead for each turn, between two flanks with play;
 it runs with friction; behind the head that has come to rest the preload rises with the turn as the
 joint is stiff, and what it takes to turn on and to break loose is that of VDI 2230-1:

   T = F (P / (2 pi) + 1.155 mu d2 / 2 + mu D_K / 2)   on,
   T = F (1.155 mu d2 / 2 + mu D_K / 2 - P / (2 pi))   off.

 With z the distance of the part from its place along the way out, and u the angle about it in which
 it comes out, the helix is at c(u) = h max(u - u_head, 0), h = |lead| / (2 pi): the drawn place is
 that of the tightened part, whose head has rested since u_head = F_M / (k h). A flank holds the
 part where z < c - play / 2, the other one where z > c + play / 2. At the mouth, where two leads of
 thread are not in yet, the first flank alone leads, and the other one comes nearer by and by: a
 part that is pressed on and turned backwards rises on it, and drops by a lead where the thread
 begins.

 A part that comes in so tilted that one side of its first turn is in the next groove, tan(tilt) >
 P / (2 d2), turns for half a turn and then sticks: the thread is crossed until the part is out.

 Flanks are springs that only push, as stiff as contacts are, with the potentials of their gaps;
 friction is a bristle. RT-safe. */
class ThreadRows {
 public:
  explicit ThreadRows(const ForceMap& torque_map) noexcept : map_(torque_map) {}

  /** @param starts_in_place  It is taken out: it is tight in its thread. */
  void Reset(bool starts_in_place) noexcept;

  /** Adds the thread to a step of the displayed part. @pre mate.thread. */
  void Add(const DisplayedPart& displayed, const HeldMate& mate, const MateGeometry& geometry,
           const ContactOptions& contact, double dt, ConstraintSolver* solver) noexcept;

  [[nodiscard]] ThreadForces Finish(const ConstraintSolver& solver) noexcept;

  /** The part is in its thread as of the last Add(): it can neither fall nor be drawn out. */
  [[nodiscard]] bool is_in() const noexcept { return is_in_; }

  /** It came in tilted, and is not out again. */
  [[nodiscard]] bool is_crossed() const noexcept { return is_crossed_; }

  /** Angle to its place in which it still has to be turned, 0 where it is in place [rad]. Valid
   while is_in(). */
  [[nodiscard]] double angle() const noexcept { return angle_; }

  /** Unit, the way out. */
  [[nodiscard]] const Vec3& out_W() const noexcept { return out_W_; }

 private:
  /** Torques about the axis in true newton metres, positive in the sense in which it comes out. */
  struct Load {
    double spring{0};
    double slope{0};     // How much `spring` falls for each radian.
    double friction{0};  // Of the clamped parts and of what runs.
    double preload{0};   // [N]
  };

  void Enter(double z, double turn) noexcept;
  [[nodiscard]] Load CalcLoad(double angle) const noexcept;
  void AddFlanks(double z, double depth, const Vec3& p_CmQ_W, const ContactOptions& contact,
                 ConstraintSolver* solver) noexcept;
  void AddTorque(ConstraintSolver* solver) noexcept;

  ForceMap map_;
  bool is_in_{false};
  bool is_crossed_{false};
  double angle_{0};        // u, counted over whole turns.
  double entry_angle_{0};  // Where it came in.
  double flank_force_{0};  // Of the last step, as felt [N].
  double stretch_{0};      // Of the bristle about the axis [rad].

  // Of this step.
  HeldThread thread_;
  Vec3 out_W_{Vec3::UnitZ()};
  double sense_{1};  // In which it comes out about out_W_: 1 counter-clockwise.
  double rise_{0};   // h [m/rad]
  double dt_{1e-3};
  int inner_row_{-1};  // Flank that holds it from going in.
  int outer_row_{-1};
  int torque_row_{-1};
  double spring_felt_{0};  // Torque before the step [N m].
  double slope_felt_{0};   // [N m/rad]
};

}  // namespace hvas::haptics
