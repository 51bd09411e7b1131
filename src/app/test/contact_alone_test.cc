// The rig of W7 put together by contact alone: no mate guides, the parts have the sizes that were
// drawn from their tolerance zones (W1, W2).

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

constexpr int kNotAllSeated = 2;  // exit status

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ProductFile;
using testing::RunHvasJson;

TEST(ContactAlone, TheBushingWithItsFitsGoesInWithoutAMate) {
  std::set<std::string> digests;
  for (const int seed : {1, 2, 3}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const json run = RunHvasJson({"assemble", ProductFile("bushing"), "--condition", "collision",
                                  "--fit", "shaft=H7/g6", "--seed", std::to_string(seed)});
    EXPECT_EQ(run["seated"], 3);
    for (const json& part : run["parts"]) {
      EXPECT_TRUE(part["seated"].get<bool>()) << part.dump(1);
      EXPECT_LT(part["pose_error_um"].get<double>(), 1) << part["name"];
    }
    digests.insert(run["digest"].get<std::string>());
  }
  EXPECT_EQ(digests.size(), 3U);
}

// L: a careful hand brings a shaft of 40 mm in with 9 um of play that touches its hole, whatever
// the seed: it gives way until it feels neither force nor torque across, and only then goes in.
TEST(ContactAlone, ACarefulHandDoesNotWedgeAShaftWithLittlePlay) {
  const TemporaryFolder folder;
  const auto product = folder.path() / "bushing.step";
  std::filesystem::copy_file(ProductFile("bushing"), product);
  std::ofstream(folder.path() / "bushing.hvas.json") << R"({"format": "hvas-assignments-1",
    "fits": [{"hole": "chuck", "shaft": "bushing", "diameter_mm": 80, "fit": "H7/h6"},
             {"hole": "bushing", "shaft": "shaft", "hole_diameter_mm": 40.009,
              "shaft_diameter_mm": 40}]})";
  for (const char* seed : {"1", "2", "3", "4", "5", "6", "7", "8"}) {
    const json run =
        RunHvasJson({"assemble", product.string(), "--contact-in-holes", "--seed", seed});
    const json& shaft = run["parts"][2];
    EXPECT_TRUE(shaft["seated"].get<bool>()) << seed << " " << shaft["reason"];
    EXPECT_LT(shaft["time_s"].get<double>(), 20) << seed;
    EXPECT_LT(shaft["deepest_um"].get<double>(), 20) << seed;
  }
}

// Press fits have no room for contact to find: nothing pretends that they went in by it.
TEST(ContactAlone, APartWithoutItsPartnerIsNotSeatedInMidAir) {
  // With interference in the chuck the bushing stays outside, and then the shaft has no hole.
  const json run = RunHvasJson({"assemble", ProductFile("bushing"), "--condition", "collision",
                                "--fit", "bushing=H7/s6", "--seed", "1"},
                               kNotAllSeated);
  EXPECT_EQ(run["seated"], 1);
  for (const json& part : run["parts"]) {
    EXPECT_EQ(part["seated"].get<bool>(), part["reason"].get<std::string>().empty());
  }
}

}  // namespace
}  // namespace hvas::app
