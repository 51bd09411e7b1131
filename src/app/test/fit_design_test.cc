#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using testing::ExpectRefusal;
using testing::Ran;
using testing::RunHvas;
using testing::RunHvasJson;

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
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "cannot be assembled", cold.out);
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
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "by cold: impossible", text.out);
  // A tempered hub bears 200 C, and 206 C are needed.
  const json hard = RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--hub-material", "16MnCr5",
                                 "--hub", "80", "--hub-temp", "210"});
  EXPECT_TRUE(hard["joining"]["heat_hub_to_c"].is_null());
  EXPECT_EQ(hard["joining"]["asked"]["is_hub_too_hot"], true);
  // Little interference: cold alone does it.
  EXPECT_NEAR(RunHvasJson({"fit", "40 H7/k6", "--length", "50"})["joining"]["cool_shaft_to_c"]
                  .get<double>(),
              20 - 58 / (40e3 * 8.5e-6), 0.005);
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--shaft-temp", "-230"}, {"liquid nitrogen"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--shaft-temp", "-300"}, {"absolute zero"});
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
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "E=210"},
                {"needs both E and nu"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "S355 Re=-4"}, {"Re=-4"});
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "S355 colour=4"}, {"colour=4"});
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
  ExpectRefusal({"fit", "design", "--nominal", "40", "--length", "50"}, {"--torque or --axial"});
  ExpectRefusal({"fit", "design", "--nominal", "40", "--length", "5", "--torque", "9000"},
                {"yields"});
}

TEST(FitCommand, MaterialsAreListedWithWhatFitsTakeOfThem) {
  const json materials = RunHvasJson({"fit", "materials"});
  EXPECT_GE(materials.size(), 40U);
  EXPECT_EQ(materials[1]["name"], "S355JR");
  EXPECT_NEAR(materials[1]["cooling_per_k"].get<double>(), 8.5e-6, 1e-12);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "42CrMo4", RunHvas({"fit", "materials"}).out);
}

TEST(FitCommand, FrictionSaysWhereEachCoefficientIsFrom) {
  const json rows = RunHvasJson({"fit", "friction"});
  EXPECT_GE(rows.size(), 40U);
  EXPECT_FALSE(rows[0]["source"].get<std::string>().empty());
  const Ran card = RunHvas({"fit", "40 H7/p6", "--length", "50", "--hub-material", "EN-GJL-250"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring,
                      "mu 0.12 for pressing in, 0.12 for holding, 0.11 for sliding out",
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

}  // namespace
}  // namespace hvas::app
