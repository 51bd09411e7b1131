#include "study/analysis.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "study/analysis_page.h"
#include "study/figures.h"

namespace hvas::study {
namespace {

/** Right answers of 15 participants among 15 trials of each fit: paper W, table 2. */
Table PaperTable() {
  constexpr int kCounts[15][3] = {{14, 11, 13}, {12, 14, 9},  {12, 13, 13}, {15, 12, 12},
                                  {14, 13, 9},  {15, 14, 12}, {12, 9, 13},  {14, 10, 13},
                                  {15, 13, 10}, {14, 10, 13}, {14, 11, 12}, {14, 14, 10},
                                  {12, 10, 14}, {15, 14, 10}, {13, 13, 11}};
  Table table{"right answers", "", {"B1", "B2", "B3"}, {}};
  int id = 0;
  for (const auto& counts : kCounts) {
    Row row{std::to_string(++id), {}};
    for (const int count : counts) {
      row.values.emplace_back(count);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

AnalysisOptions OptionsOfPaper() {
  AnalysisOptions options;
  options.of = 15;
  return options;
}

TEST(Analysis, W11OfPaperWsTableSaysWhatThePaperSays) {
  const auto analysis = Analyse(PaperTable(), OptionsOfPaper());
  ASSERT_TRUE(analysis);
  EXPECT_NEAR(*analysis->friedman->p, 0.0128149, 5e-8);
  ASSERT_EQ(analysis->pairs.size(), 3u);
  EXPECT_NEAR(*analysis->pairs[0].wilcoxon.p, 0.0091679, 5e-8);
  EXPECT_NEAR(analysis->bonferroni_level, 0.05 / 3, 1e-15);
  EXPECT_TRUE(analysis->pairs[0].is_different);
  EXPECT_TRUE(analysis->pairs[1].is_different);
  EXPECT_FALSE(analysis->pairs[2].is_different);
  EXPECT_EQ(analysis->conditions[0].share->right, 205);
  EXPECT_EQ(analysis->conditions[1].share->right, 181);
  EXPECT_EQ(analysis->conditions[2].share->right, 174);
  EXPECT_DOUBLE_EQ(analysis->chance, 1.0 / 3);
  // Twice 0.0091679 is below Holm's p of the smaller one, and so takes that.
  EXPECT_NEAR(analysis->pairs[0].holm_p, 3 * 0.0072138, 2e-7);
  EXPECT_NEAR(analysis->pairs[1].holm_p, 3 * 0.0072138, 2e-7);
  EXPECT_NEAR(analysis->pairs[0].bonferroni_p, 3 * 0.0091679, 2e-7);
}

TEST(Analysis, DirectionChangesWordsOnly) {
  AnalysisOptions options = OptionsOfPaper();
  const auto plain = Analyse(PaperTable(), options);
  EXPECT_EQ(DescribePair(*plain, plain->pairs[0]), "B1 higher");
  EXPECT_EQ(DescribePair(*plain, plain->pairs[2]), "not shown");
  options.direction = Direction::kHigherIsBetter;
  const auto higher = Analyse(PaperTable(), options);
  EXPECT_EQ(DescribePair(*higher, higher->pairs[0]), "B1 better");
  options.direction = Direction::kLowerIsBetter;
  const auto lower = Analyse(PaperTable(), options);
  EXPECT_EQ(DescribePair(*lower, lower->pairs[0]), "B2 better");
  EXPECT_EQ(lower->pairs[0].wilcoxon.p, plain->pairs[0].wilcoxon.p);
}

TEST(Analysis, LeavesOutMissingCellsWhereTheyAreMissing) {
  Table table = PaperTable();
  table.rows[4].values[2].reset();
  const auto analysis = Analyse(table, OptionsOfPaper());
  ASSERT_TRUE(analysis);
  EXPECT_EQ(analysis->complete_rows, 14u);
  EXPECT_EQ(analysis->friedman->row_count, 14u);
  EXPECT_EQ(analysis->pairs[0].difference.summary.n, 15u);
  EXPECT_EQ(analysis->pairs[1].difference.summary.n, 14u);
  EXPECT_EQ(analysis->conditions[2].summary.n, 14u);
  EXPECT_EQ(analysis->conditions[2].share->trials, 14 * 15);
  ASSERT_EQ(analysis->notes.size(), 1u);
  EXPECT_NE(analysis->notes[0].find("1 of 15"), std::string::npos);
}

TEST(Analysis, SaysWhatIsNotDefined) {
  Table table{"score", "", {"A", "B", "C"}, {}};
  for (const char* id : {"1", "2", "3"}) {
    table.rows.push_back({id, {5.0, 5.0, 5.0}});
  }
  const auto analysis = Analyse(table, {});
  ASSERT_TRUE(analysis);
  EXPECT_FALSE(analysis->friedman->p);
  EXPECT_EQ(analysis->notes.size(), 4u);  // Friedman, and three pairs.
  for (const PairResult& pair : analysis->pairs) {
    EXPECT_FALSE(pair.is_different || pair.d_z);
  }
  const std::string html = MakeAnalysisHtml(*analysis);
  EXPECT_EQ(html.find(">nan"), std::string::npos);
  EXPECT_NE(html.find("not defined"), std::string::npos);
}

TEST(Analysis, OfTwoConditionsHasNoFriedman) {
  const Table table{"time", "s", {"A", "B"}, {{"1", {1.0, 2.0}}, {"2", {2.0, 2.5}}}};
  const auto analysis = Analyse(table, {});
  ASSERT_TRUE(analysis);
  EXPECT_FALSE(analysis->friedman);
  EXPECT_EQ(analysis->pairs.size(), 1u);
  EXPECT_TRUE(DescribeFriedman(*analysis).empty());
}

TEST(Analysis, RefusesTablesThatCannotBeComparedAndNamesTheCell) {
  const auto refusal = [](const Table& table, const AnalysisOptions& options) {
    const auto analysis = Analyse(table, options);
    return analysis ? std::string() : analysis.error().ToString();
  };
  Table table = PaperTable();
  table.rows[3].values[1] = 16;
  EXPECT_NE(refusal(table, OptionsOfPaper()).find("participant 4, condition B2"),
            std::string::npos);
  table.rows[3].values[1] = std::nan("");
  EXPECT_NE(refusal(table, {}).find("participant 4, condition B2"), std::string::npos);
  table = PaperTable();
  table.rows[1].participant = "1";
  EXPECT_NE(refusal(table, {}).find("twice"), std::string::npos);
  table = PaperTable();
  table.conditions[1] = "B1";
  EXPECT_NE(refusal(table, {}).find("same name"), std::string::npos);
  table = PaperTable();
  table.rows[0].values.pop_back();
  EXPECT_FALSE(refusal(table, {}).empty());
  EXPECT_FALSE(refusal({"t", "s", {"A"}, {{"1", {1.0}}, {"2", {1.0}}}}, {}).empty());
  EXPECT_FALSE(refusal({"t", "s", {"A", "B"}, {{"1", {1.0, 2.0}}}}, {}).empty());
  EXPECT_FALSE(refusal({"t", "s", {"A", "B"}, {{"1", {1.0, {}}}, {"2", {2.0, {}}}}}, {}).empty());
  EXPECT_FALSE(refusal({"t", "s", {"A", "B"}, {{"1", {1.0, {}}}, {"2", {{}, 2.0}}}}, {}).empty());
  AnalysisOptions options;
  options.chance = 0.3;
  EXPECT_NE(refusal(PaperTable(), options).find("trials"), std::string::npos);
  options = {};
  options.alpha = 0.7;
  EXPECT_FALSE(refusal(PaperTable(), options).empty());
}

TEST(Trials, AreSummarisedInTheOrderInWhichTheyCome) {
  const std::vector<Trial> trials{{"b", "late", 4},  {"b", "late", 6},  {"b", "late", 20},
                                  {"a", "early", 1}, {"b", "early", 3}, {"a", "early", 2}};
  const Table mean = MakeTable(trials, TrialSummary::kMean, "time", "s");
  EXPECT_EQ(mean.conditions, (std::vector<std::string>{"late", "early"}));
  EXPECT_EQ(mean.rows[0].participant, "b");
  EXPECT_EQ(mean.rows[0].values[0], 10);
  EXPECT_EQ(mean.rows[1].values[1], 1.5);
  EXPECT_FALSE(mean.rows[1].values[0]);
  EXPECT_EQ(MakeTable(trials, TrialSummary::kMedian, "time", "s").rows[0].values[0], 6);
}

TEST(Identification, CountsWhatWasTakenForWhat) {
  const std::vector<IdentificationAnswer> answers{{"1", "g6", "g6"},
                                                  {"1", "p6", "p6"},
                                                  {"1", "p6", "g6"},
                                                  {"2", "g6", "g6"},
                                                  {"2", "p6", "none"}};
  const auto result = AnalyseIdentification(answers);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->names, (std::vector<std::string>{"g6", "p6", "none"}));
  EXPECT_EQ(result->confusion.counts[1], (std::vector<std::int64_t>{1, 1, 1}));
  EXPECT_EQ(result->participant_count, 2u);
  EXPECT_DOUBLE_EQ(*result->chance, 0.5);
  EXPECT_FALSE(result->confusion.recall[2]);
  EXPECT_NE(MakeIdentificationHtml(*result).find("p6 taken for none: 1"), std::string::npos);
  EXPECT_FALSE(AnalyseIdentification({}));
}

TEST(Page, HasFiguresWithWordsAndIdsOfItsOwnAndIsTheSameEveryTime) {
  Table table = PaperTable();
  table.conditions[0] = "B1 <&>";
  const auto analysis = Analyse(table, OptionsOfPaper());
  const std::string html = MakeAnalysisHtml(*analysis, "x");
  for (const char* what :
       {"<section id=\"x\">", "x-boxesp0", "x-meansp0", "x-pairsp0", "<desc>", "role=\"img\"",
        "B1 &lt;&amp;&gt;", "prefers-color-scheme:dark", "by guessing: 33.3 %", "0.0128"}) {
    EXPECT_NE(html.find(what), std::string::npos) << what;
  }
  for (const char* what : {"B1 <", "nan", "<script", "http://", "<body"}) {
    const std::size_t at = html.find(what);
    EXPECT_TRUE(at == std::string::npos || html.compare(at, 17, "http://www.w3.org") == 0) << what;
  }
  EXPECT_EQ(html, MakeAnalysisHtml(*Analyse(table, OptionsOfPaper()), "x"));
}

TEST(FormatP, IsShortAndNeverZero) {
  EXPECT_EQ(FormatP(0.0128149), "0.0128");
  EXPECT_EQ(FormatP(0.0091679), "0.00917");
  EXPECT_EQ(FormatP(1e-9), "< 0.0001");
  EXPECT_EQ(FormatP(0), "< 0.0001");
}

}  // namespace
}  // namespace hvas::study
