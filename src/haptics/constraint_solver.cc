#include "haptics/constraint_solver.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

void ConstraintSolver::Begin(double mass, const Mat3& I_W, const Vec3& p_WCm,
                             const spatial::Twist& V_0, double dt) noexcept {
  dt_ = dt;
  p_WCm_ = p_WCm;
  contact_count_ = 0;
  bounded_count_ = 0;
  is_factored_ = false;
  A_.setZero();
  A_.topLeftCorner<3, 3>() = I_W;
  A_.bottomRightCorner<3, 3>() = mass * Mat3::Identity();
  rhs_.head<3>() = I_W * V_0.w;
  rhs_.tail<3>() = mass * V_0.v;
}

void ConstraintSolver::AddWrench(const spatial::Wrench& F_Cm_W) noexcept {
  rhs_.head<3>() += dt_ * F_Cm_W.t;
  rhs_.tail<3>() += dt_ * F_Cm_W.f;
}

void ConstraintSolver::AddPointSpring(const Vec3& p_WQ, const Vec3& f0, const Mat3& K) noexcept {
  // Velocity of Q: v - [r] w, with r from the centre of mass to Q.
  const Vec3 r = p_WQ - p_WCm_;
  const Mat3 S = spatial::Skew(r);
  const Mat3 KS = K * S;
  const double dt2 = dt_ * dt_;
  A_.topLeftCorner<3, 3>() += dt2 * (S.transpose() * KS);
  A_.topRightCorner<3, 3>() -= dt2 * (S.transpose() * K);
  A_.bottomLeftCorner<3, 3>() -= dt2 * KS;
  A_.bottomRightCorner<3, 3>() += dt2 * K;
  rhs_.head<3>() += dt_ * r.cross(f0);
  rhs_.tail<3>() += dt_ * f0;
}

void ConstraintSolver::AddAngularSpring(const Vec3& t0, const Mat3& K) noexcept {
  A_.topLeftCorner<3, 3>() += dt_ * dt_ * K;
  rhs_.head<3>() += dt_ * t0;
}

void ConstraintSolver::AddPointDamper(const Vec3& p_WQ, const Vec3& v_target, double b) noexcept {
  const Vec3 r = p_WQ - p_WCm_;
  const Mat3 S = spatial::Skew(r);
  A_.topLeftCorner<3, 3>() += dt_ * b * (S.transpose() * S);
  A_.topRightCorner<3, 3>() -= dt_ * b * S.transpose();
  A_.bottomLeftCorner<3, 3>() -= dt_ * b * S;
  A_.bottomRightCorner<3, 3>() += dt_ * b * Mat3::Identity();
  rhs_.head<3>() += dt_ * b * r.cross(v_target);
  rhs_.tail<3>() += dt_ * b * v_target;
}

void ConstraintSolver::AddAngularDamper(const Vec3& w_target, double b) noexcept {
  A_.topLeftCorner<3, 3>() += dt_ * b * Mat3::Identity();
  rhs_.head<3>() += dt_ * b * w_target;
}

void ConstraintSolver::AddContact(const Vec3& p_WC, const Vec3& nhat_W, double velocity_bias,
                                  double friction, double compliance,
                                  double recovery_speed) noexcept {
  if (contact_count_ == kMaxContacts) {
    return;
  }
  const Vec3 r = p_WC - p_WCm_;
  const Quat q_WC = spatial::FrameFromZ(nhat_W);
  ContactRows& rows = contacts_[static_cast<std::size_t>(contact_count_++)];
  rows.friction = friction;
  rows.recovery_speed = recovery_speed;
  rows.normal = {};
  rows.normal.J << r.cross(nhat_W), nhat_W;
  rows.normal.bias = velocity_bias;
  rows.normal.softness = compliance / (dt_ * dt_);
  const Vec3 tangents[2] = {q_WC * Vec3::UnitX(), q_WC * Vec3::UnitY()};
  for (int k = 0; k < 2; ++k) {
    rows.tangent[k] = {};
    rows.tangent[k].J << r.cross(tangents[k]), tangents[k];
  }
}

int ConstraintSolver::AddBoundedRow(const Vec6& J, double bound) noexcept {
  if (bounded_count_ == kMaxBoundedRows) {
    return -1;
  }
  const int index = bounded_count_++;
  bounded_[static_cast<std::size_t>(index)] = {};
  bounded_[static_cast<std::size_t>(index)].J = J;
  bounds_[static_cast<std::size_t>(index)] = bound * dt_;
  return index;
}

void ConstraintSolver::Factor() noexcept {
  if (!is_factored_) {
    factor_.compute(A_);
    is_factored_ = true;
  }
}

spatial::Twist ConstraintSolver::SolveUnconstrained() noexcept {
  Factor();
  const Vec6 V = factor_.solve(rhs_);
  return {V.head<3>(), V.tail<3>()};
}

void ConstraintSolver::Prepare(Row* row) noexcept {
  row->W = factor_.solve(row->J);
  row->inverse = 1.0 / (row->J.dot(row->W) + row->softness);
  row->lambda = 0;
}

void ConstraintSolver::PrepareFriction(ContactRows* rows) noexcept {
  Row& x = rows->tangent[0];
  Row& y = rows->tangent[1];
  Prepare(&x);
  Prepare(&y);
  const double a = x.J.dot(x.W);
  const double c = y.J.dot(y.W);
  rows->coupling = x.J.dot(y.W);
  rows->gradient_step = 1 / (0.5 * (a + c) + std::hypot(0.5 * (a - c), rows->coupling));
}

void ConstraintSolver::Relax(Row* row, double low, double high) noexcept {
  const double residual = row->J.dot(V_) - row->bias + row->softness * row->lambda;
  const double lambda = std::clamp(row->lambda - residual * row->inverse, low, high);
  V_ += (lambda - row->lambda) * row->W;
  row->lambda = lambda;
}

void ConstraintSolver::RelaxNormal(ContactRows* rows) noexcept {
  // Up to the recovery speed the force is what the depth asks for, whatever the load; beyond it the
  // contact lets go. A bound on the bias alone would let a hard press sink in for ever.
  Row& row = rows->normal;
  const double slack = row.J.dot(row.W);
  const double at_recovery = row.lambda + (rows->recovery_speed - row.J.dot(V_)) / slack;
  Relax(&row, 0, std::max(0.0, at_recovery));
}

void ConstraintSolver::RelaxFriction(ContactRows* rows) noexcept {
  // Coulomb's disc, no square about two chosen axes: the world has no preferred direction. If
  // sticking needs no more than the disc has it is solved exactly, else a projected gradient step
  // turns the force against the sliding.
  Row& x = rows->tangent[0];
  Row& y = rows->tangent[1];
  const double limit = rows->friction * rows->normal.lambda;
  const Eigen::Vector2d slip(x.J.dot(V_), y.J.dot(V_));
  const Eigen::Vector2d before(x.lambda, y.lambda);
  const double a = 1 / x.inverse;
  const double c = 1 / y.inverse;
  const double determinant = a * c - rows->coupling * rows->coupling;
  Eigen::Vector2d lambda = before - Eigen::Vector2d(c * slip.x() - rows->coupling * slip.y(),
                                                    a * slip.y() - rows->coupling * slip.x()) /
                                        determinant;
  if (lambda.norm() > limit) {
    lambda = before - rows->gradient_step * slip;
    const double size = lambda.norm();
    lambda *= size > limit ? limit / size : 1.0;
  }
  V_ += (lambda.x() - x.lambda) * x.W + (lambda.y() - y.lambda) * y.W;
  x.lambda = lambda.x();
  y.lambda = lambda.y();
}

spatial::Twist ConstraintSolver::Solve(int iterations) noexcept {
  Factor();
  V_ = factor_.solve(rhs_);
  const std::span<ContactRows> contacts(contacts_.data(), static_cast<std::size_t>(contact_count_));
  const auto bounded_count = static_cast<std::size_t>(bounded_count_);
  for (ContactRows& rows : contacts) {
    Prepare(&rows.normal);
    if (rows.friction > 0) {
      PrepareFriction(&rows);
    }
  }
  for (std::size_t i = 0; i < bounded_count; ++i) {
    Prepare(&bounded_[i]);
  }
  constexpr double kConverged = 1e-9;  // [m/s or rad/s]
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const Vec6 V_before = V_;
    for (std::size_t i = 0; i < bounded_count; ++i) {
      Relax(&bounded_[i], -bounds_[i], bounds_[i]);
    }
    for (ContactRows& rows : contacts) {
      if (rows.friction > 0) {
        RelaxFriction(&rows);
      }
    }
    // Normals last: what remains of the error is in friction, not in penetration.
    for (ContactRows& rows : contacts) {
      RelaxNormal(&rows);
    }
    if ((V_ - V_before).squaredNorm() < kConverged * kConverged) {
      break;
    }
  }
  return {V_.head<3>(), V_.tail<3>()};
}

Vec3 ConstraintSolver::contact_force(int i) const noexcept {
  const ContactRows& rows = contacts_[static_cast<std::size_t>(i)];
  return (rows.normal.lambda * rows.normal.J.tail<3>() +
          rows.tangent[0].lambda * rows.tangent[0].J.tail<3>() +
          rows.tangent[1].lambda * rows.tangent[1].J.tail<3>()) /
         dt_;
}

double ConstraintSolver::normal_force(int i) const noexcept {
  return contacts_[static_cast<std::size_t>(i)].normal.lambda / dt_;
}

double ConstraintSolver::bounded_force(int row) const noexcept {
  return row < 0 ? 0.0 : bounded_[static_cast<std::size_t>(row)].lambda / dt_;
}

}  // namespace hvas::haptics
