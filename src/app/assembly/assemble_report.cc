#include "app/assembly/assemble_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/assembly/gap_reason_json.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "app/product/drawing_errors_report.h"
#include "base/units.h"
#include "mates/drawn_volumes.h"

namespace hvas::app {
namespace {

using assembly::RunOutcome;
using simulation::Model;
using simulation::PartAllowance;
using simulation::PartResult;

std::size_t CountSeated(const RunOutcome& outcome) {
  return static_cast<std::size_t>(
      std::count_if(outcome.parts.begin(), outcome.parts.end(),
                    [](const PartResult& part) { return part.is_seated; }));
}

/** Counts the parts that were put where nothing held them at that moment. */
std::size_t CountUntouched(const RunOutcome& outcome) {
  return static_cast<std::size_t>(
      std::count_if(outcome.parts.begin(), outcome.parts.end(),
                    [](const PartResult& part) { return part.is_seated && !part.has_touched; }));
}

/** Counts the parts that nothing brought to their place, and that were put there for the others. */
std::size_t CountAssumed(const RunOutcome& outcome) {
  return static_cast<std::size_t>(
      std::count_if(outcome.parts.begin(), outcome.parts.end(),
                    [](const PartResult& part) { return part.is_assumed; }));
}

/** Counts the parts in their place that had no way there but by an allowance. */
std::size_t CountByAllowance(const RunOutcome& outcome) {
  return static_cast<std::size_t>(std::count_if(
      outcome.parts.begin(), outcome.parts.end(),
      [](const PartResult& part) { return part.is_seated && !part.allowances.empty(); }));
}

nlohmann::ordered_json ToJson(const Model& model, const PartAllowance& allowance) {
  const bool is_drawn = allowance.kind == PartAllowance::Kind::kDrawn;
  nlohmann::ordered_json json{{"kind", is_drawn ? "drawn_overlap" : "gives"},
                              {"with", PathOf(model, allowance.other)},
                              {"depth_mm", units::ToMm(allowance.depth)},
                              {"is_beyond_drawn", allowance.is_beyond}};
  if (is_drawn) {
    json["volume_mm3"] = units::ToMm3(
        mates::MeasureSharedVolume(*model.product, allowance.own, allowance.other).volume);
    json["faces"] = allowance.own_faces;
    json["other_faces"] = allowance.other_faces;
  } else {
    json["flexible"] = PathOf(model, allowance.flexible);
    json["flexible_kind"] = ToString(allowance.flexible_kind);
    if (allowance.force.in > 0) {
      json["force_in_n"] = allowance.force.in;
      json["force_out_n"] = allowance.force.out;
    }
    if (allowance.strain > 0) {
      json["strain_percent"] = 100 * allowance.strain;
      json["bearable_strain_percent"] = 100 * allowance.bearable_strain;
    }
  }
  return json;
}

nlohmann::ordered_json ToJson(const Model& model, const PartResult& part) {
  nlohmann::ordered_json json{{"id", part.occurrence.value()},
                              {"name", PathOf(model, part.occurrence)},
                              {"seated", part.is_seated},
                              {"is_assumed", part.is_assumed}};
  json.update(MakeHoldJson(part));
  const simulation::Passage& passage = part.passage;
  json.update(
      {{"beyond_drawn_um", units::ToUm(passage.depth)},
       {"beyond_drawn_in", passage.through.is_valid() ? PathOf(model, passage.through) : ""},
       {"insertion_mm", units::ToMm(part.insertion)},
       {"needs_press", part.needs_press()},
       {"mates", part.mates},
       {"touched", part.has_touched},
       {"arrival_um", units::ToUm(part.arrival)},
       {"arrival_urad", 1e6 * part.arrival_angle},
       {"pose_error_um", units::ToUm(part.pose_error)},
       {"pose_error_urad", 1e6 * part.pose_error_angle}});
  if (const auto* aside = sequence::FindAside(model.sequence, part.occurrence)) {
    json["moved_aside"] = MakeAsideJson(model, *aside);
  }
  json["allowances"] = nlohmann::ordered_json::array();
  for (const PartAllowance& allowance : part.allowances) {
    json["allowances"].push_back(ToJson(model, allowance));
  }
  if (!part.presses.empty()) {
    json["presses"] = nlohmann::ordered_json::array();
    for (const simulation::PressedPair& press : part.presses) {
      nlohmann::ordered_json parts = nlohmann::ordered_json::array();
      for (const product::OccurrenceId id : press.parts) {
        parts.push_back(PathOf(model, id));
      }
      json["presses"].push_back({{"parts", std::move(parts)},
                                 {"compression_mm", units::ToMm(press.compression)},
                                 {"force_n", press.force},
                                 {"source", press.source}});
    }
  }
  return json;
}

/** A residual below what a double resolves of a product's size is not a measurement. */
std::string DescribeResidual(double residual_um) {
  // A double resolves 1e-16 of a product's size: 1e-10 um of a metre, with the resolver's
  // iterations beside it.
  constexpr double kResolved_um = 1e-6;
  return residual_um < kResolved_um ? "< 1e-6" : fmt::format("{:.1e}", residual_um);
}

void PrintParts(const Model& model, const RunOutcome& outcome) {
  TextTable table({"  #", "part", "time\ns", "path\nm", "true\nN", "felt\nN", "mates",
                   "arrival\num", "tilt\nmrad", "residual\num"},
                  2);
  for (std::size_t i = 0; i < outcome.parts.size(); ++i) {
    const PartResult& part = outcome.parts[i];
    const std::string number = fmt::format("{:>3}", i + 1);
    const std::string name = PathOf(model, part.occurrence);
    if (!part.is_seated) {
      table.Add({number, name},
                (part.is_assumed ? "ASSUMED IN PLACE: " : "NOT IN PLACE: ") + part.reason);
      continue;
    }
    table.Add({number, name, fmt::format("{:.2f}", part.time), fmt::format("{:.3f}", part.path),
               fmt::format("{:.2f}", part.peak_true), fmt::format("{:.2f}", part.peak_felt),
               fmt::format("{}", part.mates), fmt::format("{:.1f}", units::ToUm(part.arrival)),
               fmt::format("{:.2f}", 1e3 * part.arrival_angle),
               DescribeResidual(units::ToUm(part.pose_error))},
              part.time == 0 ? "in the fixture" : part.note);
  }
  fmt::print("{}{}", table.ToText(),
             Fold("arrival, tilt: from the place to which the hand brought a part, before it was "
                  "moved exactly there; residual: from there to the file's pose, by the resolution "
                  "of the mates\n"));
}

}  // namespace

void PrintAssemblyJson(const Model& model, const SessionReport& report, const LeftOut& left_out) {
  const RunOutcome& outcome = report.run;
  nlohmann::ordered_json json = MakeRunJson(model, report);
  json["seated"] = CountSeated(outcome);
  json["by_allowance"] = CountByAllowance(outcome);
  json["assumed"] = CountAssumed(outcome);
  json["not_tried"] = outcome.parts.size() - CountSeated(outcome) - CountAssumed(outcome);
  json["untouched"] = CountUntouched(outcome);
  json["drawing_errors"] = MakeDrawingErrorsJson(*model.product);
  json["parts"] = nlohmann::ordered_json::array();
  for (const PartResult& part : outcome.parts) {
    json["parts"].push_back(ToJson(model, part));
    if (const orders::GapReason* reason = FindReason(left_out, part.occurrence)) {
      json["parts"].back()["why"] = MakeGapReasonJson(model, *reason);
    }
  }
  PrintJson(json);
}

void PrintAssemblyTable(const Model& model, const SessionReport& report) {
  const RunOutcome& outcome = report.run;
  PrintParts(model, outcome);
  PrintDrawingErrors(*model.product, false);
  const std::size_t allowed = CountByAllowance(outcome);
  const std::size_t untouched = CountUntouched(outcome);
  std::string apart = allowed > 0 ? fmt::format(", {} of them only by an allowance", allowed) : "";
  apart +=
      untouched > 0 ? fmt::format(", {} of them touching no part that was there", untouched) : "";
  const std::size_t assumed = CountAssumed(outcome);
  apart += assumed > 0 ? fmt::format("; {} assumed there, for the parts after them", assumed) : "";
  PrintRun(
      model, report,
      fmt::format("{} of {} parts in place{}", CountSeated(outcome), outcome.parts.size(), apart));
}

}  // namespace hvas::app
