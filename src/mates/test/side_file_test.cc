#include "mates/side_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mates/located_json.h"

namespace hvas::mates {
namespace {

TEST(LocatedJson, KnowsTheLineOfEveryElement) {
  const auto json = ParseLocatedJson(
      "\n{\"a\": 1,\n \"b\": [\n  {\"c\": \"x\\\"}\"},\n  7,\n  {\"d\":\n    []}\n ],\n \"e\": "
      "{}}\n",
      "f");
  ASSERT_TRUE(json.has_value()) << json.error().ToString();
  const std::map<std::string, int> expected{{"", 2},     {"/a", 2},     {"/b", 3},
                                            {"/b/0", 4}, {"/b/0/c", 4}, {"/b/1", 5},
                                            {"/b/2", 6}, {"/b/2/d", 7}, {"/e", 9}};
  EXPECT_EQ(json->lines, expected);
  EXPECT_EQ(json->LineOf("/b/2/d/0"), 7);
  EXPECT_EQ(json->LineOf("/z"), 2);
}

TEST(LocatedJson, SyntaxErrorsNameTheLine) {
  const auto line = [](const std::string& text) {
    const auto json = ParseLocatedJson(text, "f");
    EXPECT_FALSE(json.has_value()) << text;
    EXPECT_FALSE(json.error().remedy.empty());
    return json.error().where;
  };
  EXPECT_EQ(line("{\n\"a\": 1\n\"b\": 2}"), "f:3");
  EXPECT_EQ(line("{\n\"a\": [1,\n2,\n]}"), "f:4");
  EXPECT_EQ(line("{\"a\": 1,\n\n\"a\": 2}"), "f:3");
  EXPECT_EQ(line("{\"a\": {\"b\": 1}, \"\\u0061\": 2}"), "f:1");
  EXPECT_EQ(line("{} {}"), "f:1");
  EXPECT_EQ(line("{\"a\": \"x\n\"}"), "f:1");
  EXPECT_EQ(line("\n\n" + std::string(1000, '[')), "f:3");
  EXPECT_EQ(line(""), "f:1");
}

TEST(LocatedJson, DamagedTextsAreErrorsAndNoMore) {
  const std::string whole =
      R"({"format": "hvas-assignments-2", "fits": [{"mate": "m1", "fit": "H7/g6", "friction": 0.1}],
          "mates": [{"a": {"occurrence": "x", "face": 1}, "b": {"occurrence": "y", "face": 2}}]})";
  ASSERT_TRUE(ParseSideFile(whole, "f").has_value());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_FALSE(ParseSideFile(whole.substr(0, i), "f").has_value()) << i;
    for (const char c : {'{', '}', '[', ']', '"', '\\', ',', ':', '\0', '\xff', '9', '\n'}) {
      std::string damaged = whole;
      damaged[i] = c;
      const auto read = ParseSideFile(damaged, "f");
      EXPECT_TRUE(read.has_value() || !read.error().remedy.empty()) << damaged;
    }
  }
}

TEST(SideFile, FormatPutsAnEntryOnALineAndKeepsOrderAndUnicode) {
  const std::string text =
      "{\n"
      "  \"note\": \"M\\u00fc\\n\",\n"
      "  \"format\": \"hvas-assignments-2\",\n"
      "  \"removed\": [],\n"
      "  \"fits\": [\n"
      "    {\"shaft\": \"Welle Ø\", \"hole\": \"a\\\"b\", \"fit\": \"H7/g6\", \"diameter_mm\": "
      "6.0},\n"
      "    {\"mate\": \"m1\", \"friction\": 0.001}\n"
      "  ]\n"
      "}\n";
  const auto document = nlohmann::ordered_json::parse(text);
  std::string expected = text;
  expected.replace(expected.find("\\u00fc"), 6, "ü");
  EXPECT_EQ(FormatSideFile(document), expected);
  EXPECT_EQ(nlohmann::ordered_json::parse(FormatSideFile(document)), document);
}

TEST(SideFile, NearestWordIsAtMostAFewSlipsAway) {
  const std::vector<std::string> words{"hole", "shaft", "friction", "fit"};
  EXPECT_EQ(FindNearest("holes", words), "hole");
  EXPECT_EQ(FindNearest("friktion", words), "friction");
  EXPECT_EQ(FindNearest("fti", words), "fit");
  EXPECT_EQ(FindNearest("temperature", words), "");
  EXPECT_EQ(FindNearest("x", {}), "");
}

}  // namespace
}  // namespace hvas::mates
