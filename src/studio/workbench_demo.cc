#include "studio/workbench_demo.h"

#include <fmt/format.h>

namespace hvas::studio {

using product::OccurrenceId;
using sequence::SequenceStep;
using simulation::DisassemblyPlan;
using simulation::Placement;

Result<void> WorkbenchDemo::Start() {
  auto idle = live_->CheckIdle();
  if (idle) {
    ends_after_step_ = false;
    worker_->Post([this](const std::stop_token& /*stop*/) {
      edits_->Remember(live_->MakeSnapshot(), "demo");
      live_->Restart(true);
    });
  }
  return idle;
}

Result<void> WorkbenchDemo::DoNext() {
  auto started = Start();
  if (started) {
    ends_after_step_ = true;
  }
  return started;
}

Result<void> WorkbenchDemo::PlanRemoval(OccurrenceId id, const PlannedFn& done) {
  auto idle = live_->CheckIdle();
  if (idle) {
    worker_->Post([this, id, done](const std::stop_token& /*stop*/) { done(MakePlan(id)); });
  }
  return idle;
}

Result<void> WorkbenchDemo::TakeOut(OccurrenceId id, const PlannedFn& done) {
  auto idle = live_->CheckIdle();
  if (idle) {
    ends_after_step_ = false;
    worker_->Post([this, id, done](const std::stop_token& /*stop*/) {
      const auto plan = MakePlan(id);
      if (plan) {
        edits_->Remember(live_->MakeSnapshot(), "demo");
        plan_ = std::make_shared<const DisassemblyPlan>(*plan);
        live_->Restart(true);
      }
      done(plan);
    });
  }
  return idle;
}

Result<DisassemblyPlan> WorkbenchDemo::MakePlan(OccurrenceId id) const {
  const SceneSnapshot now = live_->MakeSnapshot();
  const simulation::Model& model = *now.scene->model;
  if (id.index() >= now.state.parts.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such part", fmt::format("o{}", id.value()), "");
  }
  const std::string& name = model.product->occurrences[id.index()].name;
  if (sequence::FindBase(model.sequence) == id) {
    return Fail(ErrorCode::kInvalid, "the part is the base, which stays in the fixture", name,
                "take the other parts off it");
  }
  if (now.state.parts[id.index()].placement != Placement::kPlaced) {
    return Fail(ErrorCode::kInvalid, "the part is not in its place", name,
                "choose a part that is in its place");
  }
  simulation::DisassemblyOptions options;
  options.target = id;
  for (const simulation::PartState& part : now.state.parts) {
    options.is_in_place.push_back(part.placement == Placement::kPlaced);
  }
  DisassemblyPlan plan = simulation::PlanDisassembly(model, options);
  if (!plan.stuck.empty()) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the part cannot come out: {}", plan.stuck.front().reason), name,
                "check the drawing there");
  }
  return plan;
}

void WorkbenchDemo::Stop() {
  // A held part is not dropped; a demo that is about to begin ends, too.
  worker_->Post([this](const std::stop_token& /*stop*/) { ends_after_step_ = live_->is_demo(); });
}

void WorkbenchDemo::EndRun() {
  worker_->Post([this](const std::stop_token& /*stop*/) { live_->Restart(false); });
}

void WorkbenchDemo::ConfigureRun(const OpenScene& /*scene*/, LiveOptions* live) {
  live->disassembly = std::exchange(plan_, nullptr);
  is_taking_out_ = live->disassembly != nullptr;
}

void WorkbenchDemo::OnStep(const OpenScene& scene, std::size_t step, bool has_person) {
  const auto& steps = scene.model->sequence.steps;
  const bool is_finished = step >= steps.size();
  // Placing a fixture part is no work of a person, and does not end a demo of one step.
  const bool is_work = step > 0 && steps[step - 1].kind != SequenceStep::Kind::kBase;
  if (has_person && !is_taking_out_ &&
      (is_finished || (is_work && ends_after_step_.exchange(false)))) {
    EndRun();
  }
}

void WorkbenchDemo::OnRemoval(bool is_last) {
  if (is_last || ends_after_step_.exchange(false)) {
    EndRun();
  }
}

}  // namespace hvas::studio
