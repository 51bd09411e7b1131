#include "studio/event_json.h"

#include <algorithm>

#include "base/error_name.h"
#include "base/units.h"

namespace hvas::studio {
namespace {

using simulation::SimulationEvent;

Json MetricsOf(const SimulationEvent& event) {
  const simulation::HoldMetrics& metrics = event.metrics;
  return {{"time_s", 1e-9 * static_cast<double>(event.t_ns - metrics.t_taken_ns)},
          {"path_mm", units::ToMm(metrics.path)},
          {"peak_true_n", metrics.peak_true},
          {"peak_felt_n", metrics.peak_felt},
          {"fit_true_n", metrics.fit_true},
          {"depth_um", units::ToUm(metrics.deepest)},
          {"insertion_mm", units::ToMm(metrics.insertion)},
          {"collisions", metrics.collisions}};
}

Json ReasonsOf(std::uint32_t actions) {
  Json reasons = Json::array();
  for (const haptics::GateAction action : haptics::ListNewActions(0, actions)) {
    reasons.push_back(haptics::ToString(action));
  }
  return reasons;
}

}  // namespace

const char* ToString(simulation::Placement placement) {
  switch (placement) {
    case simulation::Placement::kLoose:
      return "loose";
    case simulation::Placement::kHeld:
      return "held";
    case simulation::Placement::kPlaced:
      return "placed";
    case simulation::Placement::kParked:
      return "parked";
    case simulation::Placement::kPending:
      return "pending";
  }
  return "loose";
}

std::string HideFolders(std::string_view text) {
  constexpr std::string_view kBeforePath = " \t\n\"'`(=:,;<[";  // What a path may follow.
  constexpr std::string_view kAfterPath = " \t\n\"'`);,>]";     // What ends one, in sentences.
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    const bool begins = text[i] == '/' && (i == 0 || kBeforePath.find(text[i - 1]) != text.npos);
    if (!begins) {
      shown += text[i++];
      continue;
    }
    const std::size_t end = std::min(text.find_first_of(kAfterPath, i), text.size());
    const std::string_view path = text.substr(i, end - i);
    shown += path.substr(path.find_last_of('/', path.size() > 1 ? path.size() - 2 : 0) + 1);
    i = end;
  }
  return shown;
}

Json ToJson(const Error& error) {
  return {{"code", NameOf(error.code)},
          {"message", HideFolders(error.message)},
          {"where", HideFolders(error.where)},
          {"remedy", HideFolders(error.remedy)}};
}

Json ToJson(const std::vector<product::OccurrenceId>& ids) {
  Json json = Json::array();
  for (const product::OccurrenceId id : ids) {
    json.push_back(id.value());
  }
  return json;
}

Json ToJson(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json ToJson(const spatial::Pose& X) {
  return {{"p", ToJson(X.p())}, {"q", {X.q().w(), X.q().x(), X.q().y(), X.q().z()}}};
}

Json ToJson(const SimulationEvent& event) {
  Json json{{"event", ""}, {"hand", event.hand}};
  if (event.occurrence.is_valid()) {
    json["occurrence"] = event.occurrence.value();
  }
  json["state"] = static_cast<int>(event.state);
  switch (event.kind) {
    case SimulationEvent::Kind::kTaken:
      json["event"] = "taken";
      return json;
    case SimulationEvent::Kind::kState:
      json["event"] = "state";
      return json;
    case SimulationEvent::Kind::kDropped:
      json["event"] = "dropped";
      json["was_seated"] = event.was_seated;
      json["to_place_mm"] = units::ToMm(event.to_place);
      json["metrics"] = MetricsOf(event);
      return json;
    case SimulationEvent::Kind::kSafety:
      json["event"] = "safety";
      json["gate_actions"] = event.gate_actions;
      json["reasons"] = ReasonsOf(event.gate_actions);
      return json;
    default:
      return nullptr;
  }
}

}  // namespace hvas::studio
