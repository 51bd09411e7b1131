// Handlers of the commands "find_orders", "check_order" and "explain_gap" in docs/protocol.md.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "evidence/gap_picture.h"
#include "pages/embedded_image.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

using assembly::CheckedOrder;
using assembly::OrderPlan;
using orders::FoundOrder;
using orders::OrderRules;
using product::OccurrenceId;

/** An order of which everything is known that a client sees. */
struct DescribedOrder {
  const OrderRules& rules;
  const std::vector<std::size_t>& moves;
  const std::vector<std::vector<std::size_t>>* blocking;  ///< By place; null: none is blocked.
  const FoundOrder* order;                                ///< Null: it is not possible.
  const assembly::OrderStatics* statics;                  ///< Null: they are not known.
};

Json LeadersOf(const OrderRules& rules, const std::vector<std::size_t>& moves) {
  std::vector<OccurrenceId> leaders;
  leaders.reserve(moves.size());
  for (const std::size_t move : moves) {
    leaders.push_back(rules.moves[move].parts.front());
  }
  return ToJson(leaders);
}

Json MakeOrderJson(const DescribedOrder& described) {
  Json moves = Json::array();
  for (std::size_t place = 0; place < described.moves.size(); ++place) {
    const orders::FreeMove& move = described.rules.moves[described.moves[place]];
    const std::vector<OccurrenceId> members(move.parts.begin() + 1, move.parts.end());
    const bool has_holds = described.statics != nullptr && described.statics->holds[place];
    moves.push_back(
        {{"occurrence", move.parts.front().value()},
         {"members", ToJson(members)},
         {"blocked_by", described.blocking != nullptr
                            ? LeadersOf(described.rules, (*described.blocking)[place])
                            : Json::array()},
         {"in_tool_space",
          described.order != nullptr
              ? ToJson(orders::ListInToolSpace(described.rules, *described.order, place))
              : Json::array()},
         {"holds", has_holds ? ToJson(*described.statics->holds[place]) : Json(nullptr)}});
  }
  const FoundOrder* order = described.order;
  const auto count = [order](auto orders::OrderCounts::*which) {
    return order != nullptr ? Json(order->counts.*which) : Json(nullptr);
  };
  using orders::OrderCounts;
  return {{"moves", std::move(moves)},
          {"is_possible", order != nullptr},
          {"cost", order != nullptr ? Json(order->cost) : Json(nullptr)},
          {"turns", count(&OrderCounts::turns)},
          {"direction_changes", count(&OrderCounts::direction_changes)},
          {"tool_changes", count(&OrderCounts::tool_changes)},
          {"loose", count(&OrderCounts::loose)},
          {"cramped", count(&OrderCounts::cramped)},
          {"reach_m", count(&OrderCounts::reach)},
          {"force_n", count(&OrderCounts::force)},
          {"hand_time_s", order != nullptr ? Json(order->counts.hand_time()) : Json(nullptr)}};
}

Result<Json> Describe(const Result<OrderPlan>& plan) {
  if (!plan) {
    return Unexpected(plan.error());
  }
  Json orders = Json::array();
  for (std::size_t i = 0; i < plan->search.orders.size(); ++i) {
    const FoundOrder& order = plan->search.orders[i];
    orders.push_back(MakeOrderJson({plan->rules, order.moves, nullptr, &order,
                                    i < plan->statics.size() ? &plan->statics[i] : nullptr}));
  }
  return Json{{"orders", std::move(orders)}, {"is_ended_early", plan->search.is_ended_early}};
}

Result<Json> Describe(const OrderRules& rules, const Result<CheckedOrder>& checked) {
  if (!checked) {
    return Unexpected(checked.error());
  }
  return MakeOrderJson({rules, checked->moves, &checked->blocking,
                        checked->order ? &*checked->order : nullptr,
                        checked->statics ? &*checked->statics : nullptr});
}

Result<Json> Describe(const simulation::Model& model, const Result<orders::GapReason>& reason) {
  if (!reason) {
    return Unexpected(reason.error());
  }
  const std::string png = evidence::MakeGapPicture(model, *reason);
  return Json{{"lines", orders::FormatGapReason(model, *reason)},
              {"picture", png.empty() ? png : pages::MakePngAddress(png)},
              {"picture_about", evidence::DescribeGapPicture(model, *reason)}};
}

}  // namespace

Result<Json> Hub::DoFindOrders(const Caller& caller, const protocol::FindOrdersCommand&) {
  const auto posted =
      workbench_->orders().Find([events = &workbench_->events(), to = caller.id,
                                 id = IdOf(caller.command)](const Result<OrderPlan>& plan) {
        events->Publish(MakeDeferredReply(to, id, Describe(plan)));
      });
  return posted ? Result<Json>(MakeDeferredResult()) : Unexpected(posted.error());
}

Result<Json> Hub::DoCheckOrder(const Caller& caller, const protocol::CheckOrderCommand& command) {
  const auto posted = workbench_->orders().Check(
      command.occurrences,
      [events = &workbench_->events(), to = caller.id, id = IdOf(caller.command)](
          const OrderRules& rules, const Result<CheckedOrder>& checked) {
        events->Publish(MakeDeferredReply(to, id, Describe(rules, checked)));
      });
  return posted ? Result<Json>(MakeDeferredResult()) : Unexpected(posted.error());
}

Result<Json> Hub::DoExplainGap(const Caller& caller, const protocol::ExplainGapCommand& command) {
  const auto posted = workbench_->orders().Explain(
      product::OccurrenceId(command.occurrence),
      [events = &workbench_->events(), to = caller.id, id = IdOf(caller.command)](
          const simulation::Model& model, const Result<orders::GapReason>& reason) {
        events->Publish(MakeDeferredReply(to, id, Describe(model, reason)));
      });
  return posted ? Result<Json>(MakeDeferredResult()) : Unexpected(posted.error());
}

}  // namespace hvas::studio
