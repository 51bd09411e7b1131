#pragma once

#include "haptics/displayed_part.h"
#include "haptics/fit_rows.h"
#include "haptics/giving_rows.h"
#include "haptics/mate_guide.h"
#include "haptics/options.h"
#include "haptics/thread_rows.h"
#include "haptics/tick_output.h"

namespace hvas::haptics {

/** Energy that is owed to the hand beyond what it put in [J]. */
struct EnergyCredit {
  double force{0};
  double torque{0};
};

/** Guidance of the held part by its mates: springs of captured mates and attraction along their
 axis (X8..X10), and the resistance of their fits (W5, W8, W9) and of parts that give. RT-safe. */
class Guidance {
 public:
  explicit Guidance(const TickOptions& options) noexcept
      : options_(options),
        fit_rows_(options.force_map, options.device),
        giving_rows_(MakeForceMap(options.device)),
        thread_rows_(MakeTorqueMap(options.device)) {}

  void Begin(const HeldPart& part) noexcept;

  /** Captures and releases mates, where the condition has any. */
  void Update(const DisplayedPart& displayed, const spatial::Pose& X_WT) noexcept;

  /** Adds springs, attraction and fits to a step of the displayed part.
   @param weight      Of the part, true [N].
   @param soft_start  0..1 over the first moments of a hold.
   @returns what an attraction that begins will give the hand. */
  EnergyCredit AddTo(const DisplayedPart& displayed, double weight, double soft_start,
                     ConstraintSolver* solver) noexcept;

  /** Fills in forces of the fits, and what the true wrench has beyond the felt one, once the step
 is solved. */
  void Finish(const ConstraintSolver& solver, TickOutput* out) noexcept;

  [[nodiscard]] GuidedAxis DescribeAxis(const HeldPart& part) const noexcept;

  /** More mates are captured than when this was asked last. */
  [[nodiscard]] bool HasCapturedMore() noexcept;

  [[nodiscard]] const MateGuide& mates() const noexcept { return guide_; }

  [[nodiscard]] const ThreadRows& thread() const noexcept { return thread_rows_; }

  /** The fits, its thread or what gives hold more than the part's weight. */
  [[nodiscard]] bool is_stuck() const noexcept { return is_stuck_; }

 private:
  [[nodiscard]] EnergyCredit AddAttraction(const DisplayedPart& displayed, const MateGeometry& axis,
                                           double soft_start, ConstraintSolver* solver) noexcept;
  void AddFits(const DisplayedPart& displayed, const MateGeometry& axis, double weight,
               ConstraintSolver* solver) noexcept;

  /** Lets the part turn in its thread. False where it has none that is captured, or threads do not
   turn. */
  bool AddThread(const DisplayedPart& displayed, ConstraintSolver* solver) noexcept;

  const TickOptions& options_;
  MateGuide guide_;
  FitRows fit_rows_;
  FitAxis fit_axis_;
  GivingRows giving_rows_;
  ThreadRows thread_rows_;
  bool is_stuck_{false};
  int captured_before_{0};
  bool is_attracting_{false};
  double start_distance_{0};  ///< d_0 of X(9) [m].
  double start_angle_{0};     ///< [rad]
};

}  // namespace hvas::haptics
