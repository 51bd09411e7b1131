#include "simulation/reaches.h"

#include <algorithm>
#include <cmath>

namespace hvas::simulation {
namespace {

constexpr double kShortestReach = 0.35;  // [s]; docs/algorithms/simulated_person.md

double MinimumJerk(double s) noexcept {
  return s * s * s * (10 + s * (-15 + 6 * s));
}

}  // namespace

void Reaches::Start(const spatial::Pose& X_from, const Vec3& centre_W) noexcept {
  count_ = 0;
  index_ = 0;
  time_s_ = 0;
  X_WR_ = X_from;
  centre_W_ = centre_W;
}

void Reaches::Add(const spatial::Pose& X_to, double speed, bool is_arc) noexcept {
  if (count_ == kMost) {
    return;
  }
  Reach& reach = reaches_[count_];
  reach.p_from = count_ == 0 ? X_WR_.p() : reaches_[count_ - 1].p_to;
  reach.q_from = count_ == 0 ? X_WR_.q() : reaches_[count_ - 1].q_to;
  reach.p_to = X_to.p();
  reach.q_to = X_to.q();
  reach.is_arc = is_arc;
  double length = (reach.p_to - reach.p_from).norm();
  if (is_arc) {
    const Vec3 a = reach.p_from - centre_W_;
    const Vec3 b = reach.p_to - centre_W_;
    length = std::atan2(a.cross(b).norm(), a.dot(b)) * std::max(a.norm(), b.norm());
  }
  reach.duration_s = std::max(kShortestReach, length / speed);
  ++count_;
}

bool Reaches::Follow(double dt) noexcept {
  if (is_done()) {
    return true;
  }
  const Reach& reach = reaches_[index_];
  time_s_ += dt;
  const double s = MinimumJerk(std::min(1.0, time_s_ / reach.duration_s));
  const Quat q = reach.q_from.slerp(s, reach.q_to);
  if (reach.is_arc) {
    const Vec3 a = reach.p_from - centre_W_;
    const Vec3 b = reach.p_to - centre_W_;
    const Vec3 turn = spatial::RotationVector(spatial::RotationTaking(a, b));
    const double radius = (1 - s) * a.norm() + s * b.norm();
    X_WR_ = {q, centre_W_ + radius * (spatial::RotationFromVector(s * turn) * a.normalized())};
  } else {
    X_WR_ = {q, reach.p_from + s * (reach.p_to - reach.p_from)};
  }
  if (time_s_ >= reach.duration_s) {
    ++index_;
    time_s_ = 0;
  }
  return is_done();
}

}  // namespace hvas::simulation
