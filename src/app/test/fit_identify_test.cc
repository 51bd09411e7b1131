// How forces of fits are shown: `hvas fit identify`, `hvas assemble --force-map`.

#include <string>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "fits/paper_scales.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using testing::ProductFile;
using testing::RunHvas;
using testing::RunHvasJson;

// W12, N4: every fit is told more often than by the paper's people, and it says that it is no
// people.
TEST(FitIdentifyTest, TellsFitsApartAndSaysThatItIsSimulated) {
  const json run = RunHvasJson({"fit", "identify", "--trials", "400", "--seed", "1"});
  EXPECT_EQ(run["schema"], "hvas-fit-identify-1");
  EXPECT_NE(run["what"].get<std::string>().find("simulated"), std::string::npos);
  EXPECT_EQ(run["force_map"], "published");
  ASSERT_EQ(run["fits"].size(), 3u);
  for (const json& fit : run["fits"]) {
    EXPECT_GT(fit["right_share"], fit["paper_right_share"]) << fit.dump(1);
    int answers = 0;
    for (const auto& [name, count] : fit["answers"].items()) {
      answers += count.get<int>();
    }
    EXPECT_EQ(answers, 400);
    EXPECT_LT(fit["right_share_95"][0], fit["right_share"]);
    EXPECT_GT(fit["right_share_95"][1], fit["right_share"].get<double>() - 1e-9);
  }
  EXPECT_EQ(run, RunHvasJson({"fit", "identify", "--trials", "400", "--seed", "1"}));
}

TEST(FitIdentifyTest, RefusesWhatIsNoExperiment) {
  const testing::Ran none = RunHvas({"fit", "identify", "--trials", "0"});
  EXPECT_EQ(none.status, 64);
  EXPECT_NE(none.err.find("--trials"), std::string::npos) << none.err;
  EXPECT_NE(RunHvas({"fit", "identify", "--force-map", "loud"}).status, 0);
}

// W9, W10, N4: true newtons are the same whatever the map; the paper's are k_r times them.
TEST(ForceMapTest, MapsChangeWhatIsFeltAndNotWhatIsTrue) {
  const auto press = [](const std::string& map) {
    const json run = RunHvasJson({"assemble", ProductFile("bushing"), "--fit", "shaft=H7/p6",
                                  "--force-map", map, "--operator", "person"});
    EXPECT_EQ(run["force_map"], map);
    EXPECT_EQ(run["seated"], 3);
    return run["parts"][2];
  };
  const json published = press("published");
  const json paper = press("paper");
  const double truth = published["fit_true_n"];
  EXPECT_GT(truth, 10'000);
  EXPECT_NEAR(paper["fit_true_n"], truth, 0.01 * truth);
  const double factor = fits::FindPaperScale(fits::FitKind::kInterference).factor;
  EXPECT_NEAR(paper["fit_felt_n"], factor * truth, 0.5);
  EXPECT_LT(published["fit_felt_n"], 7.9);
  EXPECT_NE(published["fit_felt_n"], paper["fit_felt_n"]);
}

}  // namespace
}  // namespace hvas::app
