#pragma once

#include <array>

#include "haptics/constraint_solver.h"
#include "haptics/displayed_part.h"
#include "haptics/force_map.h"
#include "haptics/giving_curve.h"

namespace hvas::haptics {

/** Forces of the parts that give on the way of the held part, along that way: a spring that takes
 the step implicitly, and friction as a bristle. All together are felt by the published map of true
 forces. What gives engages where it does not give yet, and lets go there: a part that comes from
 aside meets no force, and none that begins or ends has any energy in it. RT-safe. */
class GivingRows {
 public:
  /** Parts that give on one way; further ones resist nothing. Room that is made once: a choice. */
  static constexpr std::size_t kMaxCurves = 8;

  explicit GivingRows(const ForceMap& map) noexcept : map_(map) {}

  /** @param starts_in_place  It is taken out: what it holds by is engaged. */
  void Reset(bool starts_in_place) noexcept;

  /** Adds spring and friction to a step of the displayed part. */
  void Add(const DisplayedPart& displayed, double dt, ConstraintSolver* solver) noexcept;

  /** Forces along the way once the step is solved, positive outwards [N]. */
  struct Forces {
    double truth{0};  ///< No more than what gives can hold where the step ends.
    double felt{0};
  };

  [[nodiscard]] Forces Finish(const ConstraintSolver& solver) noexcept;

  /** Friction that it takes to move the part, either way, as of the last Add() [N]. */
  [[nodiscard]] double holding_force() const noexcept { return holding_; }

  /** Unit, the way out. */
  [[nodiscard]] const Vec3& out_W() const noexcept { return out_W_; }

 private:
  [[nodiscard]] GivingLoad CalcLoad(double travel) const noexcept;
  void UpdateEngagement(const DisplayedPart& displayed, double travel) noexcept;

  ForceMap map_;
  std::array<bool, kMaxCurves> is_engaged_{};
  const HeldPart* part_{nullptr};
  int row_{-1};
  double travel_{0};  // From its place outwards, before the step [m].
  Vec3 out_W_{Vec3::UnitZ()};
  double holding_{0};    // [N]
  double spring_{0};     // As felt, outwards, before the step [N].
  double stiffness_{0};  // As felt [N/m].
  double dt_{1e-3};
  double stretch_{0};  // Of the bristle, outwards [m].
};

}  // namespace hvas::haptics
