// The report of a session, and its record in the formats of others, by the program.

#include <cstdlib>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using testing::ProductFile;
using testing::ReadText;
using testing::RunHvas;

class RecordOfAPress : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<hvas::testing::TemporaryFolder>();
    EXPECT_EQ(RunHvas({"assemble", ProductFile("bushing"), "--record", File(), "-q"}).status, 0);
  }

  static void TearDownTestSuite() { folder_.reset(); }

  static std::string File() { return (*folder_ / "press.hvasrec").string(); }

  hvas::testing::TemporaryFolder out;

 private:
  static std::unique_ptr<hvas::testing::TemporaryFolder> folder_;
};

std::unique_ptr<hvas::testing::TemporaryFolder> RecordOfAPress::folder_;

TEST_F(RecordOfAPress, ReportIsOnePageThatNeedsNothingElse) {
  const std::string page = (out / "press.html").string();
  const auto ran = RunHvas({"report", File(), "-o", page});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const std::string html = ReadText(page);
  for (const char* what :
       {"bushing rig", "shaft", "data:image/png;base64,", "<polyline", "felt [N]", "Fits and sizes",
        "Energy and rates", "Safety and devices", "prefers-color-scheme:dark", "@media print"}) {
    EXPECT_NE(html.find(what), std::string::npos) << what;
  }
  for (const char* what : {"<script", "<link", "src=\"http", "url(http", ">nan<", ">inf<"}) {
    EXPECT_EQ(html.find(what), std::string::npos) << what;
  }
  const auto again = RunHvas({"report", File(), "-o", page});
  EXPECT_EQ(again.status, 1);
  EXPECT_NE(again.err.find("--force"), std::string::npos);
  ASSERT_EQ(RunHvas({"report", File(), "-o", page, "--force"}).status, 0);
  EXPECT_EQ(ReadText(page), html) << "the same bytes every time";
}

TEST_F(RecordOfAPress, ReportIsPrintedWhereChromiumIsAndToldWhereNot) {
  const std::string file = (out / "press.pdf").string();
  const auto ran = RunHvas({"report", File(), "-o", file});
  if (std::system("command -v chromium >/dev/null") == 0) {
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ReadText(file).substr(0, 5), "%PDF-");
  } else {
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("chromium"), std::string::npos);
  }
  EXPECT_EQ(RunHvas({"report", File(), "-o", (out / "press.doc").string()}).status, 1);
}

TEST_F(RecordOfAPress, IsExportedByTheEndingOfTheOutput) {
  for (const char* ending : {".csv", ".json", ".h5", ".mcap", ".glb"}) {
    const std::string file = (out / (std::string("press") + ending)).string();
    const auto ran = RunHvas({"export", File(), "-o", file, "--every", "100"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_GT(std::filesystem::file_size(file), 1000u) << ending;
    EXPECT_EQ(RunHvas({"export", File(), "-o", file}).status, 1) << "not over what is there";
  }
  const auto wrong = RunHvas({"export", File(), "-o", (out / "press.step").string()});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find(".mcap"), std::string::npos);
}

}  // namespace
}  // namespace hvas::app
