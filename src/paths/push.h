#pragma once

#include <functional>
#include <optional>

#include "paths/probe.h"

namespace hvas::paths {

/** The pose that a push wants next after X_WB, no point further away than `step`; none where it is
 there. */
using WantedPose =
    std::function<std::optional<spatial::Pose>(const spatial::Pose& X_WB, double step)>;

/** Wants a pose: straight for the part's centre, turning evenly. */
[[nodiscard]] WantedPose MakePushTo(const Probe& probe, const spatial::Pose& X_WB_goal);
/** Wants to go on by a displacement, again and again. */
[[nodiscard]] WantedPose MakePushBy(const Probe& probe, const Displacement& d);
/** Wants to go on along a screw about a line in W, forwards or (sign -1) backwards. */
[[nodiscard]] WantedPose MakePushAbout(const Probe& probe, const ScrewAxis& axis, double sign);

struct PushOptions {
  double longest{0};         ///< Way of the part's points after which a push ends, about [m].
  double first_step{0};      ///< [m]
  double largest_step{0};    ///< [m]
  double least_step{0};      ///< Steps are not divided further [m].
  bool ends_in_gain{false};  ///< Ends where a step no longer comes nearer: of MakePushTo().
};

struct Push {
  Path path;               ///< Poses after the first, one a step.
  bool is_reached{false};  ///< What was wanted is reached; else blocked, or long enough.
  bool is_blocked{false};
  double length{0};  ///< Way gone, in steps [m].
};

/** Pushes the part as wanted until it is blocked; it slides along what it meets, with steps that
 become smaller where it is tight. */
[[nodiscard]] Push PushPart(Probe* probe, const spatial::Pose& from, const WantedPose& wanted,
                            const PushOptions& options);

/** Steps that suit the part, for a way as long as given. */
[[nodiscard]] PushOptions MakePushOptions(const Probe& probe, double longest);

}  // namespace hvas::paths
