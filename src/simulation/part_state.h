#pragma once

#include <cstdint>
#include <vector>

#include "haptics/tick_output.h"
#include "simulation/model.h"
#include "simulation/tick_log.h"
#include "spatial/pose.h"

namespace hvas::simulation {

enum class Placement : std::uint8_t {
  kLoose,  ///< The part is on the table, or falling.
  kHeld,
  kPlaced,  ///< The part is in the product, or in a subassembly that is being put together.
  /** The part is out of the way: on the shelf with its subassembly, or beside its place. */
  kParked,
  kPending,  ///< The part cannot be taken as long as its contact shape is not there.
};

/** Where a body is before anybody has moved it. */
[[nodiscard]] constexpr Placement BeginningOf(BodyRole role) noexcept {
  switch (role) {
    case BodyRole::kFixture:
      return Placement::kPlaced;
    case BodyRole::kPending:
      return Placement::kPending;
    case BodyRole::kPart:
    case BodyRole::kTool:
      break;
  }
  return Placement::kLoose;
}

/** What a part is before a step within the product moves it, and what after.
 @pre IsWithinProduct(kind) */
[[nodiscard]] constexpr Placement PlacementBefore(sequence::SequenceStep::Kind kind) noexcept {
  return kind == sequence::SequenceStep::Kind::kAside ? Placement::kPlaced : Placement::kParked;
}

[[nodiscard]] constexpr Placement PlacementAfter(sequence::SequenceStep::Kind kind) noexcept {
  return kind == sequence::SequenceStep::Kind::kAside ? Placement::kParked : Placement::kPlaced;
}

/** Where a part is, and what it does there. */
struct PartState {
  Placement placement{Placement::kLoose};
  spatial::Pose X_WB;
  /** Leader of the parts that it was put together with on the table (X1); invalid: of none. */
  product::OccurrenceId leader{};
};

/** What a viewer needs: poses of all parts and of the hands. */
struct Frame {
  std::int64_t t_ns{0};
  std::vector<spatial::Pose> X_WB;         ///< Indexed by OccurrenceId.
  std::vector<haptics::TickOutput> ticks;  ///< One for each hand.
  /** What each hand has besides the part of its tick: the rest of a subassembly. */
  std::vector<std::vector<product::OccurrenceId>> members;
};

/** A command of the physics loop to the ticks, with all that the loop knew then: enough to give it
 again, whatever physics has come to know since. */
struct GivenCommand {
  std::uint32_t number{0};  ///< 1 for the first one since the simulation began.
  std::int64_t t_ns{0};     ///< Session time that physics had seen.
  TickCommand::Kind kind{TickCommand::Kind::kPlace};
  std::size_t hand{0};           ///< The hand that takes, or helps.
  std::size_t other{0};          ///< The hand that is helped.
  sequence::SequenceStep step;   ///< What is taken; of what is placed the occurrence alone.
  bool can_join{false};          ///< What is taken may be put to loose parts on the table.
  std::vector<PartState> parts;  ///< Indexed by OccurrenceId.
};

}  // namespace hvas::simulation
