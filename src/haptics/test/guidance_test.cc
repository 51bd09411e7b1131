// The pull of X(9) along and about the axis: none at rest where it would overshoot its goal.

#include "haptics/guidance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::Above;
using testing::kDt;
using testing::Rig;

constexpr double kOneMicrometre = 1e-6;
constexpr double kTenMicroradians = 10e-6;

/** The shaft over its bushing, in a hand that stands still, so far from its place about and along
 the axis. It never arrives, so that what pulls it there goes on. */
struct StillRig : Rig {
  StillRig(double angle, double distance, TickOptions the_options = {})
      : Rig(nullptr, Above(5e-3), std::move(the_options)) {
    part.lacks_partners = true;
    part.X_WB_goal = {spatial::RotationFromVector(Vec3(0, 0, angle)),
                      part.X_WB_start.p() - Vec3(0, 0, distance)};
    Take();
  }
};

/** How far the displayed part moves and turns after it has come to rest. */
struct Unrest {
  double moved{0};
  double turned{0};
};

Unrest CalcUnrest(const std::vector<testing::Sample>& samples, std::size_t first) {
  Unrest unrest;
  const Pose& X_last = samples.back().out.X_WD;
  for (std::size_t i = first; i < samples.size(); ++i) {
    const Pose& X_WD = samples[i].out.X_WD;
    unrest.moved = std::max(unrest.moved, (X_WD.p() - X_last.p()).norm());
    unrest.turned = std::max(unrest.turned, spatial::RotationBetween(X_last.q(), X_WD.q()).norm());
  }
  return unrest;
}

// However near its place a part is captured, it comes to rest in a hand that stands still.
TEST(Guidance, X9AShaftHeldStillComesToRestWhereverItWasCaptured) {
  std::vector<double> starts{0};
  for (double start = 1e-12; start < 0.2; start *= std::sqrt(10.0)) {
    starts.push_back(start);
  }
  for (const double start : starts) {
    for (const bool turns : {true, false}) {
      StillRig rig(turns ? start : 0, turns ? 0 : start);
      rig.hand->Wait(4);
      EXPECT_TRUE(rig.hand->last().axis.mate.is_valid()) << "a mate guides it";
      const Unrest unrest = CalcUnrest(rig.hand->samples, 3000);
      EXPECT_LT(unrest.moved, kOneMicrometre) << (turns ? "turned by " : "away by ") << start;
      EXPECT_LT(unrest.turned, kTenMicroradians) << (turns ? "turned by " : "away by ") << start;
    }
  }
}

}  // namespace
}  // namespace hvas::haptics
