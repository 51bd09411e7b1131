#include "studio/live_run.h"

#include <memory>

#include <gtest/gtest.h>

#include "base/loop_clock.h"
#include "simulation/test/small_models.h"

namespace hvas::studio {
namespace {

using spatial::Pose;

constexpr std::size_t kPegIndex = 1;

/** The last that a run told, kept for the test's thread. */
class Listener {
 public:
  [[nodiscard]] LiveListeners functions() {
    LiveListeners listeners;
    listeners.on_event = [this](const simulation::SimulationEvent& event) {
      if (event.kind == simulation::SimulationEvent::Kind::kDevice) {
        condition_ = event.condition;
      }
    };
    listeners.on_placement = [](product::OccurrenceId, const simulation::PartState&) {};
    listeners.on_step = [](std::size_t) {};
    listeners.on_frame = [this](const simulation::Frame& frame, std::int64_t clock_ns,
                                const PeakForces&) {
      const std::lock_guard lock(mutex_);
      has_true_clock_ = has_true_clock_ && clock_ns >= start_ns_ && clock_ns <= MonotonicNs();
      frame_ = frame;
    };
    return listeners;
  }

  [[nodiscard]] device::Condition condition() const { return condition_; }

  /** All frames were computed since the listener began, and before they came. */
  [[nodiscard]] bool has_true_clock() const {
    const std::lock_guard lock(mutex_);
    return has_true_clock_;
  }

  [[nodiscard]] simulation::Frame frame() const {
    const std::lock_guard lock(mutex_);
    return frame_;
  }

 private:
  std::atomic<device::Condition> condition_{device::Condition::kReady};
  const std::int64_t start_ns_{MonotonicNs()};
  mutable std::mutex mutex_;
  bool has_true_clock_{true};
  simulation::Frame frame_;
};

/** A live run with an emulated device in the hand, which the pointer moves. */
class LiveRunTest : public ::testing::Test {
 protected:
  LiveRunTest() : model_(simulation::testing::PegInBlockModel()) {
    device_ = std::make_shared<device::OpenedDevice>(
        *device::OpenAnyDevice("emulated:forcedimension:sigma7", false));
    Begin();
  }

  void Begin() {
    LiveOptions options;
    options.hands = {{device_, 0}};
    options.clock = &clock_;
    run_ = std::make_unique<LiveRun>(model_, LiveState(), options, listener_.functions());
  }

  void SetFault(device::Fault fault) { device_->emulator->device().SetFault(fault); }

  /** Moves the hand to a place until something holds, for a minute of the session at most. */
  bool MoveUntil(const Vec3& p_WH, const std::function<bool()>& holds) {
    constexpr std::int64_t kInputNs = 10'000'000;  // Between inputs of a page.
    for (const std::int64_t end_ns = clock_.NowNs() + 60 * kNsPerSecond; !holds();) {
      if (clock_.NowNs() >= end_ns) {
        return false;
      }
      run_->Move(0, Pose(p_WH), true);
      clock_.Advance(kInputNs);
    }
    return true;
  }

  [[nodiscard]] double force() const {
    const simulation::Frame frame = listener_.frame();
    return frame.ticks.empty() ? 0 : frame.ticks[0].F_H_D.f.norm();
  }

  /** What the safety gate did last, as a test that fails tells. */
  [[nodiscard]] std::string Reasons() const {
    const simulation::Frame frame = listener_.frame();
    std::string reasons = "the safety gate:";
    const std::uint32_t now = frame.ticks.empty() ? 0 : frame.ticks[0].gate_actions;
    for (const haptics::GateAction action : haptics::ListNewActions(0, now)) {
      reasons += std::string(" ") + haptics::ToString(action) + ";";
    }
    return reasons;
  }

  SteeredClock clock_;
  std::shared_ptr<const simulation::Model> model_;
  Listener listener_;
  std::shared_ptr<device::OpenedDevice> device_;
  std::unique_ptr<LiveRun> run_;
};

TEST_F(LiveRunTest, DeviceThatIsPulledOutGivesNoForceAndIsTakenUpAgain) {  // N6
  const Pose X_WB = run_->state().parts[kPegIndex].X_WB;
  const sequence::SequenceStep step =
      *std::find_if(model_->sequence.steps.begin(), model_->sequence.steps.end(),
                    [](const auto& s) { return s.occurrence.index() == kPegIndex; });
  const Vec3 p_WH = X_WB * model_->bodies[kPegIndex].mass.p_BoBcm_B;
  run_->Take(0, step, Pose(p_WH));
  ASSERT_TRUE(MoveUntil(p_WH, [this] { return run_->is_holding(0); }));
  const Vec3 p_below = p_WH - Vec3(0, 0, 0.01);  // into the table
  ASSERT_TRUE(MoveUntil(p_below, [this] { return force() > 0.5; })) << Reasons();
  SetFault(device::Fault::kUnplugged);
  ASSERT_TRUE(
      MoveUntil(p_below, [this] { return listener_.condition() != device::Condition::kReady; }));
  ASSERT_TRUE(MoveUntil(p_below, [this] { return force() == 0; }));
  EXPECT_TRUE(run_->is_holding(0)) << "the part stays where it is";
  SetFault(device::Fault::kNone);
  EXPECT_TRUE(
      MoveUntil(p_below, [this] { return listener_.condition() == device::Condition::kReady; }));
  EXPECT_TRUE(MoveUntil(p_below, [this] { return force() > 0.5; })) << Reasons();
}

TEST_F(LiveRunTest, DeviceGoesFromOneRunToTheNext) {
  const Pose X_WB = run_->state().parts[kPegIndex].X_WB;
  run_.reset();
  Begin();
  const Vec3 p_WH = X_WB * model_->bodies[kPegIndex].mass.p_BoBcm_B;
  EXPECT_TRUE(MoveUntil(p_WH, [&] {
    const simulation::Frame frame = listener_.frame();
    return !frame.ticks.empty() && (frame.ticks[0].X_WH.p() - p_WH).norm() < 2e-3;
  }));
  EXPECT_TRUE(listener_.has_true_clock());
}

TEST(LiveHandTest, RendersWithTheGuidanceAskedForOutsideTrials) {
  const auto& model = simulation::testing::PegInBlockModel();
  HandPurpose purpose;
  purpose.guidance.threads_turn = true;
  purpose.guidance.contact_in_holes = true;
  const haptics::TickOptions tick = LiveHand({}, purpose, *model).tick_options();
  EXPECT_TRUE(tick.guidance.threads_turn);
  EXPECT_TRUE(tick.guidance.contact_in_holes);
  EXPECT_GT(tick.guidance.finish_distance, 0);
  EXPECT_FALSE(LiveHand({}, {}, *model).tick_options().guidance.threads_turn);
}

}  // namespace
}  // namespace hvas::studio
