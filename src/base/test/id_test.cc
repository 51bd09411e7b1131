#include "base/id.h"

#include <type_traits>
#include <unordered_set>

#include <gtest/gtest.h>

namespace hvas {
namespace {

using AppleId = Id<struct AppleTag>;
using PearId = Id<struct PearTag>;

static_assert(!std::is_convertible_v<AppleId, PearId>, "kinds do not mix");
static_assert(!std::is_convertible_v<int, AppleId>, "a bare number is not an id");

TEST(Id, IsInvalidUntilItIsGivenAnIndex) {
  EXPECT_FALSE(AppleId().is_valid());
  EXPECT_TRUE(AppleId(0).is_valid());
  EXPECT_EQ(AppleId(7).index(), 7u);
  EXPECT_EQ(AppleId(7).value(), 7u);
}

TEST(Id, OrdersAndHashesByIndexWithTheInvalidLast) {
  EXPECT_LT(AppleId(1), AppleId(2));
  EXPECT_LT(AppleId(2), AppleId());
  EXPECT_EQ(AppleId(3), AppleId(3));
  const std::unordered_set<AppleId> set{AppleId(1), AppleId(1), AppleId(2)};
  EXPECT_EQ(set.size(), 2u);
}

}  // namespace
}  // namespace hvas
