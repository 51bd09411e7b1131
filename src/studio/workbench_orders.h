#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

#include "assembly/plan_order.h"
#include "base/job_thread.h"
#include "base/result.h"
#include "orders/gap_reason.h"
#include "studio/event_bus.h"
#include "studio/live_scene.h"
#include "studio/scene_builder.h"
#include "studio/workbench_edits.h"

namespace hvas::studio {

/** Orders of assembly of the open product: finds some of low cost, checks one that the user has
 made, makes one the order of the scene, and explains why a part is left out. Any thread may call
 any function; all return at once, and leave the work to the worker. */
class WorkbenchOrders {
 public:
  using Model = simulation::Model;

  struct Parts {
    SceneBuilder* builder;  ///< Used by the worker alone.
    LiveScene* live;
    WorkbenchEdits* edits;
    EventBus* events;
    JobThread* worker;
  };

  /** Called on the worker thread. */
  using FoundFn = std::function<void(const Result<assembly::OrderPlan>& plan)>;
  using CheckedFn = std::function<void(const orders::OrderRules& rules,
                                       const Result<assembly::CheckedOrder>& order)>;

  using ExplainedFn =
      std::function<void(const Model& model, const Result<orders::GapReason>& reason)>;

  explicit WorkbenchOrders(const Parts& parts) : parts_(parts) {}

  /** Finds orders of low cost. Reports progress by events. Errors: kNotFound where nothing is open;
   of the plan: those of assembly::PlanOrder. */
  [[nodiscard]] Result<void> Find(const FoundFn& done);

  /** Checks an order. Errors: kNotFound where nothing is open; those of assembly::CheckOrder. */
  [[nodiscard]] Result<void> Check(const std::vector<product::OccurrenceId>& occurrences,
                                   const CheckedFn& done);

  /** Makes an order the scene's; it can be undone. Reports by the event "scene", or "failed" where
   the order is not possible. Errors: those of LiveScene::CheckIdle. */
  [[nodiscard]] Result<void> Set(const std::vector<product::OccurrenceId>& occurrences);

  /** Explains why a part cannot be brought in. Reports progress by events. Errors: kNotFound where
   nothing is open; those of orders::ExplainGap. */
  [[nodiscard]] Result<void> Explain(product::OccurrenceId id, const ExplainedFn& done);

 private:
  using ModelJob =
      std::function<void(const std::shared_ptr<const Model>& model, const std::stop_token& stop)>;

  /** Has the worker do a job on the model of the scene that is open by then. Errors: kNotFound
   while nothing is open. */
  [[nodiscard]] Result<void> Post(ModelJob job);
  /** The rules of a model; they are found once. */
  const orders::OrderRules& RulesOf(const std::shared_ptr<const Model>& model,
                                    const std::stop_token& stop);
  void Keep(const std::shared_ptr<const Model>& model, const orders::OrderRules& rules);
  void DoSet(const std::vector<product::OccurrenceId>& occurrences, const std::stop_token& stop);

  const Parts parts_;
  // Used by the worker alone.
  std::shared_ptr<const Model> model_;
  orders::OrderRules rules_;  ///< Rules of model_.
};

}  // namespace hvas::studio
