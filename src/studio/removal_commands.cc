// Handlers of the commands "plan_removal" and "take_out" in docs/protocol.md.
#include <utility>

#include "base/units.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

using simulation::DisassemblyPlan;
using simulation::Removal;

Json DescribeRemoval(const Removal& removal) {
  Json occurrences = Json::array({removal.step.occurrence.value()});
  for (const product::OccurrenceId member : removal.step.members) {
    occurrences.push_back(member.value());
  }
  Json waits_for = Json::array();
  for (const sequence::Obstacle& obstacle : removal.waits_for) {
    waits_for.push_back(obstacle.occurrence.value());
  }
  return {{"occurrences", std::move(occurrences)},
          {"waits_for", std::move(waits_for)},
          {"way_mm", units::ToMm(removal.way_length)},
          {"breakaway_n", removal.breakaway}};
}

Result<Json> Describe(const Result<DisassemblyPlan>& plan) {
  if (!plan) {
    return Unexpected(plan.error());
  }
  Json removals = Json::array();
  for (const Removal& removal : plan->removals) {
    removals.push_back(DescribeRemoval(removal));
  }
  return Json{{"removals", std::move(removals)}, {"is_smallest", plan->is_smallest}};
}

/** Sends a plan to the client that waits for it. */
WorkbenchDemo::PlannedFn MakeReply(EventBus* events, const std::string& to, const Json& reply_to) {
  return [events, to, reply_to](const Result<DisassemblyPlan>& plan) {
    events->Publish(MakeDeferredReply(to, reply_to, Describe(plan)));
  };
}

}  // namespace

Result<Json> Hub::DoPlanRemoval(const Caller& caller, const protocol::PlanRemovalCommand& command) {
  const auto posted = workbench_->demo().PlanRemoval(
      product::OccurrenceId(command.occurrence),
      MakeReply(&workbench_->events(), caller.id, IdOf(caller.command)));
  return posted ? Result<Json>(MakeDeferredResult()) : Unexpected(posted.error());
}

Result<Json> Hub::DoTakeOut(const Caller& caller, const protocol::TakeOutCommand& command) {
  const auto posted =
      workbench_->demo().TakeOut(product::OccurrenceId(command.occurrence),
                                 MakeReply(&workbench_->events(), caller.id, IdOf(caller.command)));
  return posted ? Result<Json>(MakeDeferredResult()) : Unexpected(posted.error());
}

}  // namespace hvas::studio
