#include "base/result.h"

#include <gtest/gtest.h>

namespace hvas {
namespace {

Result<int> Half(int value) {
  if (value % 2 != 0) {
    return Fail(ErrorCode::kInvalid, "3 is odd.", "line 2", "Give an even number");
  }
  return value / 2;
}

TEST(Result, CarriesAValueOrAnErrorThatSaysWhatToDo) {
  EXPECT_EQ(Half(4).value(), 2);
  const Result<int> bad = Half(3);
  ASSERT_FALSE(bad.has_value());
  EXPECT_EQ(bad.error().code, ErrorCode::kInvalid);
  EXPECT_EQ(bad.error().ToString(), "line 2: 3 is odd. (Give an even number)");
}

TEST(Result, LeavesOutWhatIsNotKnown) {
  const Error error{ErrorCode::kNotFound, "No such part.", "", ""};
  EXPECT_EQ(error.ToString(), "No such part.");
}

}  // namespace
}  // namespace hvas
