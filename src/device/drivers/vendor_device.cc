#include "device/drivers/vendor_device.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "device/drivers/limit_wrench.h"

namespace hvas::device {
namespace {

// While samples are missing the force fades, before the device counts as stale.
constexpr std::int64_t kFadeFromNs = 2'000'000;
constexpr std::int64_t kFadedNs = 4'000'000;

double ShareBetween(std::int64_t t_ns, std::int64_t from_ns, std::int64_t to_ns) noexcept {
  const double share = static_cast<double>(t_ns - from_ns) / static_cast<double>(to_ns - from_ns);
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace

Condition ToCondition(VendorVerdict verdict) noexcept {
  switch (verdict) {
    case VendorVerdict::kFine:
      return Condition::kReady;
    case VendorVerdict::kRefuses:
      return Condition::kNoForce;
    case VendorVerdict::kImplausible:
      return Condition::kImplausible;
    case VendorVerdict::kNotCalibrated:
      return Condition::kNotCalibrated;
    case VendorVerdict::kFault:
      return Condition::kFault;
    case VendorVerdict::kGone:
      return Condition::kLost;
  }
  return Condition::kFault;
}

DeviceProfile ProfileOfModel(std::string_view driver, const std::string& model,
                             std::string_view otherwise, std::string* note) {
  const SourcedProfile* known = FindProfileOfModel(driver, model);
  *note =
      known != nullptr
          ? fmt::format("figures of {}", known->profile.name)
          : fmt::format("the model \"{}\" is not known; limits of the weakest known model are used",
                        model);
  return known != nullptr ? known->profile : FindProfile(otherwise)->profile;
}

VendorDevice::VendorDevice(DeviceInfo info, const Clock& clock)
    : info_(std::move(info)),
      clock_(clock),
      guard_(info_.profile.position_resolution, info_.profile.rotation_resolution),
      last_new_ns_(clock.NowNs()),
      force_from_ns_(clock.NowNs()),
      reopener_(std::make_unique<Reopener>(this, clock)) {
  state_.condition = Condition::kStale;
  state_.is_valid = false;
}

DeviceState VendorDevice::Read() noexcept {
  const std::int64_t now_ns = NowNs();
  DeviceState sample;
  sample.t_ns = now_ns;
  const bool is_open = reopener_->IsThere();
  const Reading reading = is_open ? ReadVendor(&sample) : Reading::kGone;
  if (reading == Reading::kNew) {
    last_new_ns_ = now_ns;
    state_ = guard_.Accept(sample);
  } else {
    state_ = guard_.Repeat(now_ns);
  }
  if (reading == Reading::kGone) {
    state_.condition = Condition::kLost;
    state_.is_valid = false;
    state_.vendor_code = is_open ? sample.vendor_code : state_.vendor_code;
    if (is_open) {
      reopener_->Lose();
    }
  }
  state_.t_ns = now_ns;
  state_.sample_ns = last_new_ns_;
  if (state_.condition != Condition::kReady) {
    force_from_ns_ = now_ns + (state_.condition == Condition::kNoForce ? kPauseNs : kSettleNs);
  } else if (now_ns < force_from_ns_) {
    state_.condition = Condition::kNoForce;
  }
  return state_;
}

void VendorDevice::Write(const spatial::Wrench& F_H_D) noexcept {
  if (!reopener_->IsThere()) {
    return;
  }
  spatial::Wrench F;
  if (state_.condition == Condition::kReady) {
    F = LimitWrench(F_H_D, info_.profile);
    const std::int64_t now_ns = NowNs();
    const std::int64_t age_ns = now_ns - last_new_ns_;
    const double share = ShareBetween(now_ns, force_from_ns_, force_from_ns_ + kRampNs) *
                         (1 - ShareBetween(age_ns, kFadeFromNs, kFadedNs));
    F.f *= share;
    F.t *= share;
  }
  WriteVendor(F);
}

std::string VendorDevice::Explain(const DeviceState& state) const {
  const std::string words = state.vendor_code != 0 ? ExplainCode(state.vendor_code) : "";
  return Device::Explain(state) + (words.empty() ? "" : ": " + words);
}

}  // namespace hvas::device
