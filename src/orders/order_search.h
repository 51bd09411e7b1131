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

#include "orders/hand_time.h"
#include "orders/order_rules.h"
#include "simulation/arm.h"

namespace hvas::orders {

/** What makes an order worse: how often each happens in it, and what it asks of the hand. */
struct OrderCounts {
  int turns{0};              ///< The product is turned, because a part would come in from below.
  int direction_changes{0};  ///< A part comes from another direction than the one before it.
  int tool_changes{0};       ///< A part needs another tool than the last one that needed one.
  int loose{0};              ///< Nothing holds a part when it comes, and it has to be held.
  int cramped{0};  ///< A fastener comes when parts stand where its tool turns, of those that move.

  double reach{0};  ///< How far the hand goes in among what is there, of all moves [m].
  double force{0};  ///< Force of the hands against fits and weight, of all moves [N].
  int mods{0};      ///< Time of the hand (hand_time.h) [MOD].

  bool operator==(const OrderCounts&) const = default;

  [[nodiscard]] double hand_time() const { return kModSeconds * mods; }  ///< [s]
};

/** What each of them costs, in units of one change of direction. Choices: turning a product takes
 several times as long as reaching for a part from another side (MODAPTS has 0.129 s a MOD: 17 MOD
 to turn it over by hand, 5 to go to another side), and a hand that holds a part is not free for the
 next. A hand that goes in by 0.1 m, or a force of 50 N, costs as much as another side. The time of
 the hand is told, but costs nothing, as what it depends on is counted already; with all others at
 0 it is what orders are compared by. */
struct OrderWeights {
  double turn{4};
  double direction_change{1};
  double tool_change{2};
  double loose{5};
  double cramped{10};   ///< A fastener that its usual tool does not reach may not go in at all.
  double reach{10};     ///< Each metre.
  double force{0.02};   ///< Each newton.
  double hand_time{0};  ///< Each second.
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

/** The side of the product that is upwards when each move of an order comes: unit vectors along the
 axes, which change as seldom as can be, by OrderCounts::turns times. Of the sides from which no
 part comes in from below meanwhile it is the first one of OrderRules::up_sides. */
[[nodiscard]] std::vector<Vec3> ListUpSides(const OrderRules& rules, const FoundOrder& order);

/** What a move of an order asks of the hand. */
struct HandWork {
  double reach{0};  ///< [m]
  double force{0};  ///< Force of both hands, each 100 N at most: more is for a press [N].
  double press{0};  ///< What the fits need [N].
  int mods{0};      ///< Its time, with a turn of the product or another tool before it [MOD].
  std::vector<HandMotion> motions;  ///< What this time is made of, in the order of the work.
};

/** What each move of an order asks of the hand; their sums are those of OrderCounts. A move whose
 FreeMove::motions are not known has only those that the order adds. */
[[nodiscard]] std::vector<HandWork> ListHandWork(const OrderRules& rules, const FoundOrder& order);

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
[[nodiscard]] std::vector<sequence::SequenceStep> ListSteps(const OrderRules& rules,
                                                            const FoundOrder& order);

}  // namespace hvas::orders
