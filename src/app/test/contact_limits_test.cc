// What is printed of a run in which a tick had no room for all of the contact.

#include <memory>

#include <gtest/gtest.h>

#include "app/assembly/assemble_report.h"
#include "app/recording/report_page.h"

namespace hvas::app {
namespace {

using ::testing::IsSubstring;

std::string PrintTable(const simulation::ContactLimits& limits) {
  simulation::Model model;
  model.product = std::make_shared<product::Product>();
  SessionReport report;
  report.run.execution.contact_limits = limits;
  ::testing::internal::CaptureStdout();
  PrintAssemblyTable(model, report);
  return ::testing::internal::GetCapturedStdout();
}

TEST(ContactLimits, TableNamesThemWhereTheyWereReached) {
  const std::string complete = PrintTable({});
  EXPECT_EQ(complete.find("docs/limits.md"), std::string::npos) << complete;
  const std::string text = PrintTable({12, 34});
  EXPECT_PRED_FORMAT2(IsSubstring, "incomplete contact: in 12 ticks", text);
  EXPECT_PRED_FORMAT2(IsSubstring, "loose parts: in 34 ticks", text);
}

TEST(ContactLimits, ReportNamesThemWhereTheyWereReached) {
  evidence::Summary summary;
  summary.hands.emplace_back();
  const std::string complete = MakeReportPage(summary);
  EXPECT_EQ(complete.find("has room for"), std::string::npos);
  summary.hands[0].truncated_ticks = 12;
  summary.hands[0].crowded_ticks = 34;
  const std::string page = MakeReportPage(summary);
  EXPECT_PRED_FORMAT2(IsSubstring, "has room for in 12 ticks", page);
  EXPECT_PRED_FORMAT2(IsSubstring, "may move did in 34", page);
}

}  // namespace
}  // namespace hvas::app
