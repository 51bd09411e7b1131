#pragma once

#include "haptics/constraint_solver.h"
#include "haptics/force_map.h"
#include "haptics/options.h"

namespace hvas::haptics {

/** What the fits on an axis do against motion, in true newtons; of several fits, their sums. With
 paper W's own scales beside it (`shown_*`). All >= 0. */
struct FitLoad {
  double in{0};         ///< Against going in [N].
  double out{0};        ///< Against coming out [N].
  double torque{0};     ///< Against turning about the axis [N m].
  double shown_in{0};   ///< Load that paper W displays: k_r or k_s times the above [N].
  double shown_out{0};  ///< [N]
};

/** Where a fit acts. */
struct FitAxis {
  Vec3 out_W{Vec3::UnitZ()};  ///< Unit, the way out.
  Vec3 p_CmQ_W{Vec3::Zero()};
  double radius{0};      ///< [m]
  double weight_out{0};  ///< True weight of the part along the way out; negative: it helps in [N].
};

/** A resistance, true and as felt; positive against going in. */
struct FitForces {
  double axial_true{0};  ///< [N]
  double axial_felt{0};
  double torque_true{0};  ///< About out_W [N m].
  double torque_felt{0};
};

/** The fits as rows of the solver, along and about their axis (W4..W6, N4, N5).

 Each row is a bristle: stretched by motion, it pulls back up to what the fit can hold, and no
 further; then it slides along. It remembers its stretch from tick to tick, and takes the step
 implicitly: at rest it holds without creeping, it never pushes a part that is not pulled, and every
 loop of motion costs energy, whatever the bounds do meanwhile.

 What can be held is the published map of the true force. Where the part's weight w works against
 the motion as well, the hand gives both at once and the map is of their sum: Felt(F + w) - Felt(w)
 is left for the row. RT-safe. */
class FitRows {
 public:
  /** Stiffness of the bristles [N/m]; gives 0.7 um at the device's force. */
  static constexpr double kBristle = 1e7;

  FitRows(ForceMapKind kind, const device::DeviceProfile& device)
      : kind_(kind),
        largest_felt_(kLargestFeltShare * device.max_force),
        force_map_(MakeForceMap(device)),
        torque_map_(MakeTorqueMap(device)) {}

  /** No fit holds the part: forgets all stretch. */
  void Reset() noexcept;

  /** Adds the rows to a step. */
  void Add(const FitLoad& load, const FitAxis& axis, ConstraintSolver* solver) noexcept;

  /** Lets the bristles remember the solution. @returns the forces; none without rows. */
  [[nodiscard]] FitForces Finish(const ConstraintSolver& solver) noexcept;

 private:
  /** Bound of a row in one direction. */
  struct Bound {
    double truth{0};  // [N or N m]
    double felt{0};
    double weight{0};  // That works against this direction [N].
  };

  [[nodiscard]] Bound MakeBound(double truth, double shown, double weight) const noexcept;
  [[nodiscard]] double ToTrue(const Bound& bound, double felt) const noexcept;

  ForceMapKind kind_;
  double largest_felt_;
  ForceMap force_map_;
  ForceMap torque_map_;
  int axial_row_{-1};
  int turning_row_{-1};
  double radius_{0};
  Bound in_, out_, turning_;
  double stretch_{0};         // Of the axial bristle, outwards [m].
  double turned_stretch_{0};  // [rad]
};

}  // namespace hvas::haptics
