#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "device/device.h"
#include "device/sample_guard.h"
#include "haptics/buzz_detector.h"
#include "haptics/kick_detector.h"
#include "haptics/thermal_limit.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** What the device may be given, and when it is given less. SI. What is off by default is what a
 simulated device does not need; `MakeSafetyLimits` has the limits of a real one. */
struct SafetyLimits {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double max_force{7.0};       ///< [N]
  double max_torque{0.4};      ///< [N m]
  double max_force_rate{400};  ///< [N/s]; 0.4 N in a millisecond.
  double max_torque_rate{20};  ///< [N m/s]

  double continuous_force{kNever};   ///< That the motors stand for ever [N].
  double continuous_torque{kNever};  ///< [N m]
  double thermal_time{1};            ///< Time over which the mean square is taken [s].

  double soft_start_time{0};          ///< Time in which the limits grow to their full size [s].
  double engage_force_rate{kNever};   ///< The force grows no faster meanwhile [N/s].
  double engage_torque_rate{kNever};  ///< [N m/s]
  double cut_time{0};                 ///< A cut is done within this [s]; 0: the rates hold.
  double fade_speed{kNever};          ///< Speed of the hand beyond which the force fades [m/s].
  double cut_speed{kNever};           ///< Speed at which it is zero.
  double model_hold{kNever};          ///< A model of up to this age is good [s].
  double model_fade{0.05};            ///< Then the force goes to zero in so long.
  double client_hold{kNever};         ///< Age of the client's last word at which the force goes.
  double client_fade{0.05};           ///< Time in which it then goes to zero.
  bool has_detectors{false};          ///< Detection of kicks and buzzing.
  KickThresholds kick{};
  BuzzThresholds buzz{};
  BuzzThresholds turn_buzz{0.6, 0.02, 0.16};
};

/** Limits for a real device. */
[[nodiscard]] SafetyLimits MakeSafetyLimits(const device::DeviceProfile& profile) noexcept;

/** Why the gate changed a wrench; a bit mask. Records hold it: a value is never used again. */
enum GateAction : std::uint32_t {
  kGatePassed = 0,
  kGateNotFinite = 1u << 0,   ///< NaN or infinity came in: decays to zero.
  kGateMagnitude = 1u << 1,   ///< Norm limited, direction kept.
  kGateRate = 1u << 2,        ///< Change limited.
  kGateThermal = 1u << 3,     ///< Norm limited, as the motors are warm.
  kGateSoftStart = 1u << 4,   ///< Limited after a grasp, a capture or an interruption.
  kGateSpeed = 1u << 5,       ///< The hand is too fast: fades.
  kGateLateModel = 1u << 6,   ///< The model that the wrench is from is old: decays.
  kGateLostClient = 1u << 7,  ///< The client has gone silent: held, then decays.
  kGateNoDevice = 1u << 8,    ///< The device's state is not valid: cut.
  kGateNotHeld = 1u << 9,     ///< The dead-man switch is open: cut.
  kGateStopped = 1u << 10,    ///< The emergency stop is pressed: cut.
  kGateBuzz = 1u << 11,       ///< The handle buzzed: cut until the hand takes anew.
  kGateKick = 1u << 12,       ///< The handle kicked: cut until the hand takes anew.
  kGateStalled = 1u << 13,    ///< Nothing was written for too long: starts from zero.
};

inline constexpr std::array kGateActions{
    kGateNotFinite, kGateMagnitude, kGateRate,       kGateThermal,  kGateSoftStart,
    kGateSpeed,     kGateLateModel, kGateLostClient, kGateNoDevice, kGateNotHeld,
    kGateStopped,   kGateBuzz,      kGateKick,       kGateStalled};

/** The reason in words, for one action. RT-safe. */
[[nodiscard]] const char* ToString(GateAction action) noexcept;

/** Actions of a mask, each an event of its own. */
struct GateActionList {
  std::array<GateAction, kGateActions.size()> actions{};
  std::size_t count{0};

  [[nodiscard]] const GateAction* begin() const noexcept { return actions.data(); }

  [[nodiscard]] const GateAction* end() const noexcept { return actions.data() + count; }
};

/** Those that began with this tick. RT-safe. */
[[nodiscard]] GateActionList ListNewActions(std::uint32_t before, std::uint32_t now) noexcept;

/** All that the gate wants to know of a tick. Poses, twists and wrenches are of the hand, about its
 point, all in one frame that does not turn, lengths as the device has them. */
struct GateInput {
  spatial::Wrench F;  ///< That the hand is to be given.
  Vec3 p{Vec3::Zero()};
  spatial::Twist V;
  double dt{0};  ///< Since the last tick [s].
  /** Since the last sample [s]; 0: the device has none that is new; negative: as dt. */
  double sample_dt{-1};
  bool is_valid{true};      ///< The device has a live pose.
  bool is_held{true};       ///< The dead-man or presence switch is closed, or there is none.
  bool is_stopped{false};   ///< An emergency stop, of the device or in software.
  bool is_gripping{true};   ///< The hand holds on to a part: opening this ends a latch.
  bool has_engaged{false};  ///< A part was taken or a mate captured in this tick.
  double model_age{0};      ///< Age of what F was computed from [s].
  double client_age{0};     ///< Since whoever asks for F was last heard of [s].
  /** Time since the last write to the device, by the clock of the loop (WritePace) [ns]; 0: there
   was none, or none that counts. Negative: nobody knows. */
  std::int64_t since_write_ns{0};
};

/** What the gate is told of a device's state and of the wrench that the device is to be given. A
 device that shows no force has none that could be accounted for, and starts softly after.
 @param dt  Since the last tick [s].
 @param last_sample_ns  When the sample before this one was taken, kept by the caller. RT-safe. */
[[nodiscard]] GateInput MakeGateInput(const device::DeviceState& state,
                                      const spatial::Wrench& F_H_D, double dt,
                                      std::int64_t* last_sample_ns) noexcept;

/** The last thing before every device write (N6). What goes out is finite and within its limits in
 norm and in rate, and goes to zero when something is wrong; docs/algorithms/stability.md. Keeps the
 last wrench that it let through. RT-safe. */
class SafetyGate {
 public:
  explicit SafetyGate(const SafetyLimits& limits) noexcept;

  /** Whether a device was without a write for so long that it has let go of its force, as drivers
   (device::ForceHold) and the vendors' watchdogs do after device::kAgeHeldNs: what is written then
   finds a hand that feels nothing. Also where the clock went back. */
  [[nodiscard]] static constexpr bool IsStall(std::int64_t since_write_ns) noexcept {
    return since_write_ns < 0 || since_write_ns > device::kAgeHeldNs;
  }

  /** Returns the wrench that may go to the device. Never not finite, never beyond the limits. */
  [[nodiscard]] spatial::Wrench Pass(const GateInput& input) noexcept;

  /** Passes a wrench where nothing else is known. */
  [[nodiscard]] spatial::Wrench Pass(const spatial::Wrench& F_W, double dt) noexcept;

  /** What the last Pass had to do. */
  [[nodiscard]] std::uint32_t actions() const noexcept { return actions_; }

  /** A kick or a buzz has cut the force until the hand opens and takes anew. */
  [[nodiscard]] bool is_latched() const noexcept { return latch_ != kGatePassed; }

  [[nodiscard]] const SafetyLimits& limits() const noexcept { return limits_; }

 private:
  /** The part of the limits that force and torque have apart. */
  struct Channel {
    double peak;
    double rate;
    double engage_rate;
    ThermalLimit thermal;
    double start_limit;  ///< Limit with which the soft start begins.
    double cut_from;     ///< Norm when the cut began.
    Vec3 last{Vec3::Zero()};
  };

  void Restart() noexcept;
  static Channel MakeChannel(double peak, double rate, double engage_rate, double continuous,
                             double thermal_time) noexcept;
  void Watch(const GateInput& input) noexcept;
  [[nodiscard]] std::uint32_t FindCuts(const GateInput& input) const noexcept;
  [[nodiscard]] double CalcShare(const GateInput& input) noexcept;
  void UpdateStart(const GateInput& input, bool is_interrupted, double dt) noexcept;
  [[nodiscard]] double CalcLimit(const Channel& channel, std::uint32_t* why) const noexcept;
  void Advance(const Vec3& wanted, double dt, Channel* channel) noexcept;

  SafetyLimits limits_;
  Channel force_;
  Channel torque_;
  BuzzDetector buzz_;
  BuzzDetector turn_buzz_;
  KickDetector kick_;
  std::uint32_t latch_{kGatePassed};
  bool has_opened_{false};     ///< Since it latched.
  bool is_interrupted_{true};  ///< Nothing went out in the last tick, for a reason.
  bool is_cut_{false};
  double start_progress_{1};  ///< Progress of the soft start, 0..1.
  std::uint32_t actions_{kGatePassed};
};

}  // namespace hvas::haptics
