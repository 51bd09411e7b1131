#include "sequence/grip_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"

namespace hvas::sequence {

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

double GripWay::CalcSharpestBend(double travel, double along) const noexcept {
  const double low = std::min(travel, travel + along);
  const double high = std::max(travel, travel + along);
  double sharpest = 0;
  for (std::size_t i = FindPiece(low) + 1; i < travels_.size() && travels_[i] <= high; ++i) {
    const spatial::Twist before = RateAt(0.5 * (travels_[i - 1] + travels_[i]));
    const spatial::Twist after =
        i + 1 < travels_.size() ? RateAt(0.5 * (travels_[i] + travels_[i + 1])) : RateAt(length());
    sharpest = std::max(
        sharpest, std::hypot((after.v - before.v).norm(), radius_ * (after.w - before.w).norm()));
  }
  return sharpest;
}

double GripWay::CalcSpeed(const spatial::Twist& V_W, double travel) const noexcept {
  const spatial::Twist rate = RateAt(travel);
  return rate.v.dot(V_W.v) + radius_ * radius_ * rate.w.dot(V_W.w);
}

GripWay::Nearest GripWay::FindNearest(const spatial::Pose& X_WG, std::size_t piece,
                                      double from) const noexcept {
  constexpr int kLooks = 4;  // A piece that turns is not straight: a choice.
  const double least = piece == 0 ? -std::numeric_limits<double>::infinity() : travels_[piece];
  const double most =
      piece + 2 >= travels_.size() ? std::numeric_limits<double>::infinity() : travels_[piece + 1];
  Nearest nearest{.travel = std::clamp(from, least, most)};
  for (int look = 0;; ++look) {
    const spatial::Pose X_WN = At(nearest.travel);
    const spatial::Twist error{spatial::RotationBetween(X_WN.q(), X_WG.q()), X_WG.p() - X_WN.p()};
    nearest.distance = std::hypot(error.v.norm(), radius_ * error.w.norm());
    if (look == kLooks) {
      return nearest;
    }
    // At the end of a piece the rate is that of the next one, which this piece does not reach.
    const double inside = std::min(nearest.travel, std::nextafter(most, least));
    nearest.travel = std::clamp(nearest.travel + CalcSpeed(error, inside), least, most);
  }
}

double GripWay::CalcTravel(const spatial::Pose& X_WG, double near) const noexcept {
  std::size_t piece = FindPiece(near);
  Nearest nearest = FindNearest(X_WG, piece, near);
  for (const int sense : {-1, 1}) {
    while (sense < 0 ? piece > 0 : piece + 2 < travels_.size()) {
      const std::size_t next = sense < 0 ? piece - 1 : piece + 1;
      const Nearest there = FindNearest(X_WG, next, nearest.travel);
      if (there.distance >= nearest.distance) {
        break;
      }
      nearest = there;
      piece = next;
    }
  }
  return nearest.travel;
}

}  // namespace hvas::sequence
