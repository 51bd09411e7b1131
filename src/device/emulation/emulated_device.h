#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>

#include "device/profile.h"
#include "spatial/pose.h"

namespace hvas::device {

/** What can go wrong with a device, on demand. */
enum class Fault : std::uint8_t {
  kNone,
  kUnplugged,        ///< Gone: no samples, no force; back when the fault ends.
  kStalled,          ///< Sends no new samples; what it is given still gets through.
  kNotANumber,       ///< Its samples are NaN.
  kJump,             ///< Its pose is suddenly 80 mm beside the hand's.
  kCalibrationLost,  ///< Its pose is frozen, and it says that it is not calibrated.
  kForceRefused,     ///< Its motors are off, and it says so.
  kSignFlipped,      ///< It pushes the other way.
};

inline constexpr std::array kFaults{
    Fault::kUnplugged,       Fault::kStalled,      Fault::kNotANumber, Fault::kJump,
    Fault::kCalibrationLost, Fault::kForceRefused, Fault::kSignFlipped};

[[nodiscard]] const char* ToString(Fault fault) noexcept;

/** What the hand wants, as an impedance between it and the handle that it holds: it pulls the
 handle towards R. Human arm: Tsuji et al., Biological Cybernetics 72, 1995. */
struct HandIntent {
  spatial::Pose X_DR;
  spatial::Twist V_DR;
  double stiffness{400};     ///< [N/m]
  double damping{25};        ///< [N s/m]
  double mass{0.8};          ///< [kg]
  double turn_stiffness{6};  ///< [N m/rad]
  double turn_damping{0.2};  ///< [N m s/rad]
  double inertia{3e-3};      ///< [kg m^2]
  Vec3 force{Vec3::Zero()};  ///< Besides, on the handle [N].
  std::uint32_t buttons{0};
  double grip{0};          ///< 0 open .. 1 closed.
  bool is_holding{true};   ///< What a presence switch sees.
  bool is_stopped{false};  ///< The emergency stop is pressed.
};

/** What the encoders and switches of an emulated device say. */
struct EmulatedSample {
  std::int64_t t_ns{0};       ///< Time of the sample, on the emulator's clock.
  std::uint64_t sequence{0};  ///< Grows with every new sample.
  spatial::Pose X_DH;         ///< Pose that the encoders have quantised.
  spatial::Twist V_DH;        ///< Twist from differences of that over 8 samples.
  std::uint32_t buttons{0};
  double grip{0};
  bool is_holding{true};
  bool is_stopped{false};
  Fault fault{Fault::kNone};  ///< That the vendor's software would know of.
};

/** How a vendor's interface (a stub library, a server) reaches the emulated device behind it.
 Any thread. */
class EmulatedPort {
 public:
  EmulatedPort() = default;
  EmulatedPort(const EmulatedPort&) = delete;
  EmulatedPort& operator=(const EmulatedPort&) = delete;
  virtual ~EmulatedPort() = default;

  [[nodiscard]] virtual EmulatedSample Sense() const = 0;
  virtual void Command(const spatial::Wrench& F_H_D) = 0;
  /** What the device says of itself. */
  [[nodiscard]] virtual DeviceProfile profile() const = 0;
};

/** A device and the hand that holds it, as one physical model: the mass, viscous and dry friction
 of the mechanism, motors with limits, encoders with steps, the hand as an impedance; all of the
 mechanism's figures are those of a profile. Time is moved on by the owner. Every public function
 may be called from any thread; it is not RT-safe. */
class EmulatedDevice final : public EmulatedPort {
 public:
  /** @param claim  What it says of itself. */
  EmulatedDevice(const DeviceProfile& profile, const spatial::Pose& X_DH,
                 const DeviceProfile& claim);

  explicit EmulatedDevice(const DeviceProfile& profile, const spatial::Pose& X_DH = {})
      : EmulatedDevice(profile, X_DH, profile) {}

  // The vendor's side.
  [[nodiscard]] EmulatedSample Sense() const override;
  void Command(const spatial::Wrench& F_H_D) override;
  [[nodiscard]] DeviceProfile profile() const override;

  // The hand's side.
  void SetHand(const HandIntent& intent);
  /** Lets go of the handle: only the mechanism is left. */
  void ReleaseHand();

  // The tester's side.
  void SetFault(Fault fault);
  [[nodiscard]] Fault fault() const;
  /** Everything that is commanded takes so much longer to arrive [ns]. */
  void SetDelay(std::int64_t delay_ns);
  /** How long motors may be without a command until they go slack, as a vendor's own watchdog does
   [ns]; 0: never. */
  void SetCommandTimeout(std::int64_t timeout_ns);

  /** Moves time on, in steps of at most 0.1 ms; there is a sample every period of the profile's
   rate. */
  void Advance(std::int64_t step_ns);

  /** What is true now, whatever the device says. */
  struct Truth {
    std::int64_t t_ns{0};
    spatial::Pose X_DH;
    spatial::Twist V_DH;
    spatial::Wrench F_H_D;      ///< That the motors give.
    spatial::Wrench command;    ///< That they were given last (after the delay).
    double work{0};             ///< Work of the motors' forces on the hand since the start [J].
    double turning_work{0};     ///< Work of their torques [J].
    std::uint64_t commands{0};  ///< That arrived.
  };

  [[nodiscard]] Truth truth() const;

 private:
  void Step(double dt);
  void TakeSample();
  [[nodiscard]] spatial::Wrench Delivered() const;

  struct Pending {
    std::int64_t due_ns;
    spatial::Wrench F_H_D;
  };

  static constexpr std::size_t kHistory = 8;  ///< Poses that are kept, for the delay of a profile.

  mutable std::mutex mutex_;
  DeviceProfile profile_;
  DeviceProfile claim_;
  std::int64_t period_ns_;
  HandIntent hand_;
  bool has_hand_{false};
  Fault fault_{Fault::kNone};
  std::int64_t delay_ns_{0};
  std::int64_t timeout_ns_{0};
  std::int64_t last_command_ns_{0};
  std::deque<Pending> pending_;
  Truth truth_;
  EmulatedSample sample_;
  std::int64_t next_sample_ns_{0};
  std::array<spatial::Pose, kHistory> history_;
  std::size_t history_next_{0};
};

}  // namespace hvas::device
