#include "app/test/json_schema.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace hvas::app::testing {
namespace {

using nlohmann::json;

class Validator {
 public:
  explicit Validator(const json& root) : root_(root) {}

  std::vector<std::string> Check(const json& schema, const json& value, const std::string& at) {
    std::vector<std::string> errors;
    for (const auto& [keyword, argument] : schema.items()) {
      CheckKeyword(schema, keyword, argument, value, at, &errors);
    }
    return errors;
  }

 private:
  static bool IsOfType(const json& value, const std::string& type) {
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
           (type == "null" && value.is_null()) || (type == "number" && value.is_number()) ||
           (type == "integer" && value.is_number_integer());
  }

  std::size_t CountMatches(const json& schemas, const json& value, const std::string& at) {
    std::size_t count = 0;
    for (const json& schema : schemas) {
      count += Check(schema, value, at).empty() ? 1U : 0U;
    }
    return count;
  }

  void CheckObject(const json& schema, const json& value, const std::string& at,
                   std::vector<std::string>* errors) {
    for (const auto& [key, item] : value.items()) {
      const bool is_known = schema.contains("properties") && schema["properties"].contains(key);
      if (is_known) {
        Append(Check(schema["properties"][key], item, at + "/" + key), errors);
      } else if (schema.contains("additionalProperties")) {
        errors->push_back(at + "/" + key + ": not in the schema");
      }
    }
  }

  static void Append(std::vector<std::string> more, std::vector<std::string>* errors) {
    errors->insert(errors->end(), more.begin(), more.end());
  }

  /** Whether a value is within what a keyword allows that looks at nothing below it. */
  using Limit = bool (*)(const json& argument, const json& value);

  /** Finds the limit of a keyword; null for those that are no limits. */
  static Limit FindLimit(const std::string& keyword) {
    static const std::map<std::string, Limit> kLimits{
        {"enum",
         [](const json& argument, const json& value) {
           return std::find(argument.begin(), argument.end(), value) != argument.end();
         }},
        {"const", [](const json& argument, const json& value) { return value == argument; }},
        {"minimum", [](const json& argument,
                       const json& value) { return !value.is_number() || value >= argument; }},
        {"maximum", [](const json& argument,
                       const json& value) { return !value.is_number() || value <= argument; }},
        {"exclusiveMinimum",
         [](const json& argument, const json& value) {
           return !value.is_number() || value > argument;
         }},
        {"minLength",
         [](const json& argument, const json& value) {
           return !value.is_string() || value.get<std::string>().size() >= argument;
         }},
        {"pattern",
         [](const json& argument, const json& value) {
           return !value.is_string() || std::regex_search(value.get<std::string>(),
                                                          std::regex(argument.get<std::string>()));
         }},
        {"minItems",
         [](const json& argument, const json& value) {
           return !value.is_array() || value.size() >= argument;
         }},
        {"maxItems", [](const json& argument, const json& value) {
           return !value.is_array() || value.size() <= argument;
         }}};
    const auto found = kLimits.find(keyword);
    return found == kLimits.end() ? nullptr : found->second;
  }

  std::vector<std::string> CheckReference(const std::string& reference, const json& value,
                                          const std::string& at) {
    const std::size_t hash = reference.find('#');
    const json::json_pointer pointer(reference.substr(hash + 1));
    if (hash == 0) {
      return Check(root_.at(pointer), value, at);
    }
    const json other = ReadSchema(reference.substr(0, reference.find('.')));
    return Validator(other).Check(other.at(pointer), value, at);
  }

  static bool IsOfOneType(const json& types, const json& value) {
    const json list = types.is_array() ? types : json::array({types});
    return std::any_of(list.begin(), list.end(),
                       [&](const json& type) { return IsOfType(value, type); });
  }

  static bool HasAll(const json& keys, const json& value) {
    return !value.is_object() || std::all_of(keys.begin(), keys.end(), [&](const json& key) {
      return value.contains(key.get<std::string>());
    });
  }

  void CheckKeyword(const json& schema, const std::string& keyword, const json& argument,
                    const json& value, const std::string& at, std::vector<std::string>* errors) {
    static const std::set<std::string> kSilent{"$schema",     "$defs",      "title",
                                               "description", "properties", "additionalProperties"};
    const auto expect = [&](bool is_good) {
      if (!is_good) {
        errors->push_back(at + ": " + keyword + " " + argument.dump() + ", not " +
                          value.dump().substr(0, 80));
      }
    };
    if (const Limit limit = FindLimit(keyword)) {
      expect(limit(argument, value));
    } else if (keyword == "$ref") {
      Append(CheckReference(argument.get<std::string>(), value, at), errors);
    } else if (keyword == "type") {
      expect(IsOfOneType(argument, value));
      if (value.is_object()) {
        CheckObject(schema, value, at, errors);
      }
    } else if (keyword == "required") {
      expect(HasAll(argument, value));
    } else if (keyword == "items") {
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
        Append(Check(argument, value[i], at + "/" + std::to_string(i)), errors);
      }
    } else if (keyword == "oneOf") {
      expect(CountMatches(argument, value, at) == 1);
    } else if (keyword == "anyOf") {
      expect(CountMatches(argument, value, at) >= 1);
    } else if (keyword == "not") {
      expect(!Check(argument, value, at).empty());
    } else if (!kSilent.contains(keyword)) {
      errors->push_back("the schema has a keyword that is not known: " + keyword);
    }
  }

  const json& root_;
};

}  // namespace

std::vector<std::string> Validate(const json& schema, const json& document) {
  return Validator(schema).Check(schema, document, "");
}

json ReadSchema(const std::string& name) {
  std::ifstream file(std::filesystem::path(HVAS_SOURCE_DIR) / "data" / "schemas" /
                     (name + ".schema.json"));
  return json::parse(file);
}

}  // namespace hvas::app::testing
