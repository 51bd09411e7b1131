#include "app/test/json_schema.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
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
    if (keyword == "$ref") {
      const auto reference = argument.get<std::string>();
      const std::size_t hash = reference.find('#');
      const json::json_pointer pointer(reference.substr(hash + 1));
      if (hash == 0) {
        Append(Check(root_.at(pointer), value, at), errors);
      } else {
        const json other = ReadSchema(reference.substr(0, reference.find('.')));
        Append(Validator(other).Check(other.at(pointer), value, at), errors);
      }
    } else if (keyword == "type") {
      bool is_good = false;
      for (const json& type : argument.is_array() ? argument : json::array({argument})) {
        is_good = is_good || IsOfType(value, type);
      }
      expect(is_good);
      if (value.is_object()) {
        CheckObject(schema, value, at, errors);
      }
    } else if (keyword == "required") {
      for (const json& key : argument) {
        expect(!value.is_object() || value.contains(key.get<std::string>()));
      }
    } else if (keyword == "items") {
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
        Append(Check(argument, value[i], at + "/" + std::to_string(i)), errors);
      }
    } else if (keyword == "enum") {
      expect(std::find(argument.begin(), argument.end(), value) != argument.end());
    } else if (keyword == "const") {
      expect(value == argument);
    } else if (keyword == "minimum") {
      expect(!value.is_number() || value >= argument);
    } else if (keyword == "maximum") {
      expect(!value.is_number() || value <= argument);
    } else if (keyword == "exclusiveMinimum") {
      expect(!value.is_number() || value > argument);
    } else if (keyword == "minLength") {
      expect(!value.is_string() || value.get<std::string>().size() >= argument);
    } else if (keyword == "pattern") {
      expect(!value.is_string() ||
             std::regex_search(value.get<std::string>(), std::regex(argument.get<std::string>())));
    } else if (keyword == "minItems") {
      expect(!value.is_array() || value.size() >= argument);
    } else if (keyword == "maxItems") {
      expect(!value.is_array() || value.size() <= argument);
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
