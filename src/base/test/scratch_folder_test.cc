#include "base/scratch_folder.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

namespace hvas {
namespace {

namespace fs = std::filesystem;

/** Makes a folder look as if nothing had happened in it for an hour. */
void MakeOld(const fs::path& folder) {
  fs::last_write_time(folder, fs::file_time_type::clock::now() - std::chrono::hours(1));
}

/** The folder of a process that was killed. */
fs::path MakeOrphan() {
  constexpr std::size_t kLongest = 4096;
  void* shared =
      ::mmap(nullptr, kLongest, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  EXPECT_NE(shared, MAP_FAILED);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto folder = ScratchFolder::Make();
    folder->path().string().copy(static_cast<char*>(shared), kLongest - 1);
    std::ofstream(folder->path() / "file") << "text";
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  const fs::path path = static_cast<const char*>(shared);
  ::munmap(shared, kLongest);
  return path;
}

TEST(ScratchFolderTest, OfAKilledProcessGoesWhenTheNextIsMade) {
  const fs::path orphan = MakeOrphan();
  ASSERT_TRUE(fs::exists(orphan / "file"));
  { const auto other = ScratchFolder::Make(); }
  EXPECT_TRUE(fs::exists(orphan)) << "it may be one that is only just being made";
  MakeOld(orphan);
  { const auto other = ScratchFolder::Make(); }
  EXPECT_FALSE(fs::exists(orphan));
}

TEST(ScratchFolderTest, OfALivingProcessAndOfOthersStay) {
  const auto mine = ScratchFolder::Make();
  const fs::path other = mine->path().parent_path() / "hvas-others-abcdef";
  fs::create_directory(other);
  MakeOld(mine->path());
  MakeOld(other);
  { const auto next = ScratchFolder::Make(); }
  EXPECT_TRUE(fs::exists(mine->path()));
  EXPECT_TRUE(fs::exists(other));
  fs::remove_all(other);
}

}  // namespace
}  // namespace hvas
