#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/command_tree.h"
#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "mates/side_file.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using mates::SideFileObject;
using mates::SideFileType;
using nlohmann::json;
using testing::ProductFile;
using testing::ReadSchema;
using testing::RunHvasJson;
using testing::Validate;

/** A pointer to the member `key` of what `at` points to. */
std::string Below(const std::string& at, const std::string& key) {
  return at + "/" + key;
}

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
      case SideFileType::kDiameters: {
        const json one = Resolve(schema, property["oneOf"][0]);
        EXPECT_EQ(one["exclusiveMinimum"], key.low) << name;
        EXPECT_EQ(one["maximum"], key.high) << name;
        EXPECT_EQ(property["oneOf"][1]["type"], "array") << name;
        break;
      }
      case SideFileType::kObject:
        EXPECT_EQ(property["type"], "object") << name;
        break;
      case SideFileType::kList:
        EXPECT_EQ(property["type"], "array") << name;
        break;
    }
  }
}

/** Pointers to the objects of a schema that name properties and do not say whether others may be
 there. */
void ListOpenObjects(const json& schema, const std::string& at, std::vector<std::string>* open) {
  if (schema.is_object() && schema.contains("properties") &&
      schema.value("type", json()) == "object" && !schema.contains("additionalProperties") &&
      !schema.contains("unevaluatedProperties")) {
    open->push_back(at);
  }
  if (schema.is_structured()) {
    for (const auto& [key, inner] : schema.items()) {
      ListOpenObjects(inner, Below(at, key), open);
    }
  }
}

TEST(Schemas, EveryObjectSaysWhetherItMayHaveOtherProperties) {
  const std::filesystem::path folder(HVAS_SOURCE_DIR "/data/schemas");
  int count = 0;
  for (const auto& item : std::filesystem::directory_iterator(folder)) {
    const json schema = json::parse(testing::ReadText(item.path()));
    std::vector<std::string> open;
    ListOpenObjects(schema, "", &open);
    EXPECT_EQ(open, std::vector<std::string>{}) << item.path();
    ++count;
  }
  EXPECT_GT(count, 20);
}

TEST(SideFileSchema, HasTheKeysTypesAndRangesOfTheReader) {
  const json schema = ReadSchema("assignments");
  ExpectSameKeys(schema, schema, SideFileObject::kDocument);
  ExpectSameKeys(schema, schema["$defs"]["fit"], SideFileObject::kFit);
  ExpectSameKeys(schema, schema["$defs"]["mate"], SideFileObject::kMate);
  ExpectSameKeys(schema, schema["$defs"]["side"], SideFileObject::kSide);
  ExpectSameKeys(schema, schema["$defs"]["removed"], SideFileObject::kRemoved);
  ExpectSameKeys(schema, schema["$defs"]["relation"], SideFileObject::kRelation);
  ExpectSameKeys(schema, schema["$defs"]["contact"], SideFileObject::kContact);
  ExpectSameKeys(schema, schema["$defs"]["apart"], SideFileObject::kApart);
  ExpectSameKeys(schema, schema["$defs"]["compliant"], SideFileObject::kCompliant);
  ExpectSameKeys(schema, schema["$defs"]["flexible"], SideFileObject::kFlexible);
  ExpectSameKeys(schema, schema["$defs"]["elastic"], SideFileObject::kElastic);
  ExpectSameKeys(schema, schema["$defs"]["flexible"], SideFileObject::kFlexible);
  ExpectSameKeys(schema, schema["$defs"]["elastic"], SideFileObject::kElastic);
}

// The compiler names the sources that lack a kind of mate; this test names the other files.
TEST(Schemas, HaveAllKindsOfMates) {
  std::vector<std::string> kinds;
  kinds.reserve(std::size(product::kMateKinds));
  for (const product::MateKind kind : product::kMateKinds) {
    kinds.emplace_back(ToString(kind));
  }
  const json inspect = ReadSchema("inspect");
  const json& counts = inspect["$defs"]["summary"]["properties"]["mates"];
  std::vector<std::string> counted;
  for (const auto& item : counts["properties"].items()) {
    counted.push_back(item.key());
  }
  EXPECT_EQ(counts["required"], json(kinds));
  EXPECT_EQ(std::set<std::string>(counted.begin(), counted.end()),
            std::set<std::string>(kinds.begin(), kinds.end()));
  EXPECT_EQ(inspect["$defs"]["mate"]["properties"]["kind"]["enum"], json(kinds));
  EXPECT_EQ(ReadSchema("assignments")["$defs"]["mate"]["properties"]["kind"]["enum"], json(kinds));
  const json protocol = json::parse(testing::ReadText(HVAS_SOURCE_DIR "/src/studio/protocol.json"));
  EXPECT_EQ(protocol["types"]["Mate"]["fields"]["kind"],
            fmt::format("'{}'", fmt::join(kinds, "' | '")));
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
  const std::vector<std::string> refused_mates{
      "{\"a\": " + a + "}",
      "{\"a\": " + a + ", \"b\": " + a + ", \"kind\": \"weld\"}",
      R"({"a": {"occurrence": "x"}, "b": )" + a + "}",
      R"({"a": {"occurrence": "x", "face": 1, "feature": 2}, "b": )" + a + "}",
      R"({"a": {"occurrence": "x", "face": -1}, "b": )" + a + "}",
      R"({"a": {"occurrence": "x", "face": 1.5}, "b": )" + a + "}"};
  for (const std::string& entry : refused_mates) {
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
    const std::set<std::string> on_demand{"meshes", "header", "identities", "relations",
                                          "surface_relations"};
    for (const auto& [section, property] : schema["properties"].items()) {
      EXPECT_EQ(document.contains(section), !on_demand.contains(section)) << section;
    }
    const json more =
        RunHvasJson({"inspect", ProductFile(name), "--only", "identity,relations,surfaces"});
    EXPECT_EQ(Validate(schema, more), std::vector<std::string>{}) << name;
    for (const char* section : {"parts", "occurrences", "features", "forms", "faces", "mates",
                                "joints", "fits", "inner_constraints"}) {
      EXPECT_FALSE(document[section].empty()) << section;
    }
  }
}

/** A command of the tree, and what to run of it. */
struct JsonRun {
  std::vector<std::string> arguments;
  std::string schema;
  int status{0};
};

/** The runs of each command with --json, by its name: at least one. */
class JsonRuns {
 public:
  JsonRuns() {
    const std::string record = (folder_ / "run.hvasrec").string();
    const std::string way = (folder_ / "way.csv").string();
    const std::string swept = (folder_ / "swept.stl").string();
    const std::string bushing = ProductFile("bushing");
    Add({"assemble", bushing, "--record", record}, "assemble");
    Add({"assemble", bushing, "--limit", "5"}, "assemble", 2);
    Add({"assemble", bushing, "--no-cache", "--time-limit", "0.001"}, "preparation", 1);
    Add({"disassemble", bushing, "--no-cache", "--time-limit", "0.001"}, "preparation", 1);
    Add({"disassemble", bushing}, "disassemble");
    Add({"plan", bushing, "--no-cache", "--time-limit", "0.001"}, "preparation", 1);
    Add({"plan", bushing}, "plan");
    Add({"instructions", bushing, "-o", (folder_ / "early.html").string(), "--no-cache",
         "--time-limit", "0.001"},
        "preparation", 1);
    Add({"instructions", bushing, "-o", (folder_ / "bushing.glb").string()}, "instructions");
    Add({"dfa", bushing, "--no-cache", "--time-limit", "0.001"}, "preparation", 1);
    Add({"dfa", bushing}, "dfa");
    Add({"motions", "M3 E2 G3 5 C3"}, "motions");
    Add({"motions", "A1 B0 G3 A1 B0 P6 A0", "--system", "most"}, "motions");
    Add({"plan", ProductFile("gear_pump"), "--front"}, "plan");
    Add({"disassemble", bushing, "--limit", "5"}, "disassemble", 2);
    Add({"replay", record}, "replay");
    Add({"inspect", bushing}, "inspect");
    Add({"mate", "list", bushing}, "mate_list");
    Add({"path", bushing, "--part", "shaft", "--record", record, "-o", way}, "path");
    Add({"path", bushing, "--part", "shaft", "--translate", "0,0,20", "--swept", "-o", swept},
        "path");
    Add({"tool", ProductFile("gear_pump")}, "tool");
    Add({"devices"}, "devices");
    Add({"doctor", "--seconds", "0.2"}, "doctor", kAnyStatus);
    AddFits();
    AddStudies();
    AddCampaign(bushing);
  }

  static constexpr int kAnyStatus = -1;

  [[nodiscard]] const std::vector<JsonRun>& runs() const { return runs_; }

 private:
  void AddFits() {
    Add({"fit", "40", "H7"}, "fit");
    Add({"fit", "40", "H7/p6", "--length", "50", "--hub", "80", "--hub-temp", "200"}, "fit");
    Add({"fit", "40", "H7/g6", "35", "H7/k6", "--length", "50", "--population", "2000"}, "fit");
    Add({"fit", "40", "H7/g6", "--length", "50", "--jamming", (folder_ / "jam.svg").string()},
        "fit");
    Add({"fit", "40", "H7/p6", "--length", "50", "--hub-material", "GJL-250"}, "fit");
    Add({"fit", "search", "--nominal", "40", "--min", "5", "--max", "60"}, "fit_search");
    Add({"fit", "search", "--nominal", "40", "--min", "5", "--max", "6"}, "fit_search");
    Add({"fit", "identify", "--trials", "30"}, "fit_identify");
    Add({"fit", "friction"}, "fit_friction");
    Add({"fit", "materials"}, "fit_materials");
    Add({"fit", "design", "--nominal", "40", "--length", "50", "--torque", "200"}, "fit_design");
    Add({"fit", "design", "--nominal", "40", "--length", "50", "--torque", "50", "--hub-material",
         "GJL-250", "--hub", "100"},
        "fit_design");
  }

  void AddStudies() {
    const std::string study = (folder_ / "study").string();
    const std::string answers =
        folder_
            .Write("answers.csv",
                   "participant,shown,answered\n1,H7/g6,H7/g6\n1,H7/p6,H7/g6\n2,H7/g6,H7/g6\n"
                   "2,H7/p6,H7/p6\n")
            .string();
    const std::string results = HVAS_SOURCE_DIR "/data/studies/identification-2016.csv";
    Add({"study", "analyse", "--table", results, "--of", "15"}, "study_analysis");
    Add({"study", "analyse", "--table", answers}, "study_identification");
    Add({"study", "power", "--means", "0,1", "--sd", "1", "--test", "wilcoxon", "--runs", "200"},
        "study_power");
    Add({"study", "run", testing::WriteShortStudy("fit-2016", folder_.path()), "--simulated", "1",
         "-o", study},
        "study_summary");
    Add({"study", "list", study}, "study_summary");
  }

  /** A campaign of the bushing: all shards, then one missing, which is submitted. */
  void AddCampaign(const std::string& product) {
    const std::string plan =
        folder_
            .Write("plan.yaml",
                   "format: hvas-campaign-1\nid: press\nproducts: [" + product +
                       "]\nfits: [{id: p6, assign: [all=H7/p6]}, {id: s6, assign: [all=H7/s6]}]\n"
                       "seeds: {count: 100}\npress_force_n: 9000\nshard_runs: 50\n"
                       "sensitivity: {samples: 64, resamples: 100}\n")
            .string();
    const std::string folder = (folder_ / "campaign").string();
    Add({"campaign", "submit", plan, "--folder", folder, "--dry-run"}, "campaign_submission");
    Add({"campaign", "collect", folder}, "campaign_summary", 2);
    Add({"campaign", "run", plan, "--folder", folder}, "campaign_summary");
    Add({"campaign", "status", folder}, "campaign_status");
    Add({"campaign", "collect", folder}, "campaign_summary");
    Add({"campaign", "submit", plan, "--folder", folder}, "campaign_submission");
  }

  void Add(std::vector<std::string> arguments, std::string schema, int status = 0) {
    arguments.emplace_back("--json");
    runs_.push_back({std::move(arguments), std::move(schema), status});
  }

  hvas::testing::TemporaryFolder folder_;
  std::vector<JsonRun> runs_;
};

/** Numbers that say less than they seem to: a zero with a sign. */
void ExpectNoNegativeZero(const json& value, const std::string& at) {
  if (value.is_number_float() && value.get<double>() == 0) {
    EXPECT_FALSE(std::signbit(value.get<double>())) << at;
  }
  if (value.is_structured()) {
    for (const auto& [key, item] : value.items()) {
      ExpectNoNegativeZero(item, Below(at, key));
    }
  }
}

/** Names of the schemas that --json of a command promises; none where it has no such option. */
std::vector<std::string> PromisedSchemas(const CommandHelp& command) {
  std::vector<std::string> schemas;
  for (const OptionHelp& option : command.options) {
    if (option.names != std::vector<std::string>{"--json"}) {
      continue;
    }
    std::istringstream words(option.description);
    for (std::string word; words >> word;) {
      const std::string name = word.substr(0, word.find('.'));
      if (std::filesystem::exists(std::string(HVAS_SOURCE_DIR "/data/schemas/") + name +
                                  ".schema.json")) {
        schemas.push_back(name);
      }
    }
    EXPECT_FALSE(schemas.empty()) << command.name << " --json names no schema";
  }
  return schemas;
}

TEST(JsonSchemas, EveryCommandWithJsonPromisesOneAndKeepsIt) {
  const JsonRuns all;
  std::map<std::string, std::set<std::string>> promised;
  int status = 0;
  const CommandHelp root = Describe(*MakeCommandLine(&status));
  for (const CommandHelp* command : ListCommands(root)) {
    for (const std::string& schema : PromisedSchemas(*command)) {
      promised[command->name].insert(schema);
    }
  }
  std::map<std::string, std::set<std::string>> kept;
  for (const JsonRun& run : all.runs()) {
    std::string name = "hvas " + run.arguments[0];
    const std::string deeper = name + " " + run.arguments[1];
    name = promised.contains(deeper) ? deeper : name;
    SCOPED_TRACE(name + ", " + run.arguments[1]);
    const testing::Ran ran = testing::RunHvas(run.arguments);
    if (run.status != JsonRuns::kAnyStatus) {
      EXPECT_EQ(ran.status, run.status) << ran.err;
    }
    const json document = json::parse(ran.out, nullptr, false);
    ASSERT_FALSE(document.is_discarded()) << ran.out << ran.err;
    EXPECT_EQ(Validate(ReadSchema(run.schema), document), std::vector<std::string>{});
    ExpectNoNegativeZero(document, "");
    kept[name].insert(run.schema);
  }
  EXPECT_EQ(kept, promised)
      << "each command with --json, and each of its schemas, needs a run here";
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
