// The order of trials: counterbalanced, and the same for the same seed (N9, W12).

#include "study/schedule.h"

#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace hvas::study {
namespace {

class Squares : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Squares, HaveEachInEachPlaceEquallyOften) {
  for (const bool is_balanced : {false, true}) {
    const auto rows = MakeSquare(GetParam(), is_balanced);
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> counts;
    for (const auto& row : rows) {
      EXPECT_EQ(std::set<std::size_t>(row.begin(), row.end()).size(), GetParam());
      for (std::size_t place = 0; place < row.size(); ++place) {
        ++counts[{place, row[place]}];
      }
    }
    ASSERT_EQ(counts.size(), GetParam() * GetParam());
    for (const auto& [where, count] : counts) {
      EXPECT_EQ(count, rows.size() / GetParam());
    }
  }
}

TEST_P(Squares, BalancedOnesHaveEachAfterEachEquallyOften) {
  const auto rows = MakeSquare(GetParam(), true);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> counts;
  for (const auto& row : rows) {
    for (std::size_t place = 1; place < row.size(); ++place) {
      ++counts[{row[place - 1], row[place]}];
    }
  }
  ASSERT_EQ(counts.size(), GetParam() * (GetParam() - 1));
  for (const auto& [pair, count] : counts) {
    EXPECT_EQ(count, rows.size() / GetParam()) << pair.first << " then " << pair.second;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Squares, ::testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 12));

Protocol Make(const std::string& block) {
  auto protocol = ParseProtocol(
      "format: hvas-study-1\nid: t\ntitle: T\nproduct: bushing\npart: shaft\nconsent: c\n"
      "conditions:\n"
      "  - {id: A, name: A, method: hybrid, fit: H7/g6}\n"
      "  - {id: B, name: B, method: hybrid, fit: H7/k6}\n"
      "  - {id: C, name: C, method: hybrid, fit: H7/p6}\n"
      "  - {id: D, name: D, method: hybrid, fit: H7/s6}\n"
      "blocks:\n  - {id: all, " +
          block + "}\n",
      "t.yaml");
  EXPECT_TRUE(protocol) << protocol.error().ToString();
  return *protocol;
}

std::string Print(const std::vector<PlannedTrial>& trials) {
  std::string text;
  for (const PlannedTrial& trial : trials) {
    text += fmt::format("{}{} ", "ABCD"[trial.condition], trial.repetition);
  }
  return text;
}

TEST(Schedule, ParticipantsOfOneSquareAreCounterbalanced) {
  const Protocol protocol = Make("repetitions: 3");
  std::map<std::pair<std::size_t, std::size_t>, int> places, pairs;
  for (int participant = 1; participant <= 4; ++participant) {
    const auto trials = MakeSchedule(protocol, participant, 7);
    ASSERT_EQ(trials.size(), 12U);
    for (std::size_t i = 0; i < trials.size(); i += 3) {
      EXPECT_EQ(trials[i].condition, trials[i + 2].condition);  // repetitions together
      EXPECT_EQ(trials[i + 2].repetition, 3);
      ++places[{i, trials[i].condition}];
      if (i > 0) {
        ++pairs[{trials[i - 1].condition, trials[i].condition}];
      }
    }
  }
  EXPECT_EQ(places.size(), 16U);
  EXPECT_EQ(pairs.size(), 12U);
}

TEST(Schedule, RepetitionsApartAreARoundEach) {
  const auto trials = MakeSchedule(Make("repetitions: 4, together: false"), 2, 7);
  for (std::size_t round = 0; round < 4; ++round) {
    std::set<std::size_t> conditions;
    for (std::size_t i = 0; i < 4; ++i) {
      conditions.insert(trials[4 * round + i].condition);
      EXPECT_EQ(trials[4 * round + i].repetition, static_cast<int>(round) + 1);
    }
    EXPECT_EQ(conditions.size(), 4U);
  }
}

TEST(Schedule, W12IdentificationShowsEachEquallyOftenInAnOrderOfOnesOwn) {
  const Protocol protocol = Make("repetitions: 15, identification: true, question: Which");
  std::set<std::string> orders;
  for (int participant = 1; participant <= 20; ++participant) {
    const auto trials = MakeSchedule(protocol, participant, 1);
    std::map<std::size_t, int> counts;
    for (const PlannedTrial& trial : trials) {
      ++counts[trial.condition];
    }
    EXPECT_EQ(counts, (std::map<std::size_t, int>{{0, 15}, {1, 15}, {2, 15}, {3, 15}}));
    orders.insert(Print(trials));
  }
  EXPECT_EQ(orders.size(), 20U);
}

TEST(Schedule, RepeatsForTheSameSeedAndDiffersForAnother) {
  for (const char* block : {"repetitions: 2", "repetitions: 2, order: random",
                            "repetitions: 3, identification: true, question: Q"}) {
    const Protocol protocol = Make(block);
    EXPECT_EQ(Print(MakeSchedule(protocol, 3, 5)), Print(MakeSchedule(protocol, 3, 5)));
    std::set<std::string> orders;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      orders.insert(Print(MakeSchedule(protocol, 3, seed)));
    }
    EXPECT_GT(orders.size(), 4U) << block;
  }
}

TEST(Schedule, FirstPlaceIsEachConditionsEquallyOftenInRandomOrders) {
  const Protocol protocol = Make("order: random");
  std::array<int, 4> first{};
  for (int participant = 1; participant <= 400; ++participant) {
    ++first.at(MakeSchedule(protocol, participant, 11)[0].condition);
  }
  for (const int count : first) {
    EXPECT_NEAR(count, 100, 35);  // four standard deviations of the binomial
  }
}

TEST(ParticipantIds, AreNumbersAndNotNames) {
  EXPECT_EQ(FormatParticipantId(3), "P03");
  EXPECT_EQ(*ParseParticipantId("P03"), 3);
  EXPECT_EQ(*ParseParticipantId("P120"), 120);
  for (const char* id :
       {"", "P", "P3", "P0", "P00", "P003", "Alice", "P03x", "p03", "../P03", "P1000", "P-1"}) {
    EXPECT_FALSE(ParseParticipantId(id)) << id;
  }
}

}  // namespace
}  // namespace hvas::study
