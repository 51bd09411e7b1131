#include "haptics/constraint_solver.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

void ConstraintSolver::Begin(double mass, const Mat3& I_W, const Vec3& p_WCm,
                             const spatial::Twist& V_0, double dt) noexcept {
  BeginFree(dt);
  p_WCm_[0] = p_WCm;
  mass_ = mass;
  I_W_ = I_W;
  A_.setZero();
  A_.topLeftCorner<3, 3>() = I_W;
  A_.bottomRightCorner<3, 3>() = mass * Mat3::Identity();
  rhs_.head<3>() = I_W * V_0.w;
  rhs_.tail<3>() = mass * V_0.v;
}

void ConstraintSolver::BeginFree(double dt) noexcept {
  dt_ = dt;
  body_count_ = 1;
  contact_count_ = 0;
  patch_count_ = 0;
  bounded_count_ = 0;
  is_factored_ = false;
  A_.setIdentity();
  rhs_.setZero();
}

int ConstraintSolver::AddBody(const Body& body) noexcept {
  if (body_count_ == static_cast<std::size_t>(kMaxBodies)) {
    return -1;
  }
  const std::size_t i = body_count_++;
  const Mat3 turn = body.I_W.inverse();
  inverse_[i].setZero();
  inverse_[i].topLeftCorner<3, 3>() = turn;
  inverse_[i].bottomRightCorner<3, 3>() = Mat3::Identity() / body.mass;
  p_WCm_[i] = body.p_WCm;
  V_[i].head<3>() = body.V_0.w + dt_ * (turn * body.F_Cm_W.t);
  V_[i].tail<3>() = body.V_0.v + dt_ / body.mass * body.F_Cm_W.f;
  return static_cast<int>(i);
}

int ConstraintSolver::AddBody(const Vec3& p_WCm, const Vec6& V, const Mat6& inverse) noexcept {
  if (body_count_ == static_cast<std::size_t>(kMaxBodies)) {
    return -1;
  }
  const std::size_t i = body_count_++;
  inverse_[i] = inverse;
  p_WCm_[i] = p_WCm;
  V_[i] = V;
  return static_cast<int>(i);
}

spatial::Twist ConstraintSolver::CalcFreeMotion(const spatial::Wrench& F_Cm_W) const noexcept {
  const double dt2 = dt_ * dt_;
  return {dt2 * (I_W_.inverse() * F_Cm_W.t), dt2 / mass_ * F_Cm_W.f};
}

void ConstraintSolver::AddWrench(const spatial::Wrench& F_Cm_W) noexcept {
  rhs_.head<3>() += dt_ * F_Cm_W.t;
  rhs_.tail<3>() += dt_ * F_Cm_W.f;
}

void ConstraintSolver::AddPointSpring(const Vec3& p_WQ, const Vec3& f0, const Mat3& K) noexcept {
  // Velocity of Q: v - [r] w, with r from the centre of mass to Q.
  const Vec3 r = p_WQ - p_WCm_[0];
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
  const Vec3 r = p_WQ - p_WCm_[0];
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

int ConstraintSolver::AddPatch(const Patch& patch) noexcept {
  if (patch_count_ == kMaxPatches) {
    return -1;
  }
  PatchRows& rows = patches_[static_cast<std::size_t>(patch_count_)];
  rows.of = patch;
  rows.load = 0;
  rows.stick_softness = 1 / (dt_ * dt_ * patch.stiffness);
  rows.lambda.setZero();
  return patch_count_++;
}

int ConstraintSolver::AddContact(const Contact& contact) noexcept {
  if (contact_count_ == kMaxContacts) {
    return -1;
  }
  const PatchRows& patch = patches_[static_cast<std::size_t>(contact.patch)];
  const Pair pair = PairOf(patch);
  ContactRows& rows = contacts_[static_cast<std::size_t>(contact_count_)];
  rows.patch = contact.patch;
  rows.recovery_speed = contact.recovery_speed;
  rows.is_prepared = false;
  const Vec3 r = contact.p_WC - p_WCm_[pair.body];
  const auto set = [&](const Vec3& direction, Row* row) {
    row->J << r.cross(direction), direction;
    if (pair.other != kWorld) {
      const Vec3 r_other = contact.p_WC - p_WCm_[static_cast<std::size_t>(pair.other)];
      row->J_other << -r_other.cross(direction), -direction;
    }
    row->lambda = 0;
    row->softness = 0;
  };
  set(contact.nhat_W, &rows.normal);
  rows.normal.bias = contact.velocity_bias;
  rows.normal.softness = contact.compliance / (dt_ * dt_);
  const Mat3 R_WC = spatial::FrameFromZ(contact.nhat_W).toRotationMatrix();
  for (int k = 0; k < 2; ++k) {
    set(R_WC.col(k), &rows.tangent[k]);
    rows.tangent[k].bias = -R_WC.col(k).dot(contact.stick_W) / dt_;
  }
  return contact_count_++;
}

int ConstraintSolver::AddBoundedRow(const Vec6& J, const BoundedRow& bounds, int body) noexcept {
  if (bounded_count_ == kMaxBoundedRows) {
    return -1;
  }
  const int index = bounded_count_++;
  Row& row = bounded_[static_cast<std::size_t>(index)];
  row = {};
  row.J = J;
  row.bias = -bounds.stretch / dt_;
  row.softness = 1 / (dt_ * dt_ * bounds.stiffness);
  bounds_[static_cast<std::size_t>(index)] = {bounds.low * dt_, bounds.high * dt_};
  bounded_body_[static_cast<std::size_t>(index)] = static_cast<std::size_t>(body);
  return index;
}

void ConstraintSolver::Factor() noexcept {
  if (!is_factored_) {
    factor_.compute(A_);
    // Column by column: a matrix at once would go through Eigen's blocked kernels, which allocate.
    for (int i = 0; i < 6; ++i) {
      const Vec6 unit = Vec6::Unit(i);
      inverse_[0].col(i) = factor_.solve(unit);
    }
    is_factored_ = true;
  }
}

spatial::Twist ConstraintSolver::SolveUnconstrained() noexcept {
  Factor();
  const Vec6 V = factor_.solve(rhs_);
  return {V.head<3>(), V.tail<3>()};
}

void ConstraintSolver::PrepareRow(const Pair& pair, Row* row) noexcept {
  row->W.noalias() = inverse_[pair.body] * row->J;
  row->slack = row->J.dot(row->W);
  if (pair.other != kWorld) {
    row->W_other.noalias() = inverse_[static_cast<std::size_t>(pair.other)] * row->J_other;
    row->slack += row->J_other.dot(row->W_other);
  }
}

void ConstraintSolver::PrepareFriction(ContactRows* rows) noexcept {
  const Pair pair = PairOf(*rows);
  Row& x = rows->tangent[0];
  Row& y = rows->tangent[1];
  PrepareRow(pair, &x);
  PrepareRow(pair, &y);
  rows->coupling = x.J.dot(y.W);
  if (pair.other != kWorld) {
    rows->coupling += x.J_other.dot(y.W_other);
  }
  rows->larger = 0.5 * (x.slack + y.slack) + std::hypot(0.5 * (x.slack - y.slack), rows->coupling);
  rows->is_prepared = true;
}

void ConstraintSolver::PrepareRolling(PatchRows* patch) noexcept {
  if (patch->of.rolling_arm <= 0) {
    return;
  }
  const auto add = [&](std::size_t body, int side) {
    patch->W_top[side] = inverse_[body].topLeftCorner<3, 3>();
    patch->W_bottom[side] = inverse_[body].bottomLeftCorner<3, 3>();
  };
  add(static_cast<std::size_t>(patch->of.body), 0);
  Mat3 slack = patch->W_top[0];
  if (patch->of.other != kWorld) {
    add(static_cast<std::size_t>(patch->of.other), 1);
    slack += patch->W_top[1];
  }
  patch->rolling_inverse = slack.inverse();
}

double ConstraintSolver::Velocity(const Pair& pair, const Row& row) const noexcept {
  double v = row.J.dot(V_[pair.body]);
  if (pair.other != kWorld) {
    v += row.J_other.dot(V_[static_cast<std::size_t>(pair.other)]);
  }
  return v;
}

void ConstraintSolver::Push(const Pair& pair, const Row& row, double change) noexcept {
  V_[pair.body] += change * row.W;
  if (pair.other != kWorld) {
    V_[static_cast<std::size_t>(pair.other)] += change * row.W_other;
  }
}

void ConstraintSolver::RelaxBounded() noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(bounded_count_); ++i) {
    Row& row = bounded_[i];
    Vec6& V = V_[bounded_body_[i]];
    const double residual = row.J.dot(V) - row.bias + row.softness * row.lambda;
    const double lambda = std::clamp(row.lambda - residual / (row.slack + row.softness),
                                     bounds_[i][0], bounds_[i][1]);
    V += (lambda - row.lambda) * row.W;
    row.lambda = lambda;
  }
}

void ConstraintSolver::RelaxNormal(ContactRows* rows) noexcept {
  // Up to the recovery speed the force is what the depth asks for, whatever the load; beyond it the
  // contact lets go. A bound on the bias alone would let a hard press sink in for ever.
  const Pair pair = PairOf(*rows);
  Row& row = rows->normal;
  const double v = Velocity(pair, row);
  const double at_recovery = row.lambda + (rows->recovery_speed - v) / row.slack;
  const double residual = v - row.bias + row.softness * row.lambda;
  const double wanted = row.lambda - residual / (row.slack + row.softness);
  const double lambda = std::clamp(wanted, 0.0, std::max(0.0, at_recovery));
  const double change = lambda - row.lambda;
  if (change != 0) {
    Push(pair, row, change);
    row.lambda = lambda;
    patches_[static_cast<std::size_t>(rows->patch)].load += change;
  }
}

void ConstraintSolver::RelaxFriction(ContactRows* rows) noexcept {
  // Coulomb's disc, no square about two chosen axes: the world has no preferred direction. If
  // sticking needs no more than the disc has it is solved exactly, else a projected gradient step
  // turns the force against the sliding.
  const PatchRows& patch = patches_[static_cast<std::size_t>(rows->patch)];
  Row& x = rows->tangent[0];
  Row& y = rows->tangent[1];
  const double limit = patch.of.coefficient * rows->normal.lambda;
  if (limit <= 0 && x.lambda == 0 && y.lambda == 0) {
    return;
  }
  if (!rows->is_prepared) {
    PrepareFriction(rows);
  }
  const Pair pair = PairOf(patch);
  Eigen::Vector2d lambda(0, 0);
  if (limit > 0) {
    const double softness = patch.stick_softness * patch.load / rows->normal.lambda;
    const Eigen::Vector2d before(x.lambda, y.lambda);
    const Eigen::Vector2d residual(Velocity(pair, x) - x.bias + softness * x.lambda,
                                   Velocity(pair, y) - y.bias + softness * y.lambda);
    const double a = x.slack + softness;
    const double c = y.slack + softness;
    const double b = rows->coupling;
    lambda = before - Eigen::Vector2d(c * residual.x() - b * residual.y(),
                                      a * residual.y() - b * residual.x()) /
                          (a * c - b * b);
    if (lambda.norm() > limit) {
      lambda = before - residual / (rows->larger + softness);
      const double size = lambda.norm();
      lambda *= size > limit ? limit / size : 1.0;
    }
  }
  Push(pair, x, lambda.x() - x.lambda);
  Push(pair, y, lambda.y() - y.lambda);
  x.lambda = lambda.x();
  y.lambda = lambda.y();
}

void ConstraintSolver::RelaxRolling(PatchRows* patch) noexcept {
  const double limit = patch->of.rolling_arm * patch->load;
  if (limit <= 0 && patch->lambda.isZero(0)) {
    return;
  }
  const auto body = static_cast<std::size_t>(patch->of.body);
  const bool has_other = patch->of.other != kWorld;
  const auto other = static_cast<std::size_t>(std::max(0, patch->of.other));
  Vec3 w = V_[body].head<3>();
  if (has_other) {
    w -= V_[other].head<3>();
  }
  Vec3 lambda = patch->lambda - patch->rolling_inverse * w;
  const double size = lambda.norm();
  lambda *= size > limit ? limit / size : 1.0;
  const Vec3 change = lambda - patch->lambda;
  patch->lambda = lambda;
  V_[body].head<3>() += patch->W_top[0] * change;
  V_[body].tail<3>() += patch->W_bottom[0] * change;
  if (has_other) {
    V_[other].head<3>() -= patch->W_top[1] * change;
    V_[other].tail<3>() -= patch->W_bottom[1] * change;
  }
}

spatial::Twist ConstraintSolver::Solve(int iterations, bool ends_directly) noexcept {
  Factor();
  V_free_ = factor_.solve(rhs_);
  V_[0] = V_free_;
  const std::span<ContactRows> contacts(contacts_.data(), static_cast<std::size_t>(contact_count_));
  const std::span<PatchRows> patches(patches_.data(), static_cast<std::size_t>(patch_count_));
  for (ContactRows& rows : contacts) {
    PrepareRow(PairOf(rows), &rows.normal);
  }
  for (PatchRows& patch : patches) {
    PrepareRolling(&patch);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(bounded_count_); ++i) {
    PrepareRow({bounded_body_[i], kWorld}, &bounded_[i]);
  }
  constexpr double kConverged = 1e-9;  // [m/s or rad/s]: a nanometre a second. A choice.
  constexpr int kFirstSweeps = 8;  // Until what each contact does is as good as known: a choice.
  for (int sweep = 0; sweep < iterations; ++sweep) {
    const std::array<Vec6, kMaxBodies> before = V_;
    RelaxBounded();
    for (ContactRows& rows : contacts) {
      RelaxFriction(&rows);
    }
    for (PatchRows& patch : patches) {
      RelaxRolling(&patch);
    }
    // Normals last: what remains of the error is in friction, not in penetration.
    for (ContactRows& rows : contacts) {
      RelaxNormal(&rows);
    }
    double change = 0;
    for (std::size_t i = 0; i < body_count_; ++i) {
      change = std::max(change, (V_[i] - before[i]).squaredNorm());
    }
    if (change < kConverged * kConverged ||
        (ends_directly && (sweep + 1 == kFirstSweeps || sweep + 1 == iterations) &&
         SolveDirectly())) {
      break;
    }
  }
  return velocity(0);
}

Vec3 ConstraintSolver::contact_force(int i) const noexcept {
  const ContactRows& rows = contacts_[static_cast<std::size_t>(i)];
  return (rows.normal.lambda * rows.normal.J.tail<3>() +
          rows.tangent[0].lambda * rows.tangent[0].J.tail<3>() +
          rows.tangent[1].lambda * rows.tangent[1].J.tail<3>()) /
         dt_;
}

Vec3 ConstraintSolver::contact_velocity(int i) const noexcept {
  const ContactRows& rows = contacts_[static_cast<std::size_t>(i)];
  const Pair pair = PairOf(rows);
  Vec3 v = Vec3::Zero();
  for (const Row* row : {&rows.normal, &rows.tangent[0], &rows.tangent[1]}) {
    v += Velocity(pair, *row) * row->J.tail<3>();
  }
  return v;
}

double ConstraintSolver::normal_force(int i) const noexcept {
  return contacts_[static_cast<std::size_t>(i)].normal.lambda / dt_;
}

double ConstraintSolver::bounded_force(int row) const noexcept {
  return row < 0 ? 0.0 : bounded_[static_cast<std::size_t>(row)].lambda / dt_;
}

}  // namespace hvas::haptics
