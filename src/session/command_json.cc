#include "session/command_json.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "base/parse_json.h"
#include "session/tick_options_json.h"

namespace hvas::session {
namespace {

using sequence::SequenceStep;
using simulation::GivenCommand;
using simulation::PartState;

constexpr std::array kPlacements{"loose", "held", "placed", "parked", "pending"};
constexpr std::array kStepKinds{"base", "insert", "park", "remove", "aside", "return", "assume"};

Unexpected Refuse(const std::string& what, const std::string& field) {
  return Fail(ErrorCode::kUnreadable, fmt::format("{} has no valid \"{}\".", what, field));
}

Json MakePartJson(const PartState& part) {
  Json json{{"placement", kPlacements.at(static_cast<std::size_t>(part.placement))},
            {"X_WB", MakeJson(part.X_WB)}};
  if (part.leader.is_valid()) {
    json["leader"] = part.leader.value();
  }
  return json;
}

void ReadPart(JsonFields* fields, std::size_t part_count, PartState* part) {
  (*fields)("placement", part->placement, kPlacements);
  (*fields)("X_WB", part->X_WB);
  part->leader = product::OccurrenceId();
  if (fields->has("leader")) {
    fields->IdBelow("leader", part_count, &part->leader);
  }
}

/** Whether two poses are the same to the last bit, the signs of zeros included. */
bool HasSameBits(const spatial::Pose& a, const spatial::Pose& b) {
  const auto is_same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return std::equal(a.p().begin(), a.p().end(), b.p().begin(), is_same) &&
         std::equal(a.q().coeffs().begin(), a.q().coeffs().end(), b.q().coeffs().begin(), is_same);
}

bool IsSame(const PartState& a, const PartState& b) {
  return a.placement == b.placement && a.leader == b.leader && HasSameBits(a.X_WB, b.X_WB);
}

Json MakeStepJson(const SequenceStep& step) {
  Json members = Json::array();
  for (const product::OccurrenceId id : step.members) {
    members.push_back(id.value());
  }
  Json json{{"kind", kStepKinds.at(static_cast<std::size_t>(step.kind))},
            {"occurrence", step.occurrence.value()},
            {"members", std::move(members)},
            {"extraction_W", MakeJson(step.extraction_W)},
            {"engage_distance_m", MakeJson(step.engage_distance)},
            {"offset_W_m", MakeJson(step.offset_W)}};
  if (!step.way.empty()) {
    Json& way = json["way"] = Json::array();
    for (const spatial::Pose& X_WB : step.way) {
      way.push_back({{"X_WB", MakeJson(X_WB)}});
    }
  }
  return json;
}

SequenceStep ReadStep(JsonFields* fields, std::size_t part_count) {
  SequenceStep step;
  (*fields)("kind", step.kind, kStepKinds);
  fields->IdBelow("occurrence", part_count, &step.occurrence);
  (*fields)("extraction_W", step.extraction_W);
  (*fields)("engage_distance_m", step.engage_distance);
  (*fields)("offset_W_m", step.offset_W);
  for (const Json& member : fields->Array("members")) {
    if (!member.is_number_unsigned() || member.get<std::size_t>() >= part_count) {
      fields->Refuse("members");
      break;
    }
    step.members.emplace_back(member.get<std::size_t>());
  }
  if (fields->has("way")) {
    for (const Json& pose : fields->Array("way")) {
      JsonFields inner(pose);
      inner("X_WB", step.way.emplace_back());
      fields->Take(inner);
    }
    if (step.way.size() < 2) {
      fields->Refuse("way");
    }
  }
  return step;
}

}  // namespace

std::string MakeBeginningJson(const Beginning& beginning) {
  Json hands = Json::array();
  for (const haptics::TickOptions& options : beginning.hands) {
    hands.push_back(MakeTickOptionsJson(options));
  }
  return Json{{"hands", std::move(hands)}, {"parts", MakePartsJson(beginning.parts)}}.dump();
}

Result<Beginning> ParseBeginning(const std::string& text, std::size_t part_count) {
  constexpr const char* kWhat = "The beginning of a stretch";
  const Json json = ParseJson<Json>(text);
  JsonFields fields(json);
  Beginning beginning;
  for (const Json& hand : fields.Array("hands")) {
    auto options = ParseTickOptions(hand);
    if (!options) {
      return Unexpected(options.error());
    }
    beginning.hands.push_back(std::move(*options));
  }
  auto parts = ParseParts(fields.Array("parts"));
  if (!fields.refused().empty()) {
    return Refuse(kWhat, fields.refused());
  }
  if (!parts) {
    return Unexpected(parts.error());
  }
  beginning.parts = std::move(*parts);
  if (beginning.hands.empty() || beginning.hands.size() > haptics::kMaxHands) {
    return Refuse(kWhat, "hands");
  }
  if (beginning.parts.size() != part_count) {
    return Refuse(kWhat, "parts");
  }
  return beginning;
}

Json MakePartsJson(const std::vector<PartState>& parts) {
  Json json = Json::array();
  for (const PartState& part : parts) {
    json.push_back(MakePartJson(part));
  }
  return json;
}

Result<std::vector<PartState>> ParseParts(const Json& json) {
  std::vector<PartState> parts;
  for (const Json& part : json) {
    JsonFields fields(part);
    ReadPart(&fields, json.size(), &parts.emplace_back());
    if (!fields.refused().empty()) {
      return Refuse(fmt::format("Part {}", parts.size() - 1), fields.refused());
    }
  }
  return parts;
}

record::Command MakeCommand(const GivenCommand& given, const std::vector<PartState>& before) {
  Json changed = Json::array();
  for (std::size_t i = 0; i < given.parts.size(); ++i) {
    if (!IsSame(given.parts[i], before[i])) {
      Json part = MakePartJson(given.parts[i]);
      part["occurrence"] = i;
      changed.push_back(std::move(part));
    }
  }
  Json json{
      {"hand", given.hand}, {"step", MakeStepJson(given.step)}, {"parts", std::move(changed)}};
  if (given.can_join) {
    json["can_join"] = true;
  }
  if (given.kind == simulation::TickCommand::Kind::kHelp) {
    json["other"] = given.other;
  }
  return {given.t_ns, given.number, kCommandKinds.at(static_cast<std::size_t>(given.kind)),
          json.dump()};
}

Result<GivenCommand> ParseCommand(const record::Command& command,
                                  const std::vector<PartState>& before, std::size_t hands) {
  const std::string what = fmt::format("Command {}", command.number);
  const Json json = ParseJson<Json>(command.json);
  JsonFields fields(json);
  GivenCommand given;
  given.number = static_cast<std::uint32_t>(command.number);
  given.t_ns = command.t_ns;
  const auto kind = std::find(kCommandKinds.begin(), kCommandKinds.end(), command.kind);
  if (kind == kCommandKinds.end()) {
    return Refuse(what, "kind");
  }
  given.kind = static_cast<simulation::TickCommand::Kind>(kind - kCommandKinds.begin());
  fields.Index("hand", hands, &given.hand);
  if (given.kind == simulation::TickCommand::Kind::kHelp) {
    fields.Index("other", hands, &given.other);
  }
  JsonFields step = fields.Inner("step");
  given.step = ReadStep(&step, before.size());
  fields.Take(step);
  if (fields.has("can_join")) {
    fields("can_join", given.can_join);
  }
  given.parts = before;
  for (const Json& part : fields.Array("parts")) {
    JsonFields inner(part);
    std::size_t occurrence = 0;
    inner.Index("occurrence", before.size(), &occurrence);
    ReadPart(&inner, before.size(), &given.parts[occurrence]);
    fields.Take(inner);
  }
  if (!fields.refused().empty()) {
    return Refuse(what, fields.refused());
  }
  return given;
}

Json MakeStepsJson(const std::vector<SequenceStep>& steps) {
  Json json = Json::array();
  for (const SequenceStep& step : steps) {
    json.push_back(MakeStepJson(step));
  }
  return json;
}

Result<std::vector<SequenceStep>> ParseSteps(const Json& json, std::size_t part_count) {
  std::vector<SequenceStep> steps;
  for (const Json& step : json) {
    JsonFields fields(step);
    steps.push_back(ReadStep(&fields, part_count));
    if (!fields.refused().empty()) {
      return Refuse("A step of the order", fields.refused());
    }
  }
  return steps;
}

}  // namespace hvas::session
