#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "assembly/explain_gaps.h"
#include "base/result.h"
#include "orders/order_search.h"
#include "simulation/model.h"

namespace hvas::assembly {

struct PlanOptions {
  orders::OrderWeights weights;
  std::vector<std::pair<std::string, std::string>> before;  ///< Pairs of parts: first, then.
  /** Parts that have to come in this order, by name, path or id; the others anywhere. */
  std::vector<std::string> order;
  std::size_t most_reasons{kMostReasons};  ///< How many parts that are left out are looked into.
  std::size_t most_orders{5};              ///< A choice, as a reader compares so many.
  bool gives_front{false};
  std::optional<std::chrono::duration<double>> time;  ///< The search ends after that.
  std::function<void(const std::string& stage, double fraction)> progress;  ///< May be null.
  std::stop_token stop;
};

/** The statics of an order: what has to be held after each of its moves, under gravity, with the
 base in the fixture (docs/algorithms/statics.md). */
struct OrderStatics {
  /** The parts to hold, by place of move; none where the state was not looked at: in large products
   only every few states are, and the last. */
  std::vector<std::optional<std::vector<product::OccurrenceId>>> holds;
  int looked_at{0};        ///< How many states were looked at.
  int held_states{0};      ///< How many of these need something to be held.
  std::vector<Vec3> up_W;  ///< Unit, by place of move: the side of the product that is upwards.
};

/** Orders of assembly of a model. */
struct OrderPlan {
  orders::OrderRules rules;
  orders::OrderSearch search;  ///< Orders of about equal cost stand by how little is held.
  /** Statics of the first of search.orders: as many as 300 moves allow, one at least. */
  std::vector<OrderStatics> statics;
  /** How far a table with the base on it, as the fixture holds it first in the best order, may be
   inclined before the base tips [rad]; not above zero where it does not stand by itself. */
  double standing_margin{0};
  /** Why parts are left out: of the first of Sequence::gaps, as many as PlanOptions allows. */
  std::vector<orders::GapReason> reasons;
};

/** The best order of a plan: the one that the planner found where the search has none. */
[[nodiscard]] inline const orders::FoundOrder& BestOrder(const OrderPlan& plan) {
  return plan.search.orders.empty() ? plan.search.planned : plan.search.orders.front();
}

/** Finds orders of assembly of low cost.
 Errors: kNotFound and kInvalid for a name that does not mean one part that moves; kInvalid where
 what the user wishes contradicts what stands in the way, with the parts that wait for each other.
 @param model  As PrepareModel gives it. */
[[nodiscard]] Result<OrderPlan> PlanOrder(const simulation::Model& model,
                                          const PlanOptions& options);

/** What an order comes to that somebody has thought of. */
struct CheckedOrder {
  std::vector<std::size_t> moves;  ///< Numbers of the moves in the rules, in this order.
  /** The moves before each place of which one at least stands in each way of the move
   there; empty where it can come. */
  std::vector<std::vector<std::size_t>> blocking;
  /** The order with the ways of least cost; none where a move cannot come. */
  std::optional<orders::FoundOrder> order;
  std::optional<OrderStatics> statics;  ///< Its statics; none where they are not known.
};

/** Checks an order of all moves.
 Errors: kInvalid where the parts are not one of each move; kCancelled after a stop.
 @param parts  One part of each move, in the order of assembly.
 @param options  Of these, the weights and the stop count. */
[[nodiscard]] Result<CheckedOrder> CheckOrder(const simulation::Model& model,
                                              const orders::OrderRules& rules,
                                              const std::vector<product::OccurrenceId>& parts,
                                              const PlanOptions& options);

}  // namespace hvas::assembly
