// Parts at one place are told from each other by the program, and stay apart when the user wants
// it.

#include <string>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "cad/test/greedy_files.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ExpectRefusal;
using testing::RunHvasJson;

TEST(WeldedUnitsProgram, LeavesCopiesOutSaysSoAndIsRevokedByOptionAndSideFile) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("many.gltf", cad::testing::MakeManyNodesGltf(3)).string();
  const auto welded = RunHvasJson({"inspect", file});
  ASSERT_EQ(welded["occurrences"].size(), 1u);
  EXPECT_EQ(welded["occurrences"][0]["bodies"].size(), 3u);
  bool is_noted = false;
  for (const auto& item : welded["diagnostics"]) {
    is_noted = is_noted || (item["code"] == "duplicate-part" && item["severity"] == "note");
  }
  EXPECT_TRUE(is_noted);
  EXPECT_EQ(RunHvasJson({"inspect", file, "--apart", "all"})["occurrences"].size(), 3u);
  ExpectRefusal({"inspect", file, "--apart", "n9"}, {"n9", "many.gltf"});

  folder.Write("many.hvas.json",
               R"({"format": "hvas-assignments-2", "apart": [{"unit": "n1", "note": "ours"}]})");
  const auto apart = RunHvasJson({"inspect", file});
  ASSERT_EQ(apart["occurrences"].size(), 3u);
  EXPECT_TRUE(apart["occurrences"][0]["bodies"].empty());

  folder.Write("many.hvas.json",
               "{\"format\": \"hvas-assignments-2\",\n\"apart\": [{\"unit\": \"n9\"}]}");
  ExpectRefusal({"inspect", file}, {"n9", "many.hvas.json:2, apart 1"});
}

}  // namespace
}  // namespace hvas::app
