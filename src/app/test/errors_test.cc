#include <algorithm>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ExpectRefusal;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;

/** A refusal in one line, which is not for the way in which the command was written. */
void ExpectError(const std::vector<std::string>& arguments, const std::vector<std::string>& texts) {
  const Ran ran = ExpectRefusal(arguments, texts);
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}

TEST(MissingFileTest, IsWhatEachCommandNamesFirst) {
  const TemporaryFolder folder;
  const std::string record = (folder / "run.hvasrec").string();
  const std::string table = (folder / "run.csv").string();
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"export", record, "-o", table},
           {"replay", record},
           {"report", record, "-o", (folder / "run.html").string()},
           {"studio", record, "--no-open"}}) {
    ExpectError(arguments, {record + ": there is no such", "(check the path)"});
  }
}

class BadFileTest : public ::testing::TestWithParam<const char*> {};

TEST_P(BadFileTest, ErrorNamesTheFileAndWhatToDo) {
  const TemporaryFolder folder;
  const std::string command = GetParam();
  ExpectError({command, "no such file.step"}, {"no such file.step", "(check the path)"});
  ExpectError({command, folder.path().string()}, {folder.path().string(), "not a file", "STEP"});
  const auto text = folder.Write("letter.step", "Dear all,\nthis is no product.\n");
  ExpectError({command, text.string()},
              {"letter.step", "neither a STEP file, nor an IGES file, nor a mesh", "AP242"});
  const auto nothing = folder.Write("nothing.step", "");
  ExpectError({command, nothing.string()}, {"nothing.step"});
  const auto empty =
      folder.Write("empty.step",
                   "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('nothing'),'2;1');\n"
                   "FILE_NAME('empty.step','2024-01-01T00:00:00',(''),(''),'','','');\n"
                   "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\n"
                   "DATA;\nENDSEC;\nEND-ISO-10303-21;\n");
  ExpectError({command, empty.string()}, {"empty.step", "no product", "export the file again"});
  // The first half of a real file.
  const std::string whole = testing::ReadText(ProductFile("bushing"));
  const auto half = folder.Write("half.step", whole.substr(0, whole.size() / 2));
  ExpectError({command, half.string()}, {"half.step"});
}

TEST_P(BadFileTest, BadSideFileIsNamed) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(ProductFile("bushing"), folder / "rig.step");
  (void)folder.Write("rig.hvas.json", "{\"format\": \"hvas-assignments-1\", \"fits\": 7}");
  ExpectError({GetParam(), (folder / "rig.step").string()}, {"rig.hvas.json"});
}

INSTANTIATE_TEST_SUITE_P(Commands, BadFileTest, ::testing::Values("inspect", "assemble"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(AssembleErrorTest, FitThatCannotBeAssignedIsNamed) {
  const std::string file = ProductFile("bushing");
  ExpectError({"assemble", file, "--fit", "spindle=H7/p6"}, {"\"spindle\"", "hvas inspect"});
  ExpectError({"assemble", file, "--fit", "shaft=H7/q99"}, {"\"q99\"", "H7"});
  ExpectError({"assemble", file, "--fit", "shaft"}, {"\"shaft\"", "AXIS=H7/p6"});
  ExpectError({"assemble", file, "--fit", "m99=H7/p6"}, {"m99"});
}

TEST(InspectErrorTest, NamesThatAreNotThereAreAnsweredWithTheNearest) {
  const std::string file = ProductFile("bushing");
  ExpectError({"inspect", file, "--only", "tree,mats"}, {"\"mats\"", "--only", "diagnostics"});
  ExpectError({"inspect", file, "--part", "chuk"},
              {"\"chuk\"", "--part", "did you mean \"chuck\"?"});
  ExpectError({"inspect", file, "--occurrence", "shafts"}, {"did you mean \"shaft\"?"});
  ExpectError({"inspect", file, "--mate", "m99"}, {"m99"});
  ExpectError({"inspect", file, "--kind", "weld"}, {"\"weld\"", "cone-seat"});
}

TEST(AssembleErrorTest, UnknownPartInTheOrderIsNamed) {
  ExpectError({"assemble", ProductFile("bushing"), "--order", "shaft,spindle"},
              {"bushing.step", "'spindle'", "hvas inspect"});
}

TEST(AssembleErrorTest, RecordThatCannotBeWrittenIsNamed) {
  const TemporaryFolder folder;
  const std::string missing = (folder / "missing" / "session.hvasrec").string();
  ExpectError({"assemble", ProductFile("bushing"), "--record", missing}, {missing, "folder"});
  ExpectError({"assemble", ProductFile("bushing"), "--record", folder.path().string()},
              {folder.path().string()});
  // What somebody else has written is kept.
  const auto letter = folder.Write("letter.txt", "Dear all,\n");
  ExpectError({"assemble", ProductFile("bushing"), "--record", letter.string()},
              {"letter.txt", "another file name"});
  EXPECT_EQ(testing::ReadText(letter), "Dear all,\n");
}

TEST(UsageTest, WrongUsageIsAnErrorWithHelp) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"paint"},
        {"assemble"},
        {"inspect"},
        {"assemble", ProductFile("bushing"), "--condition", "soft"},
        {"assemble", ProductFile("bushing"), "--seed", "one"},
        {"assemble", ProductFile("bushing"), "--limit", "-3"},
        {"assemble", ProductFile("bushing"), "--frobnicate"}}) {
    const Ran ran = RunHvas(arguments);
    SCOPED_TRACE(arguments.back());
    EXPECT_EQ(ran.status, 64);
    EXPECT_EQ(ran.out, "");
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--help", ran.err);
  }
}

TEST(UsageTest, HelpIsAnAnswerAndNamesTheExitStatus) {
  const Ran ran = RunHvas({"assemble", "--help"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "Exit status: 0 when every part is in its place",
                      ran.out);
}

TEST(AssembleErrorTest, RunThatIsStoppedSaysWhichPartsAreMissing) {
  const nlohmann::json run =
      testing::RunHvasJson({"assemble", ProductFile("bushing"), "--limit", "5"}, 2);
  EXPECT_EQ(run["seated"], 1);
  EXPECT_EQ(run["session_s"], 5.0);
  ASSERT_EQ(run["parts"].size(), 3u);
  for (const nlohmann::json& part : run["parts"]) {
    EXPECT_EQ(part["seated"].get<bool>(), part["reason"] == "") << part.dump();
  }
  const Ran ran = RunHvas({"assemble", ProductFile("bushing"), "--limit", "5"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "NOT IN PLACE: the run reached its limit of 5 s",
                      ran.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "1 of 3 parts in place", ran.out);
}

}  // namespace
}  // namespace hvas::app
