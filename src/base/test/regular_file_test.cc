#include "base/regular_file.h"

#include <string>

#include <gtest/gtest.h>

#include "base/test/odd_files.h"
#include "base/test/temporary_folder.h"

namespace hvas {
namespace {

using testing::MakeOddFiles;
using testing::OddFile;
using testing::TemporaryFolder;

TEST(RegularFileTest, GivesTheBytesThatAreThere) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0U, 1U, 4095U, 65536U, 65537U, 1000000U}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; ++i) {
      text[i] = static_cast<char>(i % 251);
    }
    const auto path = folder.Write("file", text);
    const auto file = RegularFile::Open(path);
    ASSERT_TRUE(file.has_value()) << file.error().ToString();
    EXPECT_EQ(file->size(), size);
    EXPECT_EQ(ReadRegularFile(path).value(), text);
    EXPECT_EQ(ReadRegularFile(path, size).value(), text);
    EXPECT_EQ(ReadFileHead(path, 100).value(), text.substr(0, 100));
    if (size > 0) {
      const auto cut = ReadRegularFile(path, size - 1);
      ASSERT_FALSE(cut.has_value());
      EXPECT_EQ(cut.error().code, ErrorCode::kUnsupported);
      EXPECT_EQ(cut.error().where, path.string());
    }
  }
}

TEST(RegularFileTest, FileWhoseSizeIsNotKnownIsReadToItsEnd) {
  const auto text = ReadRegularFile("/proc/self/status");
  ASSERT_TRUE(text.has_value());
  EXPECT_NE(text->find("Name:"), std::string::npos);
  EXPECT_EQ(text->back(), '\n');
}

TEST(RegularFileTest, WhatIsNoFileIsRefusedByItsKindAndNotWaitedFor) {
  const TemporaryFolder folder;
  for (const OddFile& odd : MakeOddFiles(folder.path(), "x.step")) {
    for (const Result<void>& result :
         {CheckRegularFile(odd.path), Result<void>(ReadRegularFile(odd.path).map([](auto&&) {})),
          Result<void>(ReadFileHead(odd.path, 1).map([](auto&&) {}))}) {
      ASSERT_FALSE(result.has_value()) << odd.kind;
      EXPECT_EQ(result.error().code, ErrorCode::kUnreadable) << odd.kind;
      EXPECT_EQ(result.error().message, "this is " + odd.kind + ", not a file");
      EXPECT_EQ(result.error().where, odd.path.string());
      EXPECT_FALSE(result.error().remedy.empty()) << odd.kind;
    }
  }
}

TEST(RegularFileTest, WhatIsNotThereIsNamed) {
  const TemporaryFolder folder;
  (void)folder.Write("file", "x");
  std::filesystem::create_symlink("nowhere", folder / "dangling");
  std::filesystem::create_symlink("loop", folder / "loop");
  for (const char* name : {"nothing", "dangling", "file/below"}) {
    const auto checked = CheckRegularFile(folder / name);
    ASSERT_FALSE(checked.has_value()) << name;
    EXPECT_EQ(checked.error().code, ErrorCode::kNotFound) << name;
    EXPECT_EQ(checked.error().where, (folder / name).string());
  }
  const auto loop = CheckRegularFile(folder / "loop");
  ASSERT_FALSE(loop.has_value());
  EXPECT_EQ(loop.error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace hvas
