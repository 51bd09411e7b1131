#pragma once

#include <vector>

#include "base/result.h"
#include "statics/problem.h"

namespace hvas::statics {

struct StaticOptions {
  /** What may be missing to equilibrium in each component of force, in weights of the body, and of
   torque, in weights times its size (its farthest contact from the centre of mass). It is far above
   rounding, and far below what friction is known to. A choice. */
  double tolerance{1e-6};
  /** Linear programmes that the search for the least holds solves at most. A choice: it ends within
   a few where parts fall independently of one another. */
  int most_programmes{200};
};

/** Forces that keep all bodies in equilibrium, or the proof that there are none. */
struct Equilibrium {
  bool stands{false};
  /** Force of b on a at each contact [N], within its pyramid of friction. Where contacts span one
   plane, those at its corners. */
  std::vector<Vec3> contact_forces_W;
  /** Wrench of b on a of each joint, about its point [N m, N]. */
  std::vector<spatial::Wrench> joint_wrenches_W;
  /** Wrench of a hold on each body, about its centre of mass [N m, N]: of those with the least sum
   of components, in weights. Zero where the bodies stand. */
  std::vector<spatial::Wrench> hold_wrenches_W;
  /** Bodies that move in the proof: they fall, slide, or are pushed by those that do. */
  std::vector<bool> moves;
  /** The proof that no forces exist: virtual velocities of the bodies, about their centres of mass,
   up to a common factor. Each edge of a contact's pyramid has no negative power in them, joints
   take less than gravity gives. Zero where they stand. */
  std::vector<spatial::Twist> motions_W;
  /** Largest component of the resultant of all forces, holds included, of any body that is not
   fixed, in its weights, or weights times size. */
  double residual{0};
};

/** Decides by a linear programme whether forces exist that keep each body in equilibrium under
 gravity. Errors: those of CheckProblem; kInternal where the programme is not solved. */
[[nodiscard]] Result<Equilibrium> SolveEquilibrium(const StaticProblem& problem,
                                                   const StaticOptions& options = {});

/** The resultant wrench of gravity, contacts, joints and holds on each body, about its centre of
 mass [N m, N]: zero in equilibrium. */
[[nodiscard]] std::vector<spatial::Wrench> CalcResultants(const StaticProblem& problem,
                                                          const Equilibrium& equilibrium);

}  // namespace hvas::statics
