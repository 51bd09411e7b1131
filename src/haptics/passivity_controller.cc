#include "haptics/passivity_controller.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

PassivityChannel::PassivityChannel(const PassivityLimits& limits) noexcept : limits_(limits) {
  limits_.delay = std::clamp(limits.delay, 0, kMaxDelay);
}

const PassivityChannel::Given& PassivityChannel::FindGiven(int ticks_ago) const noexcept {
  return given_[(next_ + kHistory - static_cast<std::size_t>(ticks_ago)) % kHistory];
}

Vec3 PassivityChannel::Limit(const Vec3& moved, const Vec3& force, double stored,
                             double dt) noexcept {
  Observe(moved);
  Forget(stored, dt);
  if (dt > 0) {
    v_ = (moved + moved_) / (2 * dt);
  }
  moved_ = moved;
  wanted_ = force.allFinite() ? force : Vec3::Zero();
  Vec3 limited = dt > 0 ? Bound(Damp(wanted_, dt)) : Vec3::Zero();
  is_active_ = limited != force;
  return limited;
}

void PassivityChannel::Write(const Vec3& force) noexcept {
  given_[next_] = {force, wanted_};
  next_ = (next_ + 1) % kHistory;
}

void PassivityChannel::Lose() noexcept {
  is_lost_ = true;
  is_active_ = false;
  wanted_ = v_ = moved_ = Vec3::Zero();
  lost_force_ = std::max(lost_force_, FindGiven(1 + limits_.delay).written.norm());
}

void PassivityChannel::ForgetWritten() noexcept {
  given_.fill({});
  wanted_ = v_ = moved_ = Vec3::Zero();
  is_lost_ = false;
  lost_force_ = 0;
}

void PassivityChannel::AddCredit(double energy) noexcept {
  if (energy > 0 && std::isfinite(energy)) {
    energy_ += energy;
    account_.credited += energy;
  }
}

/** Books the work of the force that acted since the last tick. */
void PassivityChannel::Observe(const Vec3& moved) noexcept {
  const Given& acted = FindGiven(1 + limits_.delay);
  double work = acted.written.dot(moved);
  if (is_lost_) {
    work = std::max(lost_force_, acted.written.norm()) * moved.norm();
    is_lost_ = false;
    lost_force_ = 0;
  }
  energy_ -= work;
  (work > 0 ? account_.out : account_.in) += std::abs(work);
  account_.withheld += acted.wanted.dot(moved) - work;
}

/** What came in and is neither stored nor went out was dissipated. Of that, what is older than the
 window gives no right to go out any more. */
void PassivityChannel::Forget(double stored, double dt) noexcept {
  if (!std::isfinite(stored) || !(dt > 0)) {
    return;
  }
  const double dissipated = energy_ - stored;
  dissipation_[bucket_] += dissipated - dissipated_;
  dissipated_ = dissipated;
  bucket_time_ += dt;
  if (bucket_time_ < limits_.window / kBuckets) {
    return;
  }
  bucket_time_ = 0;
  bucket_ = (bucket_ + 1) % kBuckets;
  const double old = std::clamp(dissipation_[bucket_], 0.0, std::max(0.0, dissipated));
  dissipation_[bucket_] = 0;
  energy_ -= old;
  dissipated_ -= old;
  account_.forgotten += old;
}

/** Keeps the energy that is foreseen, with the speed as it is, above zero: by damping, and where
 that is not enough by leaving out what drives. */
Vec3 PassivityChannel::Damp(const Vec3& force, double dt) const noexcept {
  double before = energy_;
  for (int ago = 1; ago <= limits_.delay; ++ago) {
    before -= FindGiven(ago).written.dot(v_) * dt;
  }
  const double missing = force.dot(v_) * dt - before;
  if (missing <= 0) {
    return force;
  }
  const double square = v_.squaredNorm();
  const double floor = std::max(square, limits_.min_speed * limits_.min_speed);
  const double alpha = std::min(missing / (floor * dt), limits_.max_damping);
  Vec3 damped = force - alpha * v_;
  const double excess = damped.dot(v_) - std::max(0.0, before) / dt;
  if (excess > 0) {
    damped -= excess / square * v_;
  }
  return damped;
}

/** No larger than that all that is on its way can do, at the worst, before it is seen. */
Vec3 PassivityChannel::Bound(const Vec3& force) const noexcept {
  const double speed = v_.norm();
  const double period = limits_.longest_tick;
  const auto reach = [&](int ticks) {
    return (speed + limits_.acceleration * ticks * period) * period;
  };
  double left = energy_ + limits_.reserve;
  for (int ago = 1; ago <= limits_.delay; ++ago) {
    left -= FindGiven(ago).written.norm() * reach(limits_.delay + 1 - ago + 1);
  }
  // left = F reach + F^2 / (2 rate) speed: what it does until it is seen, and while it is taken
  // back.
  const double seen = reach(limits_.delay + 2);
  const double back = seen / (2 * limits_.rate * period);
  const double root = std::sqrt(seen * seen + 4 * back * std::max(0.0, left));
  const double most = std::min(limits_.max_force, 2 * std::max(0.0, left) / (seen + root));
  const double norm = force.norm();
  return norm > most ? Vec3(most / norm * force) : force;
}

PassivityController::PassivityController(const PassivityLimits& force,
                                         const PassivityLimits& torque) noexcept
    : force_(force), torque_(torque) {}

spatial::Wrench PassivityController::Limit(const spatial::Pose& X_DH, const spatial::Wrench& F_H_D,
                                           double stored, double stored_turning,
                                           double dt) noexcept {
  if (!spatial::IsFinite(X_DH)) {
    force_.Lose();
    torque_.Lose();
    return {};
  }
  const spatial::Pose X_before = has_pose_ ? X_DH_ : X_DH;
  X_DH_ = X_DH;
  has_pose_ = true;
  return {
      torque_.Limit(spatial::RotationBetween(X_before.q(), X_DH.q()), F_H_D.t, stored_turning, dt),
      force_.Limit(X_DH.p() - X_before.p(), F_H_D.f, stored, dt)};
}

void PassivityController::Write(const spatial::Wrench& F_H_D) noexcept {
  force_.Write(F_H_D.f);
  torque_.Write(F_H_D.t);
}

void PassivityController::Reset() noexcept {
  force_.Reset();
  torque_.Reset();
}

void PassivityController::ForgetWritten() noexcept {
  force_.ForgetWritten();
  torque_.ForgetWritten();
  has_pose_ = false;
}

double CalcDelayTicks(const device::DeviceProfile& profile, double dt) noexcept {
  return std::ceil(profile.delay / dt - 1e-6);
}

PassivityController MakePassivityController(const device::DeviceProfile& profile,
                                            double dt) noexcept {
  constexpr double kHarmless = 0.3;  // [m/s]: a choice, not measured.
  PassivityLimits force;
  force.reserve = 0.5 * profile.mass * kHarmless * kHarmless;
  force.max_force = profile.max_force;
  force.max_damping = profile.max_damping;
  force.longest_tick = 1.5 * dt;
  force.rate = 400;
  force.delay = static_cast<int>(
      std::clamp(CalcDelayTicks(profile, dt), 0.0, double{PassivityChannel::kMaxDelay}));
  PassivityLimits torque = force;
  torque.max_force = profile.max_torque;
  torque.rate = 40;
  torque.max_damping = profile.max_rotational_damping;
  torque.reserve = PassivityLimits().reserve;
  torque.min_speed = 0.05;
  torque.acceleration = 1500;
  return {force, torque};
}

}  // namespace hvas::haptics
