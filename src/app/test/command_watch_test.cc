#include "app/command_watch.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "cad/test/greedy_files.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;

/** Runs a command with a limit of time and expects that it ends soon after with the error that
 names the file, the limit and the option, unless a fast machine is done by then. */
void ExpectEndsInTime(std::vector<std::string> arguments, const std::string& name, double limit_s) {
  arguments.insert(arguments.end(), {"--no-cache", "--time-limit", fmt::format("{:g}", limit_s)});
  SCOPED_TRACE(fmt::format("{}", fmt::join(arguments, " ")));
  const auto begin = std::chrono::steady_clock::now();
  const Ran ran = RunHvas(arguments);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  // A second and a tenth are promised; the rest is for a busy machine, which starts programs
  // slowly.
  EXPECT_LT(taken.count(), 1.1 * limit_s + 1 + 4);
  if (ran.status == 0) {
    EXPECT_EQ(ran.err, "");
    return;
  }
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, name + ": ", ran.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--time-limit", ran.err);
}

TEST(CommandWatchTest, EveryCommandEndsInTimeWithFileAndOptionWhateverStageItIsAt) {
  const TemporaryFolder folder;
  const std::string name = "row.3mf";
  const std::string file = folder.Write(name, cad::testing::MakeRow3mf(4000, 1e-3)).string();
  const auto out = [&folder](const std::string& base) { return (folder / base).string(); };
  constexpr double kLimit = 3;  // [s]: enough to come to the stages after reading.
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"inspect", file},
           {"inspect", file, "--json"},
           {"mate", "list", file},
           {"export", file, "-o", out("out.json")},
           {"export", file, "-o", out("out.xml")},
           {"plan", file},
           {"assemble", file},
           {"disassemble", file},
           {"instructions", file, "-o", out("out.html")},
           {"dfa", file},
           {"path", file, "--part", "box", "--translate", "0,0,9", "-o", out("out.csv")},
           {"tool", file}}) {
    ExpectEndsInTime(arguments, name, kLimit);
  }
}

TEST(CommandWatchTest, ThousandsOfTrianglesThatAreObjectsOfTheirOwnAreListedInTime) {
  const TemporaryFolder folder;
  const std::string file =
      folder.Write("triangles.obj", cad::testing::MakeManyTrianglesObj(16'000)).string();
  const Ran ran = RunHvas({"inspect", file, "--no-cache", "--only", "diagnostics"});
  EXPECT_EQ(ran.status, 0) << ran.err;
}

/** Commands that are watched, each in a process of its own, which begins anew: a copy of this one
 would have the locks of its threads, and not the threads. */
class WatchedCommandTest : public ::testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

  /** Runs a command and ends the process with its exit status. */
  template <typename Work>
  [[noreturn]] static void Run(double limit_s, const Work& work) {
    CommandWatch& watch = CommandWatch::Get();
    WorkLimits limits;
    limits.time = limit_s;
    watch.Begin("rig.step", limits, true);
    work(&watch);
    ::_exit(watch.Conclude(0));
  }
};

TEST_F(WatchedCommandTest, HasItsOwnStatusWhereItEndsInTime) {
  EXPECT_EXIT(Run(100, [](CommandWatch* /*watch*/) {}), ::testing::ExitedWithCode(0), "");
}

TEST_F(WatchedCommandTest, IsEndedWhereItHeedsNoRequestToStop) {
  const auto work = [](CommandWatch* /*watch*/) {
    while (true) {
      ::pause();
    }
  };
  EXPECT_EXIT(Run(0.01, work), ::testing::ExitedWithCode(1), "rig.step.*--time-limit");
}

TEST_F(WatchedCommandTest, HasFailedWhereItWasCutShortAlsoWhereNothingWasReported) {
  const auto work = [](CommandWatch* watch) {
    while (!watch->stop().stop_requested()) {
      ::usleep(1000);
    }
  };
  EXPECT_EXIT(Run(0.01, work), ::testing::ExitedWithCode(1), "rig.step.*--time-limit");
}

TEST_F(WatchedCommandTest, GivesPeopleTheirOwnTime) {
  const auto work = [](CommandWatch* watch) {
    watch->End();
    ::usleep(1'500'000);
  };
  EXPECT_EXIT(Run(0.2, work), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace hvas::app
