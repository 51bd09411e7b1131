#include "assembly/plan_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "orders/state_statics.h"

namespace hvas::assembly {
namespace {

using orders::OrderRules;
using orders::OrderWish;
using product::OccurrenceId;
using simulation::Model;

std::size_t FindMove(const OrderRules& rules, OccurrenceId id) {
  const auto has_part = [id](const orders::FreeMove& move) {
    return std::find(move.parts.begin(), move.parts.end(), id) != move.parts.end();
  };
  const auto found = std::find_if(rules.moves.begin(), rules.moves.end(), has_part);
  return static_cast<std::size_t>(found - rules.moves.begin());
}

Result<std::size_t> FindMove(const Model& model, const OrderRules& rules, const std::string& name) {
  const auto id = mates::FindOccurrence(*model.product, name);
  if (!id) {
    return Unexpected(id.error());
  }
  const std::size_t move = FindMove(rules, *id);
  if (move == rules.moves.size()) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} has no turn of its own in the order: it is the base, stays out, or "
                            "belongs to what is put together first",
                            model.product->occurrences[id->index()].path),
                model.product->source, "name another part");
  }
  return move;
}

Result<std::vector<OrderWish>> ListWishes(const Model& model, const OrderRules& rules,
                                          const PlanOptions& options) {
  if (options.order.size() == 1) {  // It wishes for nothing, but has to mean a part.
    if (const auto only = FindMove(model, rules, options.order.front()); !only) {
      return Unexpected(only.error());
    }
  }
  std::vector<std::pair<std::string, std::string>> pairs = options.before;
  for (std::size_t i = 1; i < options.order.size(); ++i) {
    pairs.emplace_back(options.order[i - 1], options.order[i]);
  }
  std::vector<OrderWish> wishes;
  for (const auto& [first, then] : pairs) {
    const auto a = FindMove(model, rules, first);
    const auto b = FindMove(model, rules, then);
    if (!a || !b) {
      return Unexpected(a ? b.error() : a.error());
    }
    if (*a == *b) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("\"{}\" and \"{}\" move as one, and neither comes first", first, then),
          model.product->source, "name other parts");
    }
    wishes.push_back({*a, *b});
  }
  return wishes;
}

std::string PathOfMove(const Model& model, const OrderRules& rules, std::size_t move) {
  return model.product->occurrences[rules.moves[move].parts.front().index()].path;
}

/** Says why moves that are left cannot come as asked for. */
Error ExplainStuck(const Model& model, const OrderRules& rules,
                   const std::vector<OrderWish>& wishes, const std::vector<std::size_t>& stuck) {
  const auto is_stuck = [&stuck](std::size_t move) {
    return std::binary_search(stuck.begin(), stuck.end(), move);
  };
  std::string text;
  for (const OrderWish& wish : wishes) {
    if (!is_stuck(wish.first) || !is_stuck(wish.then)) {
      continue;
    }
    std::vector<std::size_t> others = stuck;
    std::erase(others, wish.then);
    const std::vector<std::size_t> blocking = orders::ListBlocking(rules, others, wish.then);
    const std::string then = PathOfMove(model, rules, wish.then);
    text += fmt::format("{}{} is to come before {}", text.empty() ? "" : "; ",
                        PathOfMove(model, rules, wish.first), then);
    if (!blocking.empty()) {
      const bool is_same =
          std::find(blocking.begin(), blocking.end(), wish.first) != blocking.end();
      text += fmt::format(", but {} would then be in the way of the latter",
                          is_same ? "the former" : PathOfMove(model, rules, blocking.front()));
    }
  }
  return {ErrorCode::kInvalid, "no order is as asked for: " + text, model.product->source,
          "leave out one of these wishes"};
}

/** What has to be held after each move of an order; none after a stop, or where it is not known. */
std::optional<OrderStatics> CalcStatics(const Model& model, const orders::StateStatics& states,
                                        const OrderRules& rules, const orders::FoundOrder& order,
                                        const std::stop_token& stop) {
  OrderStatics statics;
  statics.up_W = orders::ListUpSides(rules, order);
  std::vector<bool> is_in_place(model.bodies.size(), false);
  is_in_place[sequence::FindBase(model.sequence).index()] = true;
  // A state of 500 parts that falls takes a second, one of 40 some milliseconds.
  constexpr std::size_t kMostBodies = 20'000;
  const std::size_t stride = 1 + order.moves.size() * model.bodies.size() / kMostBodies;
  statics.holds.resize(order.moves.size());
  for (std::size_t i = 0; i < order.moves.size(); ++i) {
    for (const OccurrenceId part : rules.moves[order.moves[i]].parts) {
      is_in_place[part.index()] = true;
    }
    if ((order.moves.size() - 1 - i) % stride != 0) {
      continue;
    }
    orders::StateStaticsOptions state_options;
    state_options.ghat_W = -statics.up_W[i];
    const auto state = states.CalcStability(is_in_place, state_options);
    if (!state || stop.stop_requested()) {
      return std::nullopt;
    }
    ++statics.looked_at;
    statics.held_states += state->holds.empty() ? 0 : 1;
    statics.holds[i] = state->holds;
  }
  return statics;
}

// Orders whose costs differ by less than this are as good as one another: a tenth of one change of
// direction, a choice.
constexpr double kAlikeCost = 0.1;

/** Finds the statics of the orders, and puts those first of about equal cost in which less has to
 be held. */
void AddStatics(const Model& model, const PlanOptions& options, OrderPlan* plan) {
  const orders::StateStatics states(model);
  std::vector<orders::FoundOrder>& orders = plan->search.orders;
  // The first order of so many moves, more of fewer: a choice.
  constexpr std::size_t kMostStates = 300;
  std::size_t states_left = kMostStates;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (i > 0 && states_left < orders[i].moves.size()) {
      break;
    }
    states_left -= std::min(states_left, orders[i].moves.size());
    auto statics = CalcStatics(model, states, plan->rules, orders[i], options.stop);
    if (!statics) {
      return;
    }
    plan->statics.push_back(std::move(*statics));
    if (options.progress) {
      options.progress("statics", static_cast<double>(i + 1) / static_cast<double>(orders.size()));
    }
  }
  std::vector<std::size_t> places(plan->statics.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(std::floor(orders[a].cost / kAlikeCost), plan->statics[a].held_states) <
           std::pair(std::floor(orders[b].cost / kAlikeCost), plan->statics[b].held_states);
  });
  std::vector<orders::FoundOrder> sorted;
  std::vector<OrderStatics> statics;
  for (const std::size_t place : places) {
    sorted.push_back(std::move(orders[place]));
    statics.push_back(std::move(plan->statics[place]));
  }
  std::move(sorted.begin(), sorted.end(), orders.begin());
  plan->statics = std::move(statics);
}

}  // namespace

Result<OrderPlan> PlanOrder(const Model& model, const PlanOptions& options) {
  OrderPlan plan;
  orders::OrderRuleOptions rule_options;
  rule_options.stop = options.stop;
  const auto report = [&options](const char* stage) {
    return [&options, stage](double fraction) {
      if (options.progress) {
        options.progress(stage, fraction);
      }
    };
  };
  rule_options.progress = report("ways of the parts");
  plan.rules = orders::FindOrderRules(model, rule_options);
  auto wishes = ListWishes(model, plan.rules, options);
  if (!wishes) {
    return Unexpected(wishes.error());
  }
  orders::OrderSearchOptions search;
  search.weights = options.weights;
  search.wishes = *wishes;
  search.most_orders = options.most_orders;
  search.gives_front = options.gives_front;
  search.progress = report("order of least cost");
  search.stop = options.stop;
  if (options.time) {
    search.deadline =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(*options.time);
  }
  plan.search = orders::FindOrders(plan.rules, search);
  if (plan.search.orders.empty() && !plan.rules.moves.empty() && !options.stop.stop_requested()) {
    return Unexpected(ExplainStuck(model, plan.rules, *wishes, plan.search.stuck));
  }
  AddStatics(model, options, &plan);
  if (!plan.statics.empty() && !plan.statics.front().up_W.empty()) {
    plan.standing_margin = orders::CalcStandingMargin(model, sequence::FindBase(model.sequence),
                                                      Vec3(-plan.statics.front().up_W.front()));
  }
  ExplainGapsOptions gaps;
  gaps.most = options.most_reasons;
  gaps.progress = report("why parts are left out");
  gaps.stop = options.stop;
  plan.reasons = ExplainGaps(model, gaps);
  return plan;
}

namespace {

Result<std::vector<std::size_t>> FindMoves(const Model& model, const OrderRules& rules,
                                           const std::vector<OccurrenceId>& parts) {
  std::vector<std::size_t> moves;
  std::vector<bool> is_there(rules.moves.size(), false);
  for (const OccurrenceId part : parts) {
    const std::size_t move = FindMove(rules, part);
    if (move == rules.moves.size() || is_there[move]) {
      const bool is_part = part.index() < model.product->occurrences.size();
      return Fail(ErrorCode::kInvalid,
                  move == rules.moves.size() ? "this part has no turn of its own in the order"
                                             : "this part comes twice in the order",
                  is_part ? model.product->occurrences[part.index()].path
                          : fmt::format("o{}", part.value()),
                  "name one part of each step");
    }
    is_there[move] = true;
    moves.push_back(move);
  }
  const auto missing = std::find(is_there.begin(), is_there.end(), false);
  if (missing != is_there.end()) {
    return Fail(ErrorCode::kInvalid, "this part is missing in the order",
                PathOfMove(model, rules, static_cast<std::size_t>(missing - is_there.begin())),
                "name one part of each step");
  }
  return moves;
}

}  // namespace

Result<CheckedOrder> CheckOrder(const Model& model, const OrderRules& rules,
                                const std::vector<OccurrenceId>& parts,
                                const PlanOptions& options) {
  auto moves = FindMoves(model, rules, parts);
  if (!moves) {
    return Unexpected(moves.error());
  }
  CheckedOrder checked;
  orders::OrderSearchOptions search;
  search.weights = options.weights;
  search.most_orders = 1;
  search.stop = options.stop;
  std::vector<std::size_t> before;
  for (const std::size_t move : *moves) {
    checked.blocking.push_back(orders::ListBlocking(rules, before, move));
    if (!before.empty()) {
      search.wishes.push_back({before.back(), move});
    }
    before.push_back(move);
  }
  checked.moves = *std::move(moves);
  const bool is_free = std::all_of(checked.blocking.begin(), checked.blocking.end(),
                                   [](const auto& blocking) { return blocking.empty(); });
  if (is_free) {
    orders::OrderSearch found = orders::FindOrders(rules, search);
    if (!found.orders.empty()) {
      checked.order = std::move(found.orders.front());
      checked.statics =
          CalcStatics(model, orders::StateStatics(model), rules, *checked.order, options.stop);
    }
  }
  if (options.stop.stop_requested()) {
    return Fail(ErrorCode::kCancelled, "checking the order was cancelled", model.product->source);
  }
  return checked;
}

}  // namespace hvas::assembly
