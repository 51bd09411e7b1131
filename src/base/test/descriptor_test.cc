#include "base/descriptor.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"

namespace hvas {
namespace {

bool IsOpenInSystem(int value) {
  return ::fcntl(value, F_GETFD) >= 0;
}

Descriptor OpenNull() {
  return Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC));
}

TEST(DescriptorTest, IsClosedWithItsLastOwner) {
  int value = -1;
  {
    Descriptor first = OpenNull();
    value = first.value();
    Descriptor second(std::move(first));
    EXPECT_FALSE(first.is_open());  // NOLINT(bugprone-use-after-move): a moved one is closed.
    Descriptor third = OpenNull();
    const int replaced = third.value();
    third = std::move(second);
    EXPECT_FALSE(IsOpenInSystem(replaced));
    EXPECT_EQ(third.value(), value);
    EXPECT_TRUE(IsOpenInSystem(value));
  }
  EXPECT_FALSE(IsOpenInSystem(value));
}

TEST(DescriptorTest, ClosingTellsWhetherTheSystemDid) {
  Descriptor file = OpenNull();
  ::close(file.value());
  EXPECT_FALSE(file.Close());
  EXPECT_EQ(errno, EBADF);
  EXPECT_TRUE(file.Close()) << "it is closed already";
}

TEST(DescriptorTest, OneOwnerHasTheLockAtATime) {
  const testing::TemporaryFolder folder;
  const auto path = folder / "lock";
  const auto open = [&path] {
    return Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  };
  Descriptor first = open();
  const Descriptor second = open();
  EXPECT_EQ(TryLock(first), 0);
  EXPECT_EQ(TryLock(second), EWOULDBLOCK);
  EXPECT_TRUE(first.Close());
  EXPECT_EQ(TryLock(second), 0);
  EXPECT_EQ(TryLock(first), EBADF);
}

}  // namespace
}  // namespace hvas
