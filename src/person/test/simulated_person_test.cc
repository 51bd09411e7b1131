#include "person/simulated_person.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "base/digest.h"

namespace hvas::person {
namespace {

using device::DeviceState;
using spatial::Pose;
using spatial::Wrench;

constexpr double kTick = 1e-3;
constexpr double kDeviceForce = 7.9;  // [N]; the force-feedback device never gives more

/** A part on a table at (0.2, 0.3, -0.3) that goes to the origin from above. */
simulation::PersonTask MakeTask() {
  simulation::PersonTask task;
  task.occurrence = product::OccurrenceId(1);
  task.X_WG_start = Pose(Vec3(0.2, 0.3, -0.3));
  task.X_WG_goal = Pose(Vec3(0, 0, 0));
  task.engage_distance = 20e-3;
  task.transfer_radius = 0.12;
  return task;
}

Pose StartOfHand() {
  return Pose(Vec3(0, 0, 0.15));
}

/** What a world answers to the hand, given its state. */
using World = std::function<simulation::OperatorInput(const DeviceState&)>;

simulation::OperatorInput Nothing(const DeviceState&) {
  return {};
}

/** Lets a person do one task in a world, at most for a time [s], and keeps every sample. */
std::vector<DeviceState> Perform(SimulatedPerson* person, const World& world, double time) {
  std::vector<DeviceState> states;
  simulation::OperatorInput input;
  EXPECT_TRUE(person->Assign(MakeTask()));
  for (int i = 0; i * kTick < time && person->finished_count() == 0; ++i) {
    input.t_ns = static_cast<std::int64_t>(i) * 1'000'000;
    states.push_back(person->Step(input));
    input = world(states.back());
  }
  return states;
}

std::string Hash(const std::vector<DeviceState>& states) {
  Digest digest;
  for (const DeviceState& state : states) {
    for (int k = 0; k < 3; ++k) {
      digest.AddDouble(state.X_DH.p()[k]);
      digest.AddDouble(state.V_DH.v[k]);
      digest.AddDouble(state.V_DH.w[k]);
    }
    for (const double c : state.X_DH.q().coeffs()) {
      digest.AddDouble(c);
    }
    digest.AddInt(state.is_gripping ? 1 : 0);
  }
  return digest.Hex();
}

bool IsFinite(const DeviceState& state) {
  return spatial::IsFinite(state.X_DH) && state.V_DH.v.allFinite() && state.V_DH.w.allFinite();
}

/** The wall at a height, as a device shows it: a spring and damper that only push, up to the
 device's force. The part is stopped wherever the hand holds it. */
World Wall(double height, double stiffness = 1000) {
  return [=](const DeviceState& state) {
    simulation::OperatorInput input;
    const double depth = height - state.X_DH.p().z();
    if (state.is_gripping && depth > 0 && state.X_DH.p().head<2>().norm() < 0.05) {
      const double force = stiffness * depth - 8 * state.V_DH.v.z();
      input.F_H_D.f.z() = std::clamp(force, 0.0, kDeviceForce);
    }
    return input;
  };
}

/** The place: heard as soon as the hand is at the goal. */
simulation::OperatorInput OpenPlace(const DeviceState& state) {
  simulation::OperatorInput input;
  input.hears_seated = state.is_gripping && state.X_DH.p().norm() < 2e-3;
  return input;
}

/** Without aim error and tremor, and with an arm so stiff and light that the hand is where the
 person wants it. */
PersonOptions StiffAndSteady() {
  PersonOptions options;
  options.mass = 0.02;
  options.stiffness = 2000;
  options.damping = 12;
  options.aim_error = 0;
  options.aim_error_angle = 0;
  options.tremor = 0;
  return options;
}

/** Samples until the hand closes, without the wait on the part at the end. */
std::vector<DeviceState> FirstReach(const PersonOptions& options) {
  SimulatedPerson person(options, 1, StartOfHand());
  std::vector<DeviceState> states = Perform(&person, Nothing, 5);
  const auto grip = std::find_if(states.begin(), states.end(),
                                 [](const DeviceState& state) { return state.is_gripping; });
  states.erase(grip, states.end());
  return states;
}

TEST(SimulatedPersonTest, ReachIsAMinimumJerkMovement) {  // Flash and Hogan 1985, eq. (1)
  const std::vector<DeviceState> states = FirstReach(StiffAndSteady());
  const Vec3 from = StartOfHand().p();
  const Vec3 to = MakeTask().X_WG_start.p();
  const double duration = (to - from).norm() / (1.5 * PersonOptions().carry_speed);
  const int n = static_cast<int>(std::lround(duration / kTick));
  ASSERT_LT(n, static_cast<int>(states.size()));
  double worst = 0;
  double peak = 0;
  for (int i = 0; i < n; ++i) {
    // The task is taken up in the first sample.
    const double s = static_cast<double>(i) * kTick / duration;
    const double x = s * s * s * (10 - 15 * s + 6 * s * s);
    const std::size_t k = static_cast<std::size_t>(i);
    worst = std::max(worst, (states[k].X_DH.p() - (from + x * (to - from))).norm());
    peak = std::max(peak, states[k].V_DH.v.norm());
  }
  EXPECT_LT(worst, 3e-3) << "of a way of " << (to - from).norm();
  EXPECT_NEAR(peak / ((to - from).norm() / duration), 1.875, 0.01);
  // Symmetric in time.
  for (int i = 20; i < n / 2; ++i) {
    const double early = states[static_cast<std::size_t>(i)].V_DH.v.norm();
    const double late = states[static_cast<std::size_t>(n - i)].V_DH.v.norm();
    EXPECT_NEAR(early, late, 0.03 * peak) << i;
  }
}

TEST(SimulatedPersonTest, HumanArmStillMovesInABellOfSpeed) {
  // With the arm's own mass and stiffness the hand lags, but the speed keeps the shape.
  const std::vector<DeviceState> states = FirstReach({});
  const double way = (MakeTask().X_WG_start.p() - StartOfHand().p()).norm();
  const double duration = way / (1.5 * PersonOptions().carry_speed);
  double peak = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].V_DH.v.norm() > peak) {
      peak = states[i].V_DH.v.norm();
      at = i;
    }
  }
  EXPECT_NEAR(peak / (way / duration), 1.875, 0.25);
  EXPECT_NEAR(static_cast<double>(at) * kTick, 0.5 * duration, 0.12 * duration);
  EXPECT_LT(states.back().V_DH.v.norm(), 0.02);
  EXPECT_LT((states.back().X_DH.p() - MakeTask().X_WG_start.p()).norm(), 2e-3);
}

TEST(SimulatedPersonTest, BringsThePartToItsPlaceAndLetsGo) {
  SimulatedPerson person({}, 5, StartOfHand());
  const std::vector<DeviceState> states = Perform(&person, OpenPlace, 30);
  EXPECT_EQ(person.finished_count(), 1);
  EXPECT_FALSE(person.gave_up());
  EXPECT_FALSE(states.back().is_gripping);
  EXPECT_LT(states.back().X_DH.p().norm(), 5e-3);
  // It is carried around the product and not through it.
  bool is_carrying = false;
  for (const DeviceState& state : states) {
    EXPECT_TRUE(IsFinite(state));
    is_carrying = is_carrying || state.is_gripping;
    const double from_axis = state.X_DH.p().head<2>().norm();
    if (is_carrying && from_axis > 0.02) {
      EXPECT_GT(state.X_DH.p().norm(), 0.11);
    }
  }
}

TEST(SimulatedPersonTest, EqualSeedsMoveAlikeAndOthersDoNot) {
  std::vector<std::string> hashes;
  for (const std::uint64_t seed : {7, 7, 8}) {
    SimulatedPerson person({}, seed, StartOfHand());
    hashes.push_back(Hash(Perform(&person, Wall(10e-3), 15)));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_NE(hashes[0], hashes[2]);
}

TEST(SimulatedPersonTest, AimsWithTheErrorOfItsOptions) {
  // Where the hand is when insertion begins, over many people: the standard deviation of the aim.
  PersonOptions options = StiffAndSteady();
  options.aim_error = 0.7e-3;
  double sum = 0;
  double squares = 0;
  constexpr int kPeople = 200;
  for (int seed = 0; seed < kPeople; ++seed) {
    SimulatedPerson person(options, static_cast<std::uint64_t>(seed), StartOfHand());
    Vec3 p = Vec3::Zero();
    (void)Perform(
        &person,
        [&p](const DeviceState& state) {
          simulation::OperatorInput input;
          const bool is_close = state.is_gripping && state.X_DH.p().head<2>().norm() < 0.01 &&
                                state.X_DH.p().z() < 20e-3;
          if (is_close) {
            p = state.X_DH.p();
            input.hears_seated = true;
          }
          return input;
        },
        30);
    sum += p.x() + p.y();
    squares += p.x() * p.x() + p.y() * p.y();
  }
  const double n = 2.0 * kPeople;
  const double mean = sum / n;
  const double deviation = std::sqrt(squares / n - mean * mean);
  // The hand's last sample also has what it moved on, hence the generous mean.
  EXPECT_NEAR(mean, 0, 4 * options.aim_error / std::sqrt(n) + 0.05e-3);
  EXPECT_NEAR(deviation, options.aim_error, 4 * options.aim_error / std::sqrt(2 * n));
}

TEST(SimulatedPersonTest, PressesHarderWhenStuckButNotBeyondItsLimit) {
  const PersonOptions options;
  SimulatedPerson person(options, 3, StartOfHand());
  double peak = 0;
  std::vector<double> forces;
  const World wall = Wall(15e-3);
  (void)Perform(
      &person,
      [&](const DeviceState& state) {
        const simulation::OperatorInput input = wall(state);
        if (person.searches() == 0 && input.F_H_D.f.z() > 0) {
          forces.push_back(input.F_H_D.f.z());
        }
        peak = std::max(peak, input.F_H_D.f.z());
        return input;
      },
      60);
  // From the first touch to the first search the push grows from its first value by at least 1 N,
  // tremor aside.
  ASSERT_GT(forces.size(), 500u);
  const auto mean = [&forces](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) {
      sum += forces[i];
    }
    return sum / static_cast<double>(last - first);
  };
  const std::size_t n = forces.size();
  EXPECT_GT(mean(n - 200, n), mean(200, 400) + 0.5);
  EXPECT_GT(peak, options.push_limit - 1.0);
  EXPECT_LT(peak, options.push_limit + 0.7);
  EXPECT_LT(peak, kDeviceForce);
}

TEST(SimulatedPersonTest, SearchesThenGivesUpOnAWallAndBringsThePartBack) {
  PersonOptions options;
  options.patience_s = 8;
  SimulatedPerson person(options, 11, StartOfHand());
  double time_at_wall = 0;
  const World wall = Wall(15e-3);
  const std::vector<DeviceState> states = Perform(
      &person,
      [&](const DeviceState& state) {
        const simulation::OperatorInput input = wall(state);
        time_at_wall += input.F_H_D.f.z() > 0 ? kTick : 0;
        return input;
      },
      60);
  EXPECT_EQ(person.finished_count(), 1);
  EXPECT_TRUE(person.gave_up());
  EXPECT_GE(person.searches(), 2);
  EXPECT_GT(time_at_wall, 2);
  EXPECT_LT(time_at_wall, options.patience_s);
  for (const DeviceState& state : states) {
    ASSERT_TRUE(IsFinite(state));
  }
  // Back over the table where it took the part up, and open only there.
  EXPECT_FALSE(states.back().is_gripping);
  EXPECT_LT((states.back().X_DH.p() - MakeTask().X_WG_start.p()).norm(), 10e-3);
  const auto last_grip = std::find_if(states.rbegin(), states.rend(),
                                      [](const DeviceState& s) { return s.is_gripping; });
  EXPECT_LT((last_grip->X_DH.p() - MakeTask().X_WG_start.p()).norm(), 10e-3);
}

TEST(SimulatedPersonTest, SearchFindsAHoleBesideItsAim) {
  // A wall with a hole of 0.6 mm radius 1 mm beside the goal: a hand has to look around for it.
  const World wall = Wall(15e-3);
  int found = 0;
  int searched = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SimulatedPerson person({}, seed, StartOfHand());
    bool is_in_hole = false;
    (void)Perform(
        &person,
        [&](const DeviceState& state) {
          const Vec3& p = state.X_DH.p();
          const double beside = (p.head<2>() - Eigen::Vector2d(1e-3, 0)).norm();
          is_in_hole = p.z() < 15e-3 && (is_in_hole || beside < 0.6e-3);
          return is_in_hole ? OpenPlace(state) : wall(state);
        },
        60);
    found += person.finished_count() == 1 && !person.gave_up() ? 1 : 0;
    searched += person.searches() > 0 ? 1 : 0;
  }
  EXPECT_GE(found, 8);
  EXPECT_GE(searched, 3) << "the test is too easy";
}

TEST(SimulatedPersonTest, HoldsUpAWeightItHasLearned) {
  // With 5 N more in the hand it does not sink by F/k = 12.5 mm where the carry ends.
  const auto highest_over_place = [](double weight) {
    SimulatedPerson person({}, 2, StartOfHand());
    const std::vector<DeviceState> states = Perform(
        &person,
        [weight](const DeviceState& state) {
          simulation::OperatorInput input = OpenPlace(state);
          input.F_H_D.f.z() = state.is_gripping ? -weight : 0;
          return input;
        },
        30);
    double highest = 0;
    for (const DeviceState& state : states) {
      if (state.is_gripping && state.X_DH.p().head<2>().norm() < 5e-3) {
        highest = std::max(highest, state.X_DH.p().z());
      }
    }
    return highest;
  };
  EXPECT_NEAR(highest_over_place(5), highest_over_place(0), 2e-3);
}

TEST(SimulatedPersonTest, AnyForceThatADeviceCanGiveLeavesTheHandFiniteAndNear) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SimulatedPerson person({}, seed, StartOfHand());
    Random random(100 + seed);
    const std::vector<DeviceState> states = Perform(
        &person,
        [&random](const DeviceState&) {
          simulation::OperatorInput input;
          for (int k = 0; k < 3; ++k) {
            input.F_H_D.f[k] = random.Uniform(-kDeviceForce, kDeviceForce);
            input.F_H_D.t[k] = random.Uniform(-0.4, 0.4);
          }
          return input;
        },
        60);
    for (const DeviceState& state : states) {
      ASSERT_TRUE(IsFinite(state));
      ASSERT_LT(state.X_DH.p().norm(), 1.5);
      ASSERT_LT(state.V_DH.v.norm(), 3);
    }
  }
}

TEST(SimulatedPersonTest, WithoutATaskTheHandStaysOpenWhereItIs) {
  SimulatedPerson person({}, 1, StartOfHand());
  for (int i = 0; i < 3000; ++i) {
    const DeviceState state = person.Step({});
    ASSERT_FALSE(state.is_gripping);
    ASSERT_LT((state.X_DH.p() - StartOfHand().p()).norm(), 1e-3);  // tremor
  }
  EXPECT_EQ(person.finished_count(), 0);
}

TEST(SimulatedPersonTest, TakesNoMoreTasksThanItCanRemember) {
  SimulatedPerson person({}, 1, StartOfHand());
  int taken = 0;
  for (int i = 0; i < 100; ++i) {
    taken += person.Assign(MakeTask()) ? 1 : 0;
  }
  EXPECT_GE(taken, 1);
  EXPECT_LT(taken, 100);
}

}  // namespace
}  // namespace hvas::person
