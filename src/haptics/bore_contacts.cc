#include "haptics/bore_contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hvas::haptics {
namespace {

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
    centre_ = {d.dot(u_[0]), d.dot(u_[1])};
  }

  /** h(u) less what it would be about the middle of the circle were it upright, at u = (cos, sin):
   without the radius, which would cost digits. */
  [[nodiscard]] double CalcReach(double angle) const noexcept {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return c * centre_[0] + s * centre_[1] + radius_ * (std::hypot(cosine_ * c, s) - 1);
  }

  /** The angle where `sign` times the reach is largest. */
  [[nodiscard]] double FindExtreme(double sign) const noexcept {
    constexpr int kStarts = 12;
    double best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < kStarts; ++i) {
      const double angle = 2 * std::numbers::pi * i / kStarts;
      const double reach = sign * CalcReach(angle);
      if (reach > most) {
        most = reach;
        best = angle;
      }
    }
    // Golden section within the neighbours: the reach has one extreme there, or is flat.
    constexpr int kSteps = 30;  // To 1e-6 rad; the reach is flat there to 1e-12 of the radius.
    double low = best - 2 * std::numbers::pi / kStarts;
    double high = best + 2 * std::numbers::pi / kStarts;
    for (int i = 0; i < kSteps; ++i) {
      const double a = high - (high - low) / std::numbers::phi;
      const double b = low + (high - low) / std::numbers::phi;
      (sign * CalcReach(a) > sign * CalcReach(b) ? high : low) =
          sign * CalcReach(a) > sign * CalcReach(b) ? b : a;
    }
    return 0.5 * (low + high);
  }

  [[nodiscard]] Vec3 DirectionAt(double angle) const noexcept {
    return std::cos(angle) * u_[0] + std::sin(angle) * u_[1];
  }

  /** The point of the circle that is farthest along a direction. */
  [[nodiscard]] Vec3 PointAt(double angle) const noexcept {
    const double c = cosine_ * std::cos(angle);
    const double s = std::sin(angle);
    return p_WC_ + radius_ / std::hypot(c, s) * (c * in_plane_ + s * u_[1]);
  }

  [[nodiscard]] double radius() const noexcept { return radius_; }

 private:
  static constexpr double kUpright = 1e-12;  // [rad]: below what poses are exact to.

  Vec3 p_WC_;
  double radius_;
  double cosine_;
  Vec3 u_[2];
  Vec3 in_plane_;
  std::array<double, 2> centre_{};
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
  const double deepest = edge.FindExtreme(wall.sign);
  for (std::size_t i = 0; i < kBoreDirections; ++i) {
    const double angle = deepest + 2 * std::numbers::pi * static_cast<double>(i) / kBoreDirections;
    const double distance = wall.sign * (wall.radius - edge.radius() - edge.CalcReach(angle));
    if (distance > margin) {
      continue;
    }
    const Vec3 p_WC = edge.PointAt(angle);
    const double along = (p_WC - wall.p_WA).dot(wall.axis);
    if (along < wall.low || along > wall.high) {
      continue;
    }
    (*contacts)[(*count)++] = {p_WC, -edge.DirectionAt(angle), distance};
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
