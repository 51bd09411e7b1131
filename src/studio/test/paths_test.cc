#include "studio/paths.h"

#include <cstring>
#include <future>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "studio/hub.h"
#include "studio/test/small_bench.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using spatial::Pose;

/** Of two parts; one hand. */
simulation::Frame FrameAt(OccurrenceId held, const Vec3& p_WB) {
  simulation::Frame frame;
  frame.X_WB.resize(2, Pose(p_WB));
  frame.ticks.resize(1);
  frame.ticks[0].occurrence = held;
  return frame;
}

TEST(PathLogTest, X13KeepsTheWayOfThePartInTheHand) {  // the path is recorded
  PathLog log;
  for (int i = 0; i < 100; ++i) {
    log.Add(FrameAt(OccurrenceId(1), Vec3(1e-3 * i, 0, 0)));
  }
  const paths::Path path = log.PathOf(OccurrenceId(1)).path;
  EXPECT_NEAR(paths::CalcLength(path, Vec3::Zero()), 99e-3, 1e-12);
  EXPECT_EQ(path.back().p().x(), 99e-3);
  EXPECT_TRUE(log.PathOf(OccurrenceId(0)).path.empty());
}

TEST(PathLogTest, EachHoldBeginsAnewAndTheLastOneStays) {
  PathLog log;
  log.Add(FrameAt(OccurrenceId(1), Vec3(1, 0, 0)));
  log.Add(FrameAt(OccurrenceId(), Vec3(2, 0, 0)));
  log.Add(FrameAt(OccurrenceId(1), Vec3(3, 0, 0)));
  log.Add(FrameAt(OccurrenceId(1), Vec3(4, 0, 0)));
  log.Add(FrameAt(OccurrenceId(0), Vec3(5, 0, 0)));
  const paths::Path path = log.PathOf(OccurrenceId(1)).path;
  EXPECT_EQ(path.front().p().x(), 3);
  EXPECT_EQ(path.back().p().x(), 4);
  EXPECT_EQ(log.PathOf(OccurrenceId(0)).path.front().p().x(), 5);
  log.Clear();
  EXPECT_TRUE(log.PathOf(OccurrenceId(1)).path.empty());
}

TEST(PathLogTest, LongHoldsAreKeptWithFewerPoses) {
  PathLog log;
  constexpr int kFrames = 100'000;  // half an hour
  for (int i = 0; i <= kFrames; ++i) {
    const double angle = 2 * std::numbers::pi * i / kFrames;
    log.Add(FrameAt(OccurrenceId(1), Vec3(std::cos(angle), std::sin(angle), 0)));
  }
  const paths::Path path = log.PathOf(OccurrenceId(1)).path;
  EXPECT_LE(path.size(), PathLog::kMaxPoses + 1);
  EXPECT_GT(path.size(), PathLog::kMaxPoses / 4);
  EXPECT_NEAR(paths::CalcLength(path, Vec3::Zero()), 2 * std::numbers::pi, 1e-4);
}

TEST(PathLogTest, PartThatRestsInTheHandNeedsNoMemory) {
  PathLog log;
  for (int i = 0; i < 1000; ++i) {
    log.Add(FrameAt(OccurrenceId(1), Vec3(1e-9 * i, 0, 0)));
  }
  EXPECT_LE(log.PathOf(OccurrenceId(1)).path.size(), 2u);
}

TEST(SweptGlbTest, HasTheMeshWithItsNormals) {
  paths::SurfaceMesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const auto glb = MakeGlb(mesh, "a \"part\"");
  ASSERT_TRUE(glb);
  std::uint32_t size = 0;
  std::memcpy(&size, glb->data() + 12, sizeof(size));
  const Json json = Json::parse(glb->substr(20, size));
  EXPECT_EQ(json["meshes"][0]["name"], "a \"part\"");
  const Json& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 12);
  EXPECT_TRUE(primitive["attributes"].contains("NORMAL"));
}

/** A client that keeps all that it is sent. */
class Texts final : public ClientLink {
 public:
  void SendText(std::string text) override { all.push_back(Json::parse(text)); }

  void SendFrames(std::string) override {}

  void Close(const std::string&) override {}

  std::vector<Json> all;
};

class PathCommandTest : public ::testing::Test {
 protected:
  PathCommandTest() : bench_(testing::SmallBench(log_.clock())), hub_(&bench_, {}) {
    bench_.on_event = [this](Json event) { log_.Add(std::move(event)); };
    viewer_ = hub_.Join({Role::kViewer, false, 1}, &texts_, now_ns_).value_or("");
  }

  void TearDown() override { bench_.Stop(); }

  /** The answer that comes at once; null when there is none. */
  Json Ask(Json command) {
    command["id"] = 7;
    command["command"] = "path";
    texts_.all.clear();
    hub_.OnText(viewer_, command.dump(), now_ns_ += 1'000'000'000);
    return texts_.all.empty() ? Json(nullptr) : texts_.all.back();
  }

  void OpenPeg() {
    bench_.opener().Open("peg.step", "peg");
    ASSERT_TRUE(log_.Await("scene"));
  }

  /** The simulated person puts the peg into its hole, once the block stands in its fixture. */
  void PutPegIn() {
    ASSERT_TRUE(log_.Await(
        [](const Json& event) { return event["event"] == "step" && event["index"] == 1; }));
    ASSERT_TRUE(bench_.demo().DoNext());
    ASSERT_TRUE(log_.Await([](const Json& event) {
      return event["event"] == "dropped" && event["was_seated"] == true;
    }));
  }

  testing::EventLog log_;
  Workbench bench_;
  Hub hub_;
  Texts texts_;
  std::string viewer_;
  std::int64_t now_ns_{0};
};

TEST_F(PathCommandTest, X13PathIsGivenAsPointsAndAsSweptVolume) {
  OpenPeg();
  PutPegIn();
  const Json points = Ask({{"occurrence", 1}, {"as", "points"}});
  ASSERT_EQ(points["ok"], true) << points;
  EXPECT_GT(points["result"]["points_m"].size(), 10u);
  EXPECT_EQ(points["result"]["points_m"].size(), points["result"]["poses"].size());

  EXPECT_TRUE(Ask({{"occurrence", 1}, {"as", "swept"}, {"resolution_mm", 4}}).is_null());
  const auto reply = log_.Await("reply");
  ASSERT_TRUE(reply);
  hub_.Broadcast(*reply);
  const Json swept = texts_.all.back();
  EXPECT_EQ(swept["id"], 7);
  ASSERT_EQ(swept["ok"], true) << swept;
  EXPECT_GT(swept["result"]["volume_mm3"], 1000);
  EXPECT_GT(swept["result"]["error_mm"], 4);
  const std::string glb = swept["result"]["glb"];
  const std::string start = "/api/path/";
  ASSERT_EQ(glb.substr(0, start.size()), start);
  const auto kept = bench_.sweeper().Find(glb.substr(start.size(), glb.size() - start.size() - 4));
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->glb.substr(0, 4), "glTF");
  EXPECT_EQ(bench_.sweeper().Find(""), nullptr);
}

TEST_F(PathCommandTest, WhatCannotBeGivenIsAnErrorThatSaysWhatToDo) {
  EXPECT_EQ(Ask({{"occurrence", 1}, {"as", "points"}})["error"]["code"], "not-found");
  OpenPeg();
  const Json never = Ask({{"occurrence", 1}, {"as", "points"}});
  EXPECT_EQ(never["error"]["code"], "not-found");
  EXPECT_NE(never["error"]["remedy"], "");
  EXPECT_EQ(Ask({{"occurrence", 99}, {"as", "points"}})["error"]["code"], "not-found");
  EXPECT_EQ(Ask({{"occurrence", 1}})["error"]["code"], "invalid");
  EXPECT_EQ(Ask({{"occurrence", 1}, {"as", "swept"}, {"resolution_mm", -1}})["error"]["code"],
            "invalid");
  PutPegIn();
  EXPECT_EQ(Ask({{"occurrence", 1}, {"as", "film"}})["error"]["code"], "invalid");
  // Too fine for any memory: the error comes as late as the answer would.
  EXPECT_TRUE(Ask({{"occurrence", 1}, {"as", "swept"}, {"resolution_mm", 0.01}}).is_null());
  const auto reply = log_.Await("reply");
  ASSERT_TRUE(reply);
  EXPECT_EQ((*reply)["reply"]["error"]["code"], "out-of-resource");
  EXPECT_NE((*reply)["reply"]["error"]["remedy"], "");
}

TEST_F(PathCommandTest, SoManyMayBeAskedForAndNoMore) {
  OpenPeg();
  PutPegIn();
  // Volumes are done meanwhile, but not as fast as they are asked for.
  constexpr std::size_t kMostAsked = 50 * Sweeper::kMaxWaiting;
  std::size_t asked = 0;
  Json answer;
  while (asked < kMostAsked && !answer.contains("error")) {
    answer = Ask({{"occurrence", 1}, {"as", "swept"}, {"resolution_mm", 2}});
    ++asked;
  }
  ASSERT_TRUE(answer.contains("error"));
  EXPECT_EQ(answer["error"]["code"], "out-of-resource");
  EXPECT_GT(asked, Sweeper::kMaxWaiting);
  bench_.Stop();  // in the midst of it
}

}  // namespace
}  // namespace hvas::studio
