#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <numbers>
#include <thread>

#include <gtest/gtest.h>

#include "app/product/load_product.h"
#include "app/test/run_hvas.h"
#include "base/test/await_true.h"
#include "base/test/temporary_folder.h"
#include "fits/iso286.h"
#include "haptics/haptic_tick.h"
#include "record/reader.h"
#include "simulation/fit_of_mate.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using record::TickRecord;
using testing::ProductFile;
using testing::RunHvasJson;

constexpr std::uint32_t kShaft = 2;  // its occurrence in bushing.step
constexpr auto kMating = static_cast<std::uint8_t>(haptics::HoldState::kMating);

/** Assembles the rig of W7 with a fit of its shaft. */
json AssembleBushing(const std::string& fit, int seed, const std::string& record = {}) {
  std::vector<std::string> arguments{"assemble", ProductFile("bushing"), "--fit", "shaft=" + fit,
                                     "--seed",   std::to_string(seed)};
  if (!record.empty()) {
    arguments.insert(arguments.end(), {"--record", record});
  }
  return RunHvasJson(arguments);
}

void ExpectAllSeated(const json& run, std::size_t count) {
  EXPECT_EQ(run["seated"], count);
  ASSERT_EQ(run["parts"].size(), count);
  for (const json& part : run["parts"]) {
    EXPECT_TRUE(part["seated"].get<bool>()) << part.dump(1);
    EXPECT_EQ(part["reason"], "");
    EXPECT_LT(part["pose_error_um"].get<double>(), 1) << part["name"];
    EXPECT_LT(part["pose_error_urad"].get<double>(), 1) << part["name"];
    EXPECT_LE(part["arrival_um"].get<double>(), 3000) << part["name"];
    EXPECT_EQ(part["arrival_um"].get<double>() > 0, part["time_s"].get<double>() > 0)
        << part["name"] << ": the hand brings nothing exactly to its place";
    EXPECT_LE(part["deepest_um"].get<double>(), 50) << part["name"];
    EXPECT_GE(part["peak_true_n"].get<double>(), 0);
    EXPECT_LE(part["peak_felt_n"].get<double>(), 7.9 + 1e-9) << part["name"];
  }
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
      return simulation::MakeFitForce(*product, mate, static_cast<std::uint64_t>(seed),
                                      &diagnostics);
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
  const auto product = [] {
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
std::vector<double> CalcProfile(const Insertion& insertion) {
  std::vector<double> sums(45, 0.0);
  std::vector<int> counts(45, 0);
  for (const Insertion::Point& point : insertion.points) {
    const int bin = static_cast<int>(std::floor(point.depth * 1e3)) - 1;
    if (bin >= 0 && bin < 45) {
      sums[static_cast<std::size_t>(bin)] += point.axial;
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

TEST_P(BushingTest, EveryPartGoesInExactlyWithoutAJumpOfForce) {  // W7
  const TemporaryFolder folder;
  const std::string file = (folder / "session.hvasrec").string();
  const json run = AssembleBushing(GetParam(), 1, file);
  ExpectAllSeated(run, 3);
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

TEST(FitForceTest, ClearanceFitIsSmallAndSteady) {  // W10: 0..0.3 N
  const TemporaryFolder folder;
  const auto file = folder / "session";
  (void)AssembleBushing("H7/g6", 1, file.string());
  const std::vector<double> profile = CalcProfile(ReadInsertion(file));
  // From a depth on where the hand's own speed has settled. True newtons.
  const auto [least, most] = std::minmax_element(profile.begin() + 14, profile.end());
  EXPECT_LT(std::max(std::abs(*least), std::abs(*most)), 1.0);
  EXPECT_LT(*most - *least, 0.6);
}

TEST(FitForceTest, InterferenceFitGrowsSmoothlyWithDepth) {  // W10, W(9)
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

TEST(FitForceTest, TransitionFitRisesInStairs) {  // W10
  // A seed that draws sizes between which the roughness makes contact here and there.
  constexpr int kSeed = 2;
  const auto fit = DrawnFit("H7/k6", kSeed);
  ASSERT_NE(fit, nullptr);
  ASSERT_GT(fit->max_resistance(), 100);
  ASSERT_GT(fit->mean_clearance(), 0) << "no stairs to be expected";
  const TemporaryFolder folder;
  const auto file = folder / "session";
  (void)AssembleBushing("H7/k6", kSeed, file.string());
  const std::vector<double> profile = CalcProfile(ReadInsertion(file));
  const double total = profile.back() - profile.front();
  EXPECT_GT(total, 100);
  // Level for 2 mm and more, then up by a tenth of the whole within 6 mm: count such stairs.
  int stairs = 0;
  int level = 0;
  double level_force = 0;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (std::abs(profile[i] - profile[i - 1]) < 0.01 * total) {
      ++level;
      level_force = profile[i];
    } else if (level >= 2) {
      const std::size_t ahead = std::min(profile.size() - 1, i + 5);
      stairs += profile[ahead] - level_force > 0.1 * total ? 1 : 0;
      level = 0;
    } else {
      level = 0;
    }
    // A fit never pulls (W(9)).
    EXPECT_GT(profile[i] - profile[i - 1], -0.02 * total) << i << " mm";
  }
  EXPECT_GE(stairs, 2);
}

TEST(AssembleTest, GearPumpGoesTogetherCompletely) {  // N10
  const json run = RunHvasJson({"assemble", ProductFile("gear_pump")});
  ExpectAllSeated(run, 38);
  EXPECT_GT(run["real_time_factor"].get<double>(), 0);
  EXPECT_EQ(run["source"], "gear_pump.step");
  EXPECT_EQ(run["digest"].get<std::string>().size(), 32u);
  EXPECT_NEAR(run["session_s"].get<double>(), 1e-3 * run["ticks"].get<double>(), 1e-6);
  const json& tick = run["tick_us"];
  EXPECT_LE(tick["median"], tick["p99"]);
  EXPECT_LE(tick["p99"], tick["p999"]);
  EXPECT_LE(tick["p999"], tick["max"]);
  // What the product itself says about its order.
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < run["parts"].size(); ++i) {
    const std::string path = run["parts"][i]["name"];
    place[path.substr(path.rfind('/') + 1)] = i;
  }
  ASSERT_EQ(place.size(), 38u);
  std::vector<std::pair<std::string, std::string>> before{{"housing", "drive gear shaft"},
                                                          {"bushing 1", "drive gear shaft"},
                                                          {"drive gear shaft", "cover"},
                                                          {"driven gear shaft", "cover"},
                                                          {"gasket", "cover"},
                                                          {"key", "coupling hub"},
                                                          {"oil seal", "coupling hub"},
                                                          {"coupling hub", "end disc"},
                                                          {"end disc", "end screw"},
                                                          {"port ring 1", "hose nipple 1"},
                                                          {"bleed ring", "bleed plug"}};
  for (int i = 1; i <= 8; ++i) {
    before.emplace_back("cover", "cover screw " + std::to_string(i));
    before.emplace_back("lock washer " + std::to_string(i), "cover screw " + std::to_string(i));
  }
  EXPECT_EQ(place.at("housing"), 0u);
  for (const auto& [first, then] : before) {
    EXPECT_LT(place.at(first), place.at(then)) << first << " after " << then;
  }
}

TEST(AssembleTest, OrderBeginsWithThePartsThatAreAskedFor) {
  const json run = RunHvasJson(
      {"assemble", ProductFile("gear_pump"), "--order", "driven gear shaft", "--limit", "20"}, 2);
  ASSERT_EQ(run["parts"].size(), 38u);
  std::vector<std::string> names;
  for (const json& part : run["parts"]) {
    names.push_back(part["name"]);
  }
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "/housing", names[0]);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "/driven gear shaft", names[1]);
}

TEST(AssembleTest, GuidedBushingStopsAtTheCoverThatWasPutOnTooSoon) {  // N3
  // The bushing slides on the shaft, a mate that guides it, until it meets the bottom of the pocket
  // for the seal, 85 mm up in the cover: 9.5 mm of its bore, which begins after a chamfer of 0.5
  // mm, are then on the journal, which ends at 95 mm.
  const std::vector<std::string> wrong_order{"assemble", ProductFile("gear_pump"), "--order",
                                             "bushing 1,drive gear shaft,cover,bushing 3"};
  const auto run_with = [&](const std::string& condition, const std::string& limit) {
    std::vector<std::string> arguments = wrong_order;
    arguments.insert(arguments.end(), {"--condition", condition, "--limit", limit});
    const json run = RunHvasJson(arguments, 2);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "/bushing 3",
                        run["parts"][4]["name"].get<std::string>());
    return run["parts"][4];
  };
  const json stopped = run_with("hybrid", "100");
  EXPECT_FALSE(stopped["seated"].get<bool>());
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "cover assembly/cover stood in the way",
                      stopped["reason"].get<std::string>());
  EXPECT_NEAR(stopped["insertion_mm"].get<double>(), 9.5, 0.02);
  EXPECT_LE(stopped["deepest_um"].get<double>(), 25);
  // As in the papers, without collision once a mate is captured: through the cover.
  EXPECT_TRUE(run_with("constraint", "34")["seated"].get<bool>());
}

TEST(AssembleTest, RealtimeCountsWhatItMissed) {  // X4; no time is asserted: the host has the say
  const TemporaryFolder folder;
  const std::string file = (folder / "session").string();
  const json run = RunHvasJson(
      {"assemble", ProductFile("bushing"), "--realtime", "--limit", "2", "--record", file}, 2);
  EXPECT_GE(run["ticks"].get<int>(), 2000);
  EXPECT_GT(run["ticks_per_s"].get<double>(), 0);
  for (const char* key : {"late_wake_ups", "overruns", "dropped_ticks"}) {
    EXPECT_GE(run[key].get<int>(), 0) << key;
  }
  EXPECT_TRUE(run["wake_up_us"].contains("p99"));
  EXPECT_NE(run["scheduling"], "");
  auto reader = record::Reader::Open(file);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->is_complete());
  EXPECT_EQ(reader->tick_count() + run["dropped_ticks"].get<int>(), run["ticks"].get<int>());
}

/** Last moment in a record that is being written, or was cut short; -1 when there is none [ns]. */
std::int64_t LastTick(const std::filesystem::path& file) {
  auto reader = record::Reader::Open(file);
  std::int64_t last_ns = -1;
  if (reader) {
    (void)reader->ForEachTick({}, [&last_ns](const TickRecord& tick) {
      last_ns = tick.t_ns;
      return true;
    });
  }
  return last_ns;
}

TEST(AssembleTest, KilledProcessLeavesARecordThatMissesLessThanASecond) {
  const TemporaryFolder folder;
  const auto file = folder / "session";
  const pid_t child = testing::StartHvas(
      {"assemble", ProductFile("bushing"), "--realtime", "--record", file.string()});
  ASSERT_GT(child, 0);
  ASSERT_TRUE(hvas::testing::AwaitTrue([&] { return LastTick(file) >= 2'000'000'000; }));
  const std::int64_t before_ns = LastTick(file);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ASSERT_EQ(::waitpid(child, nullptr, WNOHANG), 0) << "it has ended by itself";
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);

  auto reader = record::Reader::Open(file);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_FALSE(reader->is_complete());
  EXPECT_TRUE(reader->Verify().has_value());
  // Whatever the pace at which this machine ran the session: what was on disk a second before the
  // end has been added to since, and nothing is missing in between.
  std::int64_t next_ns = 0;
  (void)reader->ForEachTick({}, [&next_ns](const TickRecord& tick) {
    EXPECT_EQ(tick.t_ns, next_ns);
    next_ns += 1'000'000;
    return true;
  });
  EXPECT_GE(before_ns, 2'000'000'000);
  EXPECT_GT(next_ns - 1'000'000, before_ns);
}

}  // namespace
}  // namespace hvas::app
