#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "orders/order_effort.h"
#include "sequence/extraction.h"
#include "simulation/model.h"

namespace hvas::orders {

/** A straight way out of a move's parts with all others in their place, and what stands in it. */
struct OrderedWay {
  sequence::SequenceStep step;                ///< The move by this way.
  std::vector<sequence::Obstacle> obstacles;  ///< One of each part that stands in it.
  std::vector<std::size_t> moves;             ///< The moves that these parts belong to; sorted.
  WayEffort effort;                           ///< What it asks of the hand.
};

/** A move of the order of assembly, and the ways by which it may go. */
struct FreeMove {
  sequence::Unit parts;          ///< The leading part first.
  std::vector<OrderedWay> ways;  ///< The planned one first; no way that what never moves closes.
  /** Moves of another part within the product that let this one pass: aside, and back. Both, or
   none. */
  std::optional<sequence::SequenceStep> aside;
  std::optional<sequence::SequenceStep> back;
  /** It goes only as planned, after what came before it: on a way that turns, or on which parts
   give, or past a part that is moved aside. */
  bool is_bound{false};
  std::string tool;           ///< The name of a fastener's tool (NameTools); empty: none is needed.
  std::string tool_of_space;  ///< The one whose space was looked at (ToolSpace::tool); or empty.
  /** What stands in the space of that tool while it turns the fastener in (tool_space.h). */
  std::vector<product::OccurrenceId> in_tool_space;
  std::vector<std::size_t> moves_in_tool_space;  ///< The moves that they belong to; sorted.
  std::vector<std::size_t> neighbours;           ///< Moves whose parts hold this one; sorted.
  bool is_held_by_base{false};                   ///< The base, or a fixture, holds it.
  double weight{0};                              ///< Weight of its parts [N].
  std::vector<HandMotion>
      motions;  ///< Motions of the hand in every order (EffortFinder::ListMotions).
  int mods{0};  ///< Their sum [MOD].
};

/** A side of the product that may be upwards: an axis of W, the positive and the negative one of x,
 then of y, then of z. */
inline constexpr int kUpSides = 6;

[[nodiscard]] Vec3 UpSideAt(int side);

/** What of an order of assembly may change: a move may come when nothing stands in one of its ways.
 Wilson and Latombe (Artificial Intelligence 71(2), 1994) call such rules AND/OR precedence. */
struct OrderRules {
  std::vector<sequence::SequenceStep> first;  ///< What is put together by itself, and the base.
  std::vector<FreeMove> moves;                ///< Moves in the planned order.
  /** Sides that may be upwards, the one to choose before others first: as drawn, then that on which
   the base stands best. */
  std::array<int, kUpSides> up_sides{4, 0, 1, 2, 3, 5};
};

struct OrderRuleOptions {
  std::function<void(double fraction)> progress;  ///< Called by the calling thread; may be null.
  std::stop_token stop;  ///< Ends the search for ways: the rest have the planned one alone.
};

/** Finds the rules of a model's order: for each move that puts a part, or parts together, into the
 product, the straight ways that its mates leave free, and what stands in each. Deterministic. */
[[nodiscard]] OrderRules FindOrderRules(const simulation::Model& model,
                                        const OrderRuleOptions& options);

}  // namespace hvas::orders
