#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "base/ring.h"
#include "simulation/arm.h"
#include "simulation/reaches.h"
#include "simulation/task_operator.h"

namespace hvas::simulation {

/** A hand that knows the planned way of each part and follows it, through the ticks that a person's
 hand goes through: it holds the part by its pose, is as compliant as an arm, feels what the part
 meets, and presses with up to kMostHandForce. It has no eye, no search and no random number, so
 that what comes of it is a statement about the product.

 A part that does not come on although the hand presses as hard as it may is drawn back a little and
 brought on again, kMostTries times in all; then it is held up, and is let go there. RT-safe. */
class GuidedHand final : public TaskOperator {
 public:
  explicit GuidedHand(const spatial::Pose& X_WH);

  /** The arm of a guided hand: that of a person who holds on firmly. */
  [[nodiscard]] static Arm MakeArm();

  bool Assign(const PersonTask& task) noexcept override { return tasks_.TryPush(task); }

  [[nodiscard]] int finished_count() const noexcept override {
    return finished_count_.load(std::memory_order_acquire);
  }

  [[nodiscard]] bool gave_up() const noexcept override { return is_held_up_; }

  [[nodiscard]] std::string DescribeEffort() const override;

  device::DeviceState Step(const OperatorInput& input) noexcept override;

 private:
  enum class Phase : std::uint8_t {
    kIdle,
    kReach,    ///< Empty hand to the part.
    kGrasp,    ///< Closes.
    kCarry,    ///< Around the product to the beginning of the way in.
    kFollow,   ///< Along the way, inward or outward.
    kSettle,   ///< Heard it seat: lets its arm go slack.
    kPutDown,  ///< Carries what it has drawn out to the table.
    kRelease,
  };

  void Begin(Phase phase) noexcept;
  void BeginTask(const PersonTask& task) noexcept;
  void BeginCarry() noexcept;
  void BeginFollow() noexcept;
  void BeginPutDown() noexcept;
  void StepPhase(const OperatorInput& input) noexcept;
  /** Follows the reaches; true when they are done and the hand is there. */
  [[nodiscard]] bool FollowReaches() noexcept;
  /** Corrects the reference so that the part is where the hand means it to be.
   @param error  From the part to there: twist as place and turn.
   @param most  How far it is corrected at most [m]. */
  void Correct(const spatial::Twist& error, double most) noexcept;
  void StepCarry(const OperatorInput& input) noexcept;
  void StepFollow(const OperatorInput& input) noexcept;
  /** Chooses how hard to press by how fast the part comes on. */
  void Press(double speed, double wanted_speed) noexcept;
  /** Moves the reference along the way, ahead of the part by what it presses with. */
  void Advance(double wanted_speed) noexcept;
  /** Whether the part has not come on for a time though the hand presses as hard as it may. */
  [[nodiscard]] bool IsHeldUp() noexcept;
  /** Begins again from a little before where the part is held up, or gives it up there. */
  void TryAgain() noexcept;
  /** Lets the part go where it is held up. */
  void GiveUp() noexcept;
  [[nodiscard]] static bool IsOnWay(const spatial::Twist& error) noexcept;
  /** Along a way that bends: goes on along it while the part keeps up with it, as pieces of it may
   lie close together.
   @param error  From the part to where the hand means it to be. */
  void FollowByPose(const spatial::Twist& error, double speed) noexcept;
  /** Along a straight way or a thread: from where the part is seen to be, as hard as it takes. */
  void FollowByForce(const spatial::Twist& error, double speed) noexcept;
  /** The speed at which the way may be followed where it turns and bends [m/s]; `speed` at most. */
  [[nodiscard]] double LimitOnWay(double speed) const noexcept;
  /** Where the reference is: ahead of the part along its way. */
  [[nodiscard]] spatial::Pose CalcLead() const noexcept;
  /** Sets the reference to a pose of the part, with what was corrected. */
  void Refer(const spatial::Pose& X_WG) noexcept;

  /** Sign of the travel that the hand wants: -1 inward, 1 outward. */
  [[nodiscard]] double Sense() const noexcept {
    return task_.takes_out || is_backing_ ? 1.0 : -1.0;
  }

  Arm arm_;
  /** The reference is ahead of the hand by no more [m]. */
  double most_ahead_{kMostHandForce / arm_.stiffness};
  Phase phase_{Phase::kIdle};
  PersonTask task_;
  Ring<PersonTask> tasks_{4};
  std::atomic<int> finished_count_{0};
  std::atomic<bool> is_held_up_{false};
  std::atomic<double> held_up_at_{0};  ///< Travel [m].

  spatial::Pose X_WH_;
  spatial::Twist V_WH_;
  Vec3 p_ref_;
  Quat q_ref_;
  Vec3 v_ref_{Vec3::Zero()};  ///< [m/s]
  bool is_gripping_{false};
  Vec3 load_W_{Vec3::Zero()};    ///< Force that the part hangs in the hand with [N].
  Vec3 offset_W_{Vec3::Zero()};  ///< Correction of the reference [m].
  Vec3 turn_W_{Vec3::Zero()};    ///< Likewise [rad].
  Reaches reaches_;
  double dt_{1e-3};
  double phase_time_s_{0};
  double travel_{0};   ///< Travel of the reference along the way [m].
  double seen_{0};     ///< Travel of the part [m].
  double speed_{0};    ///< How fast the travel of the part changes, smoothed [m/s].
  double push_{0};     ///< [N]
  double nearest_{0};  ///< Furthest travel in the sense of the motion so far [m].
  double since_nearer_s_{0};
  bool is_backing_{false};
  double back_to_{0};  ///< Travel to which the part is drawn back [m].
  int tries_{0};
};

}  // namespace hvas::simulation
