// Hands that hold one part: each is coupled to it as if it held it alone.

#include "haptics/coupling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::kDt;

/** A ball in the first of some hands; the others hold it as well. */
class SharedBall {
 public:
  explicit SharedBall(std::size_t hands, double mass) {
    static const auto shape = contact::testing::Build(contact::testing::Ball(10e-3, 20e-6));
    part_.body = scene_.Add(shape, Pose());
    part_.bodies = {part_.body};
    part_.shape = shape;
    part_.mass = mass;
    part_.I_BBcm_B = 0.4 * mass * 1e-4 * Mat3::Identity();
    part_.X_WB_goal = Pose(Vec3(1, 1, 1));
    options_.gravity_W.setZero();
    for (std::size_t hand = 0; hand < hands; ++hand) {
      ticks_.push_back(std::make_unique<HapticTick>(options_, &scene_, hand));
    }
    poses_.resize(hands);
    outs_.resize(hands);
    ticks_[0]->Take(&part_);
    Run(0.1);
    for (std::size_t hand = 1; hand < hands; ++hand) {
      ticks_[hand]->Help(ticks_[0]->Exchange(hand));
    }
    Run(0.1);
  }

  /** @returns the largest turn from one tick to the next [rad]. */
  double Run(double time) {
    double most = 0;
    for (int i = 0, count = static_cast<int>(time / kDt); i < count; ++i) {
      const Quat q_before = outs_[0].X_WD.q();
      for (std::size_t hand = 0; hand < ticks_.size(); ++hand) {
        std::vector<HandExchange> others;
        for (std::size_t other = 0; other < ticks_.size(); ++other) {
          if (other != hand) {
            others.push_back(ticks_[other]->Exchange(hand));
          }
        }
        device::DeviceState state;
        state.t_ns = t_ns_;
        state.X_DH = poses_[hand];
        state.is_valid = true;
        outs_[hand] = ticks_[hand]->Tick(state, {}, others);
      }
      t_ns_ += 1'000'000;
      most = std::max(most, spatial::RotationBetween(q_before, outs_[0].X_WD.q()).norm());
    }
    return most;
  }

  void Turn(std::size_t hand, const Vec3& turn_W) {
    poses_[hand] = {spatial::RotationFromVector(turn_W), Vec3::Zero()};
  }

  [[nodiscard]] const TickOutput& out(std::size_t hand) const { return outs_[hand]; }

 private:
  TickOptions options_;
  contact::Scene scene_;
  HeldPart part_;
  std::vector<std::unique_ptr<HapticTick>> ticks_;
  std::vector<Pose> poses_;
  std::vector<TickOutput> outs_;
  std::int64_t t_ns_{0};
};

// X1, X2: couplings of all hands are springs and dampers at the end of the step. As forces of the
// last tick the dampers of three hands would throw a light part to and fro.
TEST(Coupling, X1AllHandsThatHoldALightPartHoldItStill) {
  constexpr double kTurn = 50e-3;
  for (std::size_t hands = 1; hands <= kMaxHands; ++hands) {
    SharedBall ball(hands, 1e-3);
    ball.Turn(hands - 1, kTurn * Vec3::UnitZ());
    ball.Run(0.5);
    EXPECT_LT(ball.Run(0.5), 1e-9) << hands << " hands";
    const double share = 1.0 / static_cast<double>(hands);
    EXPECT_NEAR(ball.out(0).X_WD.q().angularDistance(Quat::Identity()), share * kTurn, 1e-6)
        << hands << " hands share the turn of one";
  }
}

}  // namespace
}  // namespace hvas::haptics
