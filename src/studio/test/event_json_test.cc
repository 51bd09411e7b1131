#include "studio/event_json.h"

#include <gtest/gtest.h>

namespace hvas::studio {
namespace {

TEST(HideFoldersTest, AbsolutePathsBecomeNamesOfFiles) {
  EXPECT_EQ(HideFolders("/home/ada/pump.step"), "pump.step");
  EXPECT_EQ(HideFolders("cannot read /home/ada/pump.step: broken"),
            "cannot read pump.step: broken");
  EXPECT_EQ(HideFolders("delete '/var/lib/x/a.hvasrec', then try"), "delete 'a.hvasrec', then try");
  EXPECT_EQ(HideFolders("(/a/b/c)"), "(c)");
  EXPECT_EQ(HideFolders("file:/a/b and=/c/d"), "file:b and=d");
  EXPECT_EQ(HideFolders("/tmp/"), "tmp/");
  EXPECT_EQ(HideFolders("/"), "/");
}

TEST(HideFoldersTest, OtherTextsStayAsTheyAre) {
  for (const char* text : {"", "12 N/mm", "and/or", "H7/p6", "a / b", "https", "1/2"}) {
    EXPECT_EQ(HideFolders(text), text);
  }
}

TEST(HideFoldersTest, ErrorsOfThePageHaveNoFolders) {
  const Json json = ToJson(Error{ErrorCode::kNotFound, "no /a/b", "/a/b", "look into /a"});
  EXPECT_EQ(json["message"], "no b");
  EXPECT_EQ(json["where"], "b");
  EXPECT_EQ(json["remedy"], "look into a");
}

}  // namespace
}  // namespace hvas::studio
