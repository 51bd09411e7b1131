#include "studio/test/protocol_schema.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "studio/hand_rack.h"

namespace hvas::studio::testing {
namespace {

const Json& Schema() {
  static const Json schema = [] {
    std::ifstream file(HVAS_PROTOCOL_SCHEMA);
    return Json::parse(file);
  }();
  return schema;
}

std::vector<std::string> AlternativesOf(const std::string& type) {
  constexpr std::string_view kOr = " | ";
  std::vector<std::string> all;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + kOr.size()) {
    end = type.find(kOr, begin);
    all.push_back(type.substr(begin, end - begin));
  }
  return all;
}

/** The type of a field, or of a name for another type, which may stand beside its meaning. */
std::string TypeOf(const Json& told) {
  return told.is_array()
             ? told[0].get<std::string>()
             : (told.is_object() ? told["type"].get<std::string>() : told.get<std::string>());
}

bool IsWhole(const Json& value, double low, double high) {
  return value.is_number_integer() && value.get<double>() >= low && value.get<double>() <= high;
}

using Check = std::function<bool(const Json&)>;

const std::map<std::string, Check>& Primitives() {
  constexpr double kMostIndex = 4294967294.0;
  constexpr double kMostWhole = 9007199254740991.0;  // that a page keeps exactly
  static const std::map<std::string, Check> primitives{
      {"text", [](const Json& value) { return value.is_string(); }},
      {"flag", [](const Json& value) { return value.is_boolean(); }},
      {"null", [](const Json& value) { return value.is_null(); }},
      {"number",
       [](const Json& value) { return value.is_number() && std::isfinite(value.get<double>()); }},
      {"whole", [](const Json& value) { return IsWhole(value, -kMostWhole, kMostWhole); }},
      {"index", [](const Json& value) { return IsWhole(value, 0, kMostIndex); }},
      {"hand", [](const Json& value) { return IsWhole(value, 0, HandRack::kMaxHands - 1); }},
  };
  return primitives;
}

/** Fields of an object, each by its name: type, and whether it may be missing. */
struct Field {
  std::string type;
  bool is_optional;
};

using Fields = std::map<std::string, Field>;

Fields FieldsOf(const Json& told) {
  Fields fields;
  if (told.contains("base")) {
    fields = FieldsOf(Schema()["types"][told["base"].get<std::string>()]);
  }
  for (auto& [name, field] : fields) {
    field.is_optional = field.is_optional || told.value("is_partial", false);
  }
  const Json own = told.value("fields", Json::object());
  for (const auto& [key, field] : own.items()) {
    const bool is_optional = key.back() == '?';
    fields[is_optional ? key.substr(0, key.size() - 1) : key] = {TypeOf(field), is_optional};
  }
  return fields;
}

std::string FindObjectFault(const Fields& fields, const Json& value) {
  if (!value.is_object()) {
    return " is no object";
  }
  for (const auto& [name, field] : fields) {
    if (!value.contains(name)) {
      if (field.is_optional) {
        continue;
      }
      return "." + name + " is missing";
    }
    if (const std::string fault = FindFault(field.type, value[name]); !fault.empty()) {
      return "." + name + fault;
    }
  }
  for (const auto& [name, field] : value.items()) {
    if (fields.count(name) == 0) {
      return "." + name + " is not in the schema";
    }
  }
  return "";
}

/** @param count  How many there have to be; none: any. */
std::string FindListFault(const std::string& type, const std::string& count, const Json& value) {
  if (!value.is_array() || (!count.empty() && value.size() != std::stoul(count))) {
    return " is no list of " + (count.empty() ? type : count);
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (const std::string fault = FindFault(type, value[i]); !fault.empty()) {
      return fmt::format("[{}]{}", i, fault);
    }
  }
  return "";
}

std::string FindMapFault(const std::string& type, const Json& value) {
  for (const auto& [key, one] : value.items()) {
    if (const std::string fault = FindFault(type, one); !fault.empty()) {
      return "." + key + fault;
    }
  }
  return value.is_object() ? "" : " is no object";
}

std::string FindOneFault(const std::string& type, const Json& value) {
  if (type.front() == '\'') {
    return value == type.substr(1, type.size() - 2) ? "" : fmt::format(" is not {}", type);
  }
  if (type.front() == '{') {
    return FindMapFault(type.substr(1, type.size() - 2), value);
  }
  if (const std::size_t bracket = type.find('['); bracket != std::string::npos) {
    const std::string count = type.substr(bracket + 1, type.size() - bracket - 2);
    return FindListFault(type.substr(0, bracket), count, value);
  }
  const auto primitive = Primitives().find(type);
  if (primitive != Primitives().end()) {
    return primitive->second(value) ? "" : fmt::format(" is no {}: {}", type, value.dump());
  }
  const Json& told = Schema()["types"].at(type);
  return told.is_object() ? FindObjectFault(FieldsOf(told), value) : FindFault(TypeOf(told), value);
}

/** An item of the list by its name; null: there is none. */
const Json* FindNamed(const char* list, const std::string& name) {
  for (const Json& one : Schema()[list]) {
    if (one["name"] == name) {
      return &one;
    }
  }
  return nullptr;
}

/** A value of a type. */
Json MakeValue(const std::string& type) {
  const std::string first = AlternativesOf(type)[0];
  if (first.starts_with('\'')) {
    return first.substr(1, first.size() - 2);
  }
  if (first.ends_with(']')) {
    const std::size_t bracket = first.find('[');
    const bool is_list = first[bracket + 1] == ']';
    const std::size_t count = is_list ? 1 : static_cast<std::size_t>(first[bracket + 1] - '0');
    return Json(std::vector<Json>(count, MakeValue(first.substr(0, bracket))));
  }
  static const std::map<std::string, Json> primitives{
      {"text", "x"}, {"flag", true}, {"number", 0},    {"whole", 0},
      {"index", 0},  {"hand", 0},    {"null", nullptr}};
  if (const auto found = primitives.find(first); found != primitives.end()) {
    return found->second;
  }
  const Json& told = Schema()["types"][first];
  if (!told.is_object()) {
    return MakeValue(TypeOf(told));
  }
  Json object = Json::object();
  for (const auto& [name, field] : told["fields"].items()) {
    object[name.ends_with('?') ? name.substr(0, name.size() - 1) : name] = MakeValue(TypeOf(field));
  }
  return object;
}

CommandExample MakeExample(const Json& told, const Json& message, const std::string& right) {
  CommandExample example{told["name"], right, message, {}};
  const Json fields = told.value("fields", Json::object());
  for (const auto& [key, field] : fields.items()) {
    const std::string name = key.ends_with('?') ? key.substr(0, key.size() - 1) : key;
    example.fields.push_back(name);
    example.message[name] = MakeValue(TypeOf(field));
  }
  return example;
}

std::set<std::string> NamesIn(const char* list) {
  std::set<std::string> names;
  for (const Json& one : Schema()[list]) {
    names.insert(one["name"].get<std::string>());
  }
  return names;
}

}  // namespace

std::string FindFault(const std::string& type, const Json& value) {
  std::string faults;
  for (const std::string& one : AlternativesOf(type)) {
    const std::string fault = FindOneFault(one, value);
    if (fault.empty()) {
      return "";
    }
    faults += (faults.empty() ? "" : ", and") + fault;
  }
  return faults;
}

std::string FindEventFault(const Json& event) {
  const std::string name = event.value("event", "");
  const Json* told = FindNamed("events", name);
  if (told == nullptr) {
    return fmt::format("there is no event {}", event.dump());
  }
  Json fields = event;
  fields.erase("event");
  const Json& base = told->contains("base") ? (*told)["base"] : Json();
  const bool is_named = base.is_string() && !Schema()["types"][base.get<std::string>()].is_object();
  const std::string fault =
      is_named ? FindFault(base, fields) : FindObjectFault(FieldsOf(*told), fields);
  return fault.empty() ? "" : name + fault;
}

std::string FindResultFault(const std::string& command, const Json& result) {
  const Json* told = FindNamed("commands", command);
  if (told == nullptr) {
    return fmt::format("there is no command {}", command);
  }
  const std::string fault =
      told->contains("result") ? FindFault((*told)["result"], result) : FindObjectFault({}, result);
  return fault.empty() ? "" : command + fault;
}

std::vector<CommandExample> MakeCommandExamples() {
  std::vector<CommandExample> examples;
  for (const Json& command : Schema()["commands"]) {
    examples.push_back(MakeExample(command, {{"command", command["name"]}}, command["right"]));
  }
  for (const Json& action : Schema()["study_actions"]) {
    examples.push_back(
        MakeExample(action, {{"command", "study"}, {"action", action["name"]}}, "anybody"));
  }
  return examples;
}

std::set<std::string> EventNames() {
  return NamesIn("events");
}

std::set<std::string> CommandNames() {
  return NamesIn("commands");
}

}  // namespace hvas::studio::testing
