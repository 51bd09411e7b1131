// hvas disassemble: products are taken apart, and single parts got out of them (X16).

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ExpectRefusal;
using ::testing::IsSubstring;
using testing::ProductFile;
using testing::RunHvas;
using testing::RunHvasJson;

/** Last part of a path. */
std::string NameOf(const json& part) {
  const std::string path = part["name"];
  return path.substr(path.rfind('/') + 1);
}

std::vector<std::string> NamesOf(const json& parts) {
  std::vector<std::string> names;
  for (const json& part : parts) {
    names.push_back(NameOf(part));
  }
  return names;
}

/** Every part of a product comes off its base, after those that it waited for, by the forces of the
 fits. */
void ExpectIsTakenApart(const std::string& product, std::size_t parts, const std::string& base) {
  const json run = RunHvasJson({"disassemble", ProductFile(product)});
  EXPECT_EQ(run["out"], parts);
  EXPECT_EQ(run["parts"].size(), parts);
  EXPECT_PRED_FORMAT2(IsSubstring, base, run["base"].get<std::string>());
  std::vector<std::string> gone;
  for (const json& part : run["parts"]) {
    EXPECT_TRUE(part["out"].get<bool>()) << part.dump(1);
    EXPECT_LE(part["deepest_um"].get<double>(), 50) << part["name"];
    for (const json& other : part["waits_for"]) {
      EXPECT_NE(std::find(gone.begin(), gone.end(), other["name"]), gone.end())
          << part["name"] << " comes before " << other["name"];
    }
    gone.push_back(part["name"]);
    // What the hand meets is what the fits say.
    const double breakaway = part["breakaway_n"];
    const double met = part["fit_true_n"];
    if (breakaway > 0) {
      EXPECT_NEAR(met / breakaway, 1, 0.02) << part["name"];
    } else {
      EXPECT_LT(met, 5) << part["name"];
    }
  }
}

TEST(DisassembleTest, X16BushingIsTakenApart) {
  ExpectIsTakenApart("bushing", 2, "chuck");
}

TEST(DisassembleReleaseTest, X16GearPumpIsTakenApartAndEachPartFollowsThoseItWaitedFor) {
  ExpectIsTakenApart("gear_pump", 37, "housing");
}

TEST(DisassembleTest, X16OilSealComesOutAfterTheSmallestSetAndTheRecordRunsAgain) {
  const TemporaryFolder folder;
  const std::string record = (folder / "seal.hvasrec").string();
  const std::vector<std::string> arguments{"disassemble", ProductFile("gear_pump"), "--part",
                                           "oil seal"};
  std::vector<std::string> recorded = arguments;
  recorded.insert(recorded.end(), {"--record", record});
  const json run = RunHvasJson(recorded);
  // The key stays on the shaft, and the screws in the cover.
  EXPECT_EQ(NamesOf(run["parts"]),
            (std::vector<std::string>{"end screw", "end disc", "coupling hub", "oil seal"}));
  EXPECT_TRUE(run["smallest"].get<bool>());
  EXPECT_EQ(run["out"], 4);
  const json& seal = run["parts"][3];
  EXPECT_EQ(NamesOf(seal["waits_for"]), (std::vector<std::string>{"coupling hub", "end disc"}));
  ASSERT_EQ(seal["way"].size(), 1u);
  EXPECT_NEAR(seal["way"][0]["direction"][2].get<double>(), 1, 1e-9);
  EXPECT_EQ(RunHvasJson(arguments)["digest"], run["digest"]);
  const testing::Ran replay = RunHvas({"replay", record, "--verify"});
  EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
  std::vector<std::string> seeded = arguments;
  seeded.insert(seeded.end(), {"--seed", "2"});
  EXPECT_NE(RunHvasJson(seeded)["digest"], run["digest"]);
}

TEST(DisassembleTest, X16PressFitBreaksLooseNearTheForceOfItsClosedForm) {
  const json run = RunHvasJson({"disassemble", ProductFile("bushing"), "--fit", "shaft=H7/p6",
                                "--part", "shaft", "--operator", "person"});
  ASSERT_EQ(run["parts"].size(), 1u);
  const json& shaft = run["parts"][0];
  EXPECT_TRUE(shaft["out"].get<bool>());
  EXPECT_GT(shaft["breakaway_n"].get<double>(), 1000);
  EXPECT_NEAR(shaft["fit_true_n"].get<double>() / shaft["breakaway_n"].get<double>(), 1, 0.01);
  EXPECT_LE(shaft["peak_felt_n"].get<double>(), 7.9 + 1e-9);
}

TEST(DisassembleTest, X16EmulatedDeviceIsEnoughToDrawAPressFitOut) {
  const json run = RunHvasJson({"disassemble", ProductFile("bushing"), "--part", "shaft",
                                "--device", "emulated:openhaptics"});
  EXPECT_EQ(run["out"], 1);
  EXPECT_TRUE(run["device"]["emulated"].get<bool>());
}

TEST(DisassembleTest, X16RefusalsNameTheFileThePartAndTheRemedy) {
  const std::string pump = ProductFile("gear_pump");
  ExpectRefusal({"disassemble", pump, "--part", "oil sael"},
                {"gear_pump.step", "oil sael", "did you mean \"oil seal\""});
  ExpectRefusal({"disassemble", pump, "--part", "housing"},
                {"gear_pump.step", "housing is the base, which stays in the fixture", "--part"});
  ExpectRefusal({"disassemble", pump, "--part", "cover", "--record", pump}, {"gear_pump.step"});
}

}  // namespace
}  // namespace hvas::app
