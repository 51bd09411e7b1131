// The rig of paper W, shaft and bushing, with the fits of its experiments B1 to B3.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "app/product/load_product.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "fits/iso286.h"
#include "haptics/haptic_tick.h"
#include "record/reader.h"
#include "sequence/fit_of_mate.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using record::TickRecord;
using testing::ExpectAllSeated;
using testing::ProductFile;
using testing::RunHvasJson;

constexpr std::uint32_t kShaft = 2;   // its occurrence in bushing.step
constexpr double kDeviceForce = 7.9;  // [N]: that of a simulated person's device.
constexpr auto kMating = static_cast<std::uint8_t>(haptics::HoldState::kMating);

/** Assembles the rig of W7 with a fit of its shaft. */
json AssembleBushing(const std::string& fit, int seed, const std::string& record = {},
                     const std::string& force_map = "published") {
  std::vector<std::string> arguments{
      "assemble",           ProductFile("bushing"), "--fit",   "shaft=" + fit, "--seed",
      std::to_string(seed), "--force-map",          force_map, "--operator",   "person"};
  if (!record.empty()) {
    arguments.insert(arguments.end(), {"--record", record});
  }
  return RunHvasJson(arguments);
}

LoadOptions BushingOptions(std::vector<std::string> fits) {
  LoadOptions options;
  options.file = ProductFile("bushing");
  options.fits = std::move(fits);
  options.is_quiet = true;
  return options;
}

/** The fit that a run of the rig draws for the shaft in the bushing. */
std::shared_ptr<const fits::FitForce> DrawnFit(const std::string& fit, int seed) {
  Diagnostics diagnostics;
  const auto product = LoadProduct(BushingOptions({"shaft=" + fit}), &diagnostics);
  for (const product::Mate& mate : product->mates) {
    if (mate.kind == product::MateKind::kAxisHole && mate.b.occurrence.value() == kShaft) {
      return sequence::MakeFitForce(*product, mate, static_cast<std::uint64_t>(seed),
                                    fits::PairChoice::kOfKind, &diagnostics);
    }
  }
  return nullptr;
}

/** A record's shaft on its way in. */
struct Insertion {
  struct Point {
    double depth;  // [m]
    double axial;  // against the way in, weight left out, true [N]
    double felt;   // the same of what the hand got, weight included [N]
  };

  std::vector<Point> points;  // where the depth grows
  double largest_jump{0};     // of the felt force in a millisecond [N]
  double deepest{0};          // [m]
};

Insertion ReadInsertion(const std::filesystem::path& file) {
  constexpr double kSlowest = 2e-6;  // [m] in a tick, to count as sliding
  Insertion insertion;
  auto reader = record::Reader::Open(file);
  EXPECT_TRUE(reader.has_value());
  static const auto product = [] {
    Diagnostics diagnostics;
    return *LoadProduct(BushingOptions({}), &diagnostics);
  }();
  const double weight = product.part_of(product::OccurrenceId(kShaft)).mass.mass * 9.81;
  Vec3 last_force = Vec3::Zero();
  std::int64_t last_ns = -1;
  double last_depth = 0;
  const auto visited = reader->ForEachTick({}, [&](const TickRecord& tick) {
    EXPECT_TRUE(last_ns < 0 || tick.t_ns == last_ns + 1'000'000);
    last_ns = tick.t_ns;
    insertion.largest_jump =
        std::max(insertion.largest_jump, (tick.F_felt_W.f - last_force).norm());
    last_force = tick.F_felt_W.f;
    insertion.deepest = std::max(insertion.deepest, -tick.deepest);
    if (tick.held == kShaft && tick.state == kMating) {
      if (tick.depth > last_depth + kSlowest) {
        // The shaft goes down: what resists points up.
        insertion.points.push_back({tick.depth, tick.F_true_W.f.z() + weight, tick.F_felt_W.f.z()});
      }
      last_depth = std::max(last_depth, tick.depth);
    }
    return true;
  });
  EXPECT_TRUE(visited.has_value());
  return insertion;
}

/** Mean axial force in each millimetre of depth between 1 and 46 mm. */
std::vector<double> CalcProfile(const Insertion& insertion,
                                double Insertion::Point::*force = &Insertion::Point::axial) {
  std::vector<double> sums(45, 0.0);
  std::vector<int> counts(45, 0);
  for (const Insertion::Point& point : insertion.points) {
    const int bin = static_cast<int>(std::floor(point.depth * 1e3)) - 1;
    if (bin >= 0 && bin < 45) {
      sums[static_cast<std::size_t>(bin)] += point.*force;
      ++counts[static_cast<std::size_t>(bin)];
    }
  }
  for (std::size_t i = 0; i < 45; ++i) {
    EXPECT_GT(counts[i], 0) << "no sliding at " << i + 1 << " mm";
    sums[i] /= std::max(1, counts[i]);
  }
  return sums;
}

class BushingTest : public ::testing::TestWithParam<const char*> {};

TEST_P(BushingTest, W7EveryPartGoesInExactlyWithoutAJumpOfForce) {
  const TemporaryFolder folder;
  const std::string file = (folder / "session.hvasrec").string();
  const json run = AssembleBushing(GetParam(), 1, file);
  ExpectAllSeated(run, 3, kDeviceForce);
  const Insertion insertion = ReadInsertion(file);
  EXPECT_LE(insertion.largest_jump, 0.5);
  EXPECT_LE(insertion.deepest, 50e-6);
  // The record is whole and is what the digest says.
  auto reader = record::Reader::Open(file);
  ASSERT_TRUE(reader.has_value());
  EXPECT_TRUE(reader->is_complete());
  const auto digest = reader->Verify();
  ASSERT_TRUE(digest.has_value()) << digest.error().ToString();
  EXPECT_EQ(*digest, run["digest"]);
  EXPECT_EQ(reader->tick_count(), run["ticks"]);
  EXPECT_EQ(reader->meta().at("seed"), "1");
  EXPECT_EQ(reader->meta().at("condition"), "hybrid");
  EXPECT_EQ(json::parse(reader->meta().at("model_json")).size(), 3u);
}

TEST_P(BushingTest, EqualSeedsGiveEqualDigestsAndOthersDoNot) {
  const TemporaryFolder folder;
  const json first = AssembleBushing(GetParam(), 5);
  // With or without a file, the digest is that of the session.
  const json second = AssembleBushing(GetParam(), 5, (folder / "session").string());
  const json other = AssembleBushing(GetParam(), 6);
  EXPECT_EQ(first["digest"], second["digest"]);
  EXPECT_EQ(first["parts"], second["parts"]);
  EXPECT_NE(first["digest"], other["digest"]);
}

INSTANTIATE_TEST_SUITE_P(Fits, BushingTest, ::testing::Values("H7/g6", "H7/k6", "H7/p6"),
                         [](const auto& instance) {
                           return std::string(instance.param).substr(3);
                         });

TEST(FitForceTest, W10ClearanceFitIsSmallAndSteady) {  // 0..0.3 N
  const TemporaryFolder folder;
  const auto file = folder / "session";
  (void)AssembleBushing("H7/g6", 1, file.string());
  const std::vector<double> profile = CalcProfile(ReadInsertion(file));
  // From a depth on where the hand's own speed has settled. True newtons.
  const auto [least, most] = std::minmax_element(profile.begin() + 14, profile.end());
  EXPECT_LT(std::max(std::abs(*least), std::abs(*most)), 1.0);
  EXPECT_LT(*most - *least, 0.6);
}

TEST(FitForceTest, W10InterferenceFitGrowsSmoothlyWithDepth) {  // W(9)
  const TemporaryFolder folder;
  const auto file = folder / "session";
  const json run = AssembleBushing("H7/p6", 1, file.string());
  const Insertion insertion = ReadInsertion(file);
  const std::vector<double> profile = CalcProfile(insertion);
  const double rise = (profile.back() - profile.front()) / 44;
  EXPECT_GT(rise, 50);  // [N/mm]
  for (std::size_t i = 1; i < profile.size(); ++i) {
    EXPECT_GT(profile[i] - profile[i - 1], 0.2 * rise) << i << " mm: a step of a stair";
    EXPECT_LT(profile[i] - profile[i - 1], 3 * rise) << i << " mm: a jump";
  }
  // The force is that of the sizes which the seed draws, at every depth (W(9)).
  const auto fit = DrawnFit("H7/p6", 1);
  for (const Insertion::Point& point : insertion.points) {
    if (point.depth > 2e-3) {
      const double expected = fit->CalcAxialResistance(point.depth);
      EXPECT_NEAR(point.axial, expected, 0.05 * expected + 20) << point.depth;
    }
  }
  // And those lie in the zones of ISO 286: W(6) with the largest interference and every roughness
  // peak inwards is an upper bound, and the mean of the drawn interference gives the order.
  const auto limits = fits::CalcFitLimits(*fits::ParseFit("H7/p6"), 40e-3);
  ASSERT_TRUE(limits.has_value());
  const auto force = [&](double interference) {  // diametral [m]
    const double wall = 1 - 0.5 * 0.5;           // c_0 = 20 mm / 40 mm
    return 0.15 * std::numbers::pi * 210e9 * wall * 0.5 * interference * fit->length();
  };
  const double peak = run["parts"][2]["peak_true_n"];
  EXPECT_LT(peak, force(-limits->min_clearance + 6.3e-6));
  EXPECT_GT(peak, force(std::max(0.0, -limits->max_clearance - 6.3e-6)));
  EXPECT_NEAR(peak, fit->max_resistance(), 0.05 * fit->max_resistance());
  // In the hand it stays within what the device can show, and grows as well.
  const double felt_rise = insertion.points.back().felt - insertion.points.front().felt;
  EXPECT_GT(felt_rise, 2);
  EXPECT_LT(felt_rise, 7.9);
}

/** What a hand can tell of a fit. */
enum class Feel { kNothing, kStairs, kSlope };

/** Mean felt force in each millimetre of depth, from the first in which the shaft slides. */
std::vector<double> CalcFeltProfile(const Insertion& insertion) {
  std::vector<double> sums, counts;
  for (const Insertion::Point& point : insertion.points) {
    const auto bin = static_cast<std::size_t>(std::floor(point.depth * 1e3));
    sums.resize(std::max(sums.size(), bin + 1), 0.0);
    counts.resize(sums.size(), 0.0);
    sums[bin] += point.felt;
    counts[bin] += 1;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] /= std::max(1.0, counts[i]);
  }
  return sums;
}

/** A classifier that knows the felt force over depth and nothing else. The published map is about
 logarithmic, so a force that grows in proportion to depth is felt as a straight line over the
 logarithm of the depth; where the felt force rises much less than that, there is a plateau. */
Feel Classify(const Insertion& insertion) {
  constexpr std::size_t kFirst = 4;       // [mm] behind the chamfer and the grip's first slip
  constexpr std::size_t kWindow = 3;      // [mm]
  constexpr double kLeastRise = 0.3;      // [N] between nothing and a fit that is felt
  constexpr double kFlat = 0.25;          // of the mean rise: less is a plateau
  constexpr double kLeastPlateaus = 0.1;  // of the length
  const std::vector<double> felt = CalcFeltProfile(insertion);
  const std::size_t last = std::min<std::size_t>(felt.size() - 1, 45);
  const auto [least, most] = std::minmax_element(felt.begin() + kFirst, felt.begin() + 46);
  if (*most - *least < kLeastRise) {
    return Feel::kNothing;
  }
  const auto slope = [&](std::size_t from, std::size_t to) {
    return (felt[to] - felt[from]) /
           std::log((static_cast<double>(to) + 0.5) / (static_cast<double>(from) + 0.5));
  };
  const double mean = slope(kFirst, last);
  int flat = 0;
  int all = 0;
  for (std::size_t x = kFirst; x + kWindow <= last; ++x, ++all) {
    flat += slope(x, x + kWindow) < kFlat * mean ? 1 : 0;
  }
  return flat > kLeastPlateaus * all ? Feel::kStairs : Feel::kSlope;
}

// W6, W10, W12: each seed draws its pair; all runs of the seeds 1 to `last_seed` feel as their kind
// of fit.
void ExpectThreeKindsOfCurve(int last_seed) {
  const TemporaryFolder folder;
  const auto file = folder / "session";
  for (const auto& [fit, feel] :
       {std::pair{"H7/g6", Feel::kNothing}, {"H7/k6", Feel::kStairs}, {"H7/p6", Feel::kSlope}}) {
    for (int seed = 1; seed <= last_seed; ++seed) {
      std::filesystem::remove(file);
      ExpectAllSeated(AssembleBushing(fit, seed, file.string()), 3, kDeviceForce);
      EXPECT_EQ(Classify(ReadInsertion(file)), feel) << fit << ", seed " << seed;
    }
  }
}

TEST(FitForceTest, W6ThreeKindsOfFitAreThreeKindsOfCurve) {
  ExpectThreeKindsOfCurve(2);
}

TEST(FitForceReleaseTest, W6ThreeKindsOfFitAreThreeKindsOfCurveForTwentySeeds) {
  ExpectThreeKindsOfCurve(20);
}

/** Plateaus of the true force between two of its rises: where it grows by less than a hundredth of
 the whole in each of two or more millimetres. */
int CountPlateaus(const std::vector<double>& profile) {
  const double total = profile.back() - profile.front();
  int plateaus = 0;
  int level = 0;
  bool has_risen = false;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const double rise = profile[i] - profile[i - 1];
    if (rise < 0.01 * total) {
      ++level;
      continue;
    }
    plateaus += has_risen && level >= 2 ? 1 : 0;
    has_risen = true;
    level = 0;
  }
  return plateaus;
}

TEST(FitForceReleaseTest, W6TransitionFitRisesInStairsForTwentySeeds) {
  const TemporaryFolder folder;
  const auto file = folder / "session";
  int plateaus = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const auto fit = DrawnFit("H7/k6", seed);
    ASSERT_NE(fit, nullptr);
    EXPECT_TRUE(fits::ShowsKind(fit->clearances(), fits::FitKind::kTransition)) << seed;
    std::filesystem::remove(file);
    (void)AssembleBushing("H7/k6", seed, file.string());
    const std::vector<double> profile = CalcProfile(ReadInsertion(file));
    plateaus += CountPlateaus(profile);
    EXPECT_GE(CountPlateaus(profile), 1) << seed;
    const double total = profile.back() - profile.front();
    for (std::size_t i = 1; i < profile.size(); ++i) {
      // A fit never pulls (W(9)).
      EXPECT_GT(profile[i] - profile[i - 1], -0.02 * total) << seed << ", " << i << " mm";
    }
  }
  RecordProperty("plateaus_of_20_runs", plateaus);
}

// Paper W, Fig. 8: with the paper's factors the hand gets the paper's curves: the range of g6, the
// slope of p6, the stairs of k6.
TEST(FitForceTest, W10WithThePapersMapTheHandGetsTheCurvesOfFigure8) {
  const TemporaryFolder folder;
  const auto felt_with = [&](const char* fit) {
    const auto file = folder / "session";
    std::filesystem::remove(file);
    ExpectAllSeated(AssembleBushing(fit, 1, file.string(), "paper"), 3, kDeviceForce);
    return CalcProfile(ReadInsertion(file), &Insertion::Point::felt);
  };
  const std::vector<double> clearance = felt_with("H7/g6");
  const auto [least, most] = std::minmax_element(clearance.begin() + 14, clearance.end());
  EXPECT_LE(*most - *least, 0.3);  // [N]; the paper's range
  // The arm's own motion is felt as well, over less than a window.
  const auto count_flat = [](const std::vector<double>& felt) {
    constexpr std::size_t kWindow = 5;  // [mm]
    constexpr double kFlat = 0.4;       // of the mean rise: less is a plateau
    const double rise = (felt.back() - felt.front()) / static_cast<double>(felt.size() - 1);
    int flat = 0;
    for (std::size_t i = 0; i + kWindow < felt.size(); ++i) {
      flat += felt[i + kWindow] - felt[i] < kFlat * rise * kWindow ? 1 : 0;
    }
    return rise > 0.05 ? flat : -1;
  };
  EXPECT_EQ(count_flat(felt_with("H7/p6")), 0);
  EXPECT_GE(count_flat(felt_with("H7/k6")), 5);
}

}  // namespace
}  // namespace hvas::app
