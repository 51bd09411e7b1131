#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "device/profile.h"
#include "spatial/pose.h"

namespace hvas::device {

/** How a device is, and why its force is what it is. In all but kReady the wrench is zero or on its
 way there. */
enum class Condition : std::uint8_t {
  kReady,          ///< Its pose is live, and it shows what it is given.
  kNoForce,        ///< Its pose is live, but it shows no force now: off, refused or recovering.
  kNotHeld,        ///< Its dead-man or presence switch says that nobody holds it.
  kNotCalibrated,  ///< Its pose is not to be trusted.
  kStale,          ///< No new sample for too long.
  kImplausible,    ///< Its sample was not finite, or a jump that no hand makes.
  kLost,           ///< Unplugged, or its connection is gone; the driver keeps trying.
  kStopped,        ///< Its emergency stop is pressed.
  kFault,          ///< It reports a fault of its own.
};

[[nodiscard]] const char* ToString(Condition condition) noexcept;

/** Something is wrong with it, and not just idle. */
[[nodiscard]] constexpr bool IsFault(Condition condition) noexcept {
  return condition != Condition::kReady && condition != Condition::kNotHeld;
}

/** One sample from a device: the hand H in the device's base frame. */
struct DeviceState {
  std::int64_t t_ns{0};
  /** When the device took it, by the clock of its driver; 0: together with the tick. The same as
   before: it is the last one again. */
  std::int64_t sample_ns{0};
  spatial::Pose X_DH;
  spatial::Twist V_DH;       ///< Twist of H in D, expressed in D.
  bool is_gripping{false};   ///< The button or grip that holds a part.
  bool is_valid{true};       ///< False where the device has no pose: the wrench decays to zero.
  bool is_clutching{false};  ///< The button that moves the workspace instead of the part.
  std::uint32_t buttons{0};  ///< Bit 0 is the first one.
  double grip{std::numeric_limits<double>::quiet_NaN()};  ///< 0 open .. 1 closed; NaN: has none.
  Condition condition{Condition::kReady};
  std::int32_t vendor_code{0};  ///< What the device's own software said last; 0: nothing.
  /** How long ago whoever steers it from afar was last heard of; 0 for what is at hand. */
  std::int64_t client_age_ns{0};
};

/** What a device has. What is not here it cannot do, and whoever renders to it must cope. */
struct Capabilities {
  int force_axes{0};           ///< 0 or 3.
  int torque_axes{0};          ///< 0 or 3.
  bool senses_position{true};  ///< False: deflections, that a pose is integrated from.
  bool senses_rotation{false};
  bool has_grip{false};    ///< A gripper with a position.
  bool can_rumble{false};  ///< Shows how strong a force is, not where to.
  bool has_presence_switch{false};
  bool has_emergency_stop{false};
  int button_count{0};
};

struct DeviceInfo {
  std::string driver;   ///< Name in the list of drivers.
  std::string address;  ///< That opens this one again, with or without the driver's name before it.
  std::string model;
  std::string serial;
  std::string version;  ///< Version of the vendor's software.
  bool is_emulated{false};
  Capabilities capabilities;
  DeviceProfile profile;     ///< What the device tells about itself, and what is known otherwise.
  std::string profile_note;  ///< What of it was read from the device, in words.
};

/** A device that is open. Read and Write belong to one thread, in turn, once a tick; both are
 RT-safe as far as HVAS's own code goes. A wrench is never older than the Write before last, and a
 device whose Write is not called any more is given zero. The destructor gives it zero and lets
 go. */
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device();

  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  /** The newest sample. Always returns; `condition` tells what to think of it. */
  [[nodiscard]] virtual DeviceState Read() noexcept = 0;

  /** The wrench on the hand about its point, in D [N m, N]. It has passed the safety gate. */
  virtual void Write(const spatial::Wrench& F_H_D) noexcept = 0;

  /** A state's condition and vendor code in words, with what to do about it. Not RT-safe. */
  [[nodiscard]] virtual std::string Explain(const DeviceState& state) const;
};

}  // namespace hvas::device
