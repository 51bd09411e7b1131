// Protocols of studies (N9, X14, W8, W11, W12): what is read, and what is refused and where.

#include "study/protocol.h"

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.h"

namespace hvas::study {
namespace {

const std::string kHead =
    "format: hvas-study-1\n"
    "id: tiny\n"
    "title: Tiny\n"
    "product: bushing\n"
    "part: shaft\n"
    "consent: You may stop at any time.\n";
const std::string kConditions =
    "conditions:\n"
    "  - {id: A, name: First, method: collision_only}\n"
    "  - {id: B, name: Second, method: hybrid, fit: H7/g6}\n";
const std::string kBlocks =
    "blocks:\n"
    "  - {id: all, repetitions: 2}\n";

struct Refused {
  std::string name;
  std::string text;
  std::string where;    // Line and column.
  std::string message;  // Part of it.
};

class RefusedProtocol : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedProtocol, SaysWhereAndWhatToDo) {
  const auto protocol = ParseProtocol(GetParam().text, "tiny.yaml");
  ASSERT_FALSE(protocol);
  EXPECT_EQ(protocol.error().where, "tiny.yaml:" + GetParam().where) << protocol.error().message;
  EXPECT_NE(protocol.error().message.find(GetParam().message), std::string::npos)
      << protocol.error().message;
  EXPECT_FALSE(protocol.error().remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedProtocol,
    ::testing::Values(
        Refused{"UnknownKey", kHead + kConditions + kBlocks + "titel: x\n", "12:1", "\"titel\""},
        Refused{"WrongType", kHead + "participants: many\n" + kConditions + kBlocks, "7:15",
                "not a whole number"},
        Refused{"QuotedNumber", kHead + "participants: \"3\"\n" + kConditions + kBlocks, "7:15",
                "not a whole number"},
        Refused{"OutOfRange", kHead + "participants: 0\n" + kConditions + kBlocks, "7:15",
                "out of its range"},
        Refused{"NoFit",
                kHead + "conditions:\n  - {id: A, name: A, method: hybrid, fit: X9}\n" + kBlocks,
                "8:43", "not a fit"},
        Refused{"UnknownMethod",
                kHead + "conditions:\n  - id: A\n    name: A\n    method: magic\n" + kBlocks,
                "10:13", "\"magic\""},
        Refused{"PicksWithoutMates",
                kHead +
                    "conditions:\n  - {id: A, name: A, method: collision_only, constraints: "
                    "picked}\n" +
                    kBlocks,
                "8:59", "needs a hand and mates"},
        Refused{"MissingMethod", kHead + "conditions:\n  - id: A\n    name: A\n" + kBlocks, "8:5",
                "no \"method\""},
        Refused{"UnknownCondition",
                kHead + kConditions + "blocks:\n  - {id: all, conditions: [A, C]}\n", "11:27",
                "\"C\""},
        Refused{"SameIdTwice",
                kHead +
                    "conditions:\n  - {id: A, name: A, method: hybrid}\n"
                    "  - {id: A, name: B, method: hybrid}\n" +
                    kBlocks,
                "9:5", "twice"},
        Refused{"SameKeyTwice", kHead + kConditions + kBlocks + "title: Other\n", "12:1", "twice"},
        Refused{"NoYaml", kHead + "conditions: [\n", "8:1", "not valid YAML"},
        Refused{"EmptyScale",
                kHead + kConditions + kBlocks +
                    "questions:\n  - {id: q, kind: scale, text: Q, low: 5, high: 5}\n",
                "13:5", "from 5 to 5"},
        Refused{"OneChoice",
                kHead + kConditions + kBlocks +
                    "questions:\n  - id: q\n    kind: choice\n    text: Q\n    choices:\n"
                    "      - {id: a, text: A}\n",
                "17:7", "fewer than two"},
        Refused{"BlockThatIsNot",
                kHead + kConditions + kBlocks +
                    "questions:\n  - {id: q, kind: scale, text: Q, block: no}\n",
                "13:42", "\"no\""},
        Refused{"AnswersThatAreEqual",
                kHead + "conditions:\n  - {id: A, name: A, method: hybrid, fit: H7/g6}\n"
                        "  - {id: B, name: B, method: hybrid, fit: H7/g6}\n"
                        "blocks:\n  - {id: b, identification: true, question: Which}\n",
                "11:5", "another condition has it"},
        Refused{"NotBlind",
                kHead + "conditions:\n  - {id: A, name: A, method: hybrid, fit: H7/g6}\n"
                        "  - {id: B, name: B, method: hybrid, fit: H7/p6}\n"
                        "blocks:\n  - {id: b, identification: true, question: Which}\n"
                        "hidden: [time]\n",
                "12:9", "not be blind"},
        Refused{"TooManyTrials",
                kHead + kConditions +
                    "blocks:\n"
                    "  - {id: a, repetitions: 1000}\n  - {id: b, repetitions: 1000}\n"
                    "  - {id: c, repetitions: 1000}\n",
                "1:1", "6000 trials"}),
    [](const auto& refused) { return refused.param.name; });

TEST(Protocol, ReadsWhatIsThere) {
  const auto protocol = ParseProtocol(kHead + kConditions + kBlocks, "tiny.yaml");
  ASSERT_TRUE(protocol) << protocol.error().ToString();
  EXPECT_EQ(protocol->CountTrials(), 4);
  EXPECT_EQ(protocol->conditions[0].method, Method::kCollision);
  EXPECT_EQ(protocol->conditions[1].fit, "H7/g6");
  EXPECT_EQ(protocol->blocks[0].order, Order::kBalanced);
  EXPECT_EQ(protocol->consent.In("de"), "You may stop at any time.");  // where there is no German
  EXPECT_TRUE(protocol->hidden.condition);
}

TEST(Protocol, ReadsJsonAsYaml) {
  const std::string json = R"({"format": "hvas-study-1", "id": "tiny", "title": {"en": "Tiny"},
    "product": "bushing", "part": "shaft", "consent": "c",
    "conditions": [{"id": "A", "name": "A", "method": "hybrid", "time_limit_s": 12.5}],
    "blocks": [{"id": "all"}]})";
  const auto protocol = ParseProtocol(json, "tiny.json");
  ASSERT_TRUE(protocol) << protocol.error().ToString();
  EXPECT_DOUBLE_EQ(protocol->conditions[0].time_limit, 12.5);
}

Result<Protocol> ReadShipped(const std::string& name) {
  return ReadProtocol(HVAS_SOURCE_DIR "/data/studies/" + name);
}

TEST(ShippedProtocols, X14XiaHasThreeConditionsTenTimes) {  // X15
  const auto protocol = ReadShipped("xia-2011.yaml");
  ASSERT_TRUE(protocol) << protocol.error().ToString();
  ASSERT_EQ(protocol->conditions.size(), 3U);
  EXPECT_EQ(protocol->participants, 10);
  EXPECT_EQ(protocol->CountTrials(), 30);
  EXPECT_DOUBLE_EQ(protocol->mating_window, 3);
  EXPECT_DOUBLE_EQ(*protocol->FindCondition("collision")->published_mean, 29.8);
  EXPECT_DOUBLE_EQ(*protocol->FindCondition("constraint")->published_mean, 12.6);
  EXPECT_DOUBLE_EQ(*protocol->FindCondition("hybrid")->published_mean, 9.4);
}

TEST(ShippedProtocols, W7FitsHaveSixExperimentsAndBlindIdentification) {  // W8, W11, W12
  const auto protocol = ReadShipped("fit-2016.yaml");
  ASSERT_TRUE(protocol) << protocol.error().ToString();
  EXPECT_EQ(protocol->participants, 15);
  EXPECT_DOUBLE_EQ(protocol->training.duration, 1800);
  EXPECT_EQ(protocol->CountTrials(), 3 * 5 + 3 * 5 + 3 * 15);
  const Condition* a3 = protocol->FindCondition("A3");
  ASSERT_NE(a3, nullptr);
  EXPECT_FALSE(a3->renders_fits);
  EXPECT_NEAR(units::ToDeg(a3->capture.angle), 10, 1e-12);
  EXPECT_DOUBLE_EQ(a3->capture.axis_distance, 5e-3);
  EXPECT_DOUBLE_EQ(a3->capture.face_distance, 3e-3);
  EXPECT_DOUBLE_EQ(a3->coupling, 700);
  EXPECT_EQ(protocol->FindCondition("A1")->method, Method::kPicking);
  EXPECT_EQ(protocol->FindCondition("B2")->fit, "H7/p6");
  EXPECT_FALSE(protocol->FindCondition("B2")->published_mean);  // not printed
  int scales = 0;
  for (const Question& question : protocol->questions) {
    scales += question.kind == QuestionKind::kScale ? 1 : 0;
    EXPECT_FALSE(question.text.de.empty()) << question.id;
  }
  EXPECT_EQ(scales, 4);
}

TEST(ShippedProtocols, SampleOfTheDocumentationIsOne) {
  std::ifstream file(HVAS_SOURCE_DIR "/docs/studies.md");
  std::stringstream page;
  page << file.rdbuf();
  const std::string text = page.str();
  const std::string fence = "```yaml\n";
  const std::size_t from = text.find(fence) + fence.size();
  const auto protocol = ParseProtocol(text.substr(from, text.find("```", from) - from), "sample");
  ASSERT_TRUE(protocol) << protocol.error().ToString();
  EXPECT_EQ(protocol->CountTrials(), 2 * 5 + 2 * 15);
}

/** All names of properties in a schema. */
void CollectKeys(const nlohmann::json& schema, std::set<std::string>* keys) {
  if (schema.is_object() && schema.contains("properties")) {
    for (const auto& [key, value] : schema["properties"].items()) {
      keys->insert(key);
    }
  }
  for (const auto& inner : schema) {
    if (inner.is_structured()) {
      CollectKeys(inner, keys);
    }
  }
}

TEST(ProtocolSchema, HasTheKeysThatTheReaderAsksFor) {
  std::ifstream file(HVAS_SOURCE_DIR "/data/schemas/study.schema.json");
  std::set<std::string> in_schema;
  CollectKeys(nlohmann::json::parse(file), &in_schema);
  std::ifstream reader(HVAS_SOURCE_DIR "/src/study/protocol.cc");
  std::stringstream source;
  source << reader.rdbuf();
  for (const std::string& key : in_schema) {
    EXPECT_NE(source.str().find('"' + key + '"'), std::string::npos) << key << " is not read";
  }
  for (const char* key : {"format", "training", "fit_force", "published_mean_s", "together",
                          "low_text", "choices", "hidden", "mating_window_s", "face_distance_mm"}) {
    EXPECT_TRUE(in_schema.contains(key)) << key;
  }
}

}  // namespace
}  // namespace hvas::study
