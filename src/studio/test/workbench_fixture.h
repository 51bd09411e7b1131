#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "studio/test/small_bench.h"
#include "studio/workbench.h"

namespace hvas::studio::testing {

inline constexpr std::size_t kBlock = 0;
inline constexpr std::size_t kPeg = 1;
inline constexpr int kSeated = 5;  // docs/protocol.md

/** A live assembly of a block and a peg, in the time of its log. */
class WorkbenchFixture : public ::testing::Test {
 protected:
  WorkbenchFixture() : bench_(SmallBench(log_.clock())) {
    bench_.on_event = [this](Json event) { log_.Add(std::move(event)); };
  }

  void TearDown() override { bench_.Stop(); }

  void OpenPeg() {
    const std::size_t start = log_.size();
    bench_.opener().Open("peg.step", "peg");
    ASSERT_TRUE(log_.Await("scene", start));
    ASSERT_TRUE(
        AwaitPlacement(0, simulation::Placement::kPlaced));  // the base goes into its fixture
  }

  [[nodiscard]] simulation::Placement PlacementOf(std::size_t i) {
    const LiveState state = bench_.live().state();
    return i < state.parts.size() ? state.parts[i].placement : simulation::Placement::kLoose;
  }

  bool AwaitPlacement(std::size_t i, simulation::Placement wanted) {
    return log_.AwaitTrue([&] { return PlacementOf(i) == wanted; });
  }

  std::optional<Json> AwaitPlacementEvent(const std::string& placement, std::size_t start) {
    return log_.Await(
        [&](const Json& event) {
          return event["event"] == "placement" && event["occurrence"] == kPeg &&
                 event["placement"] == placement;
        },
        start);
  }

  /** Takes the peg and waits until it is in the hand. */
  void TakePeg() {
    const std::size_t start = log_.size();
    X_WB_start_ = bench_.live().state().parts[kPeg].X_WB;
    const auto taken = bench_.hands().Take(hand_, product::OccurrenceId(kPeg));
    ASSERT_TRUE(taken) << taken.error().ToString();
    X_WH_ = taken->X_WH;
    X_HB_ = X_WH_.Inverse() * X_WB_start_;
    bench_.hands().Move(hand_, X_WH_, true);  // as a client does that does not wait for the event
    const auto is_taken = [](const Json& event) {
      return event["event"] == "taken" && event["occurrence"] == kPeg;
    };
    ASSERT_TRUE(log_.AwaitTrue([&] {
      bench_.hands().Move(hand_, X_WH_, true);
      return log_.Find(is_taken, start).has_value();
    }));
  }

  /** Moves the peg straight to a pose, with 100 inputs a second. Ends early when the state is
   reached. */
  void MovePeg(const spatial::Pose& X_WB, double seconds, int state = -1) {
    const spatial::Pose from = X_WH_;
    const spatial::Pose to = X_WB * X_HB_.Inverse();
    const Vec3 turn = spatial::RotationBetween(from.q(), to.q());
    const int inputs = static_cast<int>(100 * seconds);
    const std::size_t start = log_.size();
    for (int i = 1; i <= inputs; ++i) {
      const double part = static_cast<double>(i) / inputs;
      X_WH_ = {spatial::RotationFromVector(Vec3(part * turn)) * from.q(),
               Vec3(from.p() + part * (to.p() - from.p()))};
      bench_.hands().Move(hand_, X_WH_, true);
      log_.Pass(0.01);
      if (state >= 0 && HasState(state, start)) {
        return;
      }
    }
  }

  [[nodiscard]] bool HasState(int state, std::size_t start) const {
    const auto fits = [&](const Json& event) {
      return event["event"] == "state" && event["state"] == state;
    };
    return log_.Find(fits, start).has_value();
  }

  /** Moves the peg over the bore, then along its axis to the goal and a little on. */
  void InsertPeg() {
    const std::size_t start = log_.size();
    const spatial::Pose X_goal = bench_.live().scene()->model->bodies[kPeg].X_WB_goal;
    const Vec3 up = X_goal.q() * Vec3::UnitZ();
    const auto above = [&](double height) {
      return spatial::Pose(X_goal.q(), Vec3(X_goal.p() + height * up));
    };
    MovePeg(spatial::Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, 0.08))), 0.8);
    MovePeg(above(0.08), 1.2);
    MovePeg(above(0.03), 0.6);
    MovePeg(above(-0.001), 2.0, kSeated);
    // A hand that took it a little beside where it was seen presses on, as a person does.
    constexpr double kPress = 10e-6;  // Of each input [m].
    constexpr double kFarthest = 8e-3;
    double pressed = 0;
    for (int i = 0; i < 2000 && !HasState(kSeated, start); ++i) {
      const double more = std::min(kPress, kFarthest - pressed);
      pressed += more;
      X_WH_ = {X_WH_.q(), Vec3(X_WH_.p() - more * up)};
      bench_.hands().Move(hand_, X_WH_, true);
      log_.Pass(0.01);
    }
    ASSERT_TRUE(HasState(kSeated, start)) << DescribeHand();
  }

  /** Describes the hand and the part, for a failure that is not seen again. */
  std::string DescribeHand() {
    const haptics::TickOutput tick = bench_.live().frame().frame.ticks.at(hand_);
    const Vec3 lag = tick.X_WT.p() - tick.X_WD.p();
    const Vec3 behind = X_WH_.p() - tick.X_WH.p();
    return fmt::format(
        "{}: depth {:.6f} m, tilt {:.4f} rad, offset {:.6f} m; displayed behind tracked "
        "{:.4f} m, hand behind pointer {:.4f} m; {} contacts, gate {:#x}; {}",
        haptics::ToString(tick.state), tick.axis.depth, tick.axis.tilt, tick.axis.offset,
        lag.norm(), behind.norm(), tick.contact_count, tick.gate_actions,
        bench_.hands().Describe()[hand_]["condition"].dump());
  }

  void ReleasePeg() {
    const std::size_t start = log_.size();
    ASSERT_TRUE(bench_.hands().Release(hand_));
    ASSERT_TRUE(log_.Await("dropped", start));
  }

  /** Waits until a hand has this device. */
  /** Index of the first device of the list whose address begins so. */
  [[nodiscard]] std::size_t FindDevice(const std::string& address) {
    const auto& entries = bench_.hands().devices().entries();
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& entry) {
      return entry.address.starts_with(address);
    });
    EXPECT_NE(found, entries.end()) << address;
    return static_cast<std::size_t>(found - entries.begin());
  }

  bool AwaitDevice(std::size_t hand, std::size_t device, std::size_t start) {
    return log_
        .Await(
            [&](const Json& event) {
              return event["event"] == "hands" && hand < event["hands"].size() &&
                     event["hands"][hand]["device"]["index"] == device;
            },
            start)
        .has_value();
  }

  EventLog log_;
  Workbench bench_;
  std::size_t hand_{0};  ///< That takes the peg.
  spatial::Pose X_WB_start_;
  spatial::Pose X_WH_;
  spatial::Pose X_HB_;
};

}  // namespace hvas::studio::testing
