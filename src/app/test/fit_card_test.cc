#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ExpectRefusal;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

// N4: the card of paper W's interference fit; 77,931.13 N at the largest interference.
TEST(FitCommand, CardOfAPressFitHasTheClosedForms) {
  const json card = RunHvasJson(
      {"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--material", "S355", "--mu", "0.15"});
  EXPECT_EQ(card["kind"], "interference");
  EXPECT_NEAR(card["min_clearance_um"].get<double>(), -42, 1e-9);
  EXPECT_NEAR(card["max_clearance_um"].get<double>(), -1, 1e-9);
  EXPECT_NEAR(card["press"]["most"]["press_in_force_n"].get<double>(), 77931.13, 0.01);
  EXPECT_NEAR(card["press"]["mean"]["pressure_mpa"].get<double>(), 42.328, 1e-3);
  EXPECT_GT(card["press"]["most"]["margin_tresca"].get<double>(), 1);
  const Ran text = RunHvas({"fit", "40 H7/p6", "--length", "50", "--mu", "0.15"});
  EXPECT_EQ(text.status, 0);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "77931.1", text.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "heat the hub to", text.out);
}

// Roughness is B(l) in a batch and not smoothing as well: 466 N were left of 2344 N.
TEST(FitCommand, RoughnessCountsOnceInABatch) {
  const auto mean_n = [](std::vector<std::string> more) {
    std::vector<std::string> all{"fit", "40 H7/k6", "--length", "50",           "--rz",
                                 "6.3", "--mu",     "0.15",     "--population", "200000"};
    all.insert(all.end(), more.begin(), more.end());
    return RunHvasJson(all)["population"]["force"].back()["mean_n"].get<double>();
  };
  // Sampling: sigma of about 4500 N over the root of 200 000.
  EXPECT_NEAR(mean_n({}), 2344, 50);
  EXPECT_EQ(mean_n({}), mean_n({"--smoothing", "none"}));
  EXPECT_EQ(mean_n({}), mean_n({"--smoothing", "din2001"}));
  // The band of a curve and its tight pair have as much.
  const TemporaryFolder folder;
  const auto last = [&](const char* smoothing) {
    EXPECT_EQ(RunHvas({"fit", "40 H7/k6", "--length", "50", "--rz", "6.3", "--smoothing", smoothing,
                       "--curve", folder / "curve.csv"})
                  .status,
              0);
    const std::string csv = ReadText(folder / "curve.csv");
    return csv.substr(csv.rfind('\n', csv.size() - 2));
  };
  const std::string even = last("none");
  const std::string din = last("din2017");
  const auto cell = [](const std::string& row, int index) {
    std::istringstream in(row);
    std::string text;
    for (int i = 0; i <= index; ++i) {
      std::getline(in, text, ',');
    }
    return text;
  };
  for (int i = 7; i < 15; ++i) {
    EXPECT_EQ(cell(even, i), cell(din, i)) << i;
  }
  EXPECT_NE(cell(even, 5), cell(din, 5));  // The limits, taken as even, are smoothed.
}

TEST(FitCommand, CardTakesOneClassAndInches) {
  EXPECT_NEAR(RunHvasJson({"fit", "40 H7"})["hole"]["upper_um"].get<double>(), 25, 1e-9);
  EXPECT_NEAR(RunHvasJson({"fit", "1.5in H7/g6"})["nominal_mm"].get<double>(), 38.1, 1e-9);
  EXPECT_EQ(RunHvasJson({"fit", "40 H7/k6"})["kind"], "transition");
}

TEST(FitCommand, PopulationSaysHowManyWillNotBeHeldByThePress) {
  const std::vector<std::string> arguments{"fit",           "40 H7/k6", "--length",     "50",
                                           "--rz",          "6.3",      "--population", "20000",
                                           "--press-limit", "8000",     "--seed",       "3"};
  const json first = RunHvasJson(arguments)["population"];
  EXPECT_EQ(first["count"], 20000);
  EXPECT_NEAR(first["fits"][0]["mean_clearance_um"].get<double>(), 2.5, 0.2);
  EXPECT_EQ(first["force"].size(), 21U);
  EXPECT_GT(first["over_press_share"].get<double>(), 0);
  EXPECT_LT(first["over_press_share"].get<double>(), first["interference_share"].get<double>());
  EXPECT_EQ(RunHvasJson(arguments)["population"], first);
}

// N4: capability goes in: the mean of each size moves towards interference by what C_pk leaves.
TEST(FitCommand, CapabilitiesMoveAndNarrowTheBatch) {
  const json batch = RunHvasJson({"fit", "40 H7/k6", "--length", "50", "--population", "200000",
                                  "--cp", "2", "--cpk", "1"})["population"]["fits"][0];
  const double sigma_um = std::hypot(25, 16) / 12;
  EXPECT_NEAR(batch["sigma_clearance_um"].get<double>(), sigma_um, 0.02);
  // T / 2 - 3 sigma C_pk = T / 4 each.
  EXPECT_NEAR(batch["mean_clearance_um"].get<double>(), 2.5 - 25.0 / 4 - 16.0 / 4, 0.03);
}

TEST(FitCommand, RefusalsSayWhatAFitLooksLike) {
  ExpectRefusal({"fit", "H7/p6"}, {"40 H7/p6"});
  ExpectRefusal({"fit", "40 H7/p66"}, {"not a tolerance class"});
  ExpectRefusal({"fit", "4000 H7/p6"}, {"3150"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "cheese"}, {"cheese"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--hub", "30"}, {"outer diameter"});
  ExpectRefusal({"fit", "40 H7/p6", "--population", "10"}, {"length"});
  ExpectRefusal({"fit", "40 h7/G6"}, {"comes first"});
  ExpectRefusal({"fit", "0.8 N9"}, {"N9 and coarser are not defined for sizes up to 1 mm"});
  ExpectRefusal({"fit", "1000 ZC7"}, {"above 500 mm"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "-3"}, {"--length: -3 is not above 0"});
  ExpectRefusal({"fit", "1 40 H7/p6"}, {"40 H7/p6"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--curve", "force.png"}, {".svg or .csv"});
  ExpectRefusal({"fit", "40 H7/p6", "--curve", "force.svg"}, {"--length"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--jamming", "j.svg"}, {"cannot tilt"});
  ExpectRefusal({"fit", "40 H7/g6", "--length", "50", "--jamming", "j.svg", "--at", "60"},
                {"--at"});
  ExpectRefusal({"fit", "40 H7/g6", "30 H7/g6", "--length", "9,8,7"}, {"3 values for 2 fits"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--chamfer", "88", "--curve", "f.csv"},
                {"is not a lead-in"});
  ExpectRefusal(
      {"fit", "40 H7/k6", "--length", "50", "--population", "9", "--cp", "1", "--cpk", "2"},
      {"C_pk"});
  ExpectRefusal({"fit"}, {"a fit"});
}

TEST(FitCommand, OptionsWithoutEffectAreRefused) {
  const auto refuse = [](std::vector<std::string> more, const std::string& text) {
    more.insert(more.begin(), "fit");
    ExpectRefusal(more, {text});
  };
  refuse({"40 H7/p6", "--hub", "80"}, "--hub has no effect without --length");
  refuse({"40 H7/p6", "--length", "50", "--hub-temp", "200"},
         "--hub-temp has no effect without --hub");
  refuse({"40 H7/g6", "--length", "50", "--hub", "80", "--hub-temp", "200"}, "on a clearance fit");
  refuse({"40 H7/g6", "--length", "50", "--load", "1,2,3"},
         "--load has no effect without --jamming");
  refuse({"40 H7/g6", "--length", "50", "--at", "3"}, "--at has no effect without --jamming");
  refuse({"40 H7/p6", "--length", "50", "--step", "1"}, "--step has no effect without --curve");
  refuse({"40 H7/p6", "--length", "50", "--join-speed", "1"}, "--hub-temp or --shaft-temp");
  refuse({"40 H7/p6", "--length", "50", "--press-limit", "9"}, "without --population or --curve");
  refuse({"40 H7/p6", "--length", "50", "--chamfer-width", "1"}, "on an interference fit");
  refuse({"40 H7/p6", "--length", "50", "--mu", "0.1", "--oiled"},
         "--oiled has no effect together with --mu");
  refuse({"40 H7", "--length", "50"}, "--length has no effect on one class alone");
  refuse({"40 H7/p6", "limits", "--batch", "in.csv"}, "fit: has no effect before limits");
  refuse({"--length", "50", "friction"}, "--length: has no effect before friction");
}

TEST(FitCommand, CountsMayBeWrittenAsPowersAndNotWithoutEnd) {
  const std::vector<std::string> fit{"fit", "40 H7/k6", "--length", "50", "--population"};
  const auto with = [&fit](std::vector<std::string> more) {
    more.insert(more.begin(), fit.begin(), fit.end());
    return more;
  };
  EXPECT_EQ(RunHvasJson(with({"1e4"}))["population"]["count"], 10000);
  ExpectRefusal(with({"1e12"}), {"1e12 is above the maximum, 100000000"});
  ExpectRefusal(with({"1.5"}), {"1.5 is not a positive whole number"});
  ExpectRefusal(with({"100", "--threads", "100000"}), {"100000 is above the maximum, 256"});
  ExpectRefusal(with({"100", "--threads", "0"}), {"0 is not a positive whole number"});
}

TEST(FitCommand, ErrorsAreInTheUnitThatWasTyped) {
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--hub", "40"},
                {"the hub's outer diameter is 40 mm, but must be over 40 mm"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--bore", "45"},
                {"the shaft's bore is 45 mm"});
}

// No 24.999999999999996 and no -0.0.
TEST(FitCommand, NumbersAsJsonAreRoundedToWhatTheyMean) {
  const Ran h7 = RunHvas({"fit", "40 H7/g6", "--length", "50", "--json"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "\"upper_um\": 25.0,", h7.out);
  EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "-0.0", h7.out);
  for (const char* fit : {"40 H7/p6", "17 H8/f7", "63 K7/h6", "0.7 H6/js5"}) {
    const Ran ran = RunHvas({"fit", fit, "--length", "50", "--rz", "6.3", "--json"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "00000", ran.out);
    EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "99999", ran.out);
    EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "-0.0,", ran.out);
  }
}

// W3: what people write for a diameter, and E8, which is a class and no power of ten.
TEST(FitCommand, ReadsDiametersAsPeopleWriteThem) {
  const auto nominal_mm = [](const char* text) {
    return RunHvasJson({"fit", text})["nominal_mm"].get<double>();
  };
  EXPECT_NEAR(nominal_mm("\xC3\x98"
                         "40H7"),
              40, 1e-9);
  EXPECT_NEAR(nominal_mm("40E8"), 40, 1e-9);
  EXPECT_NEAR(nominal_mm("40,5 mm H7/g6"), 40.5, 1e-9);
  EXPECT_NEAR(nominal_mm("1 1/2 in H7/p6"), 38.1, 1e-9);
  EXPECT_NEAR(nominal_mm("3/8\" H7-g6"), 9.525, 1e-9);
}

// W2: measured sizes in place of drawn ones.
TEST(FitCommand, MeasuredSizesMakeTheBatch) {
  const TemporaryFolder folder;
  const std::string sizes = folder.Write("sizes.csv", "hole_mm,shaft_mm\n40.010,40.020\n40.010,\n");
  const json batch = RunHvasJson({"fit", "40 H7/k6", "--length", "50", "--mu", "0.15",
                                  "--population", "5000", "--sizes", sizes})["population"];
  EXPECT_NEAR(batch["fits"][0]["mean_clearance_um"].get<double>(), -10, 1e-6);
  EXPECT_NEAR(batch["force"].back()["mean_n"].get<double>(), 5 * 3711.01, 1);
  ExpectRefusal({"fit", "40 H7/k6", "--length", "50", "--population", "5", "--sizes",
                 folder.Write("bad.csv", "hole_mm\nten\n")},
                {"row 1"});
}

TEST(FitCommand, AnswersInTheUnitThatIsTyped) {
  const Ran inch = RunHvas({"fit", "1.5in H7/g6", "--length", "2in", "--hub", "3in"});
  for (const char* text : {"1.5 in H7/g6", "thou", "joint 2 in long, hub 3 in"}) {
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, inch.out);
  }
  EXPECT_EQ(inch.out.find(" um"), std::string::npos);
  EXPECT_EQ(inch.out.find(" mm"), std::string::npos);
  // 38.1 mm is between 30 and 50: H7 is 25 um, 0.984 thou.
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "+0.984", inch.out);
  const Ran mm = RunHvas({"fit", "1.5in H7/g6", "--unit", "mm"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "38.1 mm H7/g6", mm.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "+25", mm.out);
  EXPECT_EQ(RunHvas({"fit", "40 H7", "--unit", "in"}).out,
            RunHvas({"fit", "1.5748031496062993in H7"}).out);
}

TEST(FitCommand, FitsOfAnsiB41AreThere) {
  const json card = RunHvasJson({"fit", "1.5in RC4"});
  EXPECT_EQ(card["ansi_b41"], "RC4");
  EXPECT_EQ(card["hole"]["class"], "H8");
  EXPECT_EQ(card["kind"], "clearance");
  EXPECT_NEAR(card["max_clearance_um"].get<double>(), 3.6 * 25.4, 1e-4);
  const json force = RunHvasJson({"fit", "1.5in FN2", "--length", "2in", "--hub", "3in"});
  EXPECT_NEAR(force["min_clearance_um"].get<double>(), -2.4 * 25.4, 1e-4);
  EXPECT_GT(force["press"]["least"]["torque_nm"].get<double>(), 0);
  ExpectRefusal({"fit", "1.5in LC3"}, {"RC1 to RC9"});
  ExpectRefusal({"fit", "25in RC4"}, {"19.69"});
}

// The card as JSON is what its schema says, whatever was asked for.
TEST(FitCommand, JsonIsOfItsSchema) {
  const TemporaryFolder folder;
  const json schema = json::parse(
      ReadText(std::filesystem::path(HVAS_SOURCE_DIR) / "data" / "schemas" / "fit.schema.json"));
  const std::vector<std::vector<std::string>> commands{
      {"40 H7"},
      {"40 H7/g6"},
      {"40 H7/p6", "--length", "50", "--hub", "80", "--hub-temp", "200", "--population", "1000",
       "--rz", "4"},
      {"40 H7/k6", "35 H7/p6", "--length", "20", "--start", "0,30", "--population", "1000",
       "--press-limit", "9000"},
      {"40 H7/g6", "--length", "50", "--jamming", folder / "jam.svg"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.begin(), "fit");
    const std::vector<std::string> errors = testing::Validate(schema, RunHvasJson(command));
    EXPECT_TRUE(errors.empty()) << command[1] << ": " << errors.front();
  }
}

TEST(FitCommand, SearchFindsTheFitOfARange) {
  const json found = RunHvasJson({"fit", "search", "--nominal", "40", "--min", "9", "--max", "50"});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0]["fit"], "H7/g6");
  ExpectRefusal({"fit", "search", "--nominal", "40", "--min", "50", "--max", "9"}, {"not a range"});
}

}  // namespace
}  // namespace hvas::app
