#include "base/parse_json.h"

#include <string>

#include <gtest/gtest.h>

namespace hvas {
namespace {

std::string Nest(std::size_t depth, char open, char close) {
  return std::string(depth, open) + std::string(depth, close);
}

TEST(ParseJsonTest, NestingBeyondTheLimitIsRefused) {
  EXPECT_FALSE(IsNestedTooDeep(Nest(kDeepestJson, '[', ']')));
  EXPECT_TRUE(IsNestedTooDeep(Nest(kDeepestJson + 1, '[', ']')));
  EXPECT_TRUE(IsNestedTooDeep(std::string(kDeepestJson + 1, '{')));
  EXPECT_TRUE(IsNestedTooDeep(Nest(1'000'000, '[', ']')));
}

TEST(ParseJsonTest, BracketsInTextsAndSideBySideAreNoNesting) {
  EXPECT_FALSE(IsNestedTooDeep("\"" + std::string(1000, '[') + "\""));
  EXPECT_FALSE(IsNestedTooDeep("\"\\\"" + std::string(1000, '{') + "\""));
  std::string list = "[";
  for (int i = 0; i < 1000; ++i) {
    list += "[],";
  }
  EXPECT_FALSE(IsNestedTooDeep(list + "[]]"));
  EXPECT_TRUE(IsNestedTooDeep("\"a\\\\\"" + std::string(1000, '[')));  // the text ends before them
}

}  // namespace
}  // namespace hvas
