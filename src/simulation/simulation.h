#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/ring.h"
#include "base/triple_buffer.h"
#include "contact/scene.h"
#include "haptics/haptic_tick.h"
#include "simulation/flight_recorder.h"
#include "simulation/load_shedder.h"
#include "simulation/model.h"
#include "simulation/tick_log.h"

namespace hvas::simulation {

/** What one hold of a part amounted to. */
struct HoldMetrics {
  std::int64_t t_taken_ns{0};
  double path{0};           ///< Of the displayed centre of mass [m].
  double peak_true{0};      ///< Largest true force [N].
  double peak_felt{0};      ///< Largest force given to the device [N].
  double fit_true{0};       ///< Largest axial force of fits, true [N].
  double fit_felt{0};       ///< The same as felt [N].
  double deepest{0};        ///< Deepest penetration, >= 0 [m].
  double insertion{0};      ///< Longest engagement of a captured axis [m].
  int collisions{0};        ///< Times that it met something before a mate guided it.
  contact::BodyId hardest;  ///< Body pressed hardest while the hand was inserting; may be invalid.
  double hardest_force{0};  ///< [N]
};

/** Something that happened in a tick. */
struct SimulationEvent {
  enum class Kind : std::uint8_t {
    kTaken,
    kState,
    kDropped,
    kSafety,  ///< The gate began to do something.
    kDevice,  ///< The device's condition changed.
    kEffort,  ///< The tick does less, or more again.
    kEnergy,  ///< Once a second with a device: what went to the hand and came from it.
  };
  std::int64_t t_ns{0};
  Kind kind{Kind::kState};
  std::size_t hand{0};
  product::OccurrenceId occurrence;
  haptics::HoldState state{haptics::HoldState::kEmpty};
  spatial::Pose X_WB;                                      ///< kDropped: where the part was let go.
  bool was_seated{false};                                  ///< kDropped: it is in its place.
  double to_place{0};                                      ///< kDropped: that far from there [m].
  HoldMetrics metrics;                                     ///< kDropped: of the whole hold.
  std::uint32_t gate_actions{0};                           ///< kSafety: those that are new.
  device::Condition condition{device::Condition::kReady};  ///< kDevice
  std::int32_t vendor_code{0};                             ///< kDevice
  int effort_level{0};                                     ///< kEffort
  haptics::PassivityAccount energy;                        ///< kEnergy, of forces
  haptics::PassivityAccount turning_energy;                ///< kEnergy, of torques
};

/** Receives what the loops produce. OnTick runs on the haptic thread and must be RT-safe; OnEvent
 runs on the physics thread. */
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;
  virtual void OnTick(std::size_t hand, const device::DeviceState& device,
                      const haptics::TickOutput& out) noexcept = 0;
  virtual void OnEvent(const SimulationEvent& event) = 0;

  /** The second before a fault, and what came after. Physics thread. */
  virtual void OnFlight(const std::vector<FlightTick>& ticks) { (void)ticks; }
};

/** What a viewer needs: poses of all parts and of the hands. */
struct Frame {
  std::int64_t t_ns{0};
  std::vector<spatial::Pose> X_WB;         ///< By OccurrenceId.
  std::vector<haptics::TickOutput> ticks;  ///< By hand.
};

enum class Placement : std::uint8_t {
  kLoose,  ///< On the table, or falling.
  kHeld,
  kPlaced,  ///< In the product, or in the subassembly that is being put together.
  kParked,  ///< On the shelf with its subassembly.
};

/** Where a part is, and what it does there. */
struct PartState {
  Placement placement{Placement::kLoose};
  spatial::Pose X_WB;
};

/** What the physics loop had the ticks do, with all that it knew then: enough to have it done
 again, whatever physics has come to know since. */
struct GivenCommand {
  std::uint32_t number{0};  ///< 1 for the first one since the simulation began.
  std::int64_t t_ns{0};     ///< Session time that physics had seen.
  TickCommand::Kind kind{TickCommand::Kind::kPlace};
  std::size_t hand{0};           ///< That takes.
  SequenceStep step;             ///< What is taken; of what is placed the occurrence alone.
  std::vector<PartState> parts;  ///< By OccurrenceId.
};

/** All that changes while a model is assembled. Three loops may run it at once, each function from
 its own thread: HapticTick (1 kHz and more, every TickOptions::dt, one hand after the other),
 PhysicsStep (100 Hz), Publish (30 Hz). Called in turn from one thread it gives the same results
 every time.

 Two hands work in one scene. What one holds is an obstacle for the other, and cannot be taken by
 it; mates are those with parts that are in their place when a part is taken, not with what the
 other hand holds. A loose part that moves belongs to the hand whose part woke it. */
class Simulation {
 public:
  // X4 asks for 100 Hz and 30 Hz.
  static constexpr std::int64_t kPhysicsStepNs = 10'000'000;
  static constexpr std::int64_t kFrameNs = 33'000'000;

  Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions& options);

  /** Two hands, with the same dt. */
  Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions& first,
             const haptics::TickOptions& second);

  /** Haptic thread: each hand once in a period, in their order. RT-safe. */
  haptics::TickOutput HapticTick(std::size_t hand, const device::DeviceState& device) noexcept;

  haptics::TickOutput HapticTick(const device::DeviceState& device) noexcept {
    return HapticTick(0, device);
  }

  /** Haptic thread: from the next tick on, by the levels of kEffortLevels. RT-safe. */
  void SetEffortLevel(int level) noexcept;

  /** Any thread: no force at all from the next tick on, until it is taken back (N6). RT-safe. */
  void StopForces(bool is_stopped) noexcept {
    is_stopped_.store(is_stopped, std::memory_order_release);
  }

  /** Before the loops run: keeps in `log` what goes into the ticks. It outlives this object. */
  void KeepLog(TickLog* log) { log_ = log; }

  /** Before the loops run: tells of each command before a tick can obey it. Physics thread. */
  void TellOfCommands(std::function<void(const GivenCommand&)> tell) {
    tell_of_command_ = std::move(tell);
  }

  /** Any thread: how many events of the safety gate were never told of, as physics had not taken
   those before them. All others arrive, or are said again until they do. RT-safe. */
  [[nodiscard]] std::uint64_t lost_events() const noexcept {
    return lost_events_.load(std::memory_order_relaxed);
  }

  /** Haptic thread: how many commands the ticks have obeyed. RT-safe. */
  [[nodiscard]] std::uint32_t obeyed_commands() const noexcept { return obeyed_commands_; }

  /** Runs tick i of a log again, with the commands that came before it; ticks in their order, on a
   simulation that did nothing else. */
  haptics::TickOutput ReplayTick(const TickLog& log, std::size_t i) noexcept;

  /** The same for one tick, and for a command before it. */
  haptics::TickOutput ReplayTick(std::size_t hand, const device::DeviceState& device,
                                 const haptics::TickContext& context) noexcept;
  void ReplayCommand(const GivenCommand& command, std::int64_t t_ns);

  /** Physics thread: taking up and letting go, where loose parts have come to. `sink` may be null.
   */
  void PhysicsStep(Sink* sink);

  /** Publish thread: the newest state of everything. */
  const Frame& Publish();

  /** Physics thread: all parts, by OccurrenceId. */
  [[nodiscard]] const std::vector<PartState>& parts() const { return parts_; }

  /** Before the loops run: goes on from where all parts were. What was held is loose where it was.
   @pre one state for each part of the model. */
  void Restore(const std::vector<PartState>& parts);

  /** Puts a part in its place without a hand: the base in its fixture. Physics thread. */
  void PlaceInFixture(product::OccurrenceId id);

  /** Physics thread, or before the loops run. */
  [[nodiscard]] Placement placement(product::OccurrenceId id) const {
    return parts_[id.index()].placement;
  }

  [[nodiscard]] const spatial::Pose& pose(product::OccurrenceId id) const {
    return parts_[id.index()].X_WB;
  }

  /** What the next part that a hand takes up is for: its place, its way in, and what moves with it.
   Physics thread. Parts that nobody prepared go to their drawn place by their step of the sequence.
 */
  void Prepare(const SequenceStep& step, std::size_t hand = 0) { hands_[hand].prepared = step; }

  /** Before the loops run: what is closed already closed on something else, and takes nothing until
   it has been open. */
  void AwaitOpenGrip(std::size_t hand) { hands_[hand].is_waiting_for_grip_to_open = true; }

  /** Before the loops run: where this hand closes on no loose part, it takes the nearest one that
   is in its place out again (X16). */
  void LetTakeOut(std::size_t hand) { hands_[hand].takes_out = true; }

  /** Something is in this hand, or on its way into it. Physics thread. */
  [[nodiscard]] bool is_holding(std::size_t hand) const { return hands_[hand].held != nullptr; }

  /** A part that has a mate with this one and comes before it in the order, but is not in its
   place; invalid where there is none, or where another such part is in its place. Physics thread.
 */
  [[nodiscard]] product::OccurrenceId FindMissingPartner(const SequenceStep& step) const;

  [[nodiscard]] const Model& model() const { return *model_; }

  [[nodiscard]] std::size_t hand_count() const { return hands_.size(); }

  [[nodiscard]] const haptics::TickOptions& options(std::size_t hand = 0) const {
    return hands_[hand].haptic.options();
  }

 private:
  /** A loose part that falls or is pushed, and where it is. */
  struct Moving {
    contact::BodyId body;
    spatial::Pose X_WB;
  };

  /** From haptics to physics, newest wins. */
  struct Report {
    std::int64_t t_ns{0};
    bool is_gripping{false};
    haptics::TickOutput out;
    std::array<Moving, haptics::FreeBodies::kMaxAwake> moving;
    std::size_t moving_count{0};
  };

  /** One hand, with what it holds. */
  struct Hand {
    Hand(std::size_t i, const haptics::TickOptions& options, contact::Scene* scene)
        : index(i), haptic(options, scene) {}

    const std::size_t index;

    // The haptic thread's own.
    haptics::HapticTick haptic;
    haptics::HoldState last_state{haptics::HoldState::kEmpty};
    HoldMetrics metrics;
    Vec3 p_last_Cm{Vec3::Zero()};
    std::int64_t last_contact_ns{0};
    device::Condition last_condition{device::Condition::kReady};
    std::array<std::int64_t, 32> last_action_ns{};  // When the gate last did it, by bit.

    TripleBuffer<Report> reports;

    // The physics thread's own.
    std::shared_ptr<const haptics::HeldPart> held;  // Kept until haptics has let go of it.
    SequenceStep held_step;
    std::optional<SequenceStep> prepared;
    bool is_waiting_for_grip_to_open{false};
    bool takes_out{false};
    std::int64_t next_energy_ns{0};
  };

  Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions* options,
             std::size_t hands);
  haptics::TickOutput RunTick(Hand* hand, const device::DeviceState& device,
                              const haptics::TickContext& context) noexcept;
  void Obey(const TickCommand& command, std::int64_t t_ns) noexcept;
  void Give(const TickCommand& command, const SequenceStep& step);
  void PassCommands();
  void PushOwnership(const SimulationEvent& event) noexcept;
  [[nodiscard]] bool TryPushTelemetry(const SimulationEvent& event) noexcept;
  void TellOfSafety(Hand* hand, const device::DeviceState& device,
                    const haptics::TickOutput& out) noexcept;
  static void Measure(Hand* hand, std::int64_t t_ns, const haptics::TickOutput& out) noexcept;
  void HandleEvent(const SimulationEvent& event);
  void Heed(Hand* hand);
  static void TellOfEnergy(Hand* hand, Sink* sink);
  void FillFrame(Frame* frame) const;
  void TakeNearest(Hand* hand, const Vec3& p_WH);
  void Take(Hand* hand, const SequenceStep& step);
  /** Within reach of a hand. */
  [[nodiscard]] product::OccurrenceId FindNearest(const Vec3& p_WH, Placement placement) const;
  [[nodiscard]] bool CanTake(const SequenceStep& step, const Vec3& p_WH) const;
  [[nodiscard]] std::shared_ptr<haptics::HeldPart> MakeHeldPart(const SequenceStep& step) const;
  void AddMembers(const SequenceStep& step, haptics::HeldPart* held) const;
  void AddMates(const SequenceStep& step, std::size_t member, haptics::HeldPart* held) const;
  [[nodiscard]] std::vector<contact::BodyId> LeftOut(product::OccurrenceId id,
                                                     const SequenceStep& step) const;
  [[nodiscard]] spatial::Pose ClearOfTable(product::OccurrenceId id) const;

  std::shared_ptr<const Model> model_;
  contact::Scene scene_;  // Written by the haptic thread only, once the loops run.
  std::deque<Hand> hands_;

  // The haptic thread's own.
  TickLog* log_{nullptr};
  int effort_level_{0};
  int told_effort_level_{0};
  std::size_t replayed_commands_{0};
  std::uint32_t obeyed_commands_{0};

  std::atomic<bool> is_stopped_{false};
  std::atomic<std::int64_t> physics_t_ns_{0};  // Session time that physics has seen.

  Ring<TickCommand> commands_;
  Ring<SimulationEvent> events_;
  std::atomic<std::uint64_t> lost_events_{0};
  TripleBuffer<Frame> frames_;

  // The physics thread's own.
  std::vector<PartState> parts_;
  std::function<void(const GivenCommand&)> tell_of_command_;
  std::uint32_t given_commands_{0};
  std::deque<TickCommand> waiting_commands_;  ///< The ring has no room for them yet.
};

}  // namespace hvas::simulation
