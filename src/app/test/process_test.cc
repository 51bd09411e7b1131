#include <signal.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/await_true.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

namespace fs = std::filesystem;
using hvas::testing::TemporaryFolder;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;

/** The process that another has started, once it has; 0 when it never does. */
pid_t ChildOf(pid_t parent) {
  const std::string pid = std::to_string(parent);
  pid_t child = 0;
  const auto has_child = [&] {
    return static_cast<bool>(std::ifstream("/proc/" + pid + "/task/" + pid + "/children") >> child);
  };
  return hvas::testing::AwaitTrue(has_child) ? child : 0;
}

/** Whether a process is gone; one that waits to be reaped is. */
bool IsGone(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string word;
  std::string state;
  return !(stat >> word >> word >> state) || state == "Z" || state == "X";
}

/** /dev/full takes nothing, as a disk without room. */
class FullDiskTest : public ::testing::Test {
 protected:
  static void ExpectFailure(const std::vector<std::string>& arguments) {
    const Ran ran = testing::RunHvasInto("/dev/full", arguments);
    EXPECT_EQ(ran.status, 1) << arguments.front();
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "No space left on device", ran.err);
  }

  TemporaryFolder folder_;
};

TEST_F(FullDiskTest, OutputOfEveryCommandThatCannotBeWrittenIsAFailure) {
  ExpectFailure({"fit", "40 H7/p6"});
  ExpectFailure({"fit", "40 H7/p6", "--length", "50", "--json"});
  ExpectFailure({"fit", "40 H7/k6", "--length", "50", "--population", "1000", "--stations", "200",
                 "--json"});  // More than a buffer.
  ExpectFailure({"fit", "search", "--nominal", "40", "--min", "5", "--max", "60"});
  ExpectFailure(
      {"fit", "limits", "--batch", folder_.Write("classes.csv", "nominal_mm,class\n40,H7\n")});
  const std::string times =
      folder_.Write("times.csv", "participant,a,b\n1,2,3\n2,3,5\n3,2,6\n4,1,3\n");
  ExpectFailure({"study", "analyse", "--table", times, "--json"});
  ExpectFailure({"inspect", ProductFile("bushing"), "--json"});
  ExpectFailure({"mate", "list", ProductFile("bushing")});
  ExpectFailure({"--help"});
}

TEST_F(FullDiskTest, FailureSaysItsOwnReasonFirst) {
  const Ran ran = testing::RunHvasInto("/dev/full", {"fit", "H7/p6"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "not a nominal size with a fit", ran.err);
}

class EndTest : public ::testing::TestWithParam<int> {};

TEST_P(EndTest, ProgramThatIsEndedWhileItReadsLeavesNoProcess) {
  const pid_t hvas = testing::StartHvas({"inspect", ProductFile("frame_500"), "--no-cache"});
  ASSERT_GT(hvas, 0);
  const pid_t reader = ChildOf(hvas);
  EXPECT_GT(reader, 0);
  ::kill(hvas, GetParam());
  int status = 0;
  ::waitpid(hvas, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it had ended before";
  EXPECT_TRUE(hvas::testing::AwaitTrue([&] { return IsGone(reader); }));
}

INSTANTIATE_TEST_SUITE_P(Signals, EndTest, ::testing::Values(SIGINT, SIGKILL),
                         [](const auto& instance) {
                           return instance.param == SIGINT ? "Interrupt" : "Kill";
                         });

TEST(ReaderTest, IsFoundBesideTheProgramWhereverThatIs) {
  const TemporaryFolder folder;
  const fs::path bin = folder / "bin";
  fs::create_directory(bin);
  fs::copy_file(HVAS_BINARY, bin / "hvas");
  const std::string command = (bin / "hvas").string() + " inspect --no-cache " +
                              ProductFile("bushing") + " > " + (folder / "out").string() + " 2>&1";
  // A program that cannot be started instead of the reader shows where it is looked for.
  std::ofstream(bin / "hvas-cad") << "no program";
  fs::permissions(bin / "hvas-cad", fs::perms::owner_all);
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_NE(testing::ReadText(folder / "out").find((bin / "hvas-cad").string()), std::string::npos);
  fs::remove(bin / "hvas-cad");
  fs::create_symlink(fs::path(HVAS_READER), bin / "hvas-cad");
  EXPECT_EQ(std::system(command.c_str()), 0) << testing::ReadText(folder / "out");
}

TEST(StrictTest, WarningsAreShownAndEndWithStatusOne) {
  // A product a thousand times too large.
  std::string text = testing::ReadText(ProductFile("bushing"));
  const std::string unit = "SI_UNIT(.MILLI.,.METRE.)";
  ASSERT_NE(text.find(unit), std::string::npos);
  for (std::size_t at = 0; (at = text.find(unit)) != std::string::npos;) {
    text.replace(at, unit.size(), "SI_UNIT($,.METRE.)");
  }
  const TemporaryFolder folder;
  const std::string file = folder.Write("huge.step", text).string();
  EXPECT_EQ(RunHvas({"inspect", file}).status, 0);
  for (const char* command : {"inspect", "assemble"}) {
    const Ran ran = RunHvas({command, file, "--strict"});
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.out, "");
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "warning implausible-size [huge.step]", ran.err);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--strict", ran.err);
  }
  EXPECT_EQ(RunHvas({"inspect", ProductFile("bushing"), "--strict"}).status, 0);
}

/** Products in the cache of this test program. */
std::size_t CountKept() {
  std::error_code absent;
  std::size_t count = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(std::getenv("XDG_CACHE_HOME")) / "hvas", absent)) {
    count += entry.path().extension() == ".hvasproduct" ? 1 : 0;
  }
  return count;
}

TEST(CacheTest, KeepsWhatWasReadUnlessToldNotTo) {
  const TemporaryFolder folder;
  const std::string file =
      folder.Write("rig.step", testing::ReadText(ProductFile("bushing")) + "\n").string();
  const Ran anew = RunHvas({"inspect", file, "--no-cache"});
  EXPECT_EQ(anew.status, 0);
  const std::size_t before = CountKept();
  ::setenv("HVAS_CACHE", "off", 1);
  EXPECT_EQ(RunHvas({"inspect", file}).out, anew.out);
  ::unsetenv("HVAS_CACHE");
  EXPECT_EQ(CountKept(), before);
  EXPECT_EQ(RunHvas({"inspect", file}).out, anew.out);
  EXPECT_EQ(CountKept(), before + 1);
  EXPECT_EQ(RunHvas({"inspect", file}).out, anew.out);
  EXPECT_EQ(CountKept(), before + 1);
}

TEST(LimitTest, FileThatTakesTooLongIsNamedWithTheRemedy) {
  const Ran ran =
      RunHvas({"inspect", ProductFile("frame_500"), "--no-cache", "--time-limit", "0.05"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "frame_500.step", ran.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--time-limit", ran.err);
}

}  // namespace
}  // namespace hvas::app
