#include "studio/history.h"

#include <gtest/gtest.h>

namespace hvas::studio {
namespace {

TEST(HistoryTest, StepsThatWereForgottenAreCounted) {
  History history;
  for (std::size_t i = 0; i < History::kMaxMoments; ++i) {
    history.Remember({}, "step");
  }
  EXPECT_EQ(history.Describe()["forgotten"], 0);
  history.Remember({}, "step");
  history.Remember({}, "step");
  EXPECT_EQ(history.Describe()["forgotten"], 2);
  history.Clear();
  EXPECT_EQ(history.Describe()["forgotten"], 0);
}

}  // namespace
}  // namespace hvas::studio
