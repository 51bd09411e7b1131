// Blind identification by a simulated observer (W12, N4).

#include "study/identification.h"

#include <gtest/gtest.h>

namespace hvas::study {
namespace {

using fits::PairChoice;

ObserverResult Show(haptics::ForceMapKind map, PairChoice sizes, std::uint64_t seed = 1,
                    const Observer& observer = {}) {
  IdentificationOptions options;
  options.map = map;
  options.pairs = sizes;
  options.seed = seed;
  options.observer = observer;
  return *Identify(options);
}

double PaperShare(int fit) {
  return static_cast<double>(kPaperRight[static_cast<std::size_t>(fit)]) / kPaperTrials;
}

// N4, W12: with one map for all fits, and a hand no better than published, every fit is told more
// often than by the paper's people: of one pair as there, and of pairs drawn from the zones.
TEST(Identification, PublishedMapBeatsThePapersPeople) {
  for (const PairChoice sizes : {PairChoice::kOnePair, PairChoice::kOfKind}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const ObserverResult result = Show(haptics::ForceMapKind::kPublished, sizes, seed);
      for (int fit = 0; fit < kShownFits; ++fit) {
        const auto i = static_cast<std::size_t>(fit);
        EXPECT_GT(result.CalcShare(fit), PaperShare(fit)) << kShownFitNames[i] << " " << seed;
        RecordProperty(std::string(kShownFitNames[i]) + "_" +
                           std::to_string(static_cast<int>(sizes)) + "_" + std::to_string(seed),
                       std::to_string(result.CalcShare(fit)));
      }
    }
  }
}

// W10, W12: with the paper's factors the same observer tells transition fits worse, drawn ones
// much worse: a small force times a large factor feels like a large force times a small one.
TEST(Identification, PapersFactorsConfuseTransitionFits) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto share = [seed](haptics::ForceMapKind map, PairChoice sizes) {
      return Show(map, sizes, seed).CalcShare(2);
    };
    using haptics::ForceMapKind;
    EXPECT_GT(share(ForceMapKind::kPublished, PairChoice::kOnePair),
              share(ForceMapKind::kPaper, PairChoice::kOnePair) + 0.02);
    EXPECT_GT(share(ForceMapKind::kPublished, PairChoice::kOfKind),
              share(ForceMapKind::kPaper, PairChoice::kOfKind) + 0.1);
  }
}

// The two ends: who feels exactly tells one pair of each without fail, who feels nothing guesses.
TEST(Identification, ObserverIsBetweenPerfectAndBlind) {
  const ObserverResult sharp = Show(haptics::ForceMapKind::kPublished, PairChoice::kOnePair, 1,
                                    {.weber = 0.001, .threshold = 0.001, .looks = 10});
  const ObserverResult numb = Show(haptics::ForceMapKind::kPublished, PairChoice::kOnePair, 1,
                                   {.weber = 0.1, .threshold = 1e6, .looks = 10});
  double guessed = 0;
  for (int fit = 0; fit < kShownFits; ++fit) {
    EXPECT_GT(sharp.CalcShare(fit), 0.999);
    guessed += numb.CalcShare(fit) / kShownFits;
  }
  EXPECT_NEAR(guessed, 1.0 / kShownFits, 0.03);  // Standard error 0.0086.
}

TEST(Identification, RepeatsBySeedAndCountsEveryTrial) {
  const ObserverResult a = Show(haptics::ForceMapKind::kPublished, PairChoice::kAny, 7);
  const ObserverResult b = Show(haptics::ForceMapKind::kPublished, PairChoice::kAny, 7);
  const ObserverResult c = Show(haptics::ForceMapKind::kPublished, PairChoice::kAny, 8);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.mean_felt, b.mean_felt);
  EXPECT_NE(a.mean_felt, c.mean_felt);
  for (const auto& row : a.counts) {
    EXPECT_EQ(row[0] + row[1] + row[2], 1000);
  }
}

// Newcombe, Statistics in Medicine 17, 1998, table I, method 3.
TEST(Identification, IntervalsAreNewcombesPublishedOnes) {
  struct Interval {
    int right, trials;
    double low, high;
  };

  for (const Interval& row : {Interval{81, 263, 0.2553, 0.3662}, Interval{15, 148, 0.0624, 0.1605},
                              Interval{0, 20, 0, 0.1611}, Interval{1, 29, 0.0061, 0.1718}}) {
    const ShareInterval interval = CalcShareInterval(row.right, row.trials);
    EXPECT_NEAR(interval.low, row.low, 5e-5);
    EXPECT_NEAR(interval.high, row.high, 5e-5);
  }
}

TEST(Identification, RefusesWhatIsNoExperiment) {
  const auto fails = [](auto&& spoil) {
    IdentificationOptions options;
    spoil(&options);
    const auto result = Identify(options);
    return !result.has_value() && result.error().code == ErrorCode::kInvalid;
  };
  EXPECT_TRUE(fails([](IdentificationOptions* o) { o->trials = 0; }));
  EXPECT_TRUE(fails([](IdentificationOptions* o) { o->training = -1; }));
  EXPECT_TRUE(fails([](IdentificationOptions* o) { o->observer.looks = 1001; }));
  EXPECT_TRUE(fails([](IdentificationOptions* o) { o->observer.weber = 1; }));
  EXPECT_TRUE(fails([](IdentificationOptions* o) { o->observer.threshold = 0; }));
}

}  // namespace
}  // namespace hvas::study
