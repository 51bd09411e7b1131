#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "app/output/text_layout.h"
#include "app/test/run_hvas.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;
using testing::RunHvasJson;

/** What `hvas inspect --json` says about a product; asked once. */
const json& Inspect(const std::string& name) {
  static std::map<std::string, json> known;
  if (!known.contains(name)) {
    known[name] = RunHvasJson({"inspect", ProductFile(name)});
  }
  return known[name];
}

class InspectTest : public ::testing::TestWithParam<const char*> {
 protected:
  const json& inspected_{Inspect(GetParam())};
  const json truth_ = json::parse(testing::ReadText(
      std::filesystem::path(ProductFile(GetParam())).replace_extension("truth.json")));
};

TEST_P(InspectTest, X1SummaryIsAsDrawn) {  // X2
  const json& summary = inspected_["summary"];
  for (const char* key : {"occurrences", "unique_parts", "depth"}) {
    EXPECT_EQ(summary[key], truth_[key]) << key;
  }
  for (const char* key : {"volume_mm3", "mass_kg"}) {
    const double drawn = truth_[key];
    EXPECT_NEAR(summary[key].get<double>() / drawn, 1, 1e-5) << key;
  }
  EXPECT_EQ(summary["mates"]["axis_hole"], truth_["mate_counts"]["axis_hole"]);
  const auto& mates = inspected_["mates"];
  const auto touching = std::count_if(mates.begin(), mates.end(), [](const json& mate) {
    return mate["kind"] == "face_face" &&
           mate["evidence"].get<std::string>().rfind("touching", 0) == 0;
  });
  // The key of the pump is between two walls that it touches, of its shaft, and two of its hub, 30
  // um from each: two prismatic mates.
  const bool has_key = std::string(GetParam()) == "gear_pump";
  EXPECT_EQ(touching, truth_["mate_counts"]["face_face"].get<int>() - (has_key ? 2 : 0));
  EXPECT_EQ(summary["mates"]["face_face"].get<int>() - touching, 0);
  EXPECT_EQ(summary["mates"]["prismatic"], has_key ? 2 : 0);
  EXPECT_EQ(summary["linked_parts"], truth_["occurrences"]);
  EXPECT_EQ(summary["linked_groups"], 1);
  EXPECT_EQ(summary["warnings"], 0) << inspected_["diagnostics"].dump(1);
}

TEST_P(InspectTest, PartsAreAsDrawn) {
  std::map<std::string, json> found;
  std::map<int, int> uses;
  for (const json& occurrence : inspected_["occurrences"]) {
    ++uses[occurrence["part"].get<int>()];
  }
  for (const json& part : inspected_["parts"]) {
    found[part["name"].get<std::string>()] = part;
  }
  ASSERT_EQ(found.size(), truth_["parts"].size());
  for (const json& drawn : truth_["parts"]) {
    const std::string name = drawn["name"];
    ASSERT_TRUE(found.contains(name)) << name;
    const json& part = found[name];
    EXPECT_EQ(uses[part["id"].get<int>()], drawn["count"]) << name;
    // The flanks of gears are splines, over which volumes are integrated less exactly.
    const double tolerance = name.find("gear") == std::string::npos ? 1e-5 : 5e-5;
    EXPECT_NEAR(part["volume_mm3"].get<double>() / drawn["volume_mm3"].get<double>(), 1, tolerance)
        << name;
    const json& material = part["material"];
    EXPECT_EQ(material["density_kg_per_m3"], drawn["density_kg_m3"]) << name;
    EXPECT_EQ(material["name"], drawn["material"]) << name;
    EXPECT_FALSE(material["is_density_assumed"].get<bool>()) << name;
    EXPECT_EQ(part["solid_count"], 1) << name;
  }
}

TEST_P(InspectTest, W3EveryFitOfTheDrawingIsOnAMate) {
  std::map<int, std::string> names;
  for (const json& occurrence : inspected_["occurrences"]) {
    names[occurrence["id"].get<int>()] = occurrence["path"];
  }
  // "tier 1/pin 1" in the drawing may be any occurrence whose path ends so, or repeat by tier.
  const auto ends_with = [](const std::string& path, const std::string& name) {
    return path == name || (path.size() > name.size() &&
                            path.compare(path.size() - name.size(), name.size(), name) == 0 &&
                            path[path.size() - name.size() - 1] == '/');
  };
  for (const json& drawn : truth_["fits"]) {
    const bool is_found =
        std::any_of(inspected_["mates"].begin(), inspected_["mates"].end(), [&](const json& mate) {
          if (mate["kind"] != "axis_hole" || mate["fit"].is_null()) {
            return false;
          }
          const json& fit = mate["fit"];
          // Threads are known by the names of the screws; other fits are stated beside the file.
          const bool is_same = drawn["fit"] == "thread"
                                   ? fit["kind"] == "thread"
                                   : fit["code"] == drawn["fit"] && fit["is_proposed"] == false;
          return is_same &&
                 std::abs(mate["hole_diameter_mm"].get<double>() /
                              drawn["diameter_mm"].get<double>() -
                          1) < 0.2 &&
                 ends_with(names[mate["hole"]["occurrence"].get<int>()], drawn["hole"]) &&
                 ends_with(names[mate["shaft"]["occurrence"].get<int>()], drawn["shaft"]);
        });
    EXPECT_TRUE(is_found) << drawn.dump();
  }
}

TEST_P(InspectTest, IdsReferToWhatTheyShould) {
  const auto size = [this](const char* key) { return inspected_[key].size(); };
  for (const char* key : {"parts", "subassemblies", "occurrences", "mates"}) {
    for (std::size_t i = 0; i < size(key); ++i) {
      EXPECT_EQ(inspected_[key][i]["id"], i) << key;
    }
  }
  std::set<std::string> paths;
  for (const json& occurrence : inspected_["occurrences"]) {
    EXPECT_LT(occurrence["part"].get<std::size_t>(), size("parts"));
    EXPECT_LT(occurrence["subassembly"].get<std::size_t>(), size("subassemblies"));
    EXPECT_TRUE(paths.insert(occurrence["path"]).second) << occurrence["path"];
    double norm = 0;
    for (const json& c : occurrence["rotation_wxyz"]) {
      norm += c.get<double>() * c.get<double>();
    }
    EXPECT_NEAR(norm, 1, 1e-12);
  }
  for (const json& mate : inspected_["mates"]) {
    const bool has_fit = mate["kind"] == "axis_hole" || mate["kind"] == "prismatic";
    for (const char* side : {has_fit ? "hole" : "a", has_fit ? "shaft" : "b"}) {
      EXPECT_LT(mate[side]["occurrence"].get<std::size_t>(), size("occurrences"));
    }
    const bool is_length = has_fit || mate["kind"] == "cone_seat";
    EXPECT_GT(mate[is_length ? "engaged_mm" : "overlap_mm2"].get<double>(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(OwnProducts, InspectTest,
                         ::testing::Values("bushing", "gear_pump", "frame_500"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(InspectTextTest, TextNamesEveryPartAndEndsWithTheCounts) {
  const Ran ran = RunHvas({"inspect", ProductFile("bushing")});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  for (const char* text : {"chuck", "bushing 40x80x50", "shaft 40", "H7/g6", "H7/h6",
                           "3 parts (3 different) in 1 levels", "2 axis-hole and 2 face mates",
                           "3 of 3 parts linked"}) {
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, ran.out);
  }
}

TEST(InspectTextTest, LinesFitIntoAHundredColumnsAndLongListsSaySo) {
  const Ran cut = RunHvas({"inspect", ProductFile("frame_500")});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "more (--all shows them)", cut.out);
  const Ran all = RunHvas({"inspect", ProductFile("frame_500"), "--all"});
  EXPECT_EQ(all.out.find("--all"), std::string::npos);
  EXPECT_GT(all.out.size(), 4 * cut.out.size());
  for (const std::string* text : {&cut.out, &all.out}) {
    std::istringstream lines(*text);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(CalcWidth(line), 80U) << line;
    }
  }
}

TEST(InspectTextTest, NamesInAnyScriptKeepTheirColumns) {
  EXPECT_EQ(CalcWidth("Wälzlager"), 9U);
  EXPECT_EQ(CalcWidth("軸受"), 4U);
  EXPECT_EQ(CalcWidth("Корпус"), 6U);
  EXPECT_EQ(Shorten("Корпус насоса", 8), "..насоса");
  EXPECT_EQ(Shorten("a\tb\x1b[0m", 20), "a?b?[0m");
  EXPECT_EQ(CalcWidth(PadTo("軸受 7", 10)), 10U);
  EXPECT_EQ(Wrap("eins zwei", 2), "  eins zwei\n");
}

TEST(InspectFilterTest, SectionsPartsOccurrencesMatesAndKinds) {
  const std::string file = ProductFile("bushing");
  json shown = RunHvasJson({"inspect", file, "--only", "mates,fits"});
  EXPECT_TRUE(shown.contains("mates") && shown.contains("fits") && shown.contains("summary"));
  EXPECT_FALSE(shown.contains("parts") || shown.contains("faces") || shown.contains("diagnostics"));
  ASSERT_EQ(shown["mates"].size(), 4U);
  const std::string key = shown["mates"][2]["key"];
  shown = RunHvasJson({"inspect", file, "--mate", key});
  ASSERT_EQ(shown["mates"].size(), 1U);
  EXPECT_EQ(shown["mates"][0]["id"], 2);
  EXPECT_EQ(shown["occurrences"].size(), 2U);
  EXPECT_EQ(shown, RunHvasJson({"inspect", file, "--mate", "m2"}));
  shown = RunHvasJson({"inspect", file, "--kind", "face-face"});
  EXPECT_EQ(shown["mates"].size(), 2U);
  EXPECT_EQ(shown["parts"].size(), 3U);
  shown = RunHvasJson({"inspect", file, "--part", "chuck"});
  EXPECT_EQ(shown["parts"].size(), 1U);
  EXPECT_EQ(shown["occurrences"].size(), 1U);
  EXPECT_EQ(shown["mates"].size(), 2U);
  EXPECT_EQ(shown["joints"].size(), 1U);
  for (const auto& face : shown["faces"]) {
    EXPECT_EQ(face["part"], 0);
  }
  shown = RunHvasJson({"inspect", ProductFile("gear_pump"), "--occurrence", "cover fasteners"});
  EXPECT_EQ(shown["occurrences"].size(), 16U);
  EXPECT_EQ(shown["parts"].size(), 2U);
}

TEST(InspectTextTest, EqualCallsGiveEqualBytes) {
  const Ran first = RunHvas({"inspect", ProductFile("gear_pump"), "--json"});
  const Ran second = RunHvas({"inspect", ProductFile("gear_pump"), "--json"});
  EXPECT_TRUE(first.out == second.out);
}

}  // namespace
}  // namespace hvas::app
