#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/triple_buffer.h"
#include "simulation/assembly_run.h"
#include "simulation/disassembly_run.h"
#include "simulation/executors.h"
#include "studio/live_hand.h"
#include "studio/live_trial.h"
#include "studio/recording.h"

namespace hvas::studio {

/** State of an assembly, from which a run can resume. */
struct LiveState {
  std::vector<simulation::PartState> parts;  ///< Indexed by OccurrenceId; empty: all on the table.
  std::size_t next_step{0};
};

/** The initial state: all parts and tools lie on the table, fixtures stand where they belong. */
[[nodiscard]] LiveState MakeStart(const simulation::Model& model);

/** Callbacks of a run. All but on_frame are called on the physics thread. */
struct LiveListeners {
  std::function<void(const simulation::SimulationEvent&)> on_event;
  std::function<void(product::OccurrenceId, const simulation::PartState&)> on_placement;
  std::function<void(std::size_t step)> on_step;
  /** Called after each removal of a disassembly. */
  std::function<void(bool is_last)> on_removal;
  /** Called on the publish thread. */
  std::function<void(const simulation::Frame&, std::int64_t clock_ns, const PeakForces&)> on_frame;
};

struct LiveOptions {
  bool has_person{false};           ///< See HandPurpose.
  std::vector<HandSetup> hands{1};  ///< One to haptics::kMaxHands.
  std::uint64_t seed{1};            ///< Any number: the simulated person's hand follows from it.
  double rate_hz{1000};             ///< X4 asks for 1 kHz.
  haptics::PaperGuidance guidance;  ///< See HandPurpose.
  bool forces_off{false};           ///< No force from the first tick on.
  /** Clock of the loops, and of the age of inputs; devices have been opened for it. */
  LoopClock* clock{&MachineClock()};
  std::shared_ptr<Recording> recording;  ///< Receives all events; may be null.
  std::shared_ptr<LiveTrial> trial;      ///< Trial of a study; may be null.
  /** Plan that the simulated person carries out instead of the assembly; may be null. */
  std::shared_ptr<const simulation::DisassemblyPlan> disassembly;
};

/** One section of a live assembly: a simulation of a model that runs by a clock, the machine's or a
 steered one, until this object is destroyed. Another model, another operator and undo each begin a
 new run from a given state. */
class LiveRun final : private simulation::Sink {
 public:
  LiveRun(std::shared_ptr<const simulation::Model> model, const LiveState& start,
          const LiveOptions& options, LiveListeners listeners);
  ~LiveRun() override;

  /** Moves a hand to a part and closes it there. Any thread may call it.
   @pre the hand follows a pointer. */
  void Take(std::size_t hand, const sequence::SequenceStep& step, const spatial::Pose& X_WH);

  /** Moves a hand to what another one holds, and closes it there: both hold it then. Any thread may
   call it. @pre both follow pointers. */
  void Help(std::size_t hand, std::size_t other, const spatial::Pose& X_WH);

  /** Sets the pointer's target pose of a hand. Any thread may call it. */
  void Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping);

  /** Lets a hand go of a part, and closes another one on it before it has fallen 5 mm. Nothing goes
   on where the part stays in its place. Any thread may call it. @pre both follow pointers. */
  void HandOver(std::size_t from, std::size_t to, product::OccurrenceId id);

  void StopForces(bool is_stopped) { simulation_->StopForces(is_stopped); }

  /** State at the last physics step; this and the next two may be called by any thread. */
  [[nodiscard]] LiveState state() const;
  [[nodiscard]] bool is_holding(std::size_t hand) const;
  /** State before the most recent take. */
  [[nodiscard]] LiveState state_before_take() const;

  /** Time of the newest input [ns] of the hand, among those that hold a part by the pointer, whose
   input is oldest; none where none does. Any thread may call it. */
  [[nodiscard]] std::optional<std::int64_t> FindOldestInput() const;

  [[nodiscard]] std::size_t hand_count() const { return hands_.size(); }

  [[nodiscard]] const LiveHand& hand(std::size_t i) const { return *hands_[i]; }

  /** Status of the last full second; none when no second has ended since the last call. For one
   thread. */
  [[nodiscard]] std::optional<simulation::LoopStatus> TakeStatus();

  [[nodiscard]] const simulation::Model& model() const { return simulation_->model(); }

 private:
  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** A part on its way from one hand into another. */
  struct Passing {
    std::size_t to;
    product::OccurrenceId id;
    std::int64_t give_up_ns;  ///< Time by the session's clock after which the part is nobody's.
  };

  void MovePointer(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping);
  void Advance();
  void Observe();
  /** Closes the second hand on a part as soon as the first one has let go. */
  void Catch();
  [[nodiscard]] simulation::PartRun& part_run();
  /** The first step whose part is not in its place, or that of the assembly. */
  [[nodiscard]] std::size_t FindNextStep(const std::vector<simulation::PartState>& parts) const;
  void Run(const LiveOptions& options);

  LoopClock* const clock_;
  LiveListeners listeners_;
  std::shared_ptr<Recording> recording_;
  std::shared_ptr<LiveTrial> trial_;
  std::vector<std::unique_ptr<LiveHand>> hands_;
  std::unique_ptr<simulation::Simulation> simulation_;
  simulation::AssemblyRun assembly_;
  std::shared_ptr<const simulation::DisassemblyPlan> plan_;
  std::optional<simulation::DisassemblyRun> disassembly_;  ///< Takes the place of assembly_.
  TripleBuffer<simulation::LoopStatus> status_;
  std::array<std::atomic<double>, haptics::kMaxHands> peak_felt_{};
  /** Time of the newest input of each hand, by the session's clock [ns]. */
  std::array<std::atomic<std::int64_t>, haptics::kMaxHands> moved_ns_{};
  /** MonotonicNs() at session time 0, by the newest tick: periods that the loop missed are no
   session time, so that it moves. */
  std::atomic<std::int64_t> begin_ns_;
  std::atomic<bool> is_stopping_{false};
  std::optional<Passing> passing_;  ///< The physics thread alone reads and writes it.

  mutable std::mutex mutex_;  ///< Protects what follows; the haptic thread never takes it.
  std::vector<std::function<void()>> tasks_;
  LiveState observed_;
  LiveState before_take_;
  std::array<bool, haptics::kMaxHands> is_holding_{};  ///< Indexed by hand.

  std::thread thread_;
};

}  // namespace hvas::studio
