#include "app/assembly/disassemble_report.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"

namespace hvas::app {
namespace {

using product::OccurrenceId;
using sequence::Obstacle;
using simulation::DisassemblyPlan;
using simulation::Model;
using simulation::PartResult;
using simulation::Removal;

/** The move by which a part comes out; null where it has none. */
const Removal* FindRemoval(const DisassemblyPlan& plan, OccurrenceId id) {
  const auto moves = [id](const Removal& removal) {
    const auto& members = removal.step.members;
    return removal.step.kind == sequence::SequenceStep::Kind::kRemove &&
           (removal.step.occurrence == id ||
            std::find(members.begin(), members.end(), id) != members.end());
  };
  const auto found = std::find_if(plan.removals.begin(), plan.removals.end(), moves);
  return found == plan.removals.end() ? nullptr : &*found;
}

/** The move by which another part lets this one pass; null where none has to. */
const sequence::SequenceStep* FindAsideOf(const DisassemblyPlan& plan, const Removal& removal) {
  const auto number = &removal - plan.removals.data();
  const sequence::SequenceStep* before = number > 0 ? &(&removal - 1)->step : nullptr;
  const bool goes_aside = before != nullptr && before->kind == sequence::SequenceStep::Kind::kAside;
  return goes_aside ? before : nullptr;
}

std::size_t CountOut(const SessionReport& report) {
  return static_cast<std::size_t>(
      std::count_if(report.run.parts.begin(), report.run.parts.end(),
                    [](const PartResult& part) { return part.reason.empty(); }));
}

std::string DescribeWaiting(const Model& model, const Removal& removal) {
  constexpr std::size_t kNamed = 4;  // So many names tell what is in the way.
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, removal.waits_for.size()); ++i) {
    const Obstacle& obstacle = removal.waits_for[i];
    text += fmt::format("{}{} ({})", i == 0 ? "after " : ", ",
                        model.product->occurrences[obstacle.occurrence.index()].name,
                        obstacle.mate.is_valid()
                            ? std::string("mate")
                            : fmt::format("met at {:.1f} mm", units::ToMm(obstacle.travelled)));
  }
  if (removal.waits_for.size() > kNamed) {
    text += fmt::format(" and {} more", removal.waits_for.size() - kNamed);
  }
  return text;
}

nlohmann::ordered_json ToJson(const Model& model, const Removal& removal) {
  nlohmann::ordered_json waits = nlohmann::ordered_json::array();
  for (const Obstacle& obstacle : removal.waits_for) {
    waits.push_back({{"id", obstacle.occurrence.value()},
                     {"name", PathOf(model, obstacle.occurrence)},
                     {"reason", obstacle.mate.is_valid() ? "mate" : "contact"},
                     {"met_after_mm", units::ToMm(obstacle.travelled)}});
    if (obstacle.mate.is_valid()) {
      waits.back()["mate"] = obstacle.mate.value();
    }
  }
  // A zero has no sign for people.
  const Vec3 direction = removal.step.extraction_W + Vec3::Zero();
  return {{"waits_for", std::move(waits)},
          {"way",
           {{{"direction", {direction.x(), direction.y(), direction.z()}},
             {"length_mm", units::ToMm(removal.way_length)},
             {"engaged_mm", units::ToMm(removal.step.engage_distance)}}}},
          {"breakaway_n", removal.breakaway}};
}

nlohmann::ordered_json ToJson(const Model& model, const DisassemblyPlan& plan,
                              const PartResult& part) {
  nlohmann::ordered_json json{{"id", part.occurrence.value()},
                              {"name", PathOf(model, part.occurrence)},
                              {"out", part.reason.empty()}};
  if (const Removal* removal = FindRemoval(plan, part.occurrence)) {
    json.update(ToJson(model, *removal));
    if (const auto* aside = FindAsideOf(plan, *removal)) {
      json["moved_aside"] = MakeAsideJson(model, *aside);
    }
  }
  json.update(MakeHoldJson(part));
  return json;
}

}  // namespace

void PrintDisassemblyJson(const Model& model, const DisassemblyPlan& plan,
                          const SessionReport& report) {
  nlohmann::ordered_json json = MakeRunJson(model, report);
  json["base"] = PathOf(model, plan.base);
  json["smallest"] = plan.is_smallest;
  json["out"] = CountOut(report);
  json["parts"] = nlohmann::ordered_json::array();
  for (const PartResult& part : report.run.parts) {
    json["parts"].push_back(ToJson(model, plan, part));
  }
  PrintJson(json);
}

void PrintDisassemblyTable(const Model& model, const DisassemblyPlan& plan,
                           const SessionReport& report) {
  TextTable table({"  #", "part", "way", "length\nmm", "break\nN", "met\nN", "peak\nN", "felt\nN",
                   "time\ns", "result"},
                  2);
  for (std::size_t i = 0; i < report.run.parts.size(); ++i) {
    const PartResult& part = report.run.parts[i];
    const std::string number = fmt::format("{:>3}", i + 1);
    const std::string name = PathOf(model, part.occurrence);
    const Removal* removal = FindRemoval(plan, part.occurrence);
    if (!part.reason.empty() || removal == nullptr) {
      table.Add({number, name}, "NOT OUT: " + part.reason);
      continue;
    }
    if (removal->step.occurrence != part.occurrence) {
      table.Add({number, name}, part.note);
      continue;
    }
    std::string waiting = DescribeWaiting(model, *removal);
    if (const auto* aside = FindAsideOf(plan, *removal)) {
      waiting += fmt::format("{}with {} moved aside by {:.1f} mm", waiting.empty() ? "" : "; ",
                             PathOf(model, aside->occurrence), units::ToMm(aside->engage_distance));
    }
    const std::string gap = waiting.empty() || part.note.empty() ? "" : "; ";
    table.Add({number, name, sequence::DescribeDirection(removal->step.extraction_W),
               fmt::format("{:.1f}", units::ToMm(removal->way_length)),
               fmt::format("{:.1f}", removal->breakaway), fmt::format("{:.1f}", part.fit_true),
               fmt::format("{:.1f}", part.peak_true), fmt::format("{:.2f}", part.peak_felt),
               fmt::format("{:.2f}", part.time), "out"},
              waiting + gap + part.note);
  }
  std::string text = fmt::format(
      "{} stays in the fixture; way, length: straight, until the part is clear of the boxes of all "
      "others; break: force that breaks its fits loose, calculated; met: the largest that they "
      "resisted with; peak: the largest true force on the part; felt: in the hand\n",
      PathOf(model, plan.base));
  if (!plan.is_smallest) {
    text +=
        "The search for the smallest set of parts was ended early: fewer may be enough, but none "
        "of these can be left out.\n";
  }
  fmt::print("{}{}", table.ToText(), Fold(text));
  PrintRun(model, report,
           fmt::format("{} of {} parts out", CountOut(report), report.run.parts.size()));
}

}  // namespace hvas::app
