#include "studio/audit_log.h"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"

namespace hvas::studio {
namespace {

class AuditLogTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<Json> Read() const {
    std::vector<Json> lines;
    std::ifstream file(file_);
    for (std::string line; std::getline(file, line);) {
      lines.push_back(Json::parse(line));
    }
    return lines;
  }

  hvas::testing::TemporaryFolder folder_;
  const std::filesystem::path file_{folder_.path() / "audit.log"};
};

TEST_F(AuditLogTest, LineSaysWhoDidWhatFromWhere) {
  AuditLog log(file_);
  log.Note(1, {"owner", "192.168.1.5", "c1", DescribeForAudit({{"command", "take"}, {"hand", 1}})},
           0);
  log.Note(AuditLog::kStranger, {"stranger", "::1", "", {{"request", "come_in"}}}, 0);
  log.Stop();
  const std::vector<Json> lines = Read();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["who"], "owner");
  EXPECT_EQ(lines[0]["address"], "192.168.1.5");
  EXPECT_EQ(lines[0]["client"], "c1");
  EXPECT_EQ(lines[0]["command"], "take");
  EXPECT_EQ(lines[0]["hand"], 1);
  EXPECT_EQ(lines[0]["time"].get<std::string>().size(),
            std::string("2026-11-29T22:41:07.312Z").size());
  EXPECT_FALSE(lines[1].contains("client"));

  struct stat status {};

  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u) << "for this user only";
}

TEST_F(AuditLogTest, WhatUsersHaveWrittenIsNotKept) {
  const Json did = DescribeForAudit({{"command", "add_note"},
                                     {"text", "secret"},
                                     {"name", "secret"},
                                     {"upload", "secret"},
                                     {"value", "secret"},
                                     {"occurrence", {{"a", "secret"}}},
                                     {"example", "../se\ncret"},
                                     {"recording", std::string(1000, 'r')}});
  EXPECT_EQ(did["example"], "(other)");
  EXPECT_EQ(did.dump().find("secret"), std::string::npos) << did;
  EXPECT_LT(did.dump().size(), 200u);
}

TEST_F(AuditLogTest, LineBreaksMakeNoLine) {
  AuditLog log(file_);
  log.Note(
      0,
      {"viewer", "x\n{\"who\": \"owner\"}", "c\r\n", DescribeForAudit({{"command", "a\nb\xff"}})},
      0);
  log.Stop();
  EXPECT_EQ(Read().size(), 1u);
}

TEST_F(AuditLogTest, RefusalsAreNotedOnceAMinuteForEachLinkWithTheirNumber) {
  AuditLog log(file_);
  const AuditLog::Entry entry{"viewer", "::1", "c2", {{"command", "take"}}};
  constexpr std::int64_t kStep = AuditLog::kRefusalPauseNs / 1000;
  for (int i = 0; i <= 1000; ++i) {  // A minute, ends included.
    log.NoteRefusal(0, entry, "invalid", i * kStep);
    log.NoteRefusal(7, entry, "invalid", i * kStep);
  }
  log.Stop();
  const std::vector<Json> lines = Read();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0]["refused"], "invalid");
  EXPECT_FALSE(lines[0].contains("refused_before"));
  EXPECT_EQ(lines[2]["refused_before"], 999);
}

TEST_F(AuditLogTest, LinesOfALinkInAMinuteAreLimited) {
  AuditLog log(file_);
  const AuditLog::Entry flood{"viewer", "::1", "c2", {{"request", "come_in"}}};
  for (int i = 0; i < 100'000; ++i) {
    log.Note(0, flood, 0);
  }
  log.Note(1, {"owner", "::1", "c1", {{"command", "delete_recording"}}}, 0);
  log.Note(0, flood, AuditLog::kRefusalPauseNs);
  log.Stop();
  const std::vector<Json> lines = Read();
  ASSERT_EQ(lines.size(), AuditLog::kMostInMinute + 2);
  EXPECT_EQ(lines[AuditLog::kMostInMinute]["who"], "owner");
  EXPECT_EQ(lines.back()["left_out_before"], 100'000 - AuditLog::kMostInMinute);
}

TEST_F(AuditLogTest, LongFileIsRenamedAndANewOneBegun) {
  std::ofstream(file_) << std::string(AuditLog::kMaxBytes + 1, ' ');
  AuditLog log(file_);
  log.Note(1, {"owner", "::1", "c1", {{"command", "reset"}}}, 0);
  log.Stop();
  EXPECT_EQ(Read().size(), 1u);
  EXPECT_GT(std::filesystem::file_size(file_.string() + ".1"), AuditLog::kMaxBytes);
}

TEST_F(AuditLogTest, NothingIsWrittenWithoutAFileOrThroughALink) {
  AuditLog none("");
  none.Note(1, {"owner", "::1", "c1", {{"command", "reset"}}}, 0);
  none.Stop();
  none.Stop();  // does nothing
  const auto target = folder_.path() / "target";
  std::ofstream(target) << "";
  std::filesystem::create_symlink(target, file_);
  ::testing::internal::CaptureStderr();
  AuditLog log(file_);
  log.Note(1, {"owner", "::1", "c1", {{"command", "reset"}}}, 0);
  log.Note(1, {"owner", "::1", "c1", {{"command", "reset"}}}, 0);
  log.Stop();
  const std::string warning = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(warning.find("the audit log cannot be written"), std::string::npos);
  EXPECT_EQ(warning.find("warning"), warning.rfind("warning")) << "said once";
  EXPECT_EQ(std::filesystem::file_size(target), 0u);
}

}  // namespace
}  // namespace hvas::studio
