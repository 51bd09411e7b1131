// The rig of W7 put together by contact alone: no mate guides, the parts have the sizes that were
// drawn from their tolerance zones (W1, W2).

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"

namespace hvas::app {
namespace {

constexpr int kNotAllSeated = 2;  // exit status

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
