#include "assembly/run_disassembly.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "assembly/assembly_setup.h"
#include "assembly/recorded_run.h"
#include "base/check.h"
#include "mates/assignments.h"
#include "simulation/disassembly_run.h"

namespace hvas::assembly {

using simulation::DisassemblyPlan;
using simulation::Model;
using simulation::PartResult;

Result<DisassemblyPlan> PlanDisassembly(const Model& model, const std::string& part,
                                        const std::function<void(double fraction)>& progress) {
  simulation::DisassemblyOptions options;
  options.progress = progress;
  if (part.empty()) {
    return simulation::PlanDisassembly(model, options);
  }
  const product::Product& product = *model.product;
  const auto id = mates::FindOccurrence(product, part);
  if (!id) {
    return Unexpected(id.error());
  }
  options.target = *id;
  const std::string& path = product.occurrences[id->index()].path;
  if (sequence::FindBase(model.sequence) == *id) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} is the base, which stays in the fixture", path), product.source,
                "name another part, or leave --part out to take all others off the base");
  }
  DisassemblyPlan plan = simulation::PlanDisassembly(model, options);
  if (!plan.stuck.empty()) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("{} cannot come out: {}", path, plan.stuck.front().reason),
                product.source,
                "check the drawing there; without --part, hvas disassemble takes out what can go");
  }
  return plan;
}

bool DisassemblyOutcome::is_complete() const {
  return std::all_of(run.parts.begin(), run.parts.end(),
                     [](const PartResult& part) { return part.reason.empty(); });
}

namespace {

/** A disassembly by one hand that has not begun, with all parts in their place. */
class DisassemblySetup final : public RunSetup {
 public:
  DisassemblySetup(std::shared_ptr<const Model> model, std::vector<Hand> hand,
                   const DisassemblyPlan* plan, simulation::Sink* downstream)
      : RunSetup(std::move(model), std::move(hand)),
        run_(&simulation(), plan, ListMovers().front(), downstream) {
    simulation::PutAllInPlace(&simulation());
  }

  [[nodiscard]] simulation::PartRun& part_run() override { return run_; }

 private:
  simulation::DisassemblyRun run_;
};

/** The results of all parts of the plan, also of those that a stopped run did not come to. */
std::vector<PartResult> ListResults(const DisassemblyPlan& plan,
                                    const std::vector<PartResult>& results) {
  constexpr const char* kStopped = "the run was stopped before its turn ended";
  std::vector<PartResult> parts;
  const auto add = [&](product::OccurrenceId id, const std::string& reason) {
    const auto found = std::find_if(results.begin(), results.end(),
                                    [id](const PartResult& part) { return part.occurrence == id; });
    if (found != results.end()) {
      parts.push_back(*found);
      return;
    }
    PartResult part;
    part.occurrence = id;
    part.is_seated = true;
    part.reason = reason;
    parts.push_back(part);
  };
  for (const simulation::Removal& removal : plan.removals) {
    if (IsWithinProduct(removal.step.kind)) {
      continue;
    }
    add(removal.step.occurrence, kStopped);
    for (const product::OccurrenceId member : removal.step.members) {
      add(member, kStopped);
    }
  }
  for (const sequence::SequenceGap& stuck : plan.stuck) {
    add(stuck.occurrence, stuck.reason);
  }
  return parts;
}

}  // namespace

Result<DisassemblyOutcome> RunDisassembly(const std::shared_ptr<const Model>& model,
                                          const DisassemblyPlan& plan, const RunOptions& options) {
  HVAS_DEMAND(model != nullptr);
  if (options.devices.size() != 1) {
    return Fail(ErrorCode::kInvalid, "a product is taken apart by one hand", model->product->source,
                "ask for one hand");
  }
  auto run = RunRecorded(
      *model, options, {{"task", "disassembly"}}, [&](std::vector<Hand> hands, auto* sink) {
        return std::make_unique<DisassemblySetup>(model, std::move(hands), &plan, sink);
      });
  if (!run) {
    return Unexpected(run.error());
  }
  run->parts = ListResults(plan, run->parts);
  return DisassemblyOutcome{std::move(*run)};
}

}  // namespace hvas::assembly
