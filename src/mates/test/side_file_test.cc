#include "mates/side_file.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/test/odd_files.h"
#include "base/test/temporary_folder.h"
#include "mates/located_json.h"
#include "product/names.h"

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

TEST(LocatedJson, NumbersBeyondAllAreNamedWithPathLineAndRemedy) {
  for (const char* number : {"1e999999", "-1e400", "1e309", "123456789e999"}) {
    const auto json = ParseLocatedJson(
        fmt::format("{{\"fits\": [\n{{}},\n{{\"friction\":\n {}}}]}}", number), "f");
    ASSERT_FALSE(json.has_value()) << number;
    EXPECT_EQ(json.error().where, "f:4");
    EXPECT_NE(json.error().message.find("/fits/1/friction"), std::string::npos);
    EXPECT_NE(json.error().message.find(number), std::string::npos);
    EXPECT_FALSE(json.error().remedy.empty());
  }
  EXPECT_TRUE(ParseLocatedJson("[1e308, -1E-400, 99999999999999999999999, 0.0]", "f").has_value());
}

TEST(SideFile, EveryNumberIsCheckedForTypeAndRange) {
  // What each key may not be, in any object of the file.
  const std::vector<std::string> never{"1e999999", "-1e999999", "true", "null", "\"1\"",
                                       "[1]",      "{}",        "-1",   "1e30"};
  for (const SideFileObject object : {SideFileObject::kFit, SideFileObject::kSide}) {
    for (const SideFileKey& key : KeysOf(object)) {
      if (key.type != SideFileType::kNumber && key.type != SideFileType::kIndex &&
          key.type != SideFileType::kDiameters) {
        continue;
      }
      std::vector<std::string> wrong = never;
      if (key.type == SideFileType::kDiameters) {
        wrong.insert(wrong.end(),
                     {"[]", "[[0]]", "[[0, 0]]", "[[0, -1]]", "[[-1, 40]]", "[[0, 40, 1]]",
                      "[[0, \"40\"]]", "[[5, 40], [5, 40]]", "[[5, 40], [4, 40]]", "[[0, 40], 41]",
                      "[[0, 1e30]]", "[[1e30, 40]]"});
      }
      if (key.type == SideFileType::kIndex) {
        wrong.insert(wrong.end(), {"1.5", "4294967295", "18446744073709551615",
                                   "99999999999999999999", "-9223372036854775808"});
      }
      if (key.is_low_excluded) {
        wrong.emplace_back("0");
      }
      for (const std::string& value : wrong) {
        if (value == "-1" && key.low < -1) {
          continue;
        }
        const std::string pair = fmt::format("\"{}\": {}", key.name, value);
        const std::string text =
            object == SideFileObject::kFit
                ? fmt::format("{{\"format\": \"{}\", \"fits\": [\n{{\"mate\": \"m1\", {}}}]}}",
                              kSideFileFormat, pair)
                : fmt::format(
                      "{{\"format\": \"{}\", \"mates\": [\n{{\"a\": {{\"occurrence\": "
                      "\"x\", {}}}, \"b\": {{\"occurrence\": \"y\", \"face\": 1}}}}]}}",
                      kSideFileFormat, pair);
        const auto read = ParseSideFile(text, "x.hvas.json");
        ASSERT_FALSE(read.has_value()) << pair;
        EXPECT_EQ(read.error().where.find("x.hvas.json:2"), 0U) << read.error().ToString();
        EXPECT_NE(read.error().message.find(key.name), std::string::npos);
        EXPECT_FALSE(read.error().remedy.empty()) << pair;
      }
    }
  }
}

TEST(SideFile, EveryKindOfMateIsReadByItsName) {
  for (const product::MateKind kind : product::kMateKinds) {
    const auto read = ParseSideFile(
        fmt::format(R"({{"format": "{}", "mates": [{{"kind": "{}", "a": {{"occurrence": "x", )"
                    R"("face": 1}}, "b": {{"occurrence": "y", "face": 2}}}}]}})",
                    kSideFileFormat, ToString(kind)),
        "x.hvas.json");
    ASSERT_TRUE(read.has_value()) << read.error().ToString();
    EXPECT_EQ(read->added.at(0).kind, kind);
  }
}

TEST(SideFile, WhatIsNoFileIsRefusedByItsKind) {
  const hvas::testing::TemporaryFolder folder;
  for (const auto& odd : hvas::testing::MakeOddFiles(folder.path(), "x.hvas.json")) {
    const auto read = ReadSideFile(odd.path);
    ASSERT_FALSE(read.has_value()) << odd.kind;
    EXPECT_EQ(read.error().where, odd.path.string());
    EXPECT_NE(read.error().message.find(odd.kind), std::string::npos) << read.error().ToString();
  }
}

TEST(SideFile, LongWordIsComparedWithNothing) {
  const std::string word(1'000'000, 'x');
  EXPECT_EQ(FindNearest(word, std::vector<std::string>(10'000, std::string(100, 'x'))), "");
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
