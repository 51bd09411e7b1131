#include "haptics/thread_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "haptics/fit_rows.h"

namespace hvas::haptics {
namespace {

constexpr double kFlankAngle = 1.155;  // 1 / cos 30 deg: the flanks of a profile of 60 deg.
// Leads of thread that are in before both flanks hold; less is the ramp of the first turn. A
// choice.
constexpr double kLeadIn = 2;
constexpr double kCrossedTurn = 0.5;  // Turns that a crossed thread goes on for: a choice.

/** Angle in (-pi, pi] by which q is turned about a unit vector. */
double CalcTwist(const Quat& q, const Vec3& axis) noexcept {
  return std::remainder(2 * std::atan2(q.vec().dot(axis), q.w()), units::kTurn);
}

}  // namespace

void ThreadRows::Reset(bool starts_in_place) noexcept {
  is_in_ = starts_in_place;
  is_crossed_ = false;
  angle_ = entry_angle_ = flank_force_ = stretch_ = 0;
  inner_row_ = outer_row_ = torque_row_ = -1;
}

ThreadRows::Load ThreadRows::CalcLoad(double angle) const noexcept {
  Load load;
  const double flank = kFlankAngle * thread_.friction * 0.5 * thread_.pitch_diameter;
  load.friction = thread_.running_torque + flank * flank_force_;
  const double turned = thread_.head_angle() - angle;
  if (thread_.stiffness > 0 && turned > 0) {
    load.preload = thread_.stiffness * rise_ * turned;
    load.spring = load.preload * rise_;
    load.slope = thread_.stiffness * rise_ * rise_;
    load.friction += load.preload * (flank + thread_.friction * thread_.head_radius);
  }
  return load;
}

// The turn at which the part is counts from its place, over whole turns: the helix is the nearest
// one that it has not passed.
void ThreadRows::Enter(double z, double turn) noexcept {
  is_in_ = true;
  const double most = (z + 0.5 * thread_.play) / rise_ + thread_.head_angle();
  angle_ = turn + units::kTurn * std::floor((most - turn) / units::kTurn);
  entry_angle_ = angle_;
  flank_force_ = stretch_ = 0;
}

void ThreadRows::Add(const DisplayedPart& displayed, const HeldMate& mate,
                     const MateGeometry& geometry, const ContactOptions& contact, double dt,
                     ConstraintSolver* solver) noexcept {
  inner_row_ = outer_row_ = torque_row_ = -1;
  const HeldPart& part = *displayed.part;
  thread_ = *mate.thread;
  dt_ = dt;
  rise_ = thread_.rise();
  sense_ = thread_.lead < 0 ? -1 : 1;
  const bool is_out = geometry.way_W.dot(part.insertion_W) <= 0;
  out_W_ = is_out ? geometry.way_W : Vec3(-geometry.way_W);
  if (geometry.depth <= 0) {
    is_in_ = is_crossed_ = false;
    return;
  }
  const Vec3& p_BN = mate.X_BN.p();
  const double z = out_W_.dot(displayed.X_WD * p_BN - part.X_WB_goal * p_BN);
  const double turn =
      sense_ * CalcTwist(displayed.X_WD.q() * part.X_WB_goal.q().conjugate(), out_W_);
  if (is_in_) {
    angle_ += std::remainder(turn - angle_, units::kTurn);
  } else {
    Enter(z, turn);
    is_crossed_ = std::tan(geometry.angle) > 0.5 * std::abs(thread_.lead) / thread_.pitch_diameter;
  }
  AddFlanks(z, geometry.depth, geometry.p_WQ - displayed.p_WCm(), contact, solver);
  AddTorque(solver);
}

void ThreadRows::AddFlanks(double z, double depth, const Vec3& p_CmQ_W,
                           const ContactOptions& contact, ConstraintSolver* solver) noexcept {
  const double lead = std::abs(thread_.lead);
  const double past_head = angle_ - thread_.head_angle();
  const double helix = rise_ * std::max(past_head, 0.0);
  const double follows = past_head > 0 ? rise_ : 0;
  const double still_out = std::max(0.0, 1 - depth / (kLeadIn * lead));
  const double open = std::max(0.0, lead - thread_.play);
  const double most = contact.max_depth / contact.compliance;
  Vec6 J;
  J << p_CmQ_W.cross(out_W_) - sense_ * follows * out_W_, out_W_;
  inner_row_ =
      solver->AddBoundedRow(J, {0, most, z - helix + 0.5 * thread_.play, 1 / contact.compliance});
  // It opens by open / kLeadIn for each lead that the part comes out, while the mouth is near.
  const double opening = still_out > 0 ? open / (kLeadIn * lead) : 0;
  J.tail<3>() -= opening * out_W_;
  J.head<3>() -= opening * p_CmQ_W.cross(out_W_);
  outer_row_ = solver->AddBoundedRow(
      J, {-most, 0, z - helix - 0.5 * thread_.play - open * still_out, 1 / contact.compliance});
}

void ThreadRows::AddTorque(ConstraintSolver* solver) noexcept {
  const Load load = CalcLoad(angle_);
  const Vec3 axis_W = sense_ * out_W_;
  spring_felt_ = map_.FeltSigned(load.spring);
  // The map is concave: its slope at the spring's torque makes the spring no stiffer than felt.
  constexpr double kDelta = 1e-5;  // [N m]
  const double slope = (map_.Felt(load.spring + kDelta) - map_.Felt(load.spring)) / kDelta;
  slope_felt_ = slope * load.slope;
  if (load.slope > 0) {
    solver->AddAngularSpring(spring_felt_ * axis_W, slope_felt_ * axis_W * axis_W.transpose());
  }
  const bool is_stuck = is_crossed_ && entry_angle_ - angle_ > kCrossedTurn * units::kTurn;
  const double most = is_stuck ? std::numeric_limits<double>::infinity()
                               : map_.FeltSigned(load.spring + load.friction);
  const double radius = 0.5 * thread_.pitch_diameter;
  Vec6 J;
  J << axis_W, Vec3::Zero();
  torque_row_ = solver->AddBoundedRow(
      J, {map_.FeltSigned(load.spring - load.friction) - spring_felt_, most - spring_felt_,
          stretch_, FitRows::kBristle * radius * radius});
}

ThreadForces ThreadRows::Finish(const ConstraintSolver& solver) noexcept {
  ThreadForces forces;
  if (torque_row_ < 0) {
    return forces;
  }
  flank_force_ = std::max(solver.bounded_force(inner_row_), -solver.bounded_force(outer_row_));
  const double radius = 0.5 * thread_.pitch_diameter;
  const double friction = solver.bounded_force(torque_row_);
  stretch_ = -friction / (FitRows::kBristle * radius * radius);
  const double turned = dt_ * sense_ * out_W_.dot(solver.velocity(0).w);
  const double felt = spring_felt_ - slope_felt_ * turned + friction;
  const Load load = CalcLoad(angle_ + turned);
  const double truth = is_crossed_ ? map_.TrueSigned(felt)
                                   : std::clamp(map_.TrueSigned(felt), load.spring - load.friction,
                                                load.spring + load.friction);
  forces.torque_felt = sense_ * felt;
  forces.torque_true = sense_ * truth;
  forces.preload = load.preload;
  inner_row_ = outer_row_ = torque_row_ = -1;
  return forces;
}

}  // namespace hvas::haptics
