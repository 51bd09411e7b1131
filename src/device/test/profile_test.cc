#include "device/profile.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "device/known_profiles.h"

namespace hvas::device {
namespace {

TEST(ProfileTest, KnownProfilesAreReadWithTheirSources) {
  ASSERT_GE(KnownProfiles().size(), 12u);
  std::set<std::string> ids;
  for (const SourcedProfile& profile : KnownProfiles()) {
    SCOPED_TRACE(profile.profile.id);
    EXPECT_TRUE(ids.insert(profile.profile.id).second);
    EXPECT_EQ(profile.sources.size(), 20u);
    for (const auto& [key, source] : profile.sources) {
      EXPECT_FALSE(source.source.empty()) << key;
    }
  }
  const SourcedProfile* desktop = FindProfileOfModel("openhaptics", "PHANTOM Desktop");
  ASSERT_NE(desktop, nullptr);
  EXPECT_EQ(desktop->profile.max_force, 7.9);  // paper W's device
  EXPECT_EQ(desktop->profile.max_stiffness, 1000);
  EXPECT_EQ(FindProfile("touch")->profile.max_force, 3.3);
  // What is up for the device is up for the user.
  EXPECT_LT((desktop->profile.q_UD * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((desktop->profile.q_UD * Vec3::UnitZ() + Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((FindProfile("sigma7")->profile.q_UD * Vec3::UnitX() + Vec3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(FindProfile("no such thing"), nullptr);
  EXPECT_EQ(FindProfileOfModel("openhaptics", "omega.7"), nullptr);
}

TEST(ProfileTest, ADriversProfileIsTheOneAskedForOrItsFirst) {
  const SourcedProfile* touch = FindProfileOfDriver("openhaptics", "touch");
  ASSERT_NE(touch, nullptr);
  EXPECT_EQ(touch, FindProfile("touch"));
  EXPECT_EQ(FindProfileOfDriver("haply", "touch"), nullptr) << "another driver's";
  const SourcedProfile* first = FindProfileOfDriver("openhaptics");
  ASSERT_NE(first, nullptr);
  for (const SourcedProfile& profile : KnownProfiles()) {
    if (profile.driver == "openhaptics") {
      EXPECT_EQ(first, &profile);
      break;
    }
  }
  EXPECT_EQ(FindProfileOfDriver("plugin"), nullptr) << "brings its own";
}

/** A known file with a piece of it replaced. */
std::string Changed(const std::string& from, const std::string& to) {
  std::string text = kKnownProfileFiles.front().json;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ProfileTest, WhatIsWrongIsNamed) {
  const auto expect_error = [](const std::string& text, const std::string& part) {
    const auto profile = ParseProfile(text, "my.json");
    ASSERT_FALSE(profile) << part;
    EXPECT_EQ(profile.error().where, "my.json");
    EXPECT_NE(profile.error().message.find(part), std::string::npos) << profile.error().message;
  };
  expect_error("{", "not a JSON object");
  expect_error("[]", "not a JSON object");
  expect_error(Changed("\"schema\": 1", "\"schema\": 2"), "schema");
  expect_error(Changed("\"rate_hz\"", "\"rate\""), "rate_hz");
  expect_error(Changed("\"value\": 20,", "\"value\": -20,"), "max_force_n");
  expect_error(Changed("\"value\": 20,", "\"value\": \"20\","), "max_force_n");
  expect_error(Changed("\"value\": 20,", "\"value\": 2,"), "above its peak");
  expect_error(Changed("[0.26, 0.26, 0.26]", "[0.26, 0.26]"), "workspace_m");
  expect_error(Changed("\"+y\", \"-x\"", "\"+y\", \"+x\""), "axes");
  expect_error(Changed("\"+y\", \"-x\"", "\"+y\""), "axes");
  expect_error(Changed("\"verified\": false", "\"verified\": 1"), "verified");
}

}  // namespace
}  // namespace hvas::device
