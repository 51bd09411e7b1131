#include "studio/workbench_orders.h"

#include <string_view>
#include <utility>

#include "studio/event_json.h"

namespace hvas::studio {

using orders::OrderRules;
using product::OccurrenceId;

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

void WorkbenchOrders::Keep(const std::shared_ptr<const Model>& model, const OrderRules& rules) {
  model_ = model;
  rules_ = rules;
}

const OrderRules& WorkbenchOrders::RulesOf(const std::shared_ptr<const Model>& model,
                                           const std::stop_token& stop) {
  if (model_ != model) {
    orders::OrderRuleOptions options;
    options.stop = stop;
    options.progress = MakeStageProgress(parts_.events, "ways of the parts");
    Keep(model, orders::FindOrderRules(*model, options));
    if (stop.stop_requested()) {
      model_ = nullptr;  // Some rules are missing.
    }
  }
  return rules_;
}

Result<void> WorkbenchOrders::Post(ModelJob job) {
  const auto open = parts_.live->FindScene();
  if (!open) {
    return Unexpected(open.error());
  }
  parts_.worker->Post([this, job = std::move(job)](const std::stop_token& stop) {
    job(parts_.live->scene()->model, stop);
  });
  return {};
}

Result<void> WorkbenchOrders::Find(const FoundFn& done) {
  return Post([this, done](const std::shared_ptr<const Model>& model, const std::stop_token& stop) {
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

Result<void> WorkbenchOrders::Check(const std::vector<OccurrenceId>& occurrences,
                                    const CheckedFn& done) {
  return Post([this, occurrences, done](const std::shared_ptr<const Model>& model,
                                        const std::stop_token& stop) {
    const OrderRules& rules = RulesOf(model, stop);
    assembly::PlanOptions options;
    options.stop = stop;
    done(rules, assembly::CheckOrder(*model, rules, occurrences, options));
  });
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
  const std::shared_ptr<const OpenScene> before = parts_.live->scene();
  const auto after =
      parts_.builder->ChangeOrder(*before, RulesOf(before->model, stop), occurrences, stop);
  if (after) {
    parts_.edits->Replace(*after, kWhat);
  } else {
    parts_.events->Publish(
        {{"event", "failed"}, {"file", kWhat}, {"error", ToJson(after.error())}});
  }
}

Result<void> WorkbenchOrders::Explain(OccurrenceId id, const ExplainedFn& done) {
  return Post(
      [this, id, done](const std::shared_ptr<const Model>& model, const std::stop_token& stop) {
        orders::GapReasonOptions options;
        options.stop = stop;
        options.progress = MakeStageProgress(parts_.events, "why the part is left out");
        done(*model, orders::ExplainGap(*model, id, options));
      });
}

}  // namespace hvas::studio
