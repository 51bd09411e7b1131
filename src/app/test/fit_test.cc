#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

/** Expects an error that says something of a text, and no output. */
void ExpectRefusal(const std::vector<std::string>& arguments, const std::string& text) {
  const Ran ran = RunHvas(arguments);
  EXPECT_TRUE(ran.status == 1 || ran.status == 64) << ran.status;
  EXPECT_EQ(ran.out, "");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, ran.err);
}

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
  ExpectRefusal({"fit", "H7/p6"}, "40 H7/p6");
  ExpectRefusal({"fit", "40 H7/p66"}, "no tolerance class");
  ExpectRefusal({"fit", "4000 H7/p6"}, "3150");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "cheese"}, "cheese");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--hub", "30"}, "outer diameter");
  ExpectRefusal({"fit", "40 H7/p6", "--population", "10"}, "length");
  ExpectRefusal({"fit", "40 h7/G6"}, "come first");
  ExpectRefusal({"fit", "0.8 N9"}, "N9 and coarser are not for sizes up to 1 mm");
  ExpectRefusal({"fit", "1000 ZC7"}, "above 500 mm");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "-3"}, "--length: -3 is not over 0");
  ExpectRefusal({"fit", "1 40 H7/p6"}, "40 H7/p6");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--curve", "force.png"}, ".svg or .csv");
  ExpectRefusal({"fit", "40 H7/p6", "--curve", "force.svg"}, "--length");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--jamming", "j.svg"}, "cannot tilt");
  ExpectRefusal({"fit", "40 H7/g6", "--length", "50", "--jamming", "j.svg", "--at", "60"}, "--at");
  ExpectRefusal({"fit", "40 H7/g6", "30 H7/g6", "--length", "9,8,7"}, "3 values for 2 fits");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--chamfer", "88", "--curve", "f.csv"},
                "leads nothing in");
  ExpectRefusal(
      {"fit", "40 H7/k6", "--length", "50", "--population", "9", "--cp", "1", "--cpk", "2"},
      "C_pk");
  ExpectRefusal({"fit"}, "a fit");
}

TEST(FitCommand, OptionsWithoutEffectAreRefused) {
  const auto refuse = [](std::vector<std::string> more, const std::string& text) {
    more.insert(more.begin(), "fit");
    ExpectRefusal(more, text);
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
         "--oiled has no effect beside --mu");
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
  ExpectRefusal(with({"1e12"}), "1e12 is over 100000000");
  ExpectRefusal(with({"1.5"}), "1.5 is not a whole number");
  ExpectRefusal(with({"100", "--threads", "100000"}), "100000 is over 256");
  ExpectRefusal(with({"100", "--threads", "0"}), "0 is not a whole number over 0");
}

TEST(FitCommand, ErrorsAreInTheUnitThatWasTyped) {
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--hub", "40"},
                "the hub's outer diameter is 40 mm, but must be over 40 mm");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--bore", "45"}, "the shaft's bore is 45 mm");
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

// N4: heat, cold and both; the play at temperatures is that of the closed form.
TEST(FitCommand, JoiningByHeatAndColdSaysThePlayAndWhetherItSticks) {
  const json slow =
      RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--hub-temp", "150",
                   "--shaft-temp", "-78", "--join-speed", "0.1"})["joining"]["asked"];
  EXPECT_NEAR(slow["clearance_um"].get<double>(), 40e3 * (11e-6 * 130 + 8.5e-6 * 98) - 42, 1e-6);
  EXPECT_LT(slow["sticking_depth_mm"].get<double>(), 50);
  const json fast =
      RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--hub-temp", "150",
                   "--shaft-temp", "-78", "--join-speed", "100"})["joining"]["asked"];
  // The depth grows with the root of the speed.
  EXPECT_NEAR(fast["sticking_depth_mm"].get<double>() / slow["sticking_depth_mm"].get<double>(),
              std::sqrt(1000), 1e-6);
  const Ran cold =
      RunHvas({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--hub-temp", "30"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "does not go together", cold.out);
}

// DIN 7190: steel 11e-6/K for heating, 8.5e-6/K for cooling. The play is 40 um on 42 um at most,
// for which the shaft alone would have to be at -221 C.
TEST(FitCommand, JoiningTakesNoMoreColdThanThereIsAndNoMoreHeatThanTheHubBears) {
  const json steel = RunHvasJson({"fit", "40 H7/p6", "--length", "50"})["joining"];
  EXPECT_NEAR(steel["heat_hub_to_c"].get<double>(), 20 + 82 / (40e3 * 11e-6), 0.005);
  EXPECT_TRUE(steel["cool_shaft_to_c"].is_null());
  EXPECT_NEAR(steel["play_in_nitrogen_um"].get<double>(), 40e3 * 8.5e-6 * 216 - 42, 1e-6);
  EXPECT_NEAR(steel["with_nitrogen_heat_hub_to_c"].get<double>(),
              20 + (82 - 40e3 * 8.5e-6 * 216) / (40e3 * 11e-6), 0.005);
  EXPECT_EQ(steel["hub_limit_c"], 350);
  const Ran text = RunHvas({"fit", "40 H7/p6", "--length", "50"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "by cold: cannot be done", text.out);
  // A tempered hub bears 200 C, and 206 C are needed.
  const json hard = RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--hub-material", "16MnCr5",
                                 "--hub", "80", "--hub-temp", "210"});
  EXPECT_TRUE(hard["joining"]["heat_hub_to_c"].is_null());
  EXPECT_EQ(hard["joining"]["asked"]["is_hub_too_hot"], true);
  // Little interference: cold alone does it.
  EXPECT_NEAR(RunHvasJson({"fit", "40 H7/k6", "--length", "50"})["joining"]["cool_shaft_to_c"]
                  .get<double>(),
              20 - 58 / (40e3 * 8.5e-6), 0.005);
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--shaft-temp", "-230"}, "liquid nitrogen");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--shaft-temp", "-300"}, "absolute zero");
}

// E = 105 GPa of both halves the pressure; Re = 400 MPa moves the margin.
TEST(FitCommand, MaterialsMayHaveValuesOfTheirOwn) {
  const auto card = [](const char* material, const char* room) {
    return RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--mu", "0.15",
                        "--material", material, "--room", room});
  };
  const json steel = card("S355", "20");
  const json soft = card("E=105 nu=0.3 Re=355 alpha=22", "30");
  EXPECT_NEAR(soft["press"]["most"]["pressure_mpa"].get<double>(),
              0.5 * steel["press"]["most"]["pressure_mpa"].get<double>(), 1e-4);
  EXPECT_NEAR(soft["joining"]["heat_hub_to_c"].get<double>(), 30 + 82 / (40e3 * 22e-6), 0.005);
  const json strong = card("S355 Re=710", "20");
  EXPECT_NEAR(strong["press"]["most"]["margin_tresca"].get<double>(),
              2 * steel["press"]["most"]["margin_tresca"].get<double>(), 1e-6);
  EXPECT_EQ(strong["joint"]["hub_material"], "S355JR Re=710");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "E=210"}, "lacks E or nu");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "S355 Re=-4"}, "Re=-4");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "S355 colour=4"}, "colour=4");
}

// PF1 of the dsoftcon manual: 70/140, L 60, 800 N m and 2.5 kN, nu 0.09, S 1.4 / 1.25 more: 34 MPa,
// 30 um smoothed and 40 um in all with G = 10 um. The hub has E = 215 GPa there.
TEST(FitCommand, DesignGoesFromTheLoadToTheInterferenceAndAFit) {
  const json design = RunHvasJson({"fit",
                                   "design",
                                   "--nominal",
                                   "70",
                                   "--length",
                                   "60",
                                   "--hub",
                                   "140",
                                   "--torque",
                                   "1000",
                                   "--axial",
                                   "3125",
                                   "--safety",
                                   "1.4",
                                   "--mu",
                                   "0.09",
                                   "--rz",
                                   "12.5",
                                   "--hub-material",
                                   "S355 E=215",
                                   "--shaft-material",
                                   "S355"});
  EXPECT_NEAR(design["required_pressure_mpa"].get<double>(), 34, 0.2);
  EXPECT_NEAR(design["required_interference_um"].get<double>(), 40, 0.5);
  ASSERT_FALSE(design["proposals"].empty());
  for (const json& fit : design["proposals"]) {
    EXPECT_GE(fit["least_interference_um"].get<double>(),
              design["required_interference_um"].get<double>());
    EXPECT_GE(fit["margin_von_mises"].get<double>(), 1);
    EXPECT_GE(fit["least_torque_nm"].get<double>(), 1.4 * 1000);
  }
  ExpectRefusal({"fit", "design", "--nominal", "40", "--length", "50"}, "--torque or --axial");
  ExpectRefusal({"fit", "design", "--nominal", "40", "--length", "5", "--torque", "9000"},
                "yields");
}

TEST(FitCommand, MaterialsAreListedWithWhatFitsTakeOfThem) {
  const json materials = RunHvasJson({"fit", "materials"});
  EXPECT_GE(materials.size(), 40U);
  EXPECT_EQ(materials[1]["name"], "S355JR");
  EXPECT_NEAR(materials[1]["cooling_per_k"].get<double>(), 8.5e-6, 1e-12);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "42CrMo4", RunHvas({"fit", "materials"}).out);
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

/** Rows of numbers under a header. */
std::vector<std::vector<double>> ReadNumbers(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) {
      rows.back().push_back(std::stod(cell));
    }
  }
  return rows;
}

// W8: 77,931.13 N at the end of the curve whatever its step; what comes out is what went in.
TEST(FitCommand, CurveEndsAtTheClosedFormWhateverTheStep) {
  const TemporaryFolder folder;
  for (const auto& [step, count] : {std::pair("0.01", 5001U), std::pair("1", 51U)}) {
    ASSERT_EQ(RunHvas({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--mu", "0.15",
                       "--curve", folder / "curve.csv", "--step", step})
                  .status,
              0);
    const auto rows = ReadNumbers(ReadText(folder / "curve.csv"));
    ASSERT_EQ(rows.size(), count);
    EXPECT_EQ(rows.front()[0], 0);
    EXPECT_EQ(rows.back()[0], 50);
    EXPECT_NEAR(rows.back()[5], 77931.133, 0.01);
    EXPECT_NEAR(rows.back()[6], 77931.133, 0.01);
    for (const auto& row : rows) {
      EXPECT_NEAR(row[5], 77931.133 * row[0] / 50, 0.01);
      for (std::size_t q = 10; q + 1 < row.size(); ++q) {
        EXPECT_LE(row[q], row[q + 1]);  // Quantiles are in order.
      }
    }
  }
}

// N4: the same bytes with any number of threads: card, curve and plot.
TEST(FitCommand, SameBytesWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto run = [&](const char* threads) {
    std::string all;
    for (const char* kind : {"curve.csv", "curve.svg"}) {
      const Ran ran = RunHvas({"fit",     "40 H7/k6",     "35 H7/p6",  "--length",      "30,20",
                               "--start", "0,40",         "--rz",      "6.3",           "--chamfer",
                               "5",       "--population", "50001",     "--press-limit", "9000",
                               "--curve", folder / kind,  "--threads", threads,         "--json"});
      EXPECT_EQ(ran.status, 0) << ran.err;
      all += ran.out + ReadText(folder / kind);
    }
    return all;
  };
  const std::string one = run("1");
  EXPECT_EQ(run("2"), one);
  EXPECT_EQ(run("3"), one);
}

// W10: paper W's ranges by its own factors, the true newtons beside them; one smooth curve, one
// stair.
TEST(FitCommand, PapersCurvesHaveItsRangesAndTheTrueNewtons) {
  const TemporaryFolder folder;
  ASSERT_EQ(RunHvas({"fit", "paper", "--curve", folder / "paper.csv"}).status, 0);
  std::istringstream in(ReadText(folder / "paper.csv"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "experiment,fit,factor,depth_mm,time_s,true_n,shown_n");
  std::map<std::string, std::vector<std::pair<double, double>>> curves;
  while (std::getline(in, line)) {
    const std::string experiment = line.substr(0, 2);
    const std::size_t shown = line.rfind(',');
    const std::size_t real = line.rfind(',', shown - 1);
    curves[experiment].emplace_back(std::stod(line.substr(real + 1)),
                                    std::stod(line.substr(shown + 1)));
  }
  const auto largest = [](const auto& curve) {
    std::pair<double, double> most{0, 0};
    for (const auto& [real, shown] : curve) {
      most = {std::max(most.first, real), std::max(most.second, shown)};
    }
    return most;
  };
  const auto flat = [](const auto& curve) {
    int count = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
      count += curve[i].first - curve[i - 1].first < 1e-9 ? 1 : 0;
    }
    return count;
  };
  ASSERT_EQ(curves.size(), 3U);
  EXPECT_NEAR(largest(curves["B1"]).second, 0.3, 0.005);
  EXPECT_EQ(largest(curves["B1"]).first, largest(curves["B1"]).second);
  EXPECT_NEAR(largest(curves["B2"]).second, 6, 1e-6);
  EXPECT_NEAR(largest(curves["B2"]).first, 39893, 3000);
  EXPECT_EQ(flat(curves["B2"]), 0);
  EXPECT_NEAR(largest(curves["B3"]).second, 4, 1e-6);
  EXPECT_GT(flat(curves["B3"]), 50);
}

/** A plot is XML that a browser reads, and has what its reader needs. */
void ExpectPlot(const std::string& svg, const std::vector<std::string>& texts) {
  EXPECT_TRUE(svg.starts_with("<svg xmlns=")) << svg.substr(0, 60);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "prefers-color-scheme:dark", svg);
  EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "nan", svg);
  for (const std::string& text : texts) {
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, svg);
  }
}

TEST(FitCommand, PlotsHaveAxesUnitsAndLegend) {
  const TemporaryFolder folder;
  ASSERT_EQ(RunHvas({"fit", "40 H7/k6", "--length", "50", "--rz", "6.3", "--press-limit", "9000",
                     "--curve", folder / "curve.svg", "--jamming", folder / "jam.svg"})
                .status,
            0);
  ASSERT_EQ(RunHvas({"fit", "paper", "--curve", folder / "paper.svg"}).status, 0);
  ExpectPlot(ReadText(folder / "curve.svg"),
             {"axial force, N", "depth of the shaft, mm", "5 to 95 %", "The tight pair by itself",
              "what the press can do", "clearance of the diameters, um"});
  ExpectPlot(ReadText(folder / "jam.svg"),
             {"F_x / F_z", "M / (r F_z)", "tilt, deg", "may wedge", "slides on"});
  ExpectPlot(ReadText(folder / "paper.svg"),
             {"H7/g6", "H7/p6", "H7/k6", "as shown, N", "true axial force, N", "k_r ="});
}

// N5: the working point's verdict is the library's, and the vertices are those of the worked case.
TEST(FitCommand, JammingHasTheVerdictOfTheLoad) {
  const TemporaryFolder folder;
  const auto jam = [&](const char* load) {
    return RunHvasJson({"fit", "20 H7/g6", "--length", "40", "--mu", "0.3", "--at", "20", "--load",
                        load, "--jamming", folder / "jam.svg"})["jamming"];
  };
  // mu 0.3, r 10, l 20: (0, 3.0) slides, (0, 3.6) jams, (2, -1) slides, (2, 1) jams.
  EXPECT_EQ(jam("0,1,30")["is_sliding"], true);
  EXPECT_EQ(jam("0,1,36")["is_sliding"], false);
  EXPECT_EQ(jam("2,1,-10")["is_sliding"], true);
  const json last = jam("2,1,10");
  EXPECT_EQ(last["is_sliding"], false);
  EXPECT_EQ(last["can_wedge"], false);
  EXPECT_NEAR(last["lambda"].get<double>(), 10.0 / 3, 1e-8);
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
                "row 1");
}

TEST(FitCommand, FrictionSaysWhereEachCoefficientIsFrom) {
  const json rows = RunHvasJson({"fit", "friction"});
  EXPECT_GE(rows.size(), 40U);
  EXPECT_FALSE(rows[0]["source"].get<std::string>().empty());
  const Ran card = RunHvas({"fit", "40 H7/p6", "--length", "50", "--hub-material", "EN-GJL-250"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring,
                      "mu 0.12 to press in, 0.12 to hold, 0.11 to slide out",
                      std::regex_replace(card.out, std::regex("\n +"), " "));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "steel / EN-GJL-250, longitudinal, dry", card.out);
}

// The torque of steel on bronze was that of 0.25, the top of a range for brass that is shrunk on.
TEST(FitCommand, WhatHoldsHasTheLowFrictionAndWhatIsPressedInTheHighOne) {
  const auto most = [](std::vector<std::string> more) {
    std::vector<std::string> all{"fit", "40 H7/p6", "--length", "50", "--hub", "80"};
    all.insert(all.end(), more.begin(), more.end());
    return RunHvasJson(all)["press"]["most"];
  };
  // p = 82.6875 MPa of paper W's rig; pi D l p = 519 540.9 N.
  const double normal_n = 77931.133 / 0.15;
  const json steel = most({});
  EXPECT_NEAR(steel["press_in_force_n"].get<double>(), 0.20 * normal_n, 0.1);
  EXPECT_NEAR(steel["push_out_force_n"].get<double>(), 0.10 * normal_n, 0.1);
  EXPECT_NEAR(steel["slide_out_force_n"].get<double>(), 0.08 * normal_n, 0.1);
  EXPECT_NEAR(steel["torque_nm"].get<double>(), 0.10 * normal_n * 0.02, 0.01);
  EXPECT_NEAR(most({"--oiled"})["torque_nm"].get<double>(), 0.07 * normal_n * 0.02, 0.01);
  EXPECT_NEAR(most({"--shrunk"})["torque_nm"].get<double>(), 0.15 * normal_n * 0.02, 0.01);
  EXPECT_NEAR(most({"--hub-temp", "210"})["torque_nm"].get<double>(), 0.15 * normal_n * 0.02, 0.01);
  const json bronze = most({"--hub-material", "CuAl10Ni"});
  EXPECT_NEAR(bronze["torque_nm"].get<double>() / (bronze["press_in_force_n"].get<double>() * 0.02),
              0.07 / 0.10, 1e-6);
  EXPECT_NEAR(bronze["torque_nm"].get<double>(), 448.2, 0.5);
}

// N5: how it gets in: the clearance and the chamfers beside the axis, and the tilts of the closed
// forms. What holds whatever the sizes are is that of the least clearance.
TEST(FitCommand, CardSaysHowTheShaftGetsIn) {
  const json entry = RunHvasJson(
      {"fit", "40 H7/g6", "--length", "50", "--chamfer-width", "0.5", "--mu", "0.15"})["entry"];
  constexpr double kDegree = 0.017453292519943295;
  const auto check = [](const json& e, double clearance_mm) {
    EXPECT_NEAR(e["window_um"].get<double>(), 500 * clearance_mm + 500, 1e-3);
    const double hole_mm = 40 + clearance_mm;
    EXPECT_NEAR(e["largest_tilt_deg"].get<double>(), std::acos(40 / hole_mm) / kDegree, 1e-6);
    // The tilt t with D = d cos t + mu d sin t: two points touch at l = mu d.
    const double t = e["wedging_tilt_deg"].get<double>() * kDegree;
    EXPECT_NEAR(40 * std::cos(t) + 6 * std::sin(t), hole_mm, 1e-6);
  };
  check(entry, 0.009);
  check(entry["with_largest_clearance"], 0.050);
  // A fit that may have none wedges at any tilt.
  for (const char* fit : {"40 H7/h6", "40 H7/k6"}) {
    const json none = RunHvasJson({"fit", fit, "--length", "50"})["entry"];
    EXPECT_NEAR(none["wedging_tilt_deg"].get<double>(), 0, 1e-6) << fit;
    const Ran text = RunHvas({"fit", fit, "--length", "50"});
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "wedges at any tilt", text.out);
  }
  const json out =
      RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--mu", "0.1", "--mu-out", "0.2"});
  EXPECT_NEAR(out["press"]["most"]["push_out_force_n"].get<double>(),
              2 * out["press"]["most"]["press_in_force_n"].get<double>(), 0.002);
}

TEST(FitCommand, WedgingLineOfADiagramIsThatOfTheLeastClearance) {
  const TemporaryFolder folder;
  const std::string svg = (folder / "jam.svg").string();
  const json jamming = RunHvasJson(
      {"fit", "40 H7/g6", "--length", "50", "--mu", "0.15", "--jamming", svg})["jamming"];
  const double t = jamming["wedging_tilt_deg"].get<double>() * 0.017453292519943295;
  EXPECT_NEAR(40 * std::cos(t) + 6 * std::sin(t), 40.009, 1e-6);
}

// sigma_t <= Rm, so p <= Rm (1 - Q^2) / (1 + Q^2) = 150 MPa of Rm = 250 and Q = 1/2, with a safety.
TEST(FitCommand, BrittleHubHasTheMarginOfItsHoopStress) {
  const std::vector<std::string> joint{"fit",   "40 H7/p6", "--length",       "50",
                                       "--hub", "80",       "--hub-material", "GJL-250"};
  const json card = RunHvasJson(joint);
  EXPECT_EQ(card["joint"]["is_hub_brittle"], true);
  const json& most = card["press"]["most"];
  EXPECT_NEAR(most["margin_von_mises"].get<double>(), 150 / most["pressure_mpa"].get<double>(),
              1e-4);
  const Ran text = RunHvas(joint);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "the hub is brittle", text.out);
  const json design = RunHvasJson({"fit", "design", "--nominal", "40", "--length", "50", "--hub",
                                   "80", "--torque", "50", "--hub-material", "GJL-250"});
  EXPECT_EQ(design["is_hub_brittle"], true);
  EXPECT_NEAR(design["largest_pressure_mpa"].get<double>(), 50, 1e-3);
  for (const json& proposal : design["proposals"]) {
    EXPECT_GE(proposal["margin_von_mises"].get<double>(), 3);
  }
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
  ExpectRefusal({"fit", "1.5in LC3"}, "RC1 to RC9");
  ExpectRefusal({"fit", "25in RC4"}, "19.69");
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

class FitTable : public ::testing::Test {
 protected:
  /** Writes a table, runs a command on it, and returns what it wrote. */
  [[nodiscard]] std::string Run(const std::string& command, const std::string& table) const {
    const Ran ran = RunHvas(
        {"fit", command, "--batch", folder_.Write("in.csv", table), "-o", folder_ / "out.csv"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ReadText(folder_ / "out.csv");
  }

  TemporaryFolder folder_;
};

TEST_F(FitTable, LimitsOfClassesOrTheReasonWhyThereAreNone) {
  EXPECT_EQ(
      Run("limits",
          "nominal_mm,class\n40,H7\n40,g6\n280,M6\n3,js7\n30.001,H7\n40,N01\n40,Q7\nten,H7\n1.5 "
          "in,H7\n4E+1,H7\n,H7\n-5,H7\n0,H7\n4000,H7\n"),
      "nominal_mm,class,kind,upper_um,lower_um,reason\n"
      "40,H7,hole,25,0,\n"
      "40,g6,shaft,-9,-25,\n"
      "280,M6,hole,-9,-41,\n"
      "3,js7,shaft,5,-5,\n"
      "30.001,H7,hole,25,0,\n"
      "40,N01,hole,,,\"ISO 286 defines no class N01 at 40 mm: delta, which holes K to ZC need "
      "between 3 "
      "and 500 mm, begins with IT3; choose another class\"\n"
      "40,Q7,,,,\"\"\"Q7\"\" is no tolerance class; write letters and grade as in H7 or js6\"\n"
      "ten,H7,,,,\"nominal_mm is no number; write millimetres, or inches as in 1.5 in\"\n"
      "1.5 in,H7,hole,25,0,\n"
      "4E+1,H7,hole,25,0,\n"
      ",H7,,,,nominal_mm is missing\n"
      "-5,H7,hole,,,-5 mm is no nominal size of ISO 286; give a diameter over 0 and up to 3150 mm\n"
      "0,H7,hole,,,0 mm is no nominal size of ISO 286; give a diameter over 0 and up to 3150 mm\n"
      "4000,H7,hole,,,4000 mm is no nominal size of ISO 286; give a diameter over 0 and up to 3150 "
      "mm\n");
}

TEST_F(FitTable, PressFitsOfJoints) {
  std::istringstream out(
      Run("press",
          "id,d_F_mm,D_hub_mm,d_bore_shaft_mm,U_eff_diametral_mm,L_mm,mu,E_hub_MPa,"
          "nu_hub,E_shaft_MPa,nu_shaft\n"
          "PF2,100,150,0,0.1,50,0.15,210000,0.3,210000,0.3\n"
          "bad,100,90,0,0.1,50,0.15,210000,0.3,210000,0.3\n"));
  std::string line;
  std::getline(out, line);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, ",p_MPa,", line);
  std::getline(out, line);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "58.33333333,0.08055555556,0.01944444444,151.6666667",
                      line);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "137444.6786,6872233.93", line);
  std::getline(out, line);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "outer diameter", line);
}

TEST_F(FitTable, QuestionsAboutAPegInAHole) {
  EXPECT_EQ(Run("peg",
                "kind,id,inputs,output,unit\n"
                "two_point,a,D=20 d=19.9 l=10,theta2,rad\n"
                "two_point,a,,theta2,deg\n"
                "two_point_depth,b,R=10 r=9.95 theta=1 deg,h,mm\n"
                "wedging,c,mu=.3 r=10 l=5.999,wedging possible,bool\n"
                "statics,d,mu=.3 r=10 l=20 f1=3 f2=5,M,N mm\n"
                "two_point,e,D=20 l=10,theta2,rad\n"
                "two_point,f,D=20 d=19.9 l=10,colour,\n"),
            "kind,id,inputs,output,unit,value,reason\n"
            "two_point,a,D=20 d=19.9 l=10,theta2,rad,0.01010170516,\n"
            "two_point,a,,theta2,deg,0.5787850718,\n"
            "two_point_depth,b,R=10 r=9.95 theta=1 deg,h,mm,5.728982938,\n"
            "wedging,c,mu=.3 r=10 l=5.999,wedging possible,bool,1,\n"
            "statics,d,mu=.3 r=10 l=20 f1=3 f2=5,M,N mm,106,\n"
            "two_point,e,D=20 l=10,theta2,rad,,the input d is missing or no number\n"
            "two_point,f,D=20 d=19.9 l=10,colour,,,\"there is no output \"\"colour\"\" of kind "
            "\"\"two_point\"\"\"\n");
}

// What no peg can have is refused with the reason; 30 mm in 20 gave a tilt of -43 degrees.
TEST_F(FitTable, QuestionsAboutAPegThatCannotBeAreRefused) {
  const auto refuse = [this](const std::string& question, const std::string& reason) {
    const std::string out = Run("peg", "kind,id,inputs,output,unit\n" + question + "\n");
    const std::string row = out.substr(out.find('\n') + 1);
    EXPECT_TRUE(row.starts_with(question + ",,")) << row;
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, reason, row);
  };
  refuse("two_point,a,D=20 d=30 l=10,theta2,rad", "diameter d = 30 mm is not below the hole's D");
  refuse("two_point,a,D=20 d=20 l=10,theta_m,rad", "not below");
  refuse("two_point,a,D=20 d=-19 l=10,theta2,rad", "d is -19, but must be over 0");
  refuse("two_point,a,D=20 d=19.9 l=-10,theta2,rad", "l is -10, but must be at least 0");
  refuse("two_point,a,D=20 d=19.9 l=nan,theta2,rad", "l is no number");
  refuse("two_point,a,D=20 d=19.9 l=1,theta2,rad", "no two-point contact: l is at least 1.9975");
  refuse("two_point,a,D=20 d=19.9 l=10 furlong,theta2,rad", "in \"\"furlong\"\"");
  refuse("two_point,a,D=20 d=19.9 l=10,theta2,kg", "has no unit");
  refuse("two_point,a,D=20 d=19.9 theta=9 deg,l2,mm", "the largest is 5.73");
  refuse("two_point,a,D=20 d=19.9 d=19 l=10,theta2,rad", "given twice");
  refuse("two_point,a,D=20 d=19.9 q=1 l=10,theta2,rad", "no input q");
  refuse("two_point_depth,b,R=10 r=11 theta=1 deg,h,mm", "radius r = 11 mm is not below");
  refuse("two_point_depth,b,R=10 r=9.95 theta=30 deg,h,mm", "does not enter");
  refuse("wedging,c,mu=-.3 r=10 l=5,wedging possible,bool", "mu is -.3, but must be at least 0");
  refuse("jamming,c,mu=0 r=10 l=5,lambda,-", "without friction");
  refuse("jamming_point,c,mu=.3 r=10 l=5 Fx=1 M=0,slides,bool", "Fz is missing");
  refuse("jamming_point,c,mu=.3 r=10 l=5 Fx=1 Fz=-2 M=0,slides,bool",
         "Fz is -2, but must be over 0");
  refuse("statics,d,mu=.3 r=10 l=20 f1=-3 f2=5,M,N mm", "f1 is -3");
  refuse("chamfer,e,Kx=10 Kt=50000 Lg=50 r=10 mu=0.9 alpha=30 deg z=1,Fz,N", "tan alpha over mu");
  refuse("one_point,f,Kx=10 Kt=50000 Lg=50 r=10 mu=0.1 eps0'=-1 theta0=0 l=10,f,N", "other side");
}

TEST_F(FitTable, QuestionsAboutAPegConvertUnits) {
  EXPECT_EQ(Run("peg",
                "kind;id;inputs;output;unit\n"
                "two_point;a;D=2 cm d=19900 um l=10,0;theta2;deg\n"
                "statics;d;mu=.3 r=10 l=20 f1=3 N f2=0.005 kN;M;N m\n"
                "one_point;e;Kx=10 N/mm Kt=50 N m/rad Lg=50 r=10 mu=0.15 eps0'=0.5 theta0=0.01 "
                "l=10;f;N\n"),
            "kind;id;inputs;output;unit;value;reason\n"
            "two_point;a;D=2 cm d=19900 um l=10,0;theta2;deg;0.5787850718;\n"
            "statics;d;mu=.3 r=10 l=20 f1=3 N f2=0.005 kN;M;N m;0.106;\n"
            "one_point;e;Kx=10 N/mm Kt=50 N m/rad Lg=50 r=10 mu=0.15 eps0'=0.5 theta0=0.01 "
            "l=10;f;N;4.587155963;\n");
}

// The four loads of the reference: inside and outside of the parallelogram of mu 0.3, r 10, l 20.
TEST_F(FitTable, LoadsJamOrSlide) {
  const std::string at = "mu=.3 r=10 l=20 Fz=10 ";
  EXPECT_EQ(Run("peg",
                "kind,id,inputs,output,unit\n"
                "jamming_point,a," +
                    at +
                    "Fx=0 M=300,slides,bool\n"
                    "jamming_point,b," +
                    at +
                    "Fx=0 M=360,slides,bool\n"
                    "jamming_point,c," +
                    at +
                    "Fx=20 M=-100,slides,bool\n"
                    "jamming_point,d," +
                    at +
                    "Fx=20 M=100,slides,bool\n"
                    "jamming_point,e," +
                    at +
                    "Fx=20 N M=0.1 Nm,jams,bool\n"
                    "jamming_point,f," +
                    at + "Fx=20 M=100,M/(rFz),-\n"),
            "kind,id,inputs,output,unit,value,reason\n"
            "jamming_point,a," +
                at +
                "Fx=0 M=300,slides,bool,1,\n"
                "jamming_point,b," +
                at +
                "Fx=0 M=360,slides,bool,0,\n"
                "jamming_point,c," +
                at +
                "Fx=20 M=-100,slides,bool,1,\n"
                "jamming_point,d," +
                at +
                "Fx=20 M=100,slides,bool,0,\n"
                "jamming_point,e," +
                at +
                "Fx=20 N M=0.1 Nm,jams,bool,1,\n"
                "jamming_point,f," +
                at + "Fx=20 M=100,M/(rFz),-,1,\n");
  // The tilt that wedges: 40.009 = 40 cos t + 6 sin t.
  EXPECT_PRED_FORMAT2(
      ::testing::IsSubstring, ",0.08",
      Run("peg", "kind,id,inputs,output,unit\nwedging,a,D=40.009 d=40 mu=.15,theta_w,deg\n"));
}

// Spreadsheets of half the world write ; between cells and 40,0 for a number.
TEST_F(FitTable, TablesMayHaveSemicolonsAndDecimalCommas) {
  EXPECT_EQ(Run("limits", "nominal_mm;class\n40,0;H7\n"),
            "nominal_mm;class;kind;upper_um;lower_um;reason\n40,0;H7;hole;25;0;\n");
  const std::string header =
      "d_F_mm,D_hub_mm,U_eff_diametral_mm,L_mm,mu,E_hub_MPa,nu_hub,E_shaft_MPa,nu_shaft\n";
  EXPECT_PRED_FORMAT2(
      ::testing::IsSubstring, ",58.33333333,",
      Run("press", header + "\"100,0\",150,\"0,1\",50,\"0,15\",210000,0.3,210000,0.3\n"));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "L_mm is no number: \"\"fifty\"\"",
                      Run("press", header + "100,150,0.1,fifty,0.15,210000,0.3,210000,0.3\n"));
}

TEST_F(FitTable, RefusesWhatIsNoTableAndNamesTheLine) {
  const auto refuse = [&](const std::string& table, const std::string& text) {
    ExpectRefusal({"fit", "limits", "--batch", folder_.Write("in.csv", table)}, text);
  };
  refuse("", "is empty");
  refuse("size,class\n40,H7\n", "nominal_mm");
  refuse("nominal_mm,class\n40,H7,x\n", "in.csv:2");
  refuse("nominal_mm,class\n40,\"H7\n", "close each");
  ExpectRefusal({"fit", "limits", "--batch", folder_ / "none.csv"}, "none.csv");
  ExpectRefusal({"fit", "limits", "--batch", folder_.path().string()}, "is a folder");
}

TEST(FitCommand, SearchFindsTheFitOfARange) {
  const json found = RunHvasJson({"fit", "search", "--nominal", "40", "--min", "9", "--max", "50"});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0]["fit"], "H7/g6");
  ExpectRefusal({"fit", "search", "--nominal", "40", "--min", "50", "--max", "9"}, "no range");
}

}  // namespace
}  // namespace hvas::app
