#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "mates/side_file.h"

namespace hvas::app {
namespace {

using mates::SideFileObject;
using mates::SideFileType;
using nlohmann::json;
using testing::ProductFile;
using testing::ReadSchema;
using testing::RunHvasJson;
using testing::Validate;

/** What a property asks for, through its reference. */
json Resolve(const json& schema, json property) {
  if (property.contains("$ref")) {
    property = schema.at(json::json_pointer(property["$ref"].get<std::string>().substr(1)));
  }
  return property;
}

void ExpectSameKeys(const json& schema, const json& object, SideFileObject kind) {
  std::set<std::string> required;
  for (const json& key : object.value("required", json::array())) {
    required.insert(key);
  }
  const auto keys = mates::KeysOf(kind);
  EXPECT_EQ(object["properties"].size(), keys.size());
  EXPECT_EQ(object["additionalProperties"], false);
  for (const mates::SideFileKey& key : keys) {
    const std::string name(key.name);
    ASSERT_TRUE(object["properties"].contains(name)) << name;
    const json property = Resolve(schema, object["properties"][name]);
    EXPECT_EQ(required.contains(name), key.is_required) << name;
    switch (key.type) {
      case SideFileType::kText:
        if (key.choices.empty()) {
          EXPECT_EQ(property["type"], "string") << name;
          EXPECT_EQ(property.value("minLength", 0), key.may_be_empty ? 0 : 1) << name;
        } else {
          EXPECT_EQ(property["enum"].size(), key.choices.size());
          for (const std::string_view choice : key.choices) {
            EXPECT_NE(std::find(property["enum"].begin(), property["enum"].end(), choice),
                      property["enum"].end())
                << choice;
          }
        }
        break;
      case SideFileType::kNumber:
      case SideFileType::kIndex:
        EXPECT_EQ(property["type"], key.type == SideFileType::kIndex ? "integer" : "number");
        EXPECT_EQ(property[key.is_low_excluded ? "exclusiveMinimum" : "minimum"], key.low) << name;
        EXPECT_EQ(property["maximum"], key.high) << name;
        break;
      case SideFileType::kObject:
        EXPECT_EQ(property["type"], "object") << name;
        break;
      case SideFileType::kList:
        EXPECT_EQ(property["type"], "array") << name;
        break;
    }
  }
}

TEST(SideFileSchema, HasTheKeysTypesAndRangesOfTheReader) {
  const json schema = ReadSchema("assignments");
  ExpectSameKeys(schema, schema, SideFileObject::kDocument);
  ExpectSameKeys(schema, schema["$defs"]["fit"], SideFileObject::kFit);
  ExpectSameKeys(schema, schema["$defs"]["mate"], SideFileObject::kMate);
  ExpectSameKeys(schema, schema["$defs"]["side"], SideFileObject::kSide);
  ExpectSameKeys(schema, schema["$defs"]["removed"], SideFileObject::kRemoved);
}

TEST(SideFileSchema, SaysTheSameAsTheReaderOnGoodAndBadFiles) {
  const json schema = ReadSchema("assignments");
  const std::string a = R"({"occurrence": "x", "face": 1})";
  const auto expect = [&](bool is_good, const std::string& list, const std::string& entry) {
    const std::string text =
        R"({"format": "hvas-assignments-2", ")" + list + "\": [" + entry + "]}";
    EXPECT_EQ(Validate(schema, json::parse(text)).empty(), is_good) << text;
    EXPECT_EQ(mates::ParseSideFile(text, "f").has_value(), is_good) << text;
  };
  for (const char* entry :
       {R"({"mate": "m1", "fit": "H7"})", R"({"hole": "a", "shaft": "b", "friction": 0})",
        R"({"hole": "a", "shaft": "b", "diameter_mm": 6, "hole_temperature_c": -273.15})",
        R"({"mate": "k", "shaft_rz_um": 6.3, "hole_diameter_mm": 6.001, "note": ""})"}) {
    expect(true, "fits", entry);
  }
  for (const char* entry :
       {R"({"mate": "m1"})", R"({"mate": "m1", "note": "x"})", R"({"mate": "", "fit": "H7"})",
        R"({"mate": "m1", "hole": "a", "shaft": "b", "fit": "H7"})", R"({"fit": "H7"})",
        R"({"hole": "a", "fit": "H7"})", R"({"mate": "m1", "diameter_mm": 6, "fit": "H7"})",
        R"({"mate": "m1", "friction": 7})", R"({"mate": "m1", "friction": "7"})",
        R"({"mate": "m1", "hole_diameter_mm": 0})", R"({"mate": "m1", "hole_temperature_c": -300})",
        R"({"mate": "m1", "fits": "H7"})", R"({"mate": "m1", "fit": 7})", "7", "[]", "null"}) {
    expect(false, "fits", entry);
  }
  expect(true, "mates", "{\"a\": " + a + ", \"b\": " + a + ", \"kind\": \"cone_seat\"}");
  expect(true, "mates", R"({"a": {"occurrence": "x", "feature": 0}, "b": )" + a + "}");
  for (const std::string& entry : std::vector<std::string>{
           "{\"a\": " + a + "}", "{\"a\": " + a + ", \"b\": " + a + ", \"kind\": \"weld\"}",
           R"({"a": {"occurrence": "x"}, "b": )" + a + "}",
           R"({"a": {"occurrence": "x", "face": 1, "feature": 2}, "b": )" + a + "}",
           R"({"a": {"occurrence": "x", "face": -1}, "b": )" + a + "}",
           R"({"a": {"occurrence": "x", "face": 1.5}, "b": )" + a + "}"}) {
    expect(false, "mates", entry);
  }
  expect(true, "removed", R"({"mate": "0123456789", "note": "n"})");
  expect(false, "removed", R"({"note": "n"})");
}

TEST(SideFileSchema, ExampleProductsAreValid) {
  const json schema = ReadSchema("assignments");
  for (const char* name : {"bushing", "gear_pump", "frame_500"}) {
    const auto file = std::filesystem::path(ProductFile(name)).replace_extension(".hvas.json");
    EXPECT_EQ(Validate(schema, json::parse(testing::ReadText(file))), std::vector<std::string>{});
  }
}

TEST(InspectSchema, RealOutputIsValidAndHasEverySection) {
  const json schema = ReadSchema("inspect");
  for (const char* name : {"bushing", "gear_pump"}) {
    const json document = RunHvasJson({"inspect", ProductFile(name)});
    EXPECT_EQ(Validate(schema, document), std::vector<std::string>{}) << name;
    for (const auto& [section, property] : schema["properties"].items()) {
      EXPECT_EQ(document.contains(section), section != "meshes") << section;
    }
    for (const char* section : {"parts", "occurrences", "features", "forms", "faces", "mates",
                                "joints", "fits", "inner_constraints"}) {
      EXPECT_FALSE(document[section].empty()) << section;
    }
  }
}

TEST(InspectSchema, MistakesAreFound) {
  const json schema = ReadSchema("inspect");
  const json good = RunHvasJson({"inspect", ProductFile("bushing")});
  json bad = good;
  bad["mates"][0].erase("key");
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["parts"][0]["colour"] = 7;
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["faces"][0]["kind"] = "flat";
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["occurrences"][0]["rotation_wxyz"].push_back(0);
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
}

}  // namespace
}  // namespace hvas::app
