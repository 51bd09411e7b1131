#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/triple_buffer.h"
#include "simulation/handover.h"
#include "simulation/haptic_side.h"
#include "simulation/model.h"
#include "simulation/part_state.h"
#include "simulation/physics_side.h"
#include "simulation/simulation_event.h"
#include "simulation/tick_log.h"

namespace hvas::simulation {

/** All that changes while a model is assembled. Three loops may run it at once, each by what is its
 own: the haptic loop (1 kHz and more, every TickOptions::dt, one hand after the other) has
 `haptics()`, the physics loop (100 Hz) `physics()`, and the publishing loop (30 Hz) Publish. Called
 in turn from one thread they give the same results every time.

 Up to haptics::kMaxHands hands work in one scene. What one holds is an obstacle for the others, and
 cannot be taken by them; mates are those with parts that are in their place when a part is taken,
 not with what another hand holds. A loose part that moves belongs to the hand whose part woke it.
 */
class Simulation {
 public:
  // X4 asks for 100 Hz and 30 Hz.
  static constexpr std::int64_t kPhysicsStepNs = 10'000'000;
  static constexpr std::int64_t kFrameNs = 33'000'000;

  Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions& options);

  /** @param hands  Options of each hand, with the same dt. @pre 1 to haptics::kMaxHands. */
  Simulation(std::shared_ptr<const Model> model, const std::vector<haptics::TickOptions>& hands);

  /** What the haptic thread may use. */
  [[nodiscard]] HapticSide& haptics() noexcept { return haptics_; }

  /** What the physics thread may use. */
  [[nodiscard]] PhysicsSide& physics() noexcept { return physics_; }

  [[nodiscard]] const PhysicsSide& physics() const noexcept { return physics_; }

  /** Publishing thread: the newest state of everything. */
  const Frame& Publish();

  /** Any thread: no force at all from the next tick on, until it is taken back (N6). RT-safe. */
  void StopForces(bool is_stopped) noexcept { haptics_.StopForces(is_stopped); }

  /** Any thread: how many events of the safety gate were lost, as physics had not taken those
   before them. All others arrive, or are reported again until they do. RT-safe. */
  [[nodiscard]] std::uint64_t lost_events() const noexcept {
    return handover_.lost_safety_events.load(std::memory_order_relaxed);
  }

  /** Keeps in `log`, which outlives this object, what goes into the ticks. Only before the loops
   * run.
   */
  void KeepLog(TickLog* log);

  /** Goes on from where all parts were; what was held is loose where it was. Only before the loops
   run. @pre one state for each part of the model. */
  void Restore(const std::vector<PartState>& parts);

  /** While no loop runs: carries out a command of another run at this session time, with the parts
   as they were then. */
  void ReplayCommand(const GivenCommand& command, std::int64_t t_ns);

  [[nodiscard]] const Model& model() const { return *model_; }

  [[nodiscard]] std::size_t hand_count() const { return haptics_.hand_count(); }

  [[nodiscard]] const haptics::TickOptions& options(std::size_t hand = 0) const {
    return haptics_.options(hand);
  }

 private:
  std::shared_ptr<const Model> model_;
  Handover handover_;
  TripleBuffer<Frame> frames_;
  HapticSide haptics_;
  PhysicsSide physics_;
};

}  // namespace hvas::simulation
