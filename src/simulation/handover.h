#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>

#include "base/ring.h"
#include "base/triple_buffer.h"
#include "contact/scene.h"
#include "haptics/contact_step.h"
#include "haptics/free_bodies.h"
#include "haptics/tick_output.h"
#include "simulation/simulation_event.h"
#include "simulation/tick_log.h"
#include "spatial/pose.h"

namespace hvas::simulation {

/** A loose part that falls or is pushed, and where it is. */
struct MovingPart {
  contact::BodyId body;
  spatial::Pose X_WB;
};

/** What the haptic loop last knew of a hand. */
struct HandReport {
  std::int64_t t_ns{0};
  bool is_gripping{false};
  haptics::TickOutput out;
  std::array<MovingPart, haptics::FreeBodies::kMaxAwake> moving;
  std::size_t moving_count{0};
  std::array<MovingPart, haptics::ContactStep::kMaxTurned> turned;  ///< Fasteners under a tool.
  std::size_t turned_count{0};
};

/** Everything that passes between the haptic and the physics loop, without a lock. */
class Handover {
 public:
  Handover(std::size_t parts, std::size_t hands) : commands(4 * parts + 64), events_(256) {
    for (std::size_t i = 0; i < hands; ++i) {
      reports.emplace_back();
    }
  }

  /** Haptic thread: an event that changes who holds a part. There is always room for it: a hand has
   at most one taking and one letting go on the way, as physics gives it the next part only when it
   has seen both. RT-safe. */
  void PushOwnership(const SimulationEvent& event) noexcept { events_.TryPush(event); }

  /** Haptic thread: any other event.
   @returns false where nothing but the room for ownership is left. RT-safe. */
  [[nodiscard]] bool TryPushTelemetry(const SimulationEvent& event) noexcept {
    return events_.TryPush(event, kRoomForOwnership);
  }

  /** Physics thread. */
  [[nodiscard]] bool TryPopEvent(SimulationEvent* event) noexcept { return events_.TryPop(event); }

  Ring<TickCommand> commands;  ///< Written by physics, read by haptics.
  /** Written by haptics, read by physics; one for each hand. */
  std::deque<TripleBuffer<HandReport>> reports;
  std::atomic<std::int64_t> physics_t_ns{0};         ///< Session time that physics has seen.
  std::atomic<std::uint64_t> lost_safety_events{0};  ///< Counted by the haptic loop.

 private:
  /** Room in the ring for a taking and a letting go of each hand. */
  static constexpr std::size_t kRoomForOwnership = 2 * haptics::kMaxHands;

  Ring<SimulationEvent> events_;  ///< Written by haptics, read by physics.
};

}  // namespace hvas::simulation
