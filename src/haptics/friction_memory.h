#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "contact/scene.h"
#include "fits/friction.h"
#include "haptics/constraint_solver.h"

namespace hvas::haptics {

/** The bristle of LuGre's model with a threshold: it gives elastically until it is bent by z_max,
 and is dragged along beyond. Integrated exactly over dt for an even velocity v along the surface:

   z + v dt                                                  while that is within z_max,
   z_max u + (z - z_max u) exp(-|v| dt / z_max), u = v / |v|  beyond,

 never more than z_max. Canudas de Wit et al., IEEE TAC 40(3), 1995; the threshold, without which
 vibration below the breakaway force makes parts creep, after Dupont et al., IEEE TAC 47(5), 2002.
 RT-safe. */
[[nodiscard]] Vec3 BendBristle(const Vec3& z, const Vec3& v, double z_max, double dt) noexcept;

/** One of the two bodies of a pair that touch. */
struct TouchingBody {
  int index{ConstraintSolver::kWorld};  ///< Index in the solver; kWorld when it cannot move.
  std::uint32_t id{0xffffffffU};        ///< Id of its body in the scene.
  spatial::Pose X_WB;                   ///< Now. Of what cannot move: anything, the same each tick.
};

/** Dry friction between all pairs of bodies, from one tick to the next: what bends is remembered
 for a pair as one small motion of its body over the other, because contact points come and go, and
 where they are is no matter of friction. RT-safe. */
class FrictionMemory {
 public:
  void Clear() noexcept { size_ = 0; }

  /** Forgets pairs that did not press in the last tick. */
  void BeginTick() noexcept;

  /** The pair's patch in the solver, added when it is not there yet; -1 when there are too many. */
  int AddPair(const TouchingBody& body, const TouchingBody& other, const fits::FrictionLaw& law,
              double rolling_arm, ConstraintSolver* solver) noexcept;

  /** Adds a contact of the patch with the bristles as they are bent there. False when full. */
  bool AddContact(const contact::Contact& c, ConstraintSolver::Contact contact,
                  ConstraintSolver* solver) noexcept;

  /** Takes over from the solved step how the bristles are bent now. */
  void EndTick(const ConstraintSolver& solver, double dt) noexcept;

 private:
  struct Pair {
    std::uint32_t id{0};
    std::uint32_t other{0};
    // In the other body's frame: the small motion of the body about `p`, as [turn; shift].
    Vec3 p{Vec3::Zero()};
    Vec6 bend{Vec6::Zero()};
    double slip{0};  // [m/s]; mean of late, by load.
    double load{0};  // [N]
    // Of this tick.
    int patch{-1};
    spatial::Pose X_WO;
    fits::FrictionLaw law;
    Vec3 p_W{Vec3::Zero()};
    Vec6 bend_W{Vec6::Zero()};
  };

  /** The motion that fits bent bristles best, by least squares. */
  struct Fit {
    Mat6 matrix{Mat6::Zero()};
    Vec6 rhs{Vec6::Zero()};
    Vec3 p_W{Vec3::Zero()};  // Middle of the load.
    double slip{0};
  };

  void Store(const Fit& fit, double dt, Pair* pair) noexcept;

  /** A pair for each patch of the solver. */
  static constexpr std::size_t kMaxPairs = ConstraintSolver::kMaxPatches;
  std::array<Pair, 2 * kMaxPairs> pairs_;
  std::size_t size_{0};
  std::array<std::size_t, kMaxPairs> pair_of_patch_{};
  std::array<Vec3, ConstraintSolver::kMaxContacts> points_;
  std::array<Vec3, ConstraintSolver::kMaxContacts> normals_;
};

}  // namespace hvas::haptics
