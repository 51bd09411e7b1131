#include "studio/json_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/parse_json.h"
#include "studio/event_json.h"
#include "studio/hand_rack.h"

namespace hvas::studio {
namespace {

constexpr std::size_t kMaxFields = 64;  // fields of a command, including those of nested objects

Unexpected FailField(const char* name, const char* wanted) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" must be {}", name, wanted), "command",
              "reload the page");
}

/** The number of an index; none of other values. */
std::optional<std::uint32_t> IndexOf(const Json& value) {
  const bool is_index = value.is_number_unsigned() &&
                        value.get<std::uint64_t>() < std::numeric_limits<std::uint32_t>::max();
  return is_index ? std::optional(value.get<std::uint32_t>()) : std::nullopt;
}

}  // namespace

Result<Json> ParseCommand(std::string_view text) {
  std::size_t fields = 0;
  const auto keep = [&fields](int, Json::parse_event_t event, const Json&) {
    fields += event == Json::parse_event_t::key ? 1 : 0;
    return fields <= kMaxFields;
  };
  Json command =
      IsNestedTooDeep(text) ? Json() : Json::parse(text, keep, /*allow_exceptions=*/false);
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

Result<std::string> TextAt(const Json& object, const char* name, std::size_t longest) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr || !field->is_string()) {
    return FailField(name, "a text");
  }
  const std::string& text = field->get_ref<const std::string&>();
  // In UTF-8 all but the first byte of a character begin with the bits 10.
  const auto characters = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  if (characters > longest) {
    return FailField(name, fmt::format("a text of at most {} characters", longest).c_str());
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
  const auto index = field != nullptr ? IndexOf(*field) : std::nullopt;
  return index ? Result<std::uint32_t>(*index) : FailField(name, "an index");
}

Result<std::vector<product::OccurrenceId>> OccurrencesAt(const Json& object, const char* name) {
  constexpr std::size_t kMost = 65'536;  // More than four times the parts of a product.
  const Json* field = FieldOf(object, name);
  if (field == nullptr || !field->is_array() || field->size() > kMost) {
    return FailField(name, "a list of indices");
  }
  std::vector<product::OccurrenceId> occurrences;
  occurrences.reserve(field->size());
  for (const Json& item : *field) {
    const auto index = IndexOf(item);
    if (!index) {
      return FailField(name, "a list of indices");
    }
    occurrences.emplace_back(*index);
  }
  return occurrences;
}

Result<std::size_t> HandAt(const Json& object, const char* name) {
  const auto hand = IndexAt(object, name);
  if (!hand || *hand >= HandRack::kMaxHands) {
    return FailField(name, fmt::format("0 to {}", HandRack::kMaxHands - 1).c_str());
  }
  return *hand;
}

Result<double> NumberAt(const Json& object, const char* name, const Limits& limits) {
  const Json* field = FieldOf(object, name);
  const bool is_number = field != nullptr && field->is_number();
  const double number = is_number ? field->get<double>() : limits.low - 1;
  if (!(number >= limits.low && number <= limits.high)) {
    return FailField(name, fmt::format("a number of {} to {}", limits.low, limits.high).c_str());
  }
  return number;
}

Result<Vec3> Vec3At(const Json& object, const char* name) {
  constexpr double kFarthest = 1e6;  // [m], and of directions: a choice.
  const Json* field = FieldOf(object, name);
  Vec3 v = Vec3::Zero();
  bool is_good = field != nullptr && field->is_array() && field->size() == 3;
  for (std::size_t i = 0; is_good && i < 3; ++i) {
    const Json& number = (*field)[i];
    is_good = number.is_number() && std::abs(number.get<double>()) <= kFarthest;
    v[static_cast<Eigen::Index>(i)] = is_good ? number.get<double>() : 0;
  }
  return is_good ? Result<Vec3>(v) : Result<Vec3>(FailField(name, "three numbers"));
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

Result<study::AnswerValue> AnswerAt(const Json& object, const char* name) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr || field->is_null()) {
    return study::AnswerValue();
  }
  if (field->is_string()) {
    return study::AnswerValue(field->get<std::string>());
  }
  using Whole = std::numeric_limits<int>;
  const bool is_whole = field->is_number_integer();
  const double number = is_whole ? field->get<double>() : 0;
  if (!is_whole || number < Whole::min() || number > Whole::max()) {
    return FailField(name, "a whole number, a text, or null for none");
  }
  return study::AnswerValue(field->get<int>());
}

Result<std::size_t> WordIndexAt(const Json& object, const char* name,
                                std::span<const char* const> words) {
  const Json* field = FieldOf(object, name);
  std::string wanted;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (field != nullptr && *field == words[i]) {
      return i;
    }
    const char* before = i == 0 ? "" : i + 1 == words.size() ? " or " : ", ";
    wanted += fmt::format("{}\"{}\"", before, words[i]);
  }
  return FailField(name, wanted.c_str());
}

}  // namespace hvas::studio
