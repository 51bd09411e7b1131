#include "base/atomic_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "base/test/small_files.h"
#include "base/test/temporary_folder.h"

namespace hvas {
namespace {

std::string Read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class AtomicFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::ptrdiff_t CountFiles() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
  }

  testing::TemporaryFolder folder_;
};

TEST_F(AtomicFile, WritesAndReplacesWholeFilesAndNothingElse) {
  const std::filesystem::path file = folder_ / "a.json";
  const std::string bytes("one\0two", 7);
  ASSERT_TRUE(WriteAtomically(file, bytes).has_value());
  EXPECT_EQ(Read(file), bytes);
  ASSERT_TRUE(WriteAtomically(file, "").has_value());
  EXPECT_EQ(Read(file), "");
  EXPECT_EQ(CountFiles(), 1);
}

TEST_F(AtomicFile, KeepsPermissionsAndSymbolicLinks) {
  const std::filesystem::path file = folder_ / "a.json";
  std::ofstream(file) << "old";
  std::filesystem::permissions(file, std::filesystem::perms(0640));
  std::filesystem::create_symlink("a.json", folder_ / "link.json");
  ASSERT_TRUE(WriteAtomically(folder_ / "link.json", "new").has_value());
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.json"));
  EXPECT_EQ(Read(file), "new");
  EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms(0640));
}

TEST_F(AtomicFile, WhatIsItsOwnersAloneIsReadByNobodyElse) {
  const std::filesystem::path file = folder_ / "key.pem";
  ASSERT_TRUE(WriteAtomically(file, "a", FileReaders::kOwner).has_value());
  EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms(0600));
  std::filesystem::permissions(file, std::filesystem::perms(0644));
  ASSERT_TRUE(WriteAtomically(file, "b", FileReaders::kOwner).has_value());
  EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms(0600));
}

TEST_F(AtomicFile, FullDiskIsAnErrorAndLeavesTheOldFile) {
  const std::filesystem::path file = folder_ / "a.json";
  std::ofstream(file) << "old";
  EXPECT_TRUE(testing::RunWithSmallFiles([&file] {
    const Result<void> result = WriteAtomically(file, std::string(100000, 'x'));
    return !result && result.error().code == ErrorCode::kOutOfResource;
  }));
  EXPECT_EQ(Read(file), "old");
  EXPECT_EQ(CountFiles(), 1);
}

TEST_F(AtomicFile, FoldersThatAreNotThereAndFoldersInTheWayAreErrors) {
  EXPECT_EQ(WriteAtomically(folder_ / "none" / "a.json", "x").error().code, ErrorCode::kNotFound);
  const Result<void> result = WriteAtomically(folder_.path(), "x");
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().where, folder_.path().string());
  EXPECT_FALSE(result.error().remedy.empty());
  EXPECT_EQ(CountFiles(), 0);
}

}  // namespace
}  // namespace hvas
