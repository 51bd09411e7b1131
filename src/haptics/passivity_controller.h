#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "device/profile.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** How a passivity channel (forces and displacements, or torques and turns) behaves. SI. */
struct PassivityLimits {
  static constexpr double kAtOnce = std::numeric_limits<double>::infinity();

  double max_force{7.9};    ///< [N] or [N m]
  double max_damping{4};    ///< That the controller may add [N s/m] or [N m s/rad].
  double min_speed{5e-3};   ///< Slower motions are taken for this fast when damped [m/s], [rad/s].
  double reserve{5e-3};     ///< Energy that may go out beyond what came in [J].
  double acceleration{50};  ///< The hand speeds up no faster [m/s^2] or [rad/s^2].
  double rate{kAtOnce};     ///< The gate takes a force back no faster [N/s] or [N m/s].
  double longest_tick{1.5e-3};  ///< No tick takes longer [s].
  int delay{0};                 ///< A wrench acts so many ticks after it was written.
  double window{0.5};           ///< Dissipation older than this is forgotten [s].
};

/** Where energy went [J]. The first four only grow. */
struct PassivityAccount {
  double in{0};         ///< Energy from the hand.
  double out{0};        ///< Energy to the hand.
  double credited{0};   ///< Owed to it.
  double forgotten{0};  ///< Old dissipation, no licence any more.
  double withheld{0};  ///< That the wanted force would have given beyond what the written one gave.
};

/** Time-domain passivity observer and controller of one kind of motion. See PassivityController.
 RT-safe. */
class PassivityChannel {
 public:
  static constexpr int kMaxDelay = 30;  ///< Longer ones are taken for this [ticks].

  explicit PassivityChannel(const PassivityLimits& limits) noexcept;

  /** Accounts for the last tick, and returns the force that may follow.
   @param moved   Of the hand since the last tick.
   @param force   That it should be given.
   @param stored  Of the energy that came in, what the environment still holds, as in springs; NaN
   where that is not known: then nothing is forgotten.
   @param dt      Since the last tick [s]. */
  [[nodiscard]] Vec3 Limit(const Vec3& moved, const Vec3& force, double stored, double dt) noexcept;

  /** What was written in the end; once after each Limit or Lose. */
  void Write(const Vec3& force) noexcept;

  /** There is no position in this tick. What the forces do meanwhile is charged for once there is
   one again, by the worst that they can have done. */
  void Lose() noexcept;

  void AddCredit(double energy) noexcept;

  void Reset() noexcept { *this = PassivityChannel(limits_); }

  /** The device has let go of all that was written: it does no work any more. */
  void ForgetWritten() noexcept;

  /** What came in, less what went out and was forgotten, and what is owed [J]. Never below minus
   the reserve by more than the bound in docs/algorithms/stability.md. */
  [[nodiscard]] double energy() const noexcept { return energy_; }

  [[nodiscard]] const PassivityAccount& account() const noexcept { return account_; }

  /** The last Limit changed the force. */
  [[nodiscard]] bool is_active() const noexcept { return is_active_; }

  [[nodiscard]] const PassivityLimits& limits() const noexcept { return limits_; }

 private:
  /** The window forgets a 32nd of itself at once: a choice. */
  static constexpr std::size_t kBuckets = 32;
  static constexpr std::size_t kHistory =
      kMaxDelay + 2;  ///< Forces of the delay, the last and the next.

  struct Given {
    Vec3 written{Vec3::Zero()};
    Vec3 wanted{Vec3::Zero()};
  };

  [[nodiscard]] const Given& FindGiven(int ticks_ago) const noexcept;
  void Observe(const Vec3& moved) noexcept;
  void Forget(double stored, double dt) noexcept;
  [[nodiscard]] Vec3 Damp(const Vec3& force, double dt) const noexcept;
  [[nodiscard]] Vec3 Bound(const Vec3& force) const noexcept;

  PassivityLimits limits_;
  double energy_{0};
  PassivityAccount account_;
  Vec3 v_{Vec3::Zero()};
  Vec3 moved_{Vec3::Zero()};           ///< Displacement in the last tick.
  std::array<Given, kHistory> given_;  ///< Ring; the newest is before `next_`.
  std::size_t next_{0};
  Vec3 wanted_{Vec3::Zero()};
  bool is_active_{false};
  bool is_lost_{false};
  double lost_force_{0};  ///< Largest that acted while there was no position.

  std::array<double, kBuckets>
      dissipation_{};  ///< Dissipation in each stretch of the window; a ring.
  std::size_t bucket_{0};
  double bucket_time_{0};
  double dissipated_{0};  ///< Total, as of the last tick.
};

/** Passivity observer and controller of one device, translation and rotation apart (Hannaford and
 Ryu, IEEE Trans. Robotics and Automation 18, 2002; with limits as in Stanford's SAI 2):

     E_k = E_(k-1) - F_(k-1-d) . (x_k - x_(k-1))

 with the force that really acted, d ticks after it was written, in device coordinates. Where E_k,
 less what is on its way and what F_k would do, falls below zero, F_k is damped; where the device
 cannot damp so much, F_k loses what drives; and no force is so large that it can overdraw the
 reserve before the next sample shows it. RT-safe. */
class PassivityController {
 public:
  PassivityController(const PassivityLimits& force, const PassivityLimits& torque) noexcept;

  /** One tick, before the safety gate.
   @param X_DH  The hand as the device has it; not finite: there is none.
   @param F_H_D  Wanted, about the hand's point, in D.
   @param stored  What of the energy that came in is still held, by motion and turning [J]; NaN:
   not known. */
  [[nodiscard]] spatial::Wrench Limit(const spatial::Pose& X_DH, const spatial::Wrench& F_H_D,
                                      double stored, double stored_turning, double dt) noexcept;

  /** What the device was given in the end, after the gate; once after each Limit. */
  void Write(const spatial::Wrench& F_H_D) noexcept;

  /** Energy that the hand is owed besides: of a weight that it lifts down, of an attraction. */
  void AddCredit(double energy) noexcept { force_.AddCredit(energy); }

  void AddTurningCredit(double energy) noexcept { torque_.AddCredit(energy); }

  /** A device was opened, or a part taken anew: the account starts at zero. */
  void Reset() noexcept;

  /** Nothing was written for so long that the device has let go (SafetyGate::IsStall): where the
   hand went meanwhile is nobody's work, and no speed. To be called before Limit. */
  void ForgetWritten() noexcept;

  [[nodiscard]] const PassivityChannel& force() const noexcept { return force_; }

  [[nodiscard]] const PassivityChannel& torque() const noexcept { return torque_; }

 private:
  PassivityChannel force_;
  PassivityChannel torque_;
  spatial::Pose X_DH_;
  bool has_pose_{false};
};

/** Delay of a device in ticks of dt [s], rounded up; it may be above PassivityChannel::kMaxDelay.
 */
[[nodiscard]] double CalcDelayTicks(const device::DeviceProfile& profile, double dt) noexcept;

/** Makes the controller of a device whose tick takes dt. */
[[nodiscard]] PassivityController MakePassivityController(const device::DeviceProfile& profile,
                                                          double dt) noexcept;

}  // namespace hvas::haptics
