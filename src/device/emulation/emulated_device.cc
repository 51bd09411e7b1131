#include "device/emulation/emulated_device.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hvas::device {
namespace {

constexpr std::int64_t kSubstepNs = 100'000;  // Step of the mechanics, ten a tick: a choice.
constexpr double kJump = 0.08;                // [m] that a faulty encoder jumps: a choice.
const Vec3 kJumpDirection = Vec3(0.6, -0.64, 0.48);

double Quantise(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

Vec3 Quantise(const Vec3& value, double step) {
  return {Quantise(value.x(), step), Quantise(value.y(), step), Quantise(value.z(), step)};
}

Vec3 LimitNorm(const Vec3& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Vec3(limit / norm * v) : v;
}

/** A velocity after dry friction has taken what it can: it stops, it never turns it round. */
Vec3 Slow(const Vec3& v, double change) {
  const double speed = v.norm();
  return speed <= change ? Vec3::Zero() : Vec3((1 - change / speed) * v);
}

}  // namespace

const char* ToString(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "none";
    case Fault::kUnplugged:
      return "unplugged";
    case Fault::kStalled:
      return "stalled";
    case Fault::kNotANumber:
      return "not-a-number";
    case Fault::kJump:
      return "jump";
    case Fault::kCalibrationLost:
      return "calibration-lost";
    case Fault::kForceRefused:
      return "force-refused";
    case Fault::kSignFlipped:
      return "sign-flipped";
  }
  return "unknown";
}

EmulatedDevice::EmulatedDevice(const DeviceProfile& profile, const spatial::Pose& X_DH,
                               const DeviceProfile& claim)
    : profile_(profile), claim_(claim), period_ns_(std::llround(1e9 / profile.rate_hz)) {
  next_sample_ns_ = period_ns_;
  truth_.X_DH = X_DH;
  history_.fill(X_DH);
  TakeSample();
}

EmulatedSample EmulatedDevice::Sense() const {
  const std::scoped_lock lock(mutex_);
  EmulatedSample sample = sample_;
  sample.fault = fault_;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (fault_ == Fault::kNotANumber) {
    sample.X_DH = spatial::Pose(Quat(kNan, kNan, kNan, kNan), Vec3::Constant(kNan));
    sample.V_DH = {Vec3::Constant(kNan), Vec3::Constant(kNan)};
  } else if (fault_ == Fault::kJump) {
    sample.X_DH = {sample.X_DH.q(), sample.X_DH.p() + kJump * kJumpDirection};
  }
  return sample;
}

void EmulatedDevice::Command(const spatial::Wrench& F_H_D) {
  const std::scoped_lock lock(mutex_);
  if (fault_ == Fault::kUnplugged) {
    return;
  }
  ++truth_.commands;
  last_command_ns_ = truth_.t_ns;
  pending_.push_back({truth_.t_ns + delay_ns_, F_H_D});
}

DeviceProfile EmulatedDevice::profile() const {
  return claim_;
}

void EmulatedDevice::SetHand(const HandIntent& intent) {
  const std::scoped_lock lock(mutex_);
  hand_ = intent;
  has_hand_ = true;
}

void EmulatedDevice::ReleaseHand() {
  const std::scoped_lock lock(mutex_);
  hand_ = {};
  has_hand_ = false;
}

void EmulatedDevice::SetFault(Fault fault) {
  const std::scoped_lock lock(mutex_);
  fault_ = fault;
  if (fault == Fault::kUnplugged) {
    pending_.clear();
    truth_.command = {};
  }
}

Fault EmulatedDevice::fault() const {
  const std::scoped_lock lock(mutex_);
  return fault_;
}

void EmulatedDevice::SetDelay(std::int64_t delay_ns) {
  const std::scoped_lock lock(mutex_);
  delay_ns_ = delay_ns;
}

void EmulatedDevice::SetCommandTimeout(std::int64_t timeout_ns) {
  const std::scoped_lock lock(mutex_);
  timeout_ns_ = timeout_ns;
}

void EmulatedDevice::Advance(std::int64_t step_ns) {
  const std::scoped_lock lock(mutex_);
  while (step_ns > 0) {
    while (!pending_.empty() && pending_.front().due_ns <= truth_.t_ns) {
      truth_.command = pending_.front().F_H_D;
      pending_.pop_front();
    }
    if (timeout_ns_ > 0 && truth_.t_ns - last_command_ns_ > timeout_ns_) {
      truth_.command = {};
    }
    const std::int64_t substep_ns = std::min(step_ns, kSubstepNs);
    Step(1e-9 * static_cast<double>(substep_ns));
    truth_.t_ns += substep_ns;
    step_ns -= substep_ns;
    const bool is_silent = fault_ == Fault::kUnplugged || fault_ == Fault::kStalled ||
                           fault_ == Fault::kCalibrationLost;
    if (truth_.t_ns >= next_sample_ns_) {
      next_sample_ns_ += period_ns_;
      if (!is_silent) {
        TakeSample();
      } else if (fault_ == Fault::kCalibrationLost) {
        sample_.t_ns = truth_.t_ns;
        ++sample_.sequence;
      }
    }
  }
}

spatial::Wrench EmulatedDevice::Delivered() const {
  if (fault_ == Fault::kUnplugged || fault_ == Fault::kForceRefused || hand_.is_stopped) {
    return {};
  }
  const double sign = fault_ == Fault::kSignFlipped ? -1 : 1;
  return {sign * LimitNorm(truth_.command.t, profile_.max_torque),
          sign * LimitNorm(truth_.command.f, profile_.max_force)};
}

void EmulatedDevice::Step(double dt) {
  truth_.F_H_D = Delivered();
  double mass = profile_.mass;
  double inertia = profile_.inertia;
  double b = profile_.damping;
  double b_turn = profile_.rotational_damping;
  Vec3 f = truth_.F_H_D.f;
  Vec3 t = truth_.F_H_D.t;
  if (has_hand_) {
    mass += hand_.mass;
    inertia += hand_.inertia;
    b += hand_.damping;
    b_turn += hand_.turn_damping;
    f += hand_.stiffness * (hand_.X_DR.p() - truth_.X_DH.p()) + hand_.damping * hand_.V_DR.v +
         hand_.force;
    t += hand_.turn_stiffness * spatial::RotationBetween(truth_.X_DH.q(), hand_.X_DR.q()) +
         hand_.turn_damping * hand_.V_DR.w;
  }
  // Damping implicitly, then dry friction as an impulse that can at most stop the motion.
  Vec3 v = (truth_.V_DH.v + dt / mass * f) / (1 + dt * b / mass);
  Vec3 w = (truth_.V_DH.w + dt / inertia * t) / (1 + dt * b_turn / inertia);
  v = Slow(v, dt / mass * profile_.friction);
  w = Slow(w, dt / inertia * profile_.rotational_friction);
  truth_.work += dt * truth_.F_H_D.f.dot(v);
  truth_.turning_work += dt * truth_.F_H_D.t.dot(w);
  truth_.V_DH = {w, v};
  truth_.X_DH = spatial::Integrate(truth_.X_DH, truth_.V_DH, dt);
}

void EmulatedDevice::TakeSample() {
  const Vec3 turn =
      Quantise(spatial::RotationVector(truth_.X_DH.q()), profile_.rotation_resolution);
  const spatial::Pose X_DH(spatial::RotationFromVector(turn),
                           Quantise(truth_.X_DH.p(), profile_.position_resolution));
  const spatial::Pose& X_before = history_[history_next_];
  const double window_s = 1e-9 * static_cast<double>(kHistory) * static_cast<double>(period_ns_);
  sample_.V_DH = {spatial::RotationBetween(X_before.q(), X_DH.q()) / window_s,
                  (X_DH.p() - X_before.p()) / window_s};
  history_[history_next_] = X_DH;
  history_next_ = (history_next_ + 1) % kHistory;
  sample_.t_ns = truth_.t_ns;
  ++sample_.sequence;
  sample_.X_DH = X_DH;
  sample_.buttons = hand_.buttons;
  sample_.grip = hand_.grip;
  sample_.is_holding = has_hand_ && hand_.is_holding;
  sample_.is_stopped = hand_.is_stopped;
}

EmulatedDevice::Truth EmulatedDevice::truth() const {
  const std::scoped_lock lock(mutex_);
  return truth_;
}

}  // namespace hvas::device
