#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/odd_files.h"
#include "base/test/temporary_folder.h"
#include "cad/test/greedy_files.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ExpectRefusal;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;

/** A command with the file that it is given, which stands where FILE does. */
using Arguments = std::vector<std::string>;

TEST(OddFileTest, EveryCommandNamesWhatIsNoFileAndWaitsForNothing) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out.csv").string();
  const std::string page = (folder / "out.html").string();
  const std::string product = ProductFile("bushing");

  struct Case {
    std::string name;  // The file's.
    Arguments arguments;
  };

  const std::vector<Case> cases{
      {"x.step", {"inspect", "FILE"}},
      {"x.step", {"inspect", "FILE", "--json"}},
      {"x.step", {"mate", "list", "FILE"}},
      {"x.step", {"mate", "remove", "FILE", "m0"}},
      {"x.step", {"export", "FILE", "-o", (folder / "out.glb").string()}},
      {"x.step", {"assemble", "FILE"}},
      {"x.step", {"path", "FILE", "--part", "shaft", "--translate", "0,0,9", "-o", out}},
      {"x.stl", {"inspect", "FILE"}},
      {"x.gltf", {"inspect", "FILE"}},
      {"x.hvasrec", {"replay", "FILE"}},
      {"x.hvasrec", {"report", "FILE", "-o", page}},
      {"x.hvasrec", {"export", "FILE", "-o", out}},
      {"x.hvasrec", {"path", product, "--part", "shaft", "--record", "FILE", "-o", out}},
      {"x.json", {"export", product, "--poses", "FILE", "-o", (folder / "out.glb").string()}},
      {"x.csv", {"fit", "limits", "--batch", "FILE"}},
      {"x.csv", {"fit", "press", "--batch", "FILE"}},
      {"x.csv", {"study", "analyse", "--table", "FILE"}},
      {"x.csv", {"fit", "40 H7/k6", "--length", "50", "--sizes", "FILE", "--curve", out}},
      {"x.yaml", {"study", "check", "FILE"}},
      {"x.yaml", {"study", "run", "FILE", "-o", (folder / "study").string()}},
      {"x.pem",
       {"studio", "--no-open", "--listen", "127.0.0.1", "--certificate", "FILE", "--key", "FILE"}},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const auto& odd : hvas::testing::MakeOddFiles(folder / std::to_string(i), cases[i].name)) {
      Arguments arguments = cases[i].arguments;
      std::replace(arguments.begin(), arguments.end(), std::string("FILE"), odd.path.string());
      ExpectRefusal(arguments, {odd.path.string(), "this is " + odd.kind + ", not a file", "("});
    }
  }
}

TEST(OddFileTest, SideFileThatIsNoFileIsNamedAndNotWaitedFor) {
  const TemporaryFolder folder;
  for (const auto& odd : hvas::testing::MakeOddFiles(folder.path(), "rig.hvas.json")) {
    const std::string product = (odd.path.parent_path() / "rig.step").string();
    std::filesystem::copy_file(ProductFile("bushing"), product);
    for (const Arguments& arguments :
         {Arguments{"inspect", product}, Arguments{"assemble", product},
          Arguments{"mate", "list", product},
          Arguments{"inspect", product, "--write-assignments", "--force"},
          Arguments{"export", product, "-o", (folder / "out.glb").string()}}) {
      ExpectRefusal(arguments, {odd.path.string(), "this is " + odd.kind + ", not a file"});
    }
  }
  // Nor is a link that leads nowhere taken for no side file.
  std::filesystem::copy_file(ProductFile("bushing"), folder / "rig.step");
  std::filesystem::create_symlink("nowhere", folder / "rig.hvas.json");
  ExpectRefusal({"inspect", (folder / "rig.step").string()}, {"rig.hvas.json", "no such file"});
}

TEST(GreedyFileTest, ThousandsOfPartsAtOnePlaceAreOpenedWhenTheyAreAllowed) {
  const TemporaryFolder folder;
  const std::string file =
      folder.Write("many.gltf", cad::testing::MakeManyNodesGltf(20'000)).string();
  const Ran refused = RunHvas({"inspect", file});
  EXPECT_EQ(refused.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "many.gltf: the file places more than 16384 parts",
                      refused.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--max-parts", refused.err);
  const auto report =
      testing::RunHvasJson({"inspect", file, "--max-parts", "20000", "--only", "diagnostics"});
  const auto& diagnostics = report["diagnostics"];
  const auto duplicate = std::find_if(diagnostics.begin(), diagnostics.end(), [](const auto& item) {
    return item["code"] == "duplicate-part";
  });
  ASSERT_NE(duplicate, diagnostics.end());
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "19999 copies",
                      (*duplicate)["message"].template get<std::string>());
}

TEST(GreedyFileReleaseTest, PartsThatAreMatedForTooLongOrTakeTooMuchAreNamedWithTheRemedy) {
  // Each a little beside the other, so that each pair has to be looked at.
  const TemporaryFolder folder;
  const std::string file =
      folder.Write("many.gltf", cad::testing::MakeManyNodesGltf(16'000, 1e-7)).string();
  for (const auto& [option, value] :
       {std::pair("--time-limit", "20"), {"--memory-limit", "600MB"}}) {
    const Ran ran = RunHvas({"inspect", file, option, value});
    EXPECT_EQ(ran.status, 1);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "many.gltf: finding the mates", ran.err);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, option, ran.err);
  }
}

}  // namespace
}  // namespace hvas::app
