// What the program prints for people at a terminal of 80 columns.

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "app/output/text_layout.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;
using testing::RunHvasAtTerminal;
using testing::WithoutControls;

constexpr const char* kResults = HVAS_SOURCE_DIR "/data/studies/identification-2016.csv";

void ExpectWithin80(const std::vector<std::string>& arguments) {
  std::string command = "hvas";
  for (const std::string& argument : arguments) {
    command += " " + argument;
  }
  SCOPED_TRACE(command);
  const Ran ran = RunHvasAtTerminal(80, arguments);
  EXPECT_GE(ran.status, 0);
  EXPECT_LE(ran.status, 2) << ran.out;
  EXPECT_FALSE(ran.out.empty());
  std::istringstream lines(WithoutControls(ran.out));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(CalcWidth(line), 80U) << line;
  }
}

TEST(Width, OfFitsIs80) {
  const std::vector<std::vector<std::string>> runs{
      {"40", "H7/p6"},
      {"40", "H7/p6", "--length", "50", "--hub", "80", "--hub-temp", "200"},
      {"40", "H7/p6", "--length", "50", "--hub-material", "GJL-250", "--bore", "12", "--rz", "6.3"},
      {"40", "H7/g6", "--length", "50", "--unit", "in", "--chamfer-width", "0.5"},
      {"1.5in", "H7/k6", "--length", "2in", "--rz", "6.3", "--population", "5000"},
      {"40", "H7/p6", "35", "H7/k6", "--length", "20,30", "--start", "0,40", "--population",
       "5000"},
      {"limits", "--help"},
      {"search", "--nominal", "40", "--min", "5", "--max", "60"},
      {"search", "--nominal", "1.5in", "--min", "5", "--max", "60", "--unit", "in"},
      {"design", "--nominal", "40", "--length", "50", "--hub", "80", "--torque", "200"},
      {"design", "--nominal", "40", "--length", "50", "--torque", "50", "--hub-material", "GJL-250",
       "--hub", "100"},
      {"materials"},
      {"friction"},
      {"paper"},
      {"identify", "--trials", "30"}};
  for (std::vector<std::string> run : runs) {
    run.insert(run.begin(), "fit");
    ExpectWithin80(run);
  }
  const TemporaryFolder folder;
  ExpectWithin80({"fit", "40", "H7/g6", "--length", "50", "--jamming",
                  (folder / "jam.svg").string(), "--at", "20", "--load", "5,20,100"});
}

TEST(Width, OfProductsIs80) {
  for (const char* name : {"bushing", "gear_pump", "frame_500"}) {
    ExpectWithin80({"inspect", ProductFile(name)});
    ExpectWithin80({"inspect", ProductFile(name), "--only", "faces,features,mates"});
    ExpectWithin80({"mate", "list", ProductFile(name)});
  }
}

TEST(Width, OfAssemblyAndPathIs80) {
  const TemporaryFolder folder;
  const std::string record = (folder / "run.hvasrec").string();
  ExpectWithin80({"assemble", ProductFile("bushing"), "--record", record});
  ExpectWithin80({"assemble", ProductFile("bushing"), "--limit", "5"});
  ExpectWithin80({"disassemble", ProductFile("gear_pump"), "--part", "oil seal"});
  ExpectWithin80({"plan", ProductFile("gear_pump")});
  ExpectWithin80({"disassemble", ProductFile("bushing"), "--limit", "5"});
  ExpectWithin80({"tool", ProductFile("gear_pump")});
  const std::string way = (folder / "way.csv").string();
  ExpectWithin80(
      {"path", ProductFile("bushing"), "--part", "shaft", "--record", record, "-o", way});
}

TEST(Width, OfStudiesIs80) {
  ExpectWithin80({"study", "analyse", "--table", kResults, "--of", "15"});
  const TemporaryFolder folder;
  const auto answers = folder.Write("answers.csv",
                                    "participant,shown,answered\n1,H7/g6,H7/g6\n1,H7/p6,H7/g6\n"
                                    "2,H7/g6,H7/g6\n2,H7/p6,H7/p6\n");
  ExpectWithin80({"study", "analyse", "--table", answers.string()});
  ExpectWithin80(
      {"study", "power", "--means", "0,1", "--sd", "1", "--test", "wilcoxon", "--runs", "200"});
  ExpectWithin80({"study", "check", "xia-2011"});
}

TEST(Width, OfMachineAndProgramIs80) {
  ExpectWithin80({"devices"});
  ExpectWithin80({"devices", "--try", "emulated:openhaptics", "--seconds", "0.6"});
  ExpectWithin80({"doctor", "--seconds", "0.2"});
  ExpectWithin80({"licences", "--list"});
  ExpectWithin80({"licences"});
}

}  // namespace
}  // namespace hvas::app
