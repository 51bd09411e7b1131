#include "sequence/grip_way.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace hvas::sequence {
namespace {

constexpr double kTurningShare =
    0.2;  // Of the travel: where less of it is distance, it turns. A choice.

}  // namespace

GripWay::GripWay(std::vector<spatial::Pose> X_WG, double radius)
    : X_WG_(std::move(X_WG)), radius_(radius) {
  HVAS_DEMAND(X_WG_.size() >= 2 && radius > 0);
  travels_.push_back(0);
  for (std::size_t i = 1; i < X_WG_.size(); ++i) {
    const double moved = (X_WG_[i].p() - X_WG_[i - 1].p()).norm();
    const double turned = spatial::RotationBetween(X_WG_[i - 1].q(), X_WG_[i].q()).norm();
    travels_.push_back(travels_.back() + std::hypot(moved, radius_ * turned));
  }
  const Vec3 last = X_WG_.back().p() - X_WG_[X_WG_.size() - 2].p();
  HVAS_DEMAND(last.norm() > 0);
  outward_W_ = last.normalized();
}

std::size_t GripWay::FindPiece(double travel) const noexcept {
  const auto next = std::upper_bound(travels_.begin() + 1, travels_.end() - 1, travel);
  return static_cast<std::size_t>(next - travels_.begin()) - 1;
}

spatial::Pose GripWay::At(double travel) const noexcept {
  if (travel >= length()) {
    return {X_WG_.back().q(), X_WG_.back().p() + (travel - length()) * outward_W_};
  }
  const std::size_t i = FindPiece(travel);
  const double span = travels_[i + 1] - travels_[i];
  const double s = span > 0 ? (travel - travels_[i]) / span : 0;  // Below 0: beyond the goal.
  const Vec3 move = X_WG_[i + 1].p() - X_WG_[i].p();
  // What comes to its place by turning goes on turning there, as a screw that is tightened.
  const bool is_turn = move.norm() < kTurningShare * span;
  return {X_WG_[i].q().slerp(is_turn ? s : std::max(0.0, s), X_WG_[i + 1].q()),
          X_WG_[i].p() + s * move};
}

spatial::Twist GripWay::RateAt(double travel) const noexcept {
  if (travel >= length()) {
    return {Vec3::Zero(), outward_W_};
  }
  const std::size_t i = FindPiece(travel);
  const double span = travels_[i + 1] - travels_[i];
  if (!(span > 0)) {
    return {Vec3::Zero(), outward_W_};
  }
  return {spatial::RotationBetween(X_WG_[i].q(), X_WG_[i + 1].q()) / span,
          (X_WG_[i + 1].p() - X_WG_[i].p()) / span};
}

double GripWay::CalcSpeed(const spatial::Twist& V_W, double travel) const noexcept {
  const spatial::Twist rate = RateAt(travel);
  return rate.v.dot(V_W.v) + radius_ * radius_ * rate.w.dot(V_W.w);
}

double GripWay::CalcTravel(const spatial::Pose& X_WG, double near) const noexcept {
  constexpr int kLooks = 4;  // Pieces turn little from one to the next: a choice.
  double travel = near;
  for (int look = 0; look < kLooks; ++look) {
    const spatial::Pose X_WN = At(travel);
    travel +=
        CalcSpeed({spatial::RotationBetween(X_WN.q(), X_WG.q()), X_WG.p() - X_WN.p()}, travel);
  }
  return travel;
}

}  // namespace hvas::sequence
