#include "device/drivers/polled_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "device/drivers/limit_wrench.h"

namespace hvas::device {
namespace {

// Error of a quaternion's length, far above single precision's: a choice.
constexpr double kUnitSlack = 0.01;

}  // namespace

PolledGuard::PolledGuard(const DeviceProfile& profile, const Clock& clock)
    : clock_(clock),
      profile_(profile),
      guard_(profile.position_resolution, profile.rotation_resolution),
      now_ns_(clock.NowNs()),
      before_ns_(now_ns_) {}

std::int64_t PolledGuard::Begin() noexcept {
  before_ns_ = now_ns_;
  now_ns_ = clock_.NowNs();
  return now_ns_;
}

DeviceState PolledGuard::Accept(DeviceState sample) noexcept {
  sample.t_ns = std::max(before_ns_, now_ns_ - SampleGuard::kStaleNs);
  return Remember(guard_.Accept(sample));
}

DeviceState PolledGuard::Repeat() noexcept {
  return Remember(guard_.Repeat(now_ns_));
}

DeviceState PolledGuard::Refuse(Condition condition, std::int32_t vendor_code) noexcept {
  DeviceState state = guard_.Repeat(now_ns_);
  state.V_DH = {};
  state.condition = condition;
  state.vendor_code = vendor_code;
  state.is_valid = false;
  return Remember(state);
}

spatial::Wrench PolledGuard::Permit(const spatial::Wrench& F_H_D) const noexcept {
  return is_ready_ ? LimitWrench(F_H_D, profile_) : spatial::Wrench{};
}

DeviceState PolledGuard::Remember(DeviceState state) noexcept {
  is_ready_ = state.is_valid && state.condition == Condition::kReady;
  return state;
}

spatial::Pose PoseFromWire(const Quat& q, const Vec3& p) noexcept {
  const double norm = q.norm();
  if (std::abs(norm - 1) > kUnitSlack || !std::isfinite(norm)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {Quat(kNan, kNan, kNan, kNan), p};
  }
  return {q.normalized(), p};
}

}  // namespace hvas::device
