#include "paths/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hvas::paths {
namespace {

using spatial::Box;
using spatial::Pose;

std::vector<Vec3> CornersOf(const Box& box) {
  std::vector<Vec3> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1) != 0 ? box.high.x() : box.low.x(),
                         (i & 2) != 0 ? box.high.y() : box.low.y(),
                         (i & 4) != 0 ? box.high.z() : box.low.z());
  }
  return corners;
}

/** Of all points of the box the longest way along a screw; it is convex, so a corner has it. */
double CalcLongestWay(const Screw& screw, const std::vector<Vec3>& corners) {
  const double angle = screw.turn.norm();
  double longest = 0;
  for (const Vec3& corner : corners) {
    const Vec3 arm = corner - screw.p_AQ;
    const double arc = angle > 0 ? screw.turn.cross(arm).norm() : 0;
    longest = std::max(longest, std::hypot(arc, screw.along.norm()));
  }
  return longest;
}

double CalcLargestMove(const Pose& from, const Pose& to, const std::vector<Vec3>& corners) {
  double largest = 0;
  for (const Vec3& corner : corners) {
    largest = std::max(largest, (to * corner - from * corner).norm());
  }
  return largest;
}

}  // namespace

Screw FindScrew(const Pose& X_AB) {
  constexpr double kNoTurn = 1e-9;  // [rad]; its axis would be too far away to be told
  Screw screw;
  screw.turn = spatial::RotationVector(X_AB.q());
  const double angle = screw.turn.norm();
  if (angle < kNoTurn) {
    screw.turn.setZero();
    screw.along = X_AB.p();
    return screw;
  }
  const Vec3 axis = screw.turn / angle;
  screw.along = axis.dot(X_AB.p()) * axis;
  const Vec3 across = X_AB.p() - screw.along;
  screw.p_AQ = 0.5 * (across + axis.cross(across) / std::tan(0.5 * angle));
  return screw;
}

Pose MoveAlong(const Screw& screw, double fraction) {
  const Quat q = spatial::RotationFromVector(Vec3(fraction * screw.turn));
  return {q, Vec3(screw.p_AQ - q * screw.p_AQ + fraction * screw.along)};
}

Path MakeTranslation(const Pose& X_WB, const Vec3& d_W) {
  return {X_WB, Pose(X_WB.q(), X_WB.p() + d_W)};
}

Path MakeRotation(const Pose& X_WB, const Vec3& p_WQ, const Vec3& axis_W, double angle) {
  // The shorter way round is the right one.
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::abs(angle) * 2 / std::numbers::pi)));
  Path path;
  for (int i = 0; i <= steps; ++i) {
    const Quat q = spatial::RotationFromVector(Vec3(angle * i / steps * axis_W));
    path.push_back(Pose(q, p_WQ - q * p_WQ) * X_WB);
  }
  return path;
}

Pose Interpolate(const Pose& from, const Pose& to, double fraction) {
  return from * MoveAlong(FindScrew(from.Inverse() * to), fraction);
}

Path Resample(const Path& path, const Box& box_B, double step) {
  constexpr double kResting = 0.125;  // of a step
  const std::vector<Vec3> corners = CornersOf(box_B);
  Path fine;
  for (const Pose& X_WB : path) {
    if (fine.empty()) {
      fine.push_back(X_WB);
      continue;
    }
    const Pose from = fine.back();
    const bool is_last = &X_WB == &path.back();
    if (CalcLargestMove(from, X_WB, corners) < kResting * step && !is_last) {
      continue;
    }
    const Screw screw = FindScrew(from.Inverse() * X_WB);
    const int steps =
        std::max(1, static_cast<int>(std::ceil(CalcLongestWay(screw, corners) / step)));
    for (int i = 1; i < steps; ++i) {
      fine.push_back(from * MoveAlong(screw, static_cast<double>(i) / steps));
    }
    fine.push_back(X_WB);
  }
  return fine;
}

double CalcLargestMove(const Pose& from, const Pose& to, const Box& box_B) {
  return CalcLargestMove(from, to, CornersOf(box_B));
}

double CalcLongestWay(const Pose& from, const Pose& to, const Box& box_B) {
  return CalcLongestWay(FindScrew(from.Inverse() * to), CornersOf(box_B));
}

double CalcLength(const Path& path, const Vec3& p_BQ) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += (path[i] * p_BQ - path[i - 1] * p_BQ).norm();
  }
  return length;
}

}  // namespace hvas::paths
