#include "studio/workbench_orders.h"

#include <string_view>
#include <utility>

#include "studio/commands.h"
#include "studio/event_json.h"

namespace hvas::studio {

using product::OccurrenceId;
using simulation::OrderRules;

namespace {

constexpr const char* kWhat = "order of assembly";  // The work, and its undo step, for people.

cad::ProgressFn MakeOrderProgress(const EventBus* events) {
  return [events](std::string_view stage, double fraction) {
    events->Publish({{"event", "order_progress"}, {"stage", stage}, {"fraction", fraction}});
  };
}

std::function<void(double)> MakeStageProgress(const EventBus* events, std::string_view stage) {
  return [report = MakeOrderProgress(events), stage](double fraction) { report(stage, fraction); };
}

}  // namespace

Result<void> WorkbenchOrders::CheckOpen() const {
  if (parts_.live->scene() == nullptr) {
    return Fail(ErrorCode::kNotFound, "no product is open", "", "open a file or an example first");
  }
  return {};
}

void WorkbenchOrders::Keep(const std::shared_ptr<const Model>& model, const OrderRules& rules) {
  model_ = model;
  rules_ = rules;
}

const OrderRules& WorkbenchOrders::RulesOf(const std::shared_ptr<const Model>& model,
                                           const std::stop_token& stop) {
  if (model_ != model) {
    simulation::OrderRuleOptions options;
    options.stop = stop;
    options.progress = MakeStageProgress(parts_.events, "ways of the parts");
    Keep(model, simulation::FindOrderRules(*model, options));
    if (stop.stop_requested()) {
      model_ = nullptr;  // Some rules are missing.
    }
  }
  return rules_;
}

Result<void> WorkbenchOrders::Find(const FoundFn& done) {
  auto open = CheckOpen();
  if (open) {
    parts_.worker->Post([this, done](const std::stop_token& stop) {
      const std::shared_ptr<const Model> model = parts_.live->scene()->model;
      assembly::PlanOptions options;
      options.most_reasons = 0;  // The parts that stay out have theirs already.
      options.progress = MakeOrderProgress(parts_.events);
      options.stop = stop;
      const auto plan = assembly::PlanOrder(*model, options);
      if (plan && !stop.stop_requested()) {
        Keep(model, plan->rules);
      }
      done(plan);
    });
  }
  return open;
}

Result<void> WorkbenchOrders::Check(const std::vector<OccurrenceId>& occurrences,
                                    const CheckedFn& done) {
  auto open = CheckOpen();
  if (open) {
    parts_.worker->Post([this, occurrences, done](const std::stop_token& stop) {
      const std::shared_ptr<const Model> model = parts_.live->scene()->model;
      const OrderRules& rules = RulesOf(model, stop);
      assembly::PlanOptions options;
      options.stop = stop;
      done(rules, assembly::CheckOrder(*model, rules, occurrences, options));
    });
  }
  return open;
}

Result<void> WorkbenchOrders::Set(const std::vector<OccurrenceId>& occurrences) {
  auto idle = parts_.live->CheckIdle();
  if (idle) {
    parts_.worker->Post(
        [this, occurrences](const std::stop_token& stop) { DoSet(occurrences, stop); });
  }
  return idle;
}

void WorkbenchOrders::DoSet(const std::vector<OccurrenceId>& occurrences,
                            const std::stop_token& stop) {
  const std::shared_ptr<const OpenScene> scene = parts_.live->scene();
  const OrderRules& rules = RulesOf(scene->model, stop);
  assembly::PlanOptions options;
  options.stop = stop;
  const auto checked = assembly::CheckOrder(*scene->model, rules, occurrences, options);
  if (!checked || !checked->order) {
    const Error error =
        checked ? Error{ErrorCode::kInvalid, "some part cannot come where it is in this order",
                        scene->name, "check the order, and move that part"}
                : checked.error();
    parts_.events->Publish({{"event", "failed"}, {"file", kWhat}, {"error", ToJson(error)}});
    return;
  }
  parts_.edits->Replace(
      parts_.builder->ChangeOrder(
          *scene, simulation::ListSteps(rules, *checked->order),
          {{"command", protocol::SetOrderCommand::kName}, {"occurrences", ToJson(occurrences)}}),
      kWhat);
}

Result<void> WorkbenchOrders::Explain(OccurrenceId id, const ExplainedFn& done) {
  auto open = CheckOpen();
  if (open) {
    parts_.worker->Post([this, id, done](const std::stop_token& stop) {
      const std::shared_ptr<const Model> model = parts_.live->scene()->model;
      simulation::GapReasonOptions options;
      options.stop = stop;
      options.progress = MakeStageProgress(parts_.events, "why the part is left out");
      done(*model, simulation::ExplainGap(*model, id, options));
    });
  }
  return open;
}

}  // namespace hvas::studio
