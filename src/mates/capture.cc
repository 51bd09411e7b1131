#include "mates/capture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "mates/mate_kind.h"

namespace hvas::mates {

using product::MateKind;
using spatial::Pose;

CaptureMate MakeCaptureMate(const product::Mate& mate, product::OccurrenceId held) {
  HVAS_DEMAND(mate.a.occurrence == held || mate.b.occurrence == held);
  const bool holds_shaft = mate.b.occurrence == held;
  CaptureMate capture;
  capture.kind = mate.kind;
  capture.placed_low = holds_shaft ? mate.hole_low : mate.shaft_low;
  capture.placed_high = holds_shaft ? mate.hole_high : mate.shaft_high;
  capture.held_low = holds_shaft ? mate.shaft_low : mate.hole_low;
  capture.held_high = holds_shaft ? mate.shaft_high : mate.hole_high;
  if (mate.kind == MateKind::kFaceFace) {
    capture.reach = std::sqrt(std::max(0.0, mate.overlap) / std::numbers::pi);
  } else if (mate.kind == MateKind::kPrismatic) {
    capture.reach = mate.breadth;
  }
  return capture;
}

namespace {

/** @param X_MN  Held connector in the placed one, along whose x axes the sides meet. */
MateDeviation CalcPrismaticDeviation(const CaptureMate& mate, const Pose& X_MN,
                                     double angle) noexcept {
  constexpr double kLeastCosine = 0.1;  // Ways that are nearly square to each other meet nowhere.
  const Vec3 way_M = X_MN.q() * Vec3::UnitX();
  const double cosine = std::max(kLeastCosine, way_M.x());
  const double low = X_MN.p().x() + cosine * mate.held_low;
  const double high = X_MN.p().x() + cosine * mate.held_high;
  const double meeting =
      0.5 * (std::clamp(mate.placed_low, low, high) + std::clamp(mate.placed_high, low, high));
  const Vec3 p_MQ = X_MN.p() + (meeting - X_MN.p().x()) / cosine * way_M;
  MateDeviation deviation;
  deviation.angle = angle;
  deviation.distance = std::hypot(p_MQ.z(), std::max(0.0, std::abs(p_MQ.y()) - mate.reach));
  deviation.gap = std::max({0.0, mate.placed_low - high, low - mate.placed_high});
  return deviation;
}

}  // namespace

MateDeviation CalcDeviation(const CaptureMate& mate, const Pose& X_WM, const Pose& X_WN) noexcept {
  const Vec3 zhat_M_W = X_WM.q() * Vec3::UnitZ();
  const Vec3 zhat_N_W = X_WN.q() * Vec3::UnitZ();
  const Vec3 p_MN_W = X_WN.p() - X_WM.p();
  MateDeviation deviation;
  if (IsCentre(mate.kind)) {
    deviation.distance = p_MN_W.norm();
    return deviation;
  }
  const bool is_axis = IsAxial(mate.kind);
  const double cosine = (mate.kind == MateKind::kFaceFace ? -1.0 : 1.0) * zhat_M_W.dot(zhat_N_W);
  // atan2 is accurate for parallel and opposed directions, where acos is not.
  deviation.angle = std::atan2(zhat_M_W.cross(zhat_N_W).norm(), cosine);
  if (mate.kind == MateKind::kPrismatic) {
    return CalcPrismaticDeviation(mate, X_WM.Inverse() * X_WN, deviation.angle);
  }
  const double along = zhat_M_W.dot(p_MN_W);
  if (!is_axis) {
    const Vec3 p_MNFlat_W = p_MN_W - along * zhat_M_W;
    deviation.distance = std::abs(along);
    deviation.gap = std::max(0.0, p_MNFlat_W.norm() - mate.reach);
    return deviation;
  }
  // Where the ends of the held span are along the placed axis.
  const double end_low = along + mate.held_low * cosine;
  const double end_high = along + mate.held_high * cosine;
  const double low = std::min(end_low, end_high);
  const double high = std::max(end_low, end_high);
  deviation.gap = std::max({0.0, mate.placed_low - high, low - mate.placed_high});
  const double meeting =
      0.5 * (std::clamp(mate.placed_low, low, high) + std::clamp(mate.placed_high, low, high));
  // A held axis square to the placed one meets it anywhere: then its origin stands for it.
  const double share = high - low > 1e-12 ? (meeting - end_low) / (end_high - end_low) : 0.5;
  const double s = mate.held_low + share * (mate.held_high - mate.held_low);
  deviation.distance = zhat_M_W.cross(p_MN_W + s * zhat_N_W).norm();
  return deviation;
}

double CalcCaptureRatio(MateKind kind, const MateDeviation& deviation,
                        const CaptureThresholds& thresholds) noexcept {
  const double distance_limit =
      kind != MateKind::kFaceFace ? thresholds.axis_distance : thresholds.face_distance;
  const double gap_limit =
      HasFit(kind) || IsAxial(kind) ? thresholds.axial_gap : thresholds.in_plane_gap;
  return std::max({deviation.angle / thresholds.angle, deviation.distance / distance_limit,
                   deviation.gap / gap_limit});
}

bool IsCaptured(MateKind kind, const MateDeviation& deviation, bool was_captured,
                const CaptureThresholds& thresholds) noexcept {
  return CalcCaptureRatio(kind, deviation, thresholds) <=
         (was_captured ? thresholds.release_ratio : 1.0);
}

}  // namespace hvas::mates
