#pragma once

#include <cstddef>
#include <vector>

#include "paths/probe.h"

namespace hvas::paths {

/** How far a point of the part moves from one sample of the check to the next, for a tolerance [m]:
 as much as the tolerance is, but no less than what contact can tell apart. */
[[nodiscard]] double CheckStepOf(double tolerance);

/** What a check of a way found. */
struct WayCheck {
  bool is_free{false};
  /** The least distance at those samples where it was measured [m]: at others it is known only to
   be no deeper than the tolerance. */
  double deepest{0};
  std::size_t edge{0};               ///< Where not free: the pose before it.
  double fraction{0};                ///< Where not free: of the screw from that pose to the next.
  spatial::Pose X_WB;                ///< Where not free: the pose.
  std::vector<StoppingFaces> stops;  ///< Where not free: what was met.
  bool is_over{false};               ///< The budget ended, or a stop was asked for; then not free.
};

/** Checks a way without gaps. At each sample the part is no deeper in others than `tolerance`, and
 from one to the next no point of it moves further than `step` plus the distance to others that it
 has at the first. No point can come nearer to a body than by what it moves, hence nowhere on the
 way is it deeper than tolerance + step / 2: between samples with distances d and d' that are s
 apart, no point is deeper than (s - d - d') / 2, with s <= step + max(0, d) and d, d' >=
 -tolerance. This holds for the points at which contact is asked for (contact::Shape's samples); the
 accuracy of their distances is that of contact.
 @pre the path has a pose. */
[[nodiscard]] WayCheck CheckWay(Probe* probe, const Path& path, double step);

/** Checks with a probe of its own; counts no budget. */
[[nodiscard]] WayCheck CheckWay(const WayProblem& problem, const Path& path, double step);

/** Checks the screw from one pose to another alone, its first pose left out; coarse steps first, so
 that what is blocked is soon known to be. */
[[nodiscard]] bool IsScrewFree(Probe* probe, const spatial::Pose& from, const spatial::Pose& to,
                               double step);

/** Lists the faces of a query's contacts that are nearest, each pair once. */
[[nodiscard]] std::vector<StoppingFaces> ListStops(std::span<const contact::Contact> contacts,
                                                   double limit);

}  // namespace hvas::paths
