#pragma once

#include <optional>
#include <span>
#include <vector>

#include "paths/probe.h"

namespace hvas::paths {

/** Finds the least displacement that takes the part out of contacts, with the contacts as planes:
 min |d| subject to n (v + w x r) >= target - distance, by projected Gauss-Seidel on the forces; the
 length is that of Probe::CalcLength(). Planes that were met before are kept, so that a part between
 two walls does not go to and fro. */
class PushOut {
 public:
  /** @param X_WB_wanted  The pose that is displaced. */
  PushOut(const Probe& probe, const spatial::Pose& X_WB_wanted);

  /** Adds contacts met at pose(), and finds the displacement that keeps `target` [m] from all. */
  void Add(std::span<const contact::Contact> contacts, double target);

  /** The wanted pose, displaced. */
  [[nodiscard]] spatial::Pose pose() const;

 private:
  static constexpr std::size_t kMostPlanes =
      160;  // What does not fit takes the place of the first.

  struct Plane {
    Vec6 row;
    double wanted, weight, force;
  };

  const Probe& probe_;
  spatial::Pose X_WB_wanted_;
  Vec6 d_{Vec6::Zero()};  // v, then w times the radius of gyration.
  std::vector<Plane> planes_;
};

/** How far contacts are kept when the part is pushed out of them [m], between what is free at the
 tolerance and none. */
[[nodiscard]] double PushTargetOf(double tolerance);

/** Takes the part from one pose in the direction of another, which is near: there if it is free,
 else to where the contacts there push it out of them, so that it slides along. None where no
 free pose is found that is ahead.
 @param step  The most that a point moves to X_WB_wanted [m]. */
[[nodiscard]] std::optional<spatial::Pose> SlideStep(Probe* probe, const spatial::Pose& X_WB,
                                                     const spatial::Pose& X_WB_wanted, double step);

}  // namespace hvas::paths
