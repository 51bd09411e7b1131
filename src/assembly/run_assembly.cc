#include "assembly/run_assembly.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "assembly/assembly_setup.h"
#include "assembly/recorded_run.h"
#include "base/check.h"

namespace hvas::assembly {
namespace {

constexpr double kSecondsPerPart = 120;  // Of session time: a choice.

using simulation::Model;
using simulation::PartResult;

/** Says what ended a run before the turn of a part ended. */
std::string DescribeEnd(const Model& model, const RunOptions& options, const RunOutcome& outcome) {
  const double limit_s = options.limit_s > 0 ? options.limit_s : CalcTimeLimit(model);
  if (1e-9 * static_cast<double>(outcome.execution.session_ns) < limit_s) {
    return "the run was stopped before its turn ended";
  }
  return fmt::format(
      "the run reached its limit of {:.0f} s of session time{} before its turn ended", limit_s,
      options.limit_s > 0 ? "" : fmt::format(", {:.0f} s for each part,", kSecondsPerPart));
}

/** Explains why a part is not in its place after a run that ended before its turn did. */
std::string ExplainMissing(const Model& model, product::OccurrenceId id, const std::string& end) {
  const std::string reason = sequence::FindGapReason(model.sequence, id);
  return reason.empty() ? end : reason;
}

/** Adds the parts that a stopped run did not come to, and says of those in whose turn it ended that
 it did. */
void AddMissing(const Model& model, const std::string& end, std::vector<PartResult>* parts) {
  for (PartResult& part : *parts) {
    if (!part.is_seated && part.reason.empty()) {
      part.reason = ExplainMissing(model, part.occurrence, end);
    }
  }
  for (const simulation::Body& body : model.bodies) {
    const bool is_listed = std::any_of(parts->begin(), parts->end(), [&](const PartResult& part) {
      return part.occurrence == body.occurrence;
    });
    if (!is_listed && body.role == simulation::BodyRole::kPart) {
      PartResult part;
      part.occurrence = body.occurrence;
      part.reason = ExplainMissing(model, body.occurrence, end);
      parts->push_back(part);
    }
  }
}

}  // namespace

bool RunOutcome::is_complete() const {
  return std::all_of(parts.begin(), parts.end(),
                     [](const PartResult& part) { return part.is_seated; });
}

double CalcTimeLimit(const Model& model) {
  // A part is carried around the product; one of ordinary size is no further than this.
  constexpr double kOrdinaryRadius = 0.5;  // [m]
  const double size = std::max(1.0, model.transfer_radius / kOrdinaryRadius);
  return kSecondsPerPart * size * static_cast<double>(model.bodies.size());
}

Result<RunOutcome> RunAssembly(const std::shared_ptr<const Model>& model,
                               const RunOptions& options) {
  HVAS_DEMAND(model != nullptr);
  auto outcome = RunRecorded(*model, options, {}, [&](std::vector<Hand> hands, auto* sink) {
    return std::make_unique<AssemblySetup>(model, std::move(hands), sink);
  });
  if (outcome) {
    AddMissing(*model, DescribeEnd(*model, options, *outcome), &outcome->parts);
  }
  return outcome;
}

}  // namespace hvas::assembly
