#pragma once

#include "haptics/constraint_solver.h"
#include "haptics/displayed_part.h"
#include "haptics/options.h"

namespace hvas::haptics {

/** Virtual coupling between the tracked and the displayed part: X(1) and X(2), a spring and a
 damper that become softer where they would give more than the device can. Keeps the grip. RT-safe.
 */
class Coupling {
 public:
  explicit Coupling(const TickOptions& options) noexcept : options_(options) {}

  /** A part was taken: its pose in the hand at the next Track is the grip. */
  void Begin() noexcept { has_grip_ = false; }

  /** Where the hand has the part. */
  const TrackedPart& Track(const Hand& hand, const DisplayedPart& displayed) noexcept;

  [[nodiscard]] const TrackedPart& tracked() const noexcept { return tracked_; }

  /** Adds spring and damper to a step of the displayed part. */
  void AddTo(const DisplayedPart& displayed, ConstraintSolver* solver) const noexcept;

  /** Wrench on the hand at the displayed part's centre of mass, in W. */
  [[nodiscard]] spatial::Wrench CalcWrench(const DisplayedPart& displayed) const noexcept;

  /** Energy in the springs of translation and rotation, as if they were never saturated [J]. */
  [[nodiscard]] double CalcEnergy(const DisplayedPart& displayed) const noexcept;
  [[nodiscard]] double CalcTurningEnergy(const DisplayedPart& displayed) const noexcept;

 private:
  /** How far the tracked part is from the displayed one, and the gains there. */
  struct Stretch {
    Vec3 e_W;      ///< Distance of the centres of mass [m].
    Vec3 theta_W;  ///< [rad]
    CouplingGains gains;
  };

  [[nodiscard]] Stretch CalcStretch(const DisplayedPart& displayed) const noexcept;

  const TickOptions& options_;
  bool has_grip_{false};
  spatial::Pose X_HB_;  ///< Grip: the tracked part in the hand.
  TrackedPart tracked_;
};

}  // namespace hvas::haptics
