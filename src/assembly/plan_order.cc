#include "assembly/plan_order.h"

#include <algorithm>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "simulation/fastener_tool.h"

namespace hvas::assembly {
namespace {

using product::OccurrenceId;
using simulation::Model;
using simulation::OrderRules;
using simulation::OrderWish;

std::size_t FindMove(const OrderRules& rules, OccurrenceId id) {
  const auto has_part = [id](const simulation::FreeMove& move) {
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
    const std::vector<std::size_t> blocking = simulation::ListBlocking(rules, others, wish.then);
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

}  // namespace

Result<OrderPlan> PlanOrder(const Model& model, const PlanOptions& options) {
  OrderPlan plan;
  simulation::OrderRuleOptions rule_options;
  rule_options.stop = options.stop;
  const auto report = [&options](const char* stage) {
    return [&options, stage](double fraction) {
      if (options.progress) {
        options.progress(stage, fraction);
      }
    };
  };
  rule_options.progress = report("ways of the parts");
  plan.rules = simulation::FindOrderRules(model, rule_options);
  auto wishes = ListWishes(model, plan.rules, options);
  if (!wishes) {
    return Unexpected(wishes.error());
  }
  const std::vector<std::string> tools = simulation::NameTools(*model.product);
  for (const simulation::FreeMove& move : plan.rules.moves) {
    plan.tools.push_back(move.parts.size() == 1 ? tools[move.parts.front().index()] : "");
  }
  simulation::OrderSearchOptions search;
  search.weights = options.weights;
  search.wishes = *wishes;
  search.tools = plan.tools;
  search.most_orders = options.most_orders;
  search.gives_front = options.gives_front;
  search.progress = report("order of least cost");
  search.stop = options.stop;
  if (options.time) {
    search.deadline =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(*options.time);
  }
  plan.search = simulation::FindOrders(plan.rules, search);
  if (plan.search.orders.empty() && !plan.rules.moves.empty() && !options.stop.stop_requested()) {
    return Unexpected(ExplainStuck(model, plan.rules, *wishes, plan.search.stuck));
  }
  return plan;
}

}  // namespace hvas::assembly
