#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ExpectRefusal;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;

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
      "40,Q7,,,,\"\"\"Q7\"\" is not a tolerance class; write letters and grade, for example H7 or "
      "js6\"\n"
      "ten,H7,,,,\"nominal_mm is not a number; write millimetres, or inches with their unit: 1.5 "
      "in\"\n"
      "1.5 in,H7,hole,25,0,\n"
      "4E+1,H7,hole,25,0,\n"
      ",H7,,,,nominal_mm is missing\n"
      "-5,H7,hole,,,\"'-5 mm is not a nominal size of ISO 286; give a diameter above 0 and up to "
      "3150 "
      "mm\"\n"
      "0,H7,hole,,,\"0 mm is not a nominal size of ISO 286; give a diameter above 0 and up to 3150 "
      "mm\"\n"
      "4000,H7,hole,,,\"4000 mm is not a nominal size of ISO 286; give a diameter above 0 and up "
      "to "
      "3150 "
      "mm\"\n");
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
            "two_point,e,D=20 l=10,theta2,rad,,the input d is missing or not a number\n"
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
  refuse("two_point,a,D=20 d=19.9 l=nan,theta2,rad", "l is not a number");
  refuse("two_point,a,D=20 d=19.9 l=1,theta2,rad", "no two-point contact: l is at least 1.9975");
  refuse("two_point,a,D=20 d=19.9 l=10 furlong,theta2,rad", "unit \"\"furlong\"\"");
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
  refuse("chamfer,e,Kx=10 Kt=50000 Lg=50 r=10 mu=0.9 alpha=30 deg z=1,Fz,N",
         "tan alpha of the chamfer has to be above mu");
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
            "two_point;a;\"D=2 cm d=19900 um l=10,0\";theta2;deg;0.5787850718;\n"
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
            "nominal_mm;class;kind;upper_um;lower_um;reason\n\"40,0\";H7;hole;25;0;\n");
  const std::string header =
      "d_F_mm,D_hub_mm,U_eff_diametral_mm,L_mm,mu,E_hub_MPa,nu_hub,E_shaft_MPa,nu_shaft\n";
  EXPECT_PRED_FORMAT2(
      ::testing::IsSubstring, ",58.33333333,",
      Run("press", header + "\"100,0\",150,\"0,1\",50,\"0,15\",210000,0.3,210000,0.3\n"));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "L_mm is not a number: \"\"fifty\"\"",
                      Run("press", header + "100,150,0.1,fifty,0.15,210000,0.3,210000,0.3\n"));
}

TEST_F(FitTable, RefusesWhatIsNoTableAndNamesTheLine) {
  const auto refuse = [&](const std::string& table, const std::string& text) {
    ExpectRefusal({"fit", "limits", "--batch", folder_.Write("in.csv", table)}, {text});
  };
  refuse("", "is empty");
  refuse("size,class\n40,H7\n", "nominal_mm");
  refuse("nominal_mm,class\n40,H7,x\n", "in.csv:2");
  refuse("nominal_mm,class\n40,\"H7\n", "close each");
  ExpectRefusal({"fit", "limits", "--batch", folder_ / "none.csv"}, {"none.csv"});
  ExpectRefusal({"fit", "limits", "--batch", folder_.path().string()}, {"is a folder"});
}

}  // namespace
}  // namespace hvas::app
