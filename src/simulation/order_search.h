#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "simulation/order_rules.h"

namespace hvas::simulation {

/** What makes an order worse: how often each happens in it. */
struct OrderCounts {
  int turns{0};              ///< The product is turned, because a part would come in from below.
  int direction_changes{0};  ///< A part comes from another direction than the one before it.
  int tool_changes{0};       ///< A part needs another tool than the last one that needed one.
  int loose{0};              ///< Nothing holds a part when it comes, and it has to be held.
  int cramped{0};  ///< A fastener comes when parts stand where its tool turns, of those that move.

  bool operator==(const OrderCounts&) const = default;
};

/** What each of them costs, in units of one change of direction. Choices: turning a product takes
 several times as long as reaching for a part from another side (MODAPTS has 0.129 s a MOD: 17 MOD
 to turn by hand, 5 to reach elsewhere), and a hand that holds a part is not free for the next. */
struct OrderWeights {
  double turn{4};
  double direction_change{1};
  double tool_change{2};
  double loose{5};
  double cramped{10};  ///< A fastener that its usual tool does not reach may not go in at all.
};

[[nodiscard]] double CalcCost(const OrderCounts& counts, const OrderWeights& weights);

/** One move has to come before another, as the user wishes. */
struct OrderWish {
  std::size_t first{0};
  std::size_t then{0};
};

struct OrderSearchOptions {
  OrderWeights weights;
  std::vector<OrderWish> wishes;
  std::size_t most_orders{5};  ///< How many of the best orders are given.
  bool gives_front{false};     ///< All orders found of which none is better in everything (Pareto).
  /** How many moves are tried in all: the search looks ever more widely until then. */
  std::uint64_t most_tries{20'000'000};
  std::optional<std::chrono::steady_clock::time_point> deadline;  ///< Ends it before that.
  std::function<void(double fraction)> progress;  ///< Called by the calling thread; may be null.
  std::stop_token stop;
};

/** An order of all moves. */
struct FoundOrder {
  std::vector<std::size_t> moves;  ///< The order in which they come.
  std::vector<std::size_t> ways;   ///< The number of the way by which each goes.
  OrderCounts counts;
  double cost{0};
};

struct OrderSearch {
  std::vector<FoundOrder> orders;  ///< The best one first; empty where the wishes contradict.
  FoundOrder planned;              ///< The order that the planner found, for comparison.
  std::uint64_t tries{0};          ///< Moves that were tried.
  std::size_t width{0};            ///< So many orders were followed at once, at last.
  bool is_ended_early{false};      ///< A deadline or a stop ended it: more may be found.
  /** Where the wishes contradict what stands in the way: moves that wait for each other. */
  std::vector<std::size_t> stuck;
};

/** Finds orders of low cost: a beam search that takes the product apart, where what can go now can
 also go later, so that it never has to go back; each round is as wide again as four of the one
 before. No order is proved to be the best. The same rules and options, without a deadline, give the
 same orders. */
[[nodiscard]] OrderSearch FindOrders(const OrderRules& rules, const OrderSearchOptions& options);

/** What an order counts. */
[[nodiscard]] OrderCounts CountOrder(const OrderRules& rules, const FoundOrder& order);

/** The sides of the product that may be upwards when each move of an order comes: unit vectors
 along the axes. They change as seldom as can be, by OrderCounts::turns times; the fixture may hold
 the product with any of the first ones upwards. */
[[nodiscard]] std::vector<std::vector<Vec3>> ListUpSides(const OrderRules& rules,
                                                         const FoundOrder& order);

/** What stands in the space of a fastener's tool when it comes at a place in an order: parts of
 moves before it, and those that never move. */
[[nodiscard]] std::vector<product::OccurrenceId> ListInToolSpace(const OrderRules& rules,
                                                                 const FoundOrder& order,
                                                                 std::size_t place);

/** Why a move cannot come at a place in an order: the moves that stand in each of its ways by then.
 Empty where it can. */
[[nodiscard]] std::vector<std::size_t> ListBlocking(const OrderRules& rules,
                                                    const std::vector<std::size_t>& before,
                                                    std::size_t move);

/** The steps of an order: what comes first, then its moves. */
[[nodiscard]] std::vector<SequenceStep> ListSteps(const OrderRules& rules, const FoundOrder& order);

}  // namespace hvas::simulation
