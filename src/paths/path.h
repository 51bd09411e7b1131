#pragma once

#include <vector>

#include "spatial/box.h"
#include "spatial/pose.h"

namespace hvas::paths {

/** Where a part B was in W, one pose after the other. From one to the next it goes along a screw:
 straight where it does not turn, along an arc where it only turns. */
using Path = std::vector<spatial::Pose>;

/** A screw: turns by |turn| [rad] about the axis along it through a point, and goes along by
 `along` [m]. */
struct Screw {
  Vec3 turn{Vec3::Zero()};
  Vec3 p_AQ{Vec3::Zero()};
  Vec3 along{Vec3::Zero()};
};

/** The screw that takes frame A to B, in A; the shorter way round.
 Source: Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 2.3.2. */
[[nodiscard]] Screw FindScrew(const spatial::Pose& X_AB);

/** The displacement of a body that goes this share of a screw, in its frame. */
[[nodiscard]] spatial::Pose MoveAlong(const Screw& screw, double fraction);

/** Straight on by d_W [m]. */
[[nodiscard]] Path MakeTranslation(const spatial::Pose& X_WB, const Vec3& d_W);

/** Around an axis in W through a point of it, by any angle [rad]. @pre axis_W is a unit vector. */
[[nodiscard]] Path MakeRotation(const spatial::Pose& X_WB, const Vec3& p_WQ, const Vec3& axis_W,
                                double angle);

/** The pose at a fraction of the screw from one to another; the shorter way round.
 Source: Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 2.3.2. */
[[nodiscard]] spatial::Pose Interpolate(const spatial::Pose& from, const spatial::Pose& to,
                                        double fraction);

/** Divides a way into steps in which no point of a box moves further than `step` [m]; where the
 part rests, poses that differ by less than an eighth of it are left out. */
[[nodiscard]] Path Resample(const Path& path, const spatial::Box& box_B, double step);

/** The largest displacement of a point of a box between two poses [m]; a corner has it. */
[[nodiscard]] double CalcLargestMove(const spatial::Pose& from, const spatial::Pose& to,
                                     const spatial::Box& box_B);

/** The longest way of a point of a box along the screw from one pose to another [m]; a corner has
 it. */
[[nodiscard]] double CalcLongestWay(const spatial::Pose& from, const spatial::Pose& to,
                                    const spatial::Box& box_B);

/** Way of a point of B [m], with arcs as the chords between the poses. */
[[nodiscard]] double CalcLength(const Path& path, const Vec3& p_BQ);

}  // namespace hvas::paths
