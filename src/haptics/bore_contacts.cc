#include "haptics/bore_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace hvas::haptics {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kCosine30 = std::numbers::sqrt3 / 2;  // cos 30 degrees, exact.

/** @param by  Cosine and sine. */
Vec2 Turned(const Vec2& u, const Vec2& by) noexcept {
  return {by.x() * u.x() - by.y() * u.y(), by.y() * u.x() + by.x() * u.y()};
}

/** The circle of an edge, as it is seen along the axis of the other cylinder. */
class SeenEdge {
 public:
  /** @param axis  Unit, along which it is seen; through p_WA.
   @param normal  Unit, of the circle's plane, within a right angle of the axis. */
  SeenEdge(const Vec3& p_WC, const Vec3& normal, double radius, const Vec3& p_WA,
           const Vec3& axis) noexcept
      : p_WC_(p_WC), radius_(radius), cosine_(normal.dot(axis)) {
    Vec3 lean = normal - cosine_ * axis;
    const double sine = lean.norm();
    // Upright, all directions are alike.
    const bool is_tilted = sine > kUpright;
    u_[0] = is_tilted ? Vec3(lean / sine) : Vec3(spatial::FrameFromZ(axis) * Vec3::UnitX());
    u_[1] = axis.cross(u_[0]);
    // In the circle's plane; seen along the axis, it is shorter by the cosine.
    in_plane_ = is_tilted ? Vec3((u_[0] - sine * normal) / cosine_) : u_[0];
    const Vec3 d = p_WC - p_WA;
    centre_ = Vec2(d.dot(u_[0]), d.dot(u_[1]));
  }

  /** h(u) less the radius, which would cost digits. @param u  Unit, in the plane that is seen. */
  [[nodiscard]] double CalcReach(const Vec2& u) const noexcept {
    return centre_.dot(u) + radius_ * (CalcLength(u) - 1);
  }

  /** The direction in which `sign` times the reach is largest. */
  [[nodiscard]] Vec2 FindExtreme(double sign) const noexcept {
    constexpr int kStarts = 12;  // The reach has at most two maxima.
    Vec2 best(1, 0);
    double most = -std::numeric_limits<double>::infinity();
    Vec2 u = best;
    for (int i = 0; i < kStarts; ++i) {
      const double reach = sign * CalcReach(u);
      if (reach > most) {
        most = reach;
        best = u;
      }
      u = Turned(u, {kCosine30, 0.5});
    }
    // Newton's method on the angle, from no farther than 15 degrees.
    constexpr int kSteps = 6;
    for (int i = 0; i < kSteps; ++i) {
      const auto [slope, bend] = CalcDerivatives(best);
      if (sign * bend >= 0) {
        break;  // Flat: all directions are as good.
      }
      constexpr double kLongest = 0.2;  // [rad]: less than the 15 degrees. A choice.
      const double turn = std::clamp(-slope / bend, -kLongest, kLongest);
      best = Turned(best, Vec2(1, turn).normalized());
      if (std::abs(turn) < 1e-12) {
        break;
      }
    }
    return best;
  }

  [[nodiscard]] Vec3 DirectionOf(const Vec2& u) const noexcept {
    return u.x() * u_[0] + u.y() * u_[1];
  }

  /** The point of the circle that is farthest along a direction. */
  [[nodiscard]] Vec3 PointAt(const Vec2& u) const noexcept {
    return p_WC_ + radius_ / CalcLength(u) * (cosine_ * u.x() * in_plane_ + u.y() * u_[1]);
  }

  [[nodiscard]] double radius() const noexcept { return radius_; }

 private:
  static constexpr double kUpright = 1e-12;  // [rad]: below what poses are exact to.

  [[nodiscard]] double CalcLength(const Vec2& u) const noexcept {
    const double x = cosine_ * u.x();
    return std::sqrt(x * x + u.y() * u.y());
  }

  /** Of the reach by the angle of u, the first and the second. */
  [[nodiscard]] std::pair<double, double> CalcDerivatives(const Vec2& u) const noexcept {
    const double length = CalcLength(u);
    const double shortening = 1 - cosine_ * cosine_;
    const double product = shortening * u.x() * u.y();
    return {centre_.dot(Vec2(-u.y(), u.x())) + radius_ * product / length,
            -centre_.dot(u) + radius_ *
                                  (shortening * (u.x() * u.x() - u.y() * u.y()) -
                                   product * product / (length * length)) /
                                  length};
  }

  Vec3 p_WC_;
  double radius_;
  double cosine_;
  Vec3 u_[2];
  Vec3 in_plane_;
  Vec2 centre_{0, 0};
};

/** The other cylinder, which an edge may touch. */
struct Wall {
  Vec3 p_WA;
  Vec3 axis;
  double radius;
  double low, high;  // Of the part of the axis that has a wall, from A.
  double sign;       // +1: the edge lies within it; -1: about it.
};

void AddEdge(const SeenEdge& edge, const Wall& wall, double margin, BoreContacts* contacts,
             std::size_t* count) noexcept {
  static_assert(kBoreDirections == 6);
  Vec2 u = edge.FindExtreme(wall.sign);
  for (std::size_t i = 0; i < kBoreDirections; ++i, u = Turned(u, {0.5, kCosine30})) {
    const double distance = wall.sign * (wall.radius - edge.radius() - edge.CalcReach(u));
    if (distance > margin) {
      continue;
    }
    const Vec3 p_WC = edge.PointAt(u);
    const double along = (p_WC - wall.p_WA).dot(wall.axis);
    if (along < wall.low || along > wall.high) {
      continue;
    }
    (*contacts)[(*count)++] = {p_WC, -edge.DirectionOf(u), distance};
  }
}

}  // namespace

std::size_t CalcBoreContacts(const Bore& bore, const spatial::Pose& X_WH, const spatial::Pose& X_WS,
                             double margin, BoreContacts* contacts) noexcept {
  const Vec3 hole_axis = X_WH.q() * Vec3::UnitZ();
  const Vec3 shaft_axis = X_WS.q() * Vec3::UnitZ();
  constexpr double kSteepest = 0.5;  // Cosine of the tilt from which on nothing is looked for.
  if (hole_axis.dot(shaft_axis) < kSteepest) {
    return 0;
  }
  const Wall hole{X_WH.p(), hole_axis, bore.hole_radius, bore.hole_low, bore.hole_high, 1};
  const Wall shaft{X_WS.p(), shaft_axis, bore.shaft_radius, bore.shaft_low, bore.shaft_high, -1};
  std::size_t count = 0;
  for (const double end : {bore.shaft_low, bore.shaft_high}) {
    AddEdge(
        SeenEdge(X_WS.p() + end * shaft_axis, shaft_axis, bore.shaft_radius, hole.p_WA, hole_axis),
        hole, margin, contacts, &count);
  }
  for (const double end : {bore.hole_low, bore.hole_high}) {
    AddEdge(
        SeenEdge(X_WH.p() + end * hole_axis, hole_axis, bore.hole_radius, shaft.p_WA, shaft_axis),
        shaft, margin, contacts, &count);
  }
  return count;
}

}  // namespace hvas::haptics
