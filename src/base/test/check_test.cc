#include "base/check.h"

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(CheckTest, DemandEndsTheProgramAndSaysWhatDoesNotHold) {
  int asked = 0;
  HVAS_DEMAND(++asked == 1);
  EXPECT_EQ(asked, 1);
  const bool is_open = false;
  EXPECT_DEATH(HVAS_DEMAND(is_open), "is_open does not hold .*check_test.cc:[0-9]+");
}

TEST(CheckTest, AssertAsksInDebugBuildsOnly) {
  int asked = 0;
  HVAS_ASSERT(++asked == 1);
#ifdef NDEBUG
  EXPECT_EQ(asked, 0);
#else
  EXPECT_EQ(asked, 1);
  EXPECT_DEATH(HVAS_ASSERT(asked == 2), "asked == 2 does not hold");
#endif
}

}  // namespace
}  // namespace hvas
