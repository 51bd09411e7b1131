#include "paths/align_way.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "paths/check_way.h"
#include "paths/face_pair.h"
#include "paths/path.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

// A part is nearly coaxial within these: a bore that is half as wide again as what is in it lets it
// tilt and stray so far, engaged by its width. Choices.
constexpr double kMostTilt = 0.25;   // [rad]
constexpr double kMostAside = 0.05;  // Of the part's size.
constexpr double kMostMove = 0.25;   // Of the clear distance, at once, as faces turn: a choice.
constexpr int kCenterings = 12;      // Until the middle of a slot is found: a choice.
constexpr double kStayWeight =
    0.02;  // Weight of staying, beside that of a pair of faces: a choice.

/** The nearest contact of each pair of faces. */
std::map<FacePair, const contact::Contact*> ListNearest(
    std::span<const contact::Contact> contacts) {
  std::map<FacePair, const contact::Contact*> nearest;
  for (const contact::Contact& contact : contacts) {
    const contact::Contact*& least = nearest.try_emplace(FacesOf(contact), &contact).first->second;
    least = contact.distance < least->distance ? &contact : least;
  }
  return nearest;
}

/** A move about an axis by an angle [rad], and along it [m]. */
Pose MakeMove(const ScrewAxis& axis, double turn, double along) {
  return MoveAlong({Vec3(turn * axis.axis_W), axis.p_WQ, Vec3(along * axis.axis_W)}, 1);
}

/** The pose, turned about the axis and moved along it from the first one, that is closest to
 another pose; none where the part is not nearly coaxial there. */
std::optional<Pose> Align(const Probe& probe, const ScrewAxis& axis, const Pose& X_first,
                          const Pose& X_WB) {
  const Pose X_moved = X_WB * X_first.Inverse();  // Of the world, as a displacement.
  const Vec3 tilted_W = X_moved.q() * axis.axis_W;
  const Vec3 gone_W = X_moved * axis.p_WQ - axis.p_WQ;
  const double along = gone_W.dot(axis.axis_W);
  const Vec3 aside_W = gone_W - along * axis.axis_W;
  const double cosine = tilted_W.dot(axis.axis_W);
  if (cosine < std::cos(kMostTilt) || aside_W.norm() > kMostAside * probe.size()) {
    return std::nullopt;
  }
  const Quat upright = spatial::RotationTaking(tilted_W, axis.axis_W) * X_moved.q();
  const double turn = spatial::RotationVector(upright).dot(axis.axis_W);
  return MakeMove(axis, turn, along) * X_first;
}

/** Moves a pose along the axis and about it to where the part is clear of others, as far as it can,
 into the middle between walls: the least squares of what it lacks of being clear. */
Pose Center(Probe* probe, const ScrewAxis& axis, const Pose& X_start) {
  const double clear = probe->clear_distance();
  const double g = probe->gyration();
  Pose X = X_start;
  for (int step = 0; step < kCenterings; ++step) {
    if (probe->Query(X, clear) >= clear) {
      break;
    }
    const Vec3 centre_W = X * probe->centre_B();
    // Of a move along the axis and of a turn, as the length that it has at the gyration.
    Eigen::Matrix<double, 6, 2> moves;
    moves << axis.axis_W, axis.axis_W.cross(centre_W - axis.p_WQ) / g, Vec3::Zero(), axis.axis_W;
    Eigen::Matrix2d normal = kStayWeight * Eigen::Matrix2d::Identity();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const auto& [faces, contact] : ListNearest(probe->contacts())) {
      const Vec6 row = probe->RowOf(contact->nhat_W, contact->p_WC, centre_W);
      const Eigen::Vector2d along = moves.transpose() * row;
      normal += along * along.transpose();
      right += (clear - contact->distance) * along;
    }
    const Eigen::Vector2d move = normal.ldlt().solve(right);
    const double scale = std::min(1.0, kMostMove * clear / std::max(move.norm(), 1e-12));
    X = MakeMove(axis, scale * move[1] / g, scale * move[0]) * X;
  }
  return X;
}

/** Straight out along an axis, clear of the boxes of all bodies; none where that is not free. */
std::optional<Pose> FindStraightOut(Probe* probe, const ScrewAxis& axis, const Pose& X,
                                    double step) {
  if (probe->problem().X_WB_goal) {
    return std::nullopt;
  }
  for (const double sign : {1.0, -1.0}) {
    const Vec3 out_W = sign * axis.axis_W;
    const double exit = probe->CalcExit(X, out_W) + 1e-6;
    const Pose X_out(X.q(), Vec3(X.p() + exit * out_W));
    if (IsScrewFree(probe, X, X_out, step)) {
      return X_out;
    }
  }
  return std::nullopt;
}

/** The way that begins on an axis; as it was where none of it can. @returns how many of its poses
 are on the axis, besides the first. */
std::size_t AlignTo(Probe* probe, const ScrewAxis& axis, const Path& path, double step, Path* out) {
  Path aligned{path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const std::optional<Pose> X = Align(*probe, axis, path.front(), path[i]);
    if (!X || probe->is_over()) {
      break;
    }
    const Pose X_centered = Center(probe, axis, *X);
    const bool is_centered = IsScrewFree(probe, aligned.back(), X_centered, step);
    if (!is_centered && !IsScrewFree(probe, aligned.back(), *X, step)) {
      break;
    }
    aligned.push_back(is_centered ? X_centered : *X);
  }
  for (; aligned.size() > 1; aligned.pop_back()) {
    const std::size_t last = aligned.size() - 1;
    if (const auto X_out = FindStraightOut(probe, axis, aligned.back(), step)) {
      *out = aligned;
      out->push_back(*X_out);
      return path.size();  // None is simpler.
    }
    for (const std::size_t next : {last + 1, last}) {
      if (IsScrewFree(probe, aligned.back(), path[next], step)) {
        *out = aligned;
        out->insert(out->end(), path.begin() + static_cast<std::ptrdiff_t>(next), path.end());
        return last;
      }
    }
  }
  return 0;
}

}  // namespace

Path AlignWay(Probe* probe, const Path& path, double step) {
  Path best = path;
  std::size_t most = 0;
  for (const ScrewAxis& axis : probe->problem().axes) {
    Path aligned;
    const std::size_t count = AlignTo(probe, axis, path, step, &aligned);
    if (count > most) {
      most = count;
      best = std::move(aligned);
    }
  }
  return CheckWay(probe, best, step).is_free ? best : path;
}

}  // namespace hvas::paths
