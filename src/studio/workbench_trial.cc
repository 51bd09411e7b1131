// Trials of studies on the workbench.

#include <utility>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "studio/event_json.h"
#include "studio/workbench.h"
#include "study/simulated_participant.h"

namespace hvas::studio {
namespace {

using simulation::Placement;

/** Makes the state in which parts that precede a step are in their place, all others on the
 table. */
LiveState MakeTrialState(const simulation::Model& model, std::size_t step) {
  LiveState state;
  for (const simulation::Body& body : model.bodies) {
    state.parts.push_back({Placement::kLoose, body.X_WB_start});
  }
  for (std::size_t i = 0; i < step; ++i) {
    const product::OccurrenceId id = model.sequence.steps[i].occurrence;
    state.parts[id.index()] = {Placement::kPlaced, model.bodies[id.index()].X_WB_goal};
  }
  state.next_step = step;
  return state;
}

}  // namespace

void Workbench::BeginTrial(const LiveTrial::Plan& plan) {
  Post([this, plan] { DoBeginTrial(plan); });
}

void Workbench::EndTrial() {
  Post([this] { DoEndTrial(); });
}

std::shared_ptr<LiveTrial> Workbench::trial() const {
  const std::lock_guard lock(mutex_);
  return trial_;
}

product::OccurrenceId Workbench::trial_part() const {
  const std::lock_guard lock(mutex_);
  return trial_ != nullptr ? scene_->model->sequence.steps[trial_step_].occurrence
                           : product::OccurrenceId();
}

std::vector<product::MateId> Workbench::trial_constraints() const {
  const std::lock_guard lock(mutex_);
  return trial_ != nullptr ? study::ListConstraints(*scene_->model, trial_step_)
                           : std::vector<product::MateId>();
}

Result<std::shared_ptr<const OpenScene>> Workbench::FindTrialScene(const LiveTrial::Plan& plan) {
  std::shared_ptr<const OpenScene>& known = trial_scenes_[plan.condition.fit];
  if (known == nullptr) {
    const std::string assignment = fmt::format("{}={}", plan.part, plan.condition.fit);
    const auto assign = [&](product::Product* product) {
      return plan.condition.fit.empty() ? Result<void>() : mates::AssignFit(product, assignment);
    };
    auto changed = builder_.Change(*scene(), {"trial", nullptr, assign}, nullptr);
    if (!changed) {
      return changed;
    }
    known = std::move(*changed);
  }
  return builder_.MakeCopy(*known);
}

void Workbench::DoBeginTrial(const LiveTrial::Plan& plan) {
  const auto fail = [this](const Error& error) {
    Publish({{"event", "trial_failed"}, {"reason", error.ToString()}});
  };
  if (scene() == nullptr) {
    fail({ErrorCode::kNotFound, "no product is open", "", ""});
    return;
  }
  const auto found = FindTrialScene(plan);
  if (!found) {
    fail(found.error());
    return;
  }
  const simulation::Model& model = *(*found)->model;
  const auto step = study::FindPartStep(model, plan.part);
  if (!step) {
    fail(step.error());
    return;
  }
  auto trial = LiveTrial::Make(plan, model, *step, 1 / options_.rate_hz);
  if (!trial) {
    fail(trial.error());
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    trial_ = *trial;
    trial_step_ = *step;
  }
  history_.Clear();  // there is no undo in a study
  const bool is_picked = plan.condition.method == study::Method::kPicking;
  Show(*found, MakeTrialState(model, *step), plan.has_person && !is_picked);
  Publish({{"event", "trial_begun"}});
}

void Workbench::DoEndTrial() {
  std::shared_ptr<LiveRun> ended;
  std::shared_ptr<LiveTrial> trial;
  {
    const std::lock_guard lock(mutex_);
    if (run_ != nullptr) {
      resting_ = run_->state();
    }
    ended = std::exchange(run_, nullptr);
    trial = std::exchange(trial_, nullptr);
  }
  ended.reset();  // its threads end here, so that the trial's result is final
  is_demo_ = false;
  if (trial != nullptr) {
    if (const auto finished = trial->Finish(); !finished) {
      Publish({{"event", "failed"}, {"file", "record"}, {"error", ToJson(finished.error())}});
    }
  }
  Publish({{"event", "trial_over"}});
}

}  // namespace hvas::studio
