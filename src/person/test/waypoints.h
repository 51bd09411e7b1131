#pragma once

#include <algorithm>
#include <vector>

#include "simulation/operator.h"

namespace hvas::person::testing {

/** A place that a hand goes to, along a straight line. */
struct Waypoint {
  Vec3 p_WH{Vec3::Zero()};
  double time{0};  ///< Time to get there [s].
  bool is_gripping{false};
};

/** A hand that goes from one place to the next, upright, and grips or not on the way there. */
class WaypointHand final : public simulation::Operator {
 public:
  explicit WaypointHand(std::vector<Waypoint> points) : points_(std::move(points)) {}

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override {
    device::DeviceState state;
    state.t_ns = input.t_ns;
    state.is_valid = true;
    while (at_ + 1 < points_.size() && t_ >= points_[at_].time) {
      t_ = 0;
      ++at_;
    }
    const Waypoint& to = points_[at_];
    const Vec3& p_from = points_[at_ == 0 ? 0 : at_ - 1].p_WH;
    const double share = to.time > 0 ? std::min(1.0, t_ / to.time) : 1.0;
    state.X_DH = spatial::Pose(Vec3(p_from + share * (to.p_WH - p_from)));
    state.V_DH.v = share < 1 ? Vec3((to.p_WH - p_from) / to.time) : Vec3::Zero();
    state.is_gripping = to.is_gripping;
    t_ += input.dt;
    return state;
  }

  [[nodiscard]] bool is_done() const {
    return at_ + 1 == points_.size() && t_ >= points_.back().time;
  }

 private:
  std::vector<Waypoint> points_;
  std::size_t at_{0};
  double t_{0};
};

/** Takes hold at a point, goes up to a height, across and down to another point, and lets go there.
 @param height  Of the way across [m]. */
inline std::vector<Waypoint> CarryOver(const Vec3& p_from, const Vec3& p_to, double height) {
  constexpr double kRest = 0.5;  // [s]
  const auto above = [height](const Vec3& p) { return Vec3(p.x(), p.y(), height); };
  const double across = (above(p_to) - above(p_from)).norm() / 0.2;
  const Vec3 p_far = above(p_to);
  return {{p_from, kRest, false},      {p_from, kRest, true}, {above(p_from), 1.0, true},
          {p_far, across + 0.2, true}, {p_far, kRest, true},  {p_to, 2.0, true},
          {p_to, 1.0, true},           {p_to, 1.5, false}};
}

}  // namespace hvas::person::testing
