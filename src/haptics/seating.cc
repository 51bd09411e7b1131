#include "haptics/seating.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {
namespace {

constexpr double kSeatTolerance = 50e-6;  // [m]; no deeper on the last bit into place
// Angle before its place at which a screw is tight [rad]: 3 % of that of an M8 on 12 mm. A choice.
constexpr double kTight = 5e-3;
constexpr double kLeaveFactor = 2;  // of the limits of being seated, to be out of place

double MinimumJerk(double s) noexcept {
  return s * s * s * (10 + s * (-15 + 6 * s));
}

}  // namespace

void Seating::Begin(const HeldPart& part) noexcept {
  arrival_ = {};
  progress_ = 0;
  is_matched_ = false;
  homing_ = 0;
  leaves_place_ = part.starts_in_place;
}

Seating::Remainder Seating::CalcRemainder(const DisplayedPart& displayed) noexcept {
  const HeldPart& part = *displayed.part;
  return {displayed.p_WCm() - part.X_WB_goal * part.p_BoBcm_B,
          spatial::RotationBetween(displayed.X_WD.q(), part.X_WB_goal.q()).norm()};
}

bool Seating::HasArrived(const DisplayedPart& displayed, const TrackedPart& tracked) noexcept {
  const HeldPart& part = *displayed.part;
  const GuidanceOptions& guidance = options_.guidance;
  if (part.lacks_partners) {
    is_matched_ = false;
    return false;
  }
  const auto [d, angle] = CalcRemainder(displayed);
  leaves_place_ = leaves_place_ && d.norm() < kLeaveFactor * guidance.match_distance &&
                  angle < kLeaveFactor * guidance.seat_angle;
  if (leaves_place_ || IsDrawnOut(part, tracked) || d.norm() > guidance.match_distance ||
      angle > guidance.seat_angle) {
    is_matched_ = false;
    return false;
  }
  if (guidance_.thread().is_in() && guidance_.thread().angle() > kTight) {
    return false;  // Its head rests, and it is not tightened yet.
  }
  const double tolerance = CalcTolerance(part);
  if (d.norm() <= tolerance) {
    return true;  // wherever the hand is by now
  }
  const bool is_guided = guidance_.mates().captured_count() > 0;
  const bool needs_guide = !part.mates.empty() && options_.condition != Condition::kCollision;
  if (needs_guide && !is_guided) {
    is_matched_ = false;
    return false;
  }
  // Along the way in, and across an axis but for its play, a part is in its place or it is not.
  const double along = std::abs(d.dot(part.insertion_W));
  if (HasAxis(part)) {
    is_matched_ = true;
    return std::hypot(along, CalcBeyondPlay(displayed)) <= tolerance && IsWayHomeFree(displayed);
  }
  is_matched_ = is_matched_ || ((!is_guided || along <= tolerance) && IsWayHomeFree(displayed));
  return false;
}

bool Seating::HasAxis(const HeldPart& part) const noexcept {
  const MateGuide& mates = guidance_.mates();
  return mates.axis() != nullptr && std::isfinite(mates.CalcAxisPlay(part));
}

double Seating::CalcTolerance(const HeldPart& part) const noexcept {
  constexpr double kShare = 0.1;  // Of the smallest feature that guides the part: a choice.
  return std::min(options_.guidance.seat_distance, kShare * part.smallest_guide);
}

void Seating::AddHoming(const DisplayedPart& displayed, ConstraintSolver* solver) noexcept {
  const HeldPart& part = *displayed.part;
  if (!IsDrawingHome(part)) {
    homing_ = 0;
    return;
  }
  const GuidanceOptions& guidance = options_.guidance;
  homing_ = std::min(1.0, homing_ + options_.dt / guidance.ramp_time);
  const Vec3& n = part.insertion_W;
  const Vec3 d = CalcRemainder(displayed).d_W;
  const Vec3 along = d.dot(n) * n;
  const auto stiffness = [&](double distance, double strongest) {
    const double k = distance * guidance.k_lin > strongest ? strongest / distance : guidance.k_lin;
    return homing_ * k;
  };
  const double k_along = stiffness(along.norm(), guidance.attraction_force);
  const double k_across = stiffness((d - along).norm(), guidance.max_force);
  solver->AddPointSpring(displayed.p_WCm(), -k_along * along - k_across * (d - along),
                         k_across * Mat3::Identity() + (k_along - k_across) * n * n.transpose());
}

double Seating::CalcBeyondPlay(const DisplayedPart& displayed) const noexcept {
  const HeldPart& part = *displayed.part;
  const MateGuide& mates = guidance_.mates();
  const Vec3& p_WM = part.mates[mates.axis_index()].X_WM.p();
  const Vec3 p_BM = part.X_WB_goal.Inverse() * p_WM;  // Of the part in its place.
  const Vec3 d = displayed.X_WD * p_BM - p_WM;
  const double across = (d - d.dot(part.insertion_W) * part.insertion_W).norm();
  return std::max(0.0, across - mates.CalcAxisPlay(part));
}

bool Seating::IsWayHomeFree(const DisplayedPart& displayed) noexcept {
  if (options_.condition == Condition::kConstraint) {
    return true;
  }
  X_WD_start_ = displayed.X_WD;
  constexpr double kSamples[] = {0.25, 0.5, 0.75};  // Shares of the way: a choice, not measured.
  for (const double s : kSamples) {
    if (!contacts_.IsFreeAt(*displayed.part, CalcPose(*displayed.part, s), kSeatTolerance)) {
      return false;
    }
  }
  return true;
}

bool Seating::CanFinish(const DisplayedPart& displayed, const TrackedPart& tracked) noexcept {
  const HeldPart& part = *displayed.part;
  if (part.lacks_partners || guidance_.is_stuck() || IsDrawnOut(part, tracked)) {
    return false;
  }
  const auto [d, angle] = CalcRemainder(displayed);
  if (d.norm() > options_.guidance.finish_distance || angle > options_.guidance.seat_angle) {
    return false;
  }
  return IsWayHomeFree(displayed);
}

bool Seating::IsDrawnOut(const HeldPart& part, const TrackedPart& tracked) const noexcept {
  const Vec3 lead = tracked.X_WT * part.p_BoBcm_B - part.X_WB_goal * part.p_BoBcm_B;
  return part.starts_in_place && lead.dot(part.insertion_W) < -options_.guidance.match_distance;
}

spatial::Pose Seating::CalcPose(const HeldPart& part, double progress) const noexcept {
  if (progress >= 1) {
    return part.X_WB_goal;
  }
  const double s = MinimumJerk(progress);
  const Vec3& p_BoBcm_B = part.p_BoBcm_B;
  const Vec3 p_from = X_WD_start_ * p_BoBcm_B;
  const Vec3 theta = spatial::RotationBetween(X_WD_start_.q(), part.X_WB_goal.q());
  const Quat q = spatial::RotationFromVector(s * theta) * X_WD_start_.q();
  return {q, p_from + s * (part.X_WB_goal * p_BoBcm_B - p_from) - q * p_BoBcm_B};
}

void Seating::Start(const DisplayedPart& displayed) noexcept {
  arrival_ = CalcRemainder(displayed);
  progress_ = 0;
  X_WD_start_ = displayed.X_WD;
}

void Seating::Advance(DisplayedPart* displayed) noexcept {
  // The last fraction of a millimetre, to the exact pose that the mates resolve to (X9).
  const HeldPart& part = *displayed->part;
  const spatial::Pose X_before = displayed->X_WD;
  progress_ = std::min(1.0, progress_ + options_.dt / options_.guidance.seat_time);
  displayed->X_WD = CalcPose(part, progress_);
  displayed->V.w = spatial::RotationBetween(X_before.q(), displayed->X_WD.q()) / options_.dt;
  displayed->V.v = (displayed->p_WCm() - X_before * part.p_BoBcm_B) / options_.dt;
}

}  // namespace hvas::haptics
