#pragma once

#include <map>
#include <memory>
#include <string>

#include "device/driver.h"
#include "device/drivers/reopener.h"
#include "device/sample_guard.h"

namespace hvas::device {

/** What a vendor's code means for the device. */
enum class VendorVerdict : std::uint8_t {
  kFine,           ///< Nothing, or nothing to act on.
  kRefuses,        ///< It gives no force for a while; pause, then ramp back.
  kImplausible,    ///< It does not believe the pose itself.
  kNotCalibrated,  ///< Its pose is not to be trusted.
  kFault,          ///< It reports a fault, and is still there.
  kGone,           ///< Drop it, and open it again.
};

[[nodiscard]] Condition ToCondition(VendorVerdict verdict) noexcept;

/** What a table has for a vendor's code; empty where it is not in it. */
template <typename Code>
[[nodiscard]] std::string WordsOf(const std::map<Code, std::string>& words, Code code) {
  const auto found = words.find(code);
  return found != words.end() ? found->second : "";
}

/** What is alike in the devices of all vendors' libraries: samples go through the guard, force only
 while all is well, ramped back after every pause, faded while samples are missing, within the
 profile; a device that is gone is opened again, off the haptic thread. */
class VendorDevice : public Device, public Reopenable {
 public:
  static constexpr std::int64_t kPauseNs = 100'000'000;  ///< Time without force after a refusal.
  static constexpr std::int64_t kSettleNs =
      20'000'000;                                       ///< Time without force after anything else.
  static constexpr std::int64_t kRampNs = 200'000'000;  ///< Time from no force to all of it.

  [[nodiscard]] const DeviceInfo& info() const noexcept final { return info_; }

  [[nodiscard]] DeviceState Read() noexcept final;
  void Write(const spatial::Wrench& F_H_D) noexcept final;
  [[nodiscard]] std::string Explain(const DeviceState& state) const final;

 protected:
  VendorDevice(DeviceInfo info, const Clock& clock);
  /** What asking the vendor for a sample came to. */
  enum class Reading : std::uint8_t { kNew, kRepeated, kGone };

  /** Fills in all but the time; `condition` as the vendor has it. RT-safe but for the vendor. */
  virtual Reading ReadVendor(DeviceState* sample) noexcept = 0;
  /** A wrench within the profile, finite. RT-safe but for the vendor. */
  virtual void WriteVendor(const spatial::Wrench& F_H_D) noexcept = 0;
  /** A vendor's code in words, or empty. */
  [[nodiscard]] virtual std::string ExplainCode(std::int32_t code) const = 0;

  /** Destructors call it first: from then on nobody else opens the device. */
  void StopReopening() { reopener_.reset(); }

  [[nodiscard]] std::int64_t NowNs() const noexcept { return clock_.NowNs(); }

 private:
  DeviceInfo info_;
  const Clock& clock_;
  SampleGuard guard_;
  DeviceState state_;
  std::int64_t last_new_ns_;    ///< When the last sample came.
  std::int64_t force_from_ns_;  ///< When force begins to come back.
  std::unique_ptr<Reopener> reopener_;
};

/** The profile of a model, or of the weakest device of the driver where the model is not known;
 which one it was, in words, goes to `note`. */
[[nodiscard]] DeviceProfile ProfileOfModel(std::string_view driver, const std::string& model,
                                           std::string_view otherwise, std::string* note);

}  // namespace hvas::device
