#include "haptics/fit_rows.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

void FitRows::Reset() noexcept {
  axial_row_ = turning_row_ = -1;
  stretch_ = turned_stretch_ = 0;
}

FitRows::Bound FitRows::MakeBound(double truth, double shown, double weight) const noexcept {
  Bound bound;
  bound.truth = truth;
  bound.weight = std::max(0.0, weight);
  const double of_weight = force_map_.Felt(bound.weight);
  bound.felt = kind_ == ForceMapKind::kPaper
                   ? std::min(shown, std::max(0.0, largest_felt_ - of_weight))
                   : force_map_.Felt(truth + bound.weight) - of_weight;
  return bound;
}

double FitRows::ToTrue(const Bound& bound, double felt) const noexcept {
  if (kind_ == ForceMapKind::kPaper) {
    return bound.felt > 0 ? felt * bound.truth / bound.felt : 0.0;
  }
  return force_map_.True(felt + force_map_.Felt(bound.weight)) - bound.weight;
}

void FitRows::Add(const FitLoad& load, const FitAxis& axis, ConstraintSolver* solver) noexcept {
  in_ = MakeBound(load.in, load.shown_in, axis.weight_out);
  out_ = MakeBound(load.out, load.shown_out, -axis.weight_out);
  turning_.truth = load.torque;
  turning_.felt = torque_map_.Felt(load.torque);
  radius_ = axis.radius;
  Vec6 J;
  J << axis.p_CmQ_W.cross(axis.out_W), axis.out_W;
  axial_row_ = solver->AddBoundedRow(J, {-out_.felt, in_.felt, stretch_, kBristle});
  J << axis.out_W, Vec3::Zero();
  turning_row_ = solver->AddBoundedRow(
      J, {-turning_.felt, turning_.felt, turned_stretch_, kBristle * radius_ * radius_});
}

FitForces FitRows::Finish(const ConstraintSolver& solver) noexcept {
  FitForces forces;
  if (axial_row_ < 0) {
    return forces;
  }
  forces.axial_felt = solver.bounded_force(axial_row_);
  forces.torque_felt = solver.bounded_force(turning_row_);
  const bool is_in = forces.axial_felt >= 0;
  forces.axial_true = (is_in ? 1 : -1) * ToTrue(is_in ? in_ : out_, std::abs(forces.axial_felt));
  forces.torque_true = torque_map_.TrueSigned(forces.torque_felt);
  stretch_ = -forces.axial_felt / kBristle;
  turned_stretch_ = radius_ > 0 ? -forces.torque_felt / (kBristle * radius_ * radius_) : 0.0;
  axial_row_ = turning_row_ = -1;
  return forces;
}

}  // namespace hvas::haptics
