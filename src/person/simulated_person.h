#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "base/random.h"
#include "base/ring.h"
#include "simulation/arm.h"
#include "simulation/operator.h"
#include "simulation/person_task.h"
#include "simulation/reaches.h"
#include "simulation/task_operator.h"

namespace hvas::person {

/** An arm and its habits. Values of the arm are of the order published for hands that hold a haptic
 device or keep a posture: Dolan, Friedman and Nagurka, IEEE Trans. SMC 23(3), 1993; Tsuji et al.,
 Biological Cybernetics 72, 1995; Fu and Cavusoglu, IEEE Trans. SMC B 42(6), 2012. Where each value
 comes from, and which are choices: docs/algorithms/simulated_person.md. */
struct PersonOptions : simulation::Arm {
  double carry_speed{0.45};       ///< Mean speed of a reach [m/s].
  double approach_speed{0.15};    ///< Towards the place [m/s].
  double insert_speed{0.04};      ///< [m/s]
  double aim_error{0.7e-3};       ///< Standard deviation of where the hand believes to be [m].
  double aim_error_angle{0.015};  ///< Error of how it is turned [rad].
  double eye_error{0.2e-3};       ///< Error where it looks closely at the part on the screen [m].
  double eye_error_angle{4e-3};   ///< [rad]
  double tremor{0.05e-3};         ///< Physiological tremor, 8..12 Hz, amplitude [m].
  double push_limit{6.8};         ///< Felt force beyond which it does not press harder [N].
  double unguided_limit{6.8};  ///< Push while no mate guides the part: nothing has to give way [N].
  double first_push{4.0};      ///< What it tries first [N].
  double careful_push{2.0};    ///< Largest push once it has missed and looks closely [N].
  double light_push{0.8};      ///< Tips nothing over [N].
  double push_rate{6};         ///< How fast it presses harder [N/s].
  double most_stretch{0.012};  ///< The hand goes no further than the part it holds [m].
  double patience_s{25};       ///< Time spent on one part, from the beginning of insertion [s].
  /** The wrist gives way to what it feels; without, it holds on to what it aims at, as a stiff
   arm of a robot does. */
  bool gives_way{true};
};

/** Ways to work. */
enum class PersonKind : std::uint8_t {
  kCareful,  ///< That of PersonOptions.
  kHasty,    ///< Three times as fast on the way in, and presses as hard as it may at once.
  kStiff,    ///< Careful, but gives way to nothing.
};

[[nodiscard]] const char* ToString(PersonKind kind) noexcept;

/** Habits for a way to work, from those of a careful person. */
[[nodiscard]] PersonOptions MakeHabits(PersonKind kind, PersonOptions careful) noexcept;

/** Somebody whose hand holds a device, whose mechanics move it. */
class DeviceHolder {
 public:
  DeviceHolder() = default;
  DeviceHolder(const DeviceHolder&) = delete;
  DeviceHolder& operator=(const DeviceHolder&) = delete;
  virtual ~DeviceHolder() = default;

  /** Replaces Operator::Step where the hand is where the screen shows it. RT-safe. */
  [[nodiscard]] virtual simulation::HandReference Intend(
      const simulation::OperatorInput& input) noexcept = 0;

  /** Impedance of the arm. */
  [[nodiscard]] virtual const PersonOptions& options() const noexcept = 0;
};

/** Seed of the person who has this hand, in a session with this seed. */
[[nodiscard]] constexpr std::uint64_t SeedOfHand(std::uint64_t seed, std::size_t hand) {
  // 2^64 over the golden ratio: an odd number, whose multiples all differ.
  constexpr std::uint64_t kApart = 0x9e3779b97f4a7c15;
  return seed ^ (hand * kApart);
}

/** A simulated person: an arm impedance that follows minimum-jerk reaches (Flash and Hogan, J.
 Neuroscience 5(7), 1985), feels the device's force, presses harder when stuck, searches when it
 misses, and gives up after a time. Seeded. It knows where the part should go and what the hand
 feels and hears. RT-safe. */
class SimulatedPerson final : public simulation::TaskOperator, public DeviceHolder {
 public:
  SimulatedPerson(const PersonOptions& options, std::uint64_t seed, const spatial::Pose& X_WH);

  bool Assign(const simulation::PersonTask& task) noexcept override { return tasks_.TryPush(task); }

  [[nodiscard]] int finished_count() const noexcept override {
    return finished_count_.load(std::memory_order_acquire);
  }

  [[nodiscard]] bool gave_up() const noexcept override { return gave_up_; }

  [[nodiscard]] int most_tries() const override { return kMostTries; }

  [[nodiscard]] std::string DescribeEffort() const override;

  [[nodiscard]] int searches() const noexcept { return search_count_; }

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] simulation::HandReference Intend(
      const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] const PersonOptions& options() const noexcept override { return options_; }

 private:
  static constexpr int kMostTries = 3;  ///< One, and two more: a choice.

  enum class Phase {
    kDone,
    kReach,     ///< Empty hand to the part.
    kGrasp,     ///< Close the hand.
    kCarry,     ///< Around the product to the way in.
    kApproach,  ///< Along the way in, until just before it engages.
    kInsert,    ///< Slowly, feeling; searches and presses.
    kRest,      ///< Part of the way in: lets its arm go slack.
    kWithdraw,  ///< Draws it out again, feeling.
    kSettle,    ///< Heard it seat: waits a moment.
    kRelease,
    kPutDown,  ///< Carries a part that has been drawn out around the product to the table.
    kGiveUp,   ///< Brings the part back to the table.
  };

  void Begin(const simulation::PersonTask& task) noexcept;
  void StartReaches(Phase phase) noexcept;
  /** Advances the reference along the reaches; true when all are done. */
  bool FollowReaches() noexcept;
  /** Whether a device's hand is still on its way round, with more than `lag` to go [rad]. */
  [[nodiscard]] bool IsTurning(double lag) const noexcept;
  /** Whether the hand, and what it holds, has come to where the reaches end: a device may hold it
   up, and what hangs on a soft coupling swings. Waits for it, but not for ever. */
  [[nodiscard]] bool HasCome(const simulation::OperatorInput& input) noexcept;
  void PlanCarry() noexcept;
  void PlanPutDown() noexcept;
  void PlanReturn() noexcept;
  /** Distance from the goal at which it begins to go in along the way [m]. */
  [[nodiscard]] double CalcWayToSphere() const noexcept;
  /** How far from the goal along the way a grip is [m]. */
  [[nodiscard]] double TravelOf(const spatial::Pose& X_WG) const noexcept;
  /** Where the hand means to be beside the way: what it aims, searches, yields and corrects. */
  [[nodiscard]] Vec3 OffsetBesideWay() const noexcept;
  [[nodiscard]] Quat TurnBesideWay() const noexcept;
  /** Travel of the hand, without what it means to be beside a way that turns [m]. */
  [[nodiscard]] double HandTravel() const noexcept;
  /** The travel at which the part is seen [m]. */
  [[nodiscard]] double SeenTravel(const simulation::OperatorInput& input) const noexcept;
  /** The direction outward of the way, there where the reference is. */
  [[nodiscard]] Vec3 OutwardOfWay() const noexcept;
  /** How fast what moves at the hand goes outward along the way, as far as it can tell [m/s]. */
  [[nodiscard]] double CalcOutwardSpeed(const simulation::OperatorInput& input) const noexcept;
  void BeginWithdraw(double travel, double push) noexcept;
  void BeginApproach(const simulation::OperatorInput& input) noexcept;
  void BeginInsert() noexcept;
  /** Begins to move what is on its way already. */
  void BeginOnWay(const simulation::OperatorInput& input) noexcept;
  /** Lets a part go where it is. */
  void LeaveThere() noexcept;

  /** How a part is being brought in: what of its path is known at this sample, and by which sense.
   */
  struct Insertion {
    Vec3 d{Vec3::Zero()};   ///< Outward along the path.
    double hand_travel{0};  ///< Distance to go of the hand [m].
    double seen_travel{0};  ///< Distance to go of the part, as it is seen [m].
    double travel{0};       ///< The one of the two that the person goes by [m].
    bool is_by_eye{false};
    bool is_by_touch{false};
    bool is_led_by_hole{false};
    bool is_careful{false};
    bool is_inside{false};
  };

  /** How fast a part goes in, and how far the hand leads it. */
  struct Advance {
    double speed{0};         ///< Speed of the part inwards, as it is felt [m/s].
    double wanted_speed{0};  ///< [m/s]
    double lead{0};          ///< Distance of the aim ahead of the hand [m].
  };

  void StepInsert(const simulation::OperatorInput& input) noexcept;
  /** Ends an insertion that is done, has come as far as it should, or has taken too long. */
  bool EndInsertion(const simulation::OperatorInput& input, const Insertion& insertion) noexcept;
  /** Chooses the senses that the part is led by. */
  void ChooseSenses(const simulation::OperatorInput& input, Insertion* insertion) const noexcept;
  void BackOff(const Insertion& insertion) noexcept;
  /** Pushes the part on, and yields or searches where it does not move. */
  void PressOn(const simulation::OperatorInput& input, const Insertion& insertion) noexcept;
  /** Moves the reference along the path. Returns whether the part is stuck. */
  bool AdvanceTravel(const simulation::OperatorInput& input, const Insertion& insertion,
                     const Advance& advance) noexcept;
  void StepWithdraw(const simulation::OperatorInput& input) noexcept;
  /** How fast the part, or the hand that holds it, moves as far as the person can tell [m/s]. */
  [[nodiscard]] const Vec3& MotionOf(const simulation::OperatorInput& input) const noexcept;
  /** Watches the part through what may stretch between it and the hand. */
  void Watch(const simulation::OperatorInput& input) noexcept;
  /** Time after which it gives up moving a part in or out [s]. */
  [[nodiscard]] double CalcPatience() const noexcept;
  [[nodiscard]] double PushLimit() const noexcept;
  /** Does what it can: more force would not come of waiting. */
  [[nodiscard]] bool IsPressing(const simulation::OperatorInput& input) const noexcept;
  /** Force on the hand besides the load that the arm holds up [N]: what pressing is felt by. */
  [[nodiscard]] double CalcAddedForce(const simulation::OperatorInput& input) const noexcept;
  /** Presses or pulls harder while little moves, but not beyond its limit.
   @param resistance  What the hand feels of it [N].
   @param speed  The way it wants to go [m/s]. */
  void AdjustPush(double resistance, double speed, double wanted_speed, bool is_light) noexcept;
  /** Where the approach ends: the hand's goal just before the part engages. */
  [[nodiscard]] Vec3 CalcApproachEnd() const noexcept;
  /** Corrects the hand's goal across the way in where the part is seen to hang beside the hand. */
  void CorrectHold(const simulation::OperatorInput& input) noexcept;
  /** Offset that moves to and fro, harder the longer the part sticks. */
  void Rock(const Vec3& d, bool is_slow) noexcept;
  /** Whether the part is felt to be held by more than the hand may have its load wrong. */
  [[nodiscard]] bool FeelsTouch(const simulation::OperatorInput& input) const noexcept;
  /** Gives way across the way in to a hole that holds the part on its axis, until it feels no force
   and no torque there. */
  void YieldToHole(const simulation::OperatorInput& input, const Vec3& d) noexcept;
  /** Whether the part is felt to be held beside the way, or tilted. */
  [[nodiscard]] bool FeelsAside(const simulation::OperatorInput& input,
                                const Vec3& d) const noexcept;
  /** Gives way across the way in, and in how it is turned, to what holds the hand back. */
  void YieldToTouch(const Vec3& d) noexcept;
  /** Whether the part is further in than it ever was on this try. */
  [[nodiscard]] bool IsNearer(double travel) noexcept;
  /** Whether no mate guides the part on a way that turns. */
  [[nodiscard]] bool IsLedByEye() const noexcept;
  /** Whether the part is in a hole on a way that turns: it has to be turned right to go on. */
  [[nodiscard]] bool HasSlotToFind() const noexcept;
  /** Whether it only pushes for a moment: stuck in a slot, what it twists against holds the part by
   friction. */
  [[nodiscard]] bool HasSlackWrist() const noexcept;
  /** Corrects, little by little, how far the part is beside its way, by what it sees; what a mate
   guides is turned about the way alone. */
  void FollowWayByEye(const simulation::OperatorInput& input, const Vec3& d) noexcept;
  /** Corrects where it believes the part to be by what it sees. */
  void LookClosely(const simulation::OperatorInput& input) noexcept;
  /** Backs off from so far before its place, to try again. */
  void StartSearch(const Vec3& d, double travel, bool is_by_eye) noexcept;
  /** Moves the reference on: what to do next. */
  void Decide(const simulation::OperatorInput& input) noexcept;
  /** Does what the present phase consists of, and begins the next one when it is over. */
  void StepPhase(const simulation::OperatorInput& input) noexcept;
  void StepReach() noexcept;
  void StepGrasp(const simulation::OperatorInput& input) noexcept;
  void StepApproach(const simulation::OperatorInput& input) noexcept;
  void BeginPhase(Phase phase) noexcept;
  /** Opens the hand. */
  void BeginRelease() noexcept;
  /** Lets the arm go slack: the reference comes to the hand. */
  void Slacken() noexcept;
  /** How far before the hand the reference goes, to press as hard as it wants to [m]. */
  [[nodiscard]] double LeadOf(const simulation::OperatorInput& input) const noexcept;
  void LearnLoad(const spatial::Wrench& F_H_W) noexcept;
  void MoveHand(const spatial::Wrench& F_H_W) noexcept;
  [[nodiscard]] Vec3 Tremor() noexcept;

  PersonOptions options_;
  Random random_;
  Phase phase_{Phase::kDone};
  simulation::PersonTask task_;
  std::atomic<bool> gave_up_{false};
  std::atomic<int> search_count_{0};
  std::atomic<int> finished_count_{0};
  Ring<simulation::PersonTask> tasks_{4};

  spatial::Pose X_WH_;  ///< The hand.
  spatial::Twist V_H_;
  Vec3 p_ref_{Vec3::Zero()};  ///< Where it wants to be.
  Quat q_ref_{Quat::Identity()};
  Vec3 v_ref_{Vec3::Zero()};
  bool is_gripping_{false};
  Vec3 carried_force_{Vec3::Zero()};  ///< Slowly learned load that the arm holds up.
  Vec3 grip_offset_W_{Vec3::Zero()};  ///< Vector from the hand to the grip point, when carried [m].
  /** Correction of the hand's goal for how the part hangs in it, across the way in [m]. */
  Vec3 hold_offset_W_{Vec3::Zero()};
  Vec3 p_part_W_{Vec3::Zero()};    ///< Grip as seen at a device.
  Vec3 v_part_W_{Vec3::Zero()};    ///< [m/s]
  Vec3 aim_offset_{Vec3::Zero()};  ///< Error of where the hand believes this part to be.
  Vec3 aim_turn_{Vec3::Zero()};
  Vec3 follow_offset_{Vec3::Zero()};    ///< The eye's correction of the part on its way [m].
  Vec3 follow_turn_{Vec3::Zero()};      ///< Likewise [rad].
  Vec3 seen_error_{Vec3::Zero()};       ///< Error of the last close look [m].
  Vec3 seen_turn_error_{Vec3::Zero()};  ///< Likewise [rad].

  simulation::Reaches reaches_;
  double phase_time_s_{0};
  double waited_s_{0};    ///< Goal of the hand at the end of the reaches.
  double calm_s_{0};      ///< Part of that time without motion.
  double swinging_s_{0};  ///< Time to wait until what swings counts as still.

  double travel_{0};          ///< Reference distance still to go along the way in [m].
  double push_{0};            ///< Force that the hand is ready to press with [N].
  double back_off_to_{0};     ///< Distance to go at which it tries again [m].
  double nearest_travel_{0};  ///< The least one of this try [m].
  double since_nearer_s_{0};  ///< Time for which it has not become less, on a way that turns.
  double stuck_time_s_{0};
  Vec3 search_offset_{Vec3::Zero()};
  Vec3 yield_offset_{Vec3::Zero()};  ///< What touch has corrected, of place [m] and turn [rad].
  Vec3 yield_turn_{Vec3::Zero()};
  Vec3 rocking_{Vec3::Zero()};  ///< [rad]
  double rocking_angle_{0};
  bool is_guided_{false};  ///< Has heard a mate being captured.
  bool is_backing_off_{false};
  double look_time_s_{0};  ///< Still to look, after backing off.
  double tremor_phase_[3]{};
  double t_s_{0};
  double dt_{1e-3};           ///< Time of the present sample [s].
  bool is_outside_{false};    ///< The last try ended before the part came to where it engages.
  bool is_at_device_{false};  ///< Something else than this arm moves the hand.
};

}  // namespace hvas::person
