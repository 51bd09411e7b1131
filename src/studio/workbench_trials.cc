#include "studio/workbench_trials.h"

#include <utility>

#include "studio/event_json.h"
#include "study/simulated_participant.h"
#include "study/trial_pair.h"

namespace hvas::studio {
namespace {

using simulation::Placement;

/** Makes the state in which parts that precede a step are in their place, all others on the
 table. */
LiveState MakeTrialState(const simulation::Model& model, std::size_t step) {
  LiveState state = MakeStart(model);
  for (std::size_t i = 0; i < step; ++i) {
    const product::OccurrenceId id = model.sequence.steps[i].occurrence;
    state.parts[id.index()] = {Placement::kPlaced, model.bodies[id.index()].X_WB_goal};
  }
  state.next_step = step;
  return state;
}

}  // namespace

void WorkbenchTrials::Begin(const LiveTrial::Plan& plan) {
  parts_.worker->Post([this, plan](const std::stop_token& /*stop*/) { DoBegin(plan); });
}

void WorkbenchTrials::End() {
  parts_.worker->Post([this](const std::stop_token& /*stop*/) { DoEnd(); });
}

std::shared_ptr<LiveTrial> WorkbenchTrials::trial() const {
  const std::lock_guard lock(mutex_);
  return current_.trial;
}

product::OccurrenceId WorkbenchTrials::part() const {
  const std::lock_guard lock(mutex_);
  return current_.trial != nullptr ? current_.scene->model->sequence.steps[current_.step].occurrence
                                   : product::OccurrenceId();
}

std::vector<product::MateId> WorkbenchTrials::ListConstraints() const {
  const std::lock_guard lock(mutex_);
  return current_.trial != nullptr
             ? study::ListPickedConstraints(current_.trial->plan().condition,
                                            *current_.scene->model, current_.step)
             : std::vector<product::MateId>();
}

Result<std::shared_ptr<const OpenScene>> WorkbenchTrials::FindScene(const LiveTrial::Plan& plan) {
  const std::string& digest = parts_.live->scene()->digest;
  std::shared_ptr<const OpenScene>& known =
      scenes_[{digest, study::MakeFitKey(plan.condition, plan.part)}];
  if (known == nullptr) {
    const auto assign = [&](product::Product* product) {
      return study::ApplyFit(plan.condition, plan.part, product);
    };
    auto changed =
        parts_.builder->Change(*parts_.live->scene(), {"trial", nullptr, assign}, nullptr);
    if (!changed) {
      return changed;
    }
    known = std::move(*changed);
  }
  return known;
}

Result<WorkbenchTrials::Current> WorkbenchTrials::Make(const LiveTrial::Plan& plan) {
  if (parts_.live->scene() == nullptr) {
    return Fail(ErrorCode::kNotFound, "no product is open", "", "");
  }
  const auto scene = FindScene(plan);
  if (!scene) {
    return Unexpected(scene.error());
  }
  const auto step = study::FindPartStep(*(*scene)->model, plan.part);
  if (!step) {
    return Unexpected(step.error());
  }
  const auto model = study::DrawPair(*(*scene)->model, *step, plan.condition, plan.pair_seed);
  if (!model) {
    return Unexpected(model.error());
  }
  auto trial = LiveTrial::Make(plan, **model, *step, period_s_);
  if (!trial) {
    return Unexpected(trial.error());
  }
  return Current{std::move(*trial), parts_.builder->MakeCopy(**scene, *model), *step};
}

void WorkbenchTrials::DoBegin(const LiveTrial::Plan& plan) {
  const auto made = Make(plan);
  if (!made) {
    parts_.events->Publish({{"event", "trial_failed"}, {"reason", made.error().ToString()}});
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    current_ = *made;
  }
  const bool is_picked = plan.condition.method == study::Method::kPicking;
  parts_.live->Show(made->scene, MakeTrialState(*made->scene->model, made->step),
                    plan.has_person && !is_picked);
  parts_.edits->ClearHistory();  // there is no undo in a study, nor of what the run before did last
  parts_.events->Publish({{"event", "trial_begun"}});
}

void WorkbenchTrials::DoEnd() {
  parts_.live->EndRun();  // its threads have ended then, so that the trial's result is final
  Current ended;
  {
    const std::lock_guard lock(mutex_);
    ended = std::exchange(current_, {});
  }
  if (ended.trial != nullptr) {
    if (const auto finished = ended.trial->Finish(); !finished) {
      parts_.events->Publish(
          {{"event", "failed"}, {"file", "record"}, {"error", ToJson(finished.error())}});
    }
  }
  parts_.events->Publish({{"event", "trial_over"}});
}

void WorkbenchTrials::ConfigureRun(const OpenScene& /*scene*/, LiveOptions* live) {
  live->trial = trial();
}

}  // namespace hvas::studio
