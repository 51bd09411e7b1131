#include "haptics/giving_rows.h"

#include <algorithm>
#include <cmath>

#include "haptics/fit_rows.h"
#include "haptics/held_part.h"

namespace hvas::haptics {
namespace {

// A part engages as far off its way as three times what gives, or this far [m], and so tilted:
// chamfers and mates lead it in from there. Choices.
constexpr double kAside = 1e-3;
constexpr double kAsideOfGiven = 3;
constexpr double kTilt = 0.15;  // [rad]

}  // namespace

void GivingRows::Reset(bool starts_in_place) noexcept {
  is_engaged_.fill(starts_in_place);
  row_ = -1;
  stretch_ = 0;
}

void GivingRows::UpdateEngagement(const DisplayedPart& displayed, double travel) noexcept {
  const HeldPart& part = *displayed.part;
  const Vec3 off_W = displayed.X_WD.p() - part.X_WB_goal.p();
  const double aside = (off_W - off_W.dot(out_W_) * out_W_).norm();
  const double tilt =
      spatial::RotationBetween(part.X_WB_goal.q(), displayed.X_WD.q()).cross(out_W_).norm();
  for (std::size_t i = 0; i < std::min(part.gives.size(), kMaxCurves); ++i) {
    const GivingCurve& curve = *part.gives[i].curve;
    if (curve.CalcGiven(travel) > 0) {
      continue;  // It has passed the beginning, or come from aside.
    }
    const double reach = std::max(kAside, kAsideOfGiven * part.gives[i].widest);
    is_engaged_[i] = aside < reach && tilt < kTilt;
  }
}

GivingLoad GivingRows::CalcLoad(double travel) const noexcept {
  GivingLoad load;
  for (std::size_t i = 0; i < std::min(part_->gives.size(), kMaxCurves); ++i) {
    if (is_engaged_[i]) {
      load += CalcGivingLoad(*part_->gives[i].curve, travel);
    }
  }
  return load;
}

void GivingRows::Add(const DisplayedPart& displayed, double dt, ConstraintSolver* solver) noexcept {
  row_ = -1;
  holding_ = 0;
  const HeldPart& part = *displayed.part;
  if (part.gives.empty()) {
    return;
  }
  out_W_ = -part.insertion_W;
  part_ = &part;
  travel_ = (displayed.X_WD.p() - part.X_WB_goal.p()).dot(out_W_);
  UpdateEngagement(displayed, travel_);
  const GivingLoad load = CalcLoad(travel_);
  if (load.spring == 0 && load.in == 0 && load.out == 0) {
    stretch_ = 0;
    return;
  }
  dt_ = dt;
  holding_ = std::max(0.0, std::min(load.in + load.spring, load.out - load.spring));
  spring_ = map_.FeltSigned(load.spring);
  // The map is concave: its slope at the spring's force makes the spring no stiffer than felt.
  constexpr double kDelta = 1e-3;  // [N]
  const double magnitude = std::abs(load.spring);
  const double slope = (map_.Felt(magnitude + kDelta) - map_.Felt(magnitude)) / kDelta;
  stiffness_ = std::max(0.0, slope * load.stiffness);
  solver->AddPointSpring(displayed.p_WCm(), spring_ * out_W_,
                         stiffness_ * out_W_ * out_W_.transpose());
  Vec6 J;
  J << Vec3::Zero(), out_W_;
  row_ = solver->AddBoundedRow(
      J, {map_.FeltSigned(load.spring - load.out) - spring_,
          map_.FeltSigned(load.spring + load.in) - spring_, stretch_, FitRows::kBristle});
}

GivingRows::Forces GivingRows::Finish(const ConstraintSolver& solver) noexcept {
  if (row_ < 0) {
    return {};
  }
  const double friction = solver.bounded_force(row_);
  stretch_ = -friction / FitRows::kBristle;
  const double moved = dt_ * out_W_.dot(solver.velocity(0).v);
  const double felt = spring_ - stiffness_ * moved + friction;
  // A stiff part that is met holds the hand like a wall for some ticks, until the step has followed
  // the map: what it truly holds is told by where it is.
  const GivingLoad load = CalcLoad(travel_ + moved);
  return {std::clamp(map_.TrueSigned(felt), load.spring - load.out, load.spring + load.in), felt};
}

}  // namespace hvas::haptics
