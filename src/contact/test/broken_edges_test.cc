// What edges meet when they are not sharp: N2. Two blocks with their sides parallel, so that gaps
// and overlaps are what their positions say.

#include <gtest/gtest.h>

#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Block;
using testing::Build;

constexpr double kHalf = 10e-3;       // [m], of the block in the scene.
constexpr double kHeldHalf = 4e-3;    // [m]
constexpr double kHeight = 1e-6;      // [m]
constexpr double kStepAhead = 50e-6;  // [m] in a tick.

/** A block held at the left of another one's top: a gap from its side, an overlap with its height.
 */
class BrokenEdges : public ::testing::Test {
 protected:
  BrokenEdges() { scene_.Add(Build(Block(Vec3::Constant(kHalf))), {}); }

  static Pose At(double gap, double overlap) {
    return Pose(Vec3(-kHalf - kHeldHalf - gap, 0, kHalf + kHeldHalf - overlap));
  }

  std::span<const Contact> Find(const Pose& X_WH, const Vec3& step, bool has_broken_edges = true) {
    QueryOptions options;
    options.margin = 100e-6;
    if (has_broken_edges) {
      options.broken_edges = contact::BrokenEdges{kHeight, Pose(X_WH.p() + step)};
    }
    scene_.Query(*held_, X_WH, options, &work_);
    return work_.contacts();
  }

  /** Of the contacts that push back against the step, the nearest; +inf if there are none. */
  static double NearestAgainst(std::span<const Contact> contacts, const Vec3& way) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Contact& c : contacts) {
      nearest = c.nhat_W.dot(way) < -0.1 ? std::min(nearest, c.distance) : nearest;
    }
    return nearest;
  }

 private:
  Scene scene_;
  std::shared_ptr<const Shape> held_{Build(Block(Vec3::Constant(kHeldHalf)))};
  QueryWorkspace work_;
};

TEST_F(BrokenEdges, LedgesLowerThanTheBreakAreNotMetFromTheirSide) {
  const Vec3 way = Vec3::UnitX();
  for (const double gap : {30e-6, 2e-6, 0.1e-6}) {
    const Pose low = At(gap, 0.5e-6);
    EXPECT_NEAR(NearestAgainst(Find(low, Vec3::Zero(), false), way), gap, 1e-9);
    EXPECT_GT(NearestAgainst(Find(low, Vec3::Zero()), way), 1);
    EXPECT_GT(NearestAgainst(Find(low, kStepAhead * way), way), 1);
  }
}

TEST_F(BrokenEdges, HigherLedgesAreMetAsDrawn) {
  const Vec3 way = Vec3::UnitX();
  for (const double gap : {30e-6, 2e-6, 0.1e-6, -0.1e-6}) {
    const Pose high = At(gap, 5e-6);
    EXPECT_NEAR(NearestAgainst(Find(high, Vec3::Zero()), way), gap, 1e-9);
    EXPECT_NEAR(NearestAgainst(Find(high, kStepAhead * way), way), gap, 1e-9);
  }
}

TEST_F(BrokenEdges, PastTheSideOfALowLedgeItsTopIsTouched) {
  const std::span<const Contact> contacts = Find(At(-0.1e-6, 0.5e-6), Vec3::Zero());
  ASSERT_FALSE(contacts.empty());
  for (const Contact& c : contacts) {
    EXPECT_NEAR(c.nhat_W.z(), 1, 1e-9);
    EXPECT_NEAR(c.distance, -0.5e-6, 1e-9);
  }
}

// Over the edge by 10 um: the nearest point's plane leans, and a straight step would cross it.
TEST_F(BrokenEdges, WhatPassesBesideAnEdgeIsNotHeldUpByIt) {
  const Pose beside = At(5e-6, -10e-6);
  const Vec3 way = Vec3::UnitX();
  EXPECT_LT(NearestAgainst(Find(beside, kStepAhead * way, false), way), 12e-6);
  EXPECT_GT(NearestAgainst(Find(beside, kStepAhead * way), way), 1);
  // Going down as well it would meet the top.
  const Vec3 down = kStepAhead * way - Vec3(0, 0, 15e-6);
  EXPECT_LT(NearestAgainst(Find(beside, down), way), 12e-6);
}

TEST_F(BrokenEdges, FlushBlocksKeepTheirContactOnTop) {
  constexpr double kNearRim = 12e-6;  // [m]; of points so near each other one stands for all.
  for (const double off : {0.0, 0.4e-6, -0.4e-6}) {
    const Pose flush(Vec3(-kHalf + kHeldHalf + off, 0, kHalf + kHeldHalf - 0.3e-6));
    double least = 1;
    double most = -1;
    for (const Contact& c : Find(flush, Vec3::Zero())) {
      EXPECT_NEAR(c.nhat_W.z(), 1, 1e-9);
      least = std::min(least, c.p_WC.x());
      most = std::max(most, c.p_WC.x());
    }
    EXPECT_LT(least, -kHalf + kNearRim);
    EXPECT_GT(most, -kHalf + 2 * kHeldHalf - kNearRim);
  }
}

}  // namespace
}  // namespace hvas::contact
