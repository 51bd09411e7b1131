#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

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
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, ran.err);
}

// N4: the card of paper W's interference fit; 77,931.13 N at the largest interference.
TEST(FitCommand, CardOfAPressFitHasTheClosedForms) {
  const json card = RunHvasJson({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--material",
                                 "S355", "--smoothing", "none"});
  EXPECT_EQ(card["kind"], "interference");
  EXPECT_NEAR(card["min_clearance_um"].get<double>(), -42, 1e-9);
  EXPECT_NEAR(card["max_clearance_um"].get<double>(), -1, 1e-9);
  EXPECT_NEAR(card["press"]["most"]["press_in_force_n"].get<double>(), 77931.13, 0.01);
  EXPECT_NEAR(card["press"]["mean"]["pressure_mpa"].get<double>(), 42.328, 1e-3);
  EXPECT_GT(card["press"]["most"]["margin_tresca"].get<double>(), 1);
  const Ran text = RunHvas({"fit", "40 H7/p6", "--length", "50", "--smoothing", "none"});
  EXPECT_EQ(text.status, 0);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "77931.1", text.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "heat the hub to", text.out);
}

TEST(FitCommand, CardTakesOneClassAndInches) {
  EXPECT_NEAR(RunHvasJson({"fit", "40 H7"})["hole"]["upper_um"].get<double>(), 25, 1e-9);
  EXPECT_NEAR(RunHvasJson({"fit", "1.5in H7/g6"})["nominal_mm"].get<double>(), 38.1, 1e-9);
  EXPECT_EQ(RunHvasJson({"fit", "40 H7/k6"})["kind"], "transition");
}

TEST(FitCommand, PopulationSaysHowManyWillNotBeHeldByThePress) {
  const std::vector<std::string> arguments{"fit",     "40 H7/k6", "--length",     "50",
                                           "--rz",    "6.3",      "--population", "20000",
                                           "--press", "20000",    "--seed",       "3"};
  const json first = RunHvasJson(arguments)["population"];
  EXPECT_EQ(first["count"], 20000);
  EXPECT_NEAR(first["mean_clearance_um"].get<double>(), 2.5, 0.2);
  EXPECT_EQ(first["force"].size(), 21U);
  EXPECT_GT(first["over_press_share"].get<double>(), 0);
  EXPECT_EQ(RunHvasJson(arguments)["population"], first);
}

TEST(FitCommand, RefusalsSayWhatAFitLooksLike) {
  ExpectRefusal({"fit", "H7/p6"}, "40 H7/p6");
  ExpectRefusal({"fit", "40 H7/p66"}, "no tolerance class");
  ExpectRefusal({"fit", "4000 H7/p6"}, "3150");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--material", "cheese"}, "cheese");
  ExpectRefusal({"fit", "40 H7/p6", "--length", "50", "--hub", "30"}, "outer diameter");
  ExpectRefusal({"fit", "40 H7/p6", "--population", "10"}, "length");
  ExpectRefusal({"fit"}, "a fit");
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
          "nominal_mm,class\n40,H7\n40,g6\n280,M6\n3,js7\n30.001,H7\n40,N01\n40,Q7\nten,H7\n"),
      "nominal_mm,class,kind,upper_um,lower_um,reason\n"
      "40,H7,hole,25,0,\n"
      "40,g6,shaft,-9,-25,\n"
      "280,M6,hole,-9,-41,\n"
      "3,js7,shaft,5,-5,\n"
      "30.001,H7,hole,25,0,\n"
      "40,N01,hole,,,ISO 286 defines no class N01 at 40 mm; choose another class\n"
      "40,Q7,,,,\"\"\"Q7\"\" is no tolerance class; write letters and grade as in H7 or js6\"\n"
      "ten,H7,,,,nominal_mm is no number\n");
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

TEST_F(FitTable, RefusesWhatIsNoTableAndNamesTheLine) {
  const auto refuse = [&](const std::string& table, const std::string& text) {
    ExpectRefusal({"fit", "limits", "--batch", folder_.Write("in.csv", table)}, text);
  };
  refuse("", "is empty");
  refuse("size,class\n40,H7\n", "nominal_mm");
  refuse("nominal_mm,class\n40,H7,x\n", "in.csv:2");
  refuse("nominal_mm,class\n40,\"H7\n", "close each");
  ExpectRefusal({"fit", "limits", "--batch", folder_ / "none.csv"}, "none.csv");
}

TEST(FitCommand, SearchFindsTheFitOfARange) {
  const json found = RunHvasJson({"fit", "search", "--nominal", "40", "--min", "9", "--max", "50"});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0]["fit"], "H7/g6");
  ExpectRefusal({"fit", "search", "--nominal", "40", "--min", "50", "--max", "9"}, "no range");
}

}  // namespace
}  // namespace hvas::app
