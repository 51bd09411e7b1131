#include "assembly/stepped_run.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/test/small_models.h"

namespace hvas::assembly {
namespace {

using simulation::HandReference;
using simulation::testing::kFloor;
using simulation::testing::kPegLength;
using simulation::testing::PegInBlockModel;
using spatial::Pose;

constexpr double kGravity = 9.81;  // [m/s^2]

/** A run with the peg in the hand, so far above its place and beside it [m]. */
std::unique_ptr<SteppedRun> Begin(double above, double beside = 0) {
  SteppedOptions options;
  options.X_WB_start = Pose(Vec3(beside, 0, kFloor + above));
  auto run = SteppedRun::Create(PegInBlockModel(), options);
  EXPECT_TRUE(run.has_value()) << run.error().ToString();
  return std::move(*run);
}

HandReference Lead(const SteppedRun& run, const Vec3& p_WB) {
  HandReference reference;
  reference.X_WR = Pose(p_WB) * run.X_HB().Inverse();
  reference.is_gripping = true;
  return reference;
}

std::vector<TickRow> LeadIn(SteppedRun* run) {
  std::vector<TickRow> all;
  for (int i = 0; i < 200 && !run->is_seated(); ++i) {
    const double above = std::max(-10e-3, 30e-3 - 0.4e-3 * i);
    const auto rows = run->Step(Lead(*run, Vec3(0, 0, kFloor + above)), 10);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

TEST(SteppedRunTest, APegThatIsLedInIsSeatedWithTheSameBytesEachTime) {
  const auto run = Begin(30e-3);
  const std::vector<TickRow> rows = LeadIn(run.get());
  EXPECT_TRUE(run->is_seated());
  run->Step(Lead(*run, Vec3(0, 0, kFloor)), 200);
  EXPECT_NEAR(run->last().X_WB[2], kFloor, 1e-6);
  EXPECT_NEAR(run->last().t_s, rows.back().t_s + 0.2, 1e-9);
  const auto again = Begin(30e-3);
  const std::vector<TickRow> same = LeadIn(again.get());
  ASSERT_EQ(same.size(), rows.size());
  EXPECT_EQ(std::memcmp(same.data(), rows.data(), rows.size() * sizeof(TickRow)), 0);
}

TEST(SteppedRunTest, APartThatHangsInTheHandWeighsWhatItWeighs) {
  const auto run = Begin(60e-3);
  const Vec3 place(0, 0, kFloor + 60e-3);
  run->Step(Lead(*run, place), 3000);
  const double mass = PegInBlockModel()->bodies[run->step().occurrence.index()].mass.mass;
  const double* F = run->last().F_felt_W;
  EXPECT_NEAR(F[2], -mass * kGravity, 0.01 * mass * kGravity);
  EXPECT_NEAR(std::hypot(F[0], F[1]), 0, 1e-3 * mass * kGravity);
  // The arm holds it up by its spring.
  const person::PersonOptions arm;
  const double sag = (Lead(*run, place).X_WR.p().z() - run->last().X_WH[2]);
  EXPECT_NEAR(arm.stiffness * sag, -F[2], 1e-3);
}

TEST(SteppedRunTest, APegBesideItsBoreRestsOnTheRimAgainstTheArm) {
  constexpr double kBeside = 9e-3;
  constexpr double kPress = 5e-3;  // How far the hand goes on below the rim [m].
  const double rim = simulation::testing::kBlockHeight - kFloor;
  const auto run = Begin(rim + 1e-3, kBeside);
  const Vec3 below(kBeside, 0, kFloor + rim - kPress);
  run->Step(Lead(*run, below), 3000);
  EXPECT_FALSE(run->is_seated());
  EXPECT_GT(run->last().contacts, 0);
  EXPECT_NEAR(run->last().X_WB[2], kFloor + rim, 0.1e-3);
  const person::PersonOptions arm;
  const double pull = arm.stiffness * (Lead(*run, below).X_WR.p().z() - run->last().X_WH[2]);
  EXPECT_NEAR(run->last().F_felt_W[2], -pull, 0.02);
}

TEST(SteppedRunTest, RefusesWhatIsNoStep) {
  const auto refused = [](const auto& change) {
    SteppedOptions options;
    change(&options);
    const auto run = SteppedRun::Create(PegInBlockModel(), options);
    return !run.has_value() && run.error().code == ErrorCode::kInvalid &&
           !run.error().remedy.empty();
  };
  EXPECT_TRUE(refused([](SteppedOptions* o) { o->step = 0; }));  // The base, in its fixture.
  EXPECT_TRUE(refused([](SteppedOptions* o) { o->step = 99; }));
  EXPECT_TRUE(refused([](SteppedOptions* o) { o->rate_hz = 10; }));
  EXPECT_TRUE(refused([](SteppedOptions* o) {
    o->X_WB_start = Pose(Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0));
  }));
}

TEST(SteppedRunTest, TakesThePartFromTheTable) {
  const auto run = SteppedRun::Create(PegInBlockModel(), {});
  ASSERT_TRUE(run.has_value()) << run.error().ToString();
  EXPECT_EQ((*run)->step().occurrence.index(), 1U);
  const auto parts = (*run)->ListParts();
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].placement, simulation::Placement::kPlaced);
  EXPECT_EQ(parts[1].placement, simulation::Placement::kHeld);
  EXPECT_EQ(parts[1].X_WB.p().z(), (*run)->last().X_WB[2]);
}

}  // namespace
}  // namespace hvas::assembly
