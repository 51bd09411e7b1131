#include "base/file_cache.h"

#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "base/test/small_files.h"
#include "base/test/temporary_folder.h"

namespace hvas {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> BytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

class FileCacheTest : public ::testing::Test {
 protected:
  [[nodiscard]] FileCache Cache(std::uintmax_t capacity = FileCache::kDefaultCapacity) const {
    return {folder_ / "cache", ".kept", capacity};
  }

  /** Stores 100 bytes, used that long ago. */
  void StoreAged(const std::string& key, std::chrono::hours age) const {
    ASSERT_TRUE(Cache().Store(key, {BytesOf(std::string(100, 'x'))}));
    Age(Cache().PathOf(key), age);
  }

  static void Age(const fs::path& file, std::chrono::hours age) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - age);
  }

  [[nodiscard]] bool Has(const std::string& key) const { return fs::exists(Cache().PathOf(key)); }

  [[nodiscard]] static std::string Read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  [[nodiscard]] std::ptrdiff_t CountFiles() const {
    return std::distance(fs::directory_iterator(folder_ / "cache"), {});
  }

  testing::TemporaryFolder folder_;
};

TEST_F(FileCacheTest, KeepsThePiecesOneBehindTheOtherAndNothingElse) {
  ASSERT_TRUE(Cache().Store("a", {BytesOf("one, "), BytesOf(""), BytesOf("two")}));
  EXPECT_EQ(Read(Cache().PathOf("a")), "one, two");
  ASSERT_TRUE(Cache().Store("a", {BytesOf("three")}));
  EXPECT_EQ(Read(Cache().PathOf("a")), "three");
  ASSERT_TRUE(Cache().Store("b", {BytesOf("four")}));
  EXPECT_EQ(Read(Cache().PathOf("a")), "three");
  EXPECT_EQ(CountFiles(), 2);
}

TEST_F(FileCacheTest, FilesNotUsedForLongestGoFirst) {
  using std::chrono::hours;
  StoreAged("a", hours(3));
  StoreAged("b", hours(2));
  StoreAged("c", hours(1));
  Cache().Touch("a");
  ASSERT_TRUE(Cache(250).Store("d", {BytesOf(std::string(100, 'x'))}));
  EXPECT_TRUE(Has("a"));
  EXPECT_FALSE(Has("b"));
  EXPECT_FALSE(Has("c"));
  EXPECT_TRUE(Has("d"));
}

TEST_F(FileCacheTest, TheFileJustStoredStaysAlsoWhenItIsTooLarge) {
  StoreAged("a", std::chrono::hours(1));
  ASSERT_TRUE(Cache(10).Store("b", {BytesOf(std::string(100, 'x'))}));
  EXPECT_FALSE(Has("a"));
  EXPECT_TRUE(Has("b"));
}

TEST_F(FileCacheTest, FilesOfOthersAreNeitherCountedNorRemoved) {
  const FileCache other(folder_ / "cache", ".other", 1000);
  ASSERT_TRUE(other.Store("a", {BytesOf(std::string(100, 'x'))}));
  Age(other.PathOf("a"), std::chrono::hours(9));
  folder_.Write("cache/notes.txt", std::string(100, 'x'));
  ASSERT_TRUE(Cache(150).Store("a", {BytesOf(std::string(100, 'x'))}));
  ASSERT_TRUE(Cache(10).Store("b", {BytesOf("x")}));
  EXPECT_TRUE(fs::exists(other.PathOf("a")));
  EXPECT_TRUE(fs::exists(folder_ / "cache" / "notes.txt"));
  EXPECT_FALSE(Has("a"));
}

TEST_F(FileCacheTest, UnfinishedFilesAreForgottenAfterAnHour) {
  fs::create_directories(folder_ / "cache");
  const fs::path killed = folder_.Write("cache/a.1.0.kept-tmp", "half");
  const fs::path writing = folder_.Write("cache/b.2.0.kept-tmp", "half");
  const fs::path others = folder_.Write("cache/c.3.0.other-tmp", "half");
  Age(killed, std::chrono::hours(2));
  Age(others, std::chrono::hours(2));
  ASSERT_TRUE(Cache(1).Store("d", {BytesOf("whole")}));
  EXPECT_FALSE(fs::exists(killed));
  EXPECT_TRUE(fs::exists(writing));
  EXPECT_TRUE(fs::exists(others));
}

TEST_F(FileCacheTest, WhatCannotBeKeptIsToldAndLeavesNothing) {
  folder_.Write("file", "not a directory");
  EXPECT_FALSE(FileCache(folder_ / "file", ".kept").Store("a", {BytesOf("x")}));
  EXPECT_FALSE(FileCache(folder_ / "file" / "in", ".kept").Store("a", {BytesOf("x")}));
  fs::create_directories(Cache().PathOf("a"));  // A directory in the way.
  EXPECT_FALSE(Cache().Store("a", {BytesOf("x")}));
  EXPECT_EQ(CountFiles(), 1);
}

TEST_F(FileCacheTest, AFullDiskLeavesTheOldFile) {
  ASSERT_TRUE(Cache().Store("a", {BytesOf("old")}));
  EXPECT_TRUE(testing::RunWithSmallFiles(
      [this] { return !Cache().Store("a", {BytesOf(std::string(100000, 'x'))}); }));
  EXPECT_EQ(Read(Cache().PathOf("a")), "old");
  EXPECT_EQ(CountFiles(), 1);
}

TEST_F(FileCacheTest, ThreadsThatStoreTheSameKeyLeaveOneWholeFile) {
  constexpr int kThreads = 4;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([this, i] {
      const std::string text(50000, static_cast<char>('a' + i));
      for (int k = 0; k < 20; ++k) {
        EXPECT_TRUE(Cache().Store("shared", {BytesOf(text)}));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const std::string text = Read(Cache().PathOf("shared"));
  ASSERT_EQ(text.size(), 50000u);
  EXPECT_EQ(text, std::string(50000, text.front()));
  EXPECT_EQ(CountFiles(), 1);
}

TEST(FileCacheDirectoryTest, FollowsTheEnvironment) {
  const auto with = [](const char* cache, const char* xdg, const char* home) {
    ::setenv("HVAS_CACHE", cache, 1);
    ::setenv("XDG_CACHE_HOME", xdg, 1);
    ::setenv("HOME", home, 1);
    return FileCache::DefaultDirectory();
  };
  const std::string home = getenv("HOME") != nullptr ? getenv("HOME") : "";
  EXPECT_EQ(with("", "/caches", "/home/kim"), fs::path("/caches/hvas"));
  EXPECT_EQ(with("", "", "/home/kim"), fs::path("/home/kim/.cache/hvas"));
  EXPECT_EQ(with("", "relative", "/home/kim"), fs::path("/home/kim/.cache/hvas"));
  EXPECT_EQ(with("", "", ""), std::nullopt);
  EXPECT_EQ(with("off", "/caches", "/home/kim"), std::nullopt);
  (void)with("off", "", home.c_str());
}

}  // namespace
}  // namespace hvas
