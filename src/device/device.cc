#include "device/device.h"

#include <fmt/format.h>

#include "device/force_withdrawal.h"

namespace hvas::device {

Device::~Device() {
  ForgetDevice(this);
}

const char* ToString(Condition condition) noexcept {
  switch (condition) {
    case Condition::kReady:
      return "ready";
    case Condition::kNoForce:
      return "no-force";
    case Condition::kNotHeld:
      return "not-held";
    case Condition::kNotCalibrated:
      return "not-calibrated";
    case Condition::kStale:
      return "stale";
    case Condition::kImplausible:
      return "implausible";
    case Condition::kLost:
      return "lost";
    case Condition::kStopped:
      return "stopped";
    case Condition::kFault:
      return "fault";
  }
  return "unknown";
}

std::string Device::Explain(const DeviceState& state) const {
  const auto words = [&]() -> const char* {
    switch (state.condition) {
      case Condition::kReady:
        return "is ready";
      case Condition::kNoForce:
        return "renders no force at present; release the part and take it again";
      case Condition::kNotHeld:
        return "is not being held; hold its handle";
      case Condition::kNotCalibrated:
        return "has lost its calibration; put its handle into the rest position";
      case Condition::kStale:
        return "has stopped sending; check its cable and the load of the machine";
      case Condition::kImplausible:
        return "reported an implausible pose; it is used again when its poses are steady";
      case Condition::kLost:
        return "is disconnected; connect it again, and it resumes by itself";
      case Condition::kStopped:
        return "is stopped; release its emergency stop";
      case Condition::kFault:
        return "reports a fault; switch it off and on again";
    }
    return "is in an unknown state";
  };
  std::string text =
      fmt::format("{} {}", info().model.empty() ? info().driver : info().model, words());
  if (state.vendor_code != 0) {
    text += fmt::format(" (its own code: {0}, 0x{0:04x})", state.vendor_code);
  }
  return text;
}

}  // namespace hvas::device
