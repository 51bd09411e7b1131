#include "studio/json_fields.h"

#include <limits>
#include <utility>

#include <fmt/format.h>

#include "studio/event_json.h"

namespace hvas::studio {
namespace {

constexpr std::size_t kLongestText = 1000;  // [bytes] of a field's text: a choice.
constexpr std::size_t kMaxFields = 64;  // fields of a command, including those of nested objects

Unexpected FailField(const char* name, const char* wanted) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" must be {}", name, wanted), "command",
              "reload the page");
}

}  // namespace

Result<Json> ParseCommand(std::string_view text) {
  std::size_t fields = 0;
  const auto keep = [&fields](int, Json::parse_event_t event, const Json&) {
    fields += event == Json::parse_event_t::key ? 1 : 0;
    return fields <= kMaxFields;
  };
  Json command = Json::parse(text, keep, /*allow_exceptions=*/false);
  if (fields > kMaxFields) {
    return Fail(ErrorCode::kInvalid, fmt::format("a command has at most {} fields", kMaxFields),
                "command", "reload the page");
  }
  if (!command.is_object()) {
    return Fail(ErrorCode::kInvalid, "the message is not a JSON object", "command",
                "reload the page");
  }
  return command;
}

Json IdOf(const Json& command) {
  const Json* id = FieldOf(command, "id");
  return id != nullptr && id->is_number_integer() ? *id : Json(nullptr);
}

Json MakeReply(const Json& id, const Result<Json>& result) {
  Json reply{{"id", id}, {"ok", result.has_value()}};
  if (result) {
    reply["result"] = *result;
  } else {
    reply["error"] = ToJson(result.error());
  }
  return reply;
}

Json MakeDeferredReply(const std::string& to, const Json& id, const Result<Json>& result) {
  return {{"event", "reply"}, {"to", to}, {"reply", MakeReply(id, result)}};
}

Result<std::string> TextAt(const Json& object, const char* name) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr || !field->is_string() ||
      field->get_ref<const std::string&>().size() > kLongestText) {
    return FailField(name, "a text");
  }
  return field->get<std::string>();
}

Result<bool> FlagAt(const Json& object, const char* name) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr || !field->is_boolean()) {
    return FailField(name, "true or false");
  }
  return field->get<bool>();
}

Result<std::uint32_t> IndexAt(const Json& object, const char* name) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr || !field->is_number_unsigned() ||
      field->get<std::uint64_t>() >= std::numeric_limits<std::uint32_t>::max()) {
    return FailField(name, "an index");
  }
  return field->get<std::uint32_t>();
}

Result<std::size_t> HandAt(const Json& object) {
  if (FieldOf(object, "hand") == nullptr) {
    return 0;
  }
  const auto hand = IndexAt(object, "hand");
  if (!hand || *hand >= HandRack::kMaxHands) {
    return FailField("hand", "0 or 1");
  }
  return *hand;
}

Result<double> NumberAt(const Json& object, const char* name, const Limits& limits,
                        double missing) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr) {
    return missing;
  }
  const double number = field->is_number() ? field->get<double>() : limits.low - 1;
  if (!(number >= limits.low && number <= limits.high)) {
    return FailField(name, fmt::format("a number of {} to {}", limits.low, limits.high).c_str());
  }
  return number;
}

Result<PickedFace> FaceAt(const Json& object, const char* name) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr) {
    return FailField(name, "a face, such as {\"occurrence\": 0, \"face\": 3}");
  }
  const auto occurrence = IndexAt(*field, "occurrence");
  const auto face = IndexAt(*field, "face");
  if (!occurrence || !face) {
    return FailField(name, "a face, such as {\"occurrence\": 0, \"face\": 3}");
  }
  return PickedFace{product::OccurrenceId(*occurrence), product::FaceId(*face)};
}

}  // namespace hvas::studio
