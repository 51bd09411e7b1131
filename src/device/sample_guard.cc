#include "device/sample_guard.h"

#include <algorithm>
#include <cmath>

namespace hvas::device {
namespace {

// What came of a sample fades in so long after kAgeHeldNs. A choice, as the vendors' threads hold a
// wrench (docs/realtime.md).
constexpr std::int64_t kAgeDecayNs = 50'000'000;
constexpr double kVelocityFade = 0.7;  // a tick, while there is no new sample

bool IsFinite(const DeviceState& sample) noexcept {
  return spatial::IsFinite(sample.X_DH) && sample.V_DH.w.allFinite() && sample.V_DH.v.allFinite();
}

}  // namespace

double ShareOfAge(std::int64_t age_ns) noexcept {
  const double decayed =
      static_cast<double>(age_ns - kAgeHeldNs) / static_cast<double>(kAgeDecayNs);
  return std::clamp(1 - decayed, 0.0, 1.0);
}

double ForceHold::CalcShare(std::int64_t given_ns, std::int64_t now_ns) noexcept {
  if (now_ns < shown_ns_ || now_ns - shown_ns_ > kAgeHeldNs) {
    valid_ns_ = now_ns;
  }
  shown_ns_ = now_ns;
  return given_ns < valid_ns_ ? 0 : ShareOfAge(now_ns - given_ns);
}

DeviceState SampleGuard::Accept(const DeviceState& sample) noexcept {
  constexpr double kClosed = 0.5;  // Half of a grip's way.
  DeviceState state = sample;
  state.is_gripping = (sample.buttons & 1U) != 0 || sample.grip > kClosed;
  state.is_clutching = (sample.buttons & 2U) != 0;
  if (!IsFinite(sample)) {
    state.X_DH = last_.X_DH;
    state.V_DH = {};
    state.condition = Condition::kImplausible;
    is_settling_ = true;
    settled_ns_ = sample.t_ns + kSettleNs;
  } else {
    if (has_last_) {
      const double dt_s =
          1e-9 * static_cast<double>(std::max<std::int64_t>(sample.t_ns - last_.t_ns, 1'000'000));
      const double step = (sample.X_DH.p() - last_.X_DH.p()).norm();
      const double turn = spatial::RotationBetween(last_.X_DH.q(), sample.X_DH.q()).norm();
      const bool is_jump =
          step > kMaxSpeed * dt_s + slack_ || turn > kMaxTurnRate * dt_s + turn_slack_;
      if (is_jump) {
        is_settling_ = true;
        settled_ns_ = sample.t_ns + kSettleNs;
      }
    }
    last_ = state;
    has_last_ = true;
    is_settling_ = is_settling_ && sample.t_ns < settled_ns_;
    if (is_settling_ && state.condition == Condition::kReady) {
      state.condition = Condition::kImplausible;
    }
  }
  const bool has_pose = state.condition == Condition::kReady ||
                        state.condition == Condition::kNoForce ||
                        state.condition == Condition::kNotHeld;
  state.is_valid = sample.is_valid && has_pose;
  return state;
}

DeviceState SampleGuard::Repeat(std::int64_t now_ns) noexcept {
  const bool is_stale = !has_last_ || now_ns - last_.t_ns > kStaleNs;
  last_.V_DH.v *= kVelocityFade;
  last_.V_DH.w *= kVelocityFade;
  DeviceState state = last_;
  if (is_stale) {
    state.condition = Condition::kStale;
    state.V_DH = {};
    state.is_valid = false;
  } else if (is_settling_) {
    state.condition = Condition::kImplausible;
    state.is_valid = false;
  }
  return state;
}

}  // namespace hvas::device
