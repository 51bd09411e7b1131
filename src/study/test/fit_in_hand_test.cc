// The three kinds of fit in the simulated person's hand: the shaft of W7's rig goes in, rests a
// part of the way, and is drawn out again and brought back (N4, N5, W4..W6, W10).

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "fits/paper_scales.h"
#include "haptics/test/rig.h"
#include "person/simulated_person.h"
#include "study/identification.h"

namespace hvas::study {
namespace {

using haptics::HoldState;
using haptics::testing::Above;
using haptics::testing::kDt;
using haptics::testing::kLength;
using haptics::testing::MakeFit;

/** One tick of a hold. */
struct Moment {
  device::DeviceState hand;
  haptics::TickOutput out;
};

/** The rig, with its part on a shelf beside the bushing, and a person. */
class Trial {
 public:
  Trial(std::shared_ptr<const fits::FitForce> fit, double turn_back, std::uint64_t seed,
        const haptics::TickOptions& options = {}, fits::FitKind kind = fits::FitKind::kClearance)
      : rig_(std::move(fit), Above(40e-3, 0.12), options),
        person_({}, seed, spatial::Pose(Vec3(0, 0, 0.3))) {
    rig_.part.mates[0].fit_kind = kind;
    // The rig takes its part at once; here the person does.
    (void)rig_.tick->Drop();
    const spatial::Pose X_BG(rig_.part.p_BoBcm_B);
    simulation::PersonTask task;
    task.occurrence = rig_.part.occurrence;
    task.X_WG_start = rig_.part.X_WB_start * X_BG;
    task.X_WG_goal = rig_.part.X_WB_goal * X_BG;
    task.p_BG = rig_.part.p_BoBcm_B;
    task.engage_distance = kLength;
    task.turn_back = turn_back;
    task.transfer_radius = 0.2;
    EXPECT_TRUE(person_.Assign(task));
  }

  /** Until the person is done, at most for a time [s]; the moments of the hold. */
  std::vector<Moment> Run(double most) {
    std::vector<Moment> moments;
    simulation::OperatorInput input;
    haptics::HoldState before = HoldState::kEmpty;
    for (int i = 0; i * kDt < most && person_.finished_count() == 0; ++i) {
      input.t_ns = static_cast<std::int64_t>(i) * 1'000'000;
      const device::DeviceState hand = person_.Step(input);
      if (hand.is_gripping != (rig_.tick->held() != nullptr)) {
        hand.is_gripping ? rig_.tick->Take(&rig_.part) : void(rig_.tick->Drop());
      }
      const haptics::TickOutput out = rig_.tick->Tick(hand);
      input.F_H_D = out.F_H_D;
      input.hears_seated = out.state == HoldState::kSeated;
      input.hears_capture = out.state == HoldState::kCaptured && before != HoldState::kCaptured;
      input.sees_part = out.occurrence.is_valid();
      input.X_WD = out.X_WD;
      before = out.state;
      if (rig_.tick->held() != nullptr) {
        moments.push_back({hand, out});
      }
    }
    EXPECT_EQ(person_.finished_count(), 1);
    return moments;
  }

  [[nodiscard]] const haptics::testing::Rig& rig() const { return rig_; }

 private:
  haptics::testing::Rig rig_;
  person::SimulatedPerson person_;
};

double CalcHeight(const Moment& moment) {
  return moment.out.X_WD.p().z();
}

/** Where the rest begins and ends: the part no longer moves by a micrometre. */
struct Rest {
  std::size_t begin{0};
  std::size_t end{0};
};

/** The longest stretch in the hole over which the part stays within 2 um. */
Rest FindRest(const std::vector<Moment>& moments) {
  Rest best;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const bool is_in = moments[i].out.insertion_depth > 1e-3;
    if (!is_in || std::abs(CalcHeight(moments[i]) - CalcHeight(moments[begin])) > 2e-6) {
      begin = i;
    }
    if (is_in && i - begin > best.end - best.begin) {
      best = {begin, i};
    }
  }
  return best;
}

/** What the device gave to the hand between two moments; negative: the hand's work [J]. */
double CalcWork(const std::vector<Moment>& moments, std::size_t begin, std::size_t end) {
  double work = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const Moment& m = moments[i];
    work += kDt * (m.out.F_H_W.f.dot(m.hand.V_DH.v) + m.out.F_H_W.t.dot(m.hand.V_DH.w));
  }
  return work;
}

/** Of a hold from when its weight has faded in until the part is back at the height it had then. */
struct Loop {
  double work{0};    // What the hand got back of what it gave, over all [J].
  double excess{0};  // The most it had got back at any time, besides the weight's share [J].
};

Loop CalcLoop(const std::vector<Moment>& moments, double felt_weight) {
  constexpr std::size_t kFadedIn = 340;
  const double height = CalcHeight(moments[kFadedIn]);
  std::size_t end = moments.size() - 1;
  while (end > kFadedIn && CalcHeight(moments[end]) < height) {
    --end;
  }
  Loop loop;
  for (std::size_t i = kFadedIn; i < end; ++i) {
    loop.work += CalcWork(moments, i, i + 1);
    const double of_weight = felt_weight * (height - CalcHeight(moments[i + 1]));
    loop.excess = std::max(loop.excess, loop.work - of_weight);
  }
  return loop;
}

/** Largest true force against coming out while the part has not slipped by more than the bristles
 give, after a rest [N]. */
double CalcBreakaway(const std::vector<Moment>& moments, const Rest& rest) {
  double largest = 0;
  for (std::size_t i = rest.begin; i < moments.size(); ++i) {
    largest = std::max(largest, -moments[i].out.axial_true);
    if (CalcHeight(moments[i]) > CalcHeight(moments[rest.end]) + 20e-6) {
      break;
    }
  }
  return largest;
}

constexpr double kStored = 1e-3;  // [J]; the coupling's, at 1 N

// N5, N6: in, at rest, and out again, of every kind of fit. Energy is never gained, on
// the whole or on the way; at rest the
// part stays and what the fit holds is no more than the hand and the weight ask for.
TEST(FitInHand, InsertsRestsAndComesOutAgain) {
  for (const char* name : {"H7/g6", "H7/k6", "H7/p6"}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(std::string(name) + " seed " + std::to_string(seed));
      const auto fit = MakeFit(name);
      Trial trial(fit, 12e-3, seed);
      const std::vector<Moment> moments = trial.Run(40);
      ASSERT_GT(moments.size(), 3000U);
      const Rest rest = FindRest(moments);
      const double weight = trial.rig().part.mass * 9.81;
      const haptics::TickOptions& options = trial.rig().options;
      const Loop loop = CalcLoop(moments, haptics::MakeForceMap(options.device).Felt(weight));
      RecordProperty(std::string(name) + " loop " + std::to_string(seed),
                     std::to_string(loop.work));
      RecordProperty(std::string(name) + " excess " + std::to_string(seed),
                     std::to_string(loop.excess));
      EXPECT_LT(loop.work, 0);
      EXPECT_LT(loop.excess, kStored);
      EXPECT_LT(moments.back().out.insertion_depth, 1e-9);
      if (fit->max_resistance() == 0) {
        continue;
      }
      ASSERT_GT(rest.end - rest.begin, 700U);
      EXPECT_GT(moments[rest.end].out.insertion_depth, 35e-3);
      for (std::size_t i = rest.begin + 400; i < rest.begin + 700; ++i) {
        ASSERT_LT(std::abs(moments[i].out.axial_true), 1.5 * weight) << i;
      }
      // Of weight and springs the loop gives all back: what is left is the fit's, both ways.
      EXPECT_LT(loop.work, -2 * 0.5 * 30e-3) << "less than half a newton over 30 mm each way";
    }
  }
}

// W8, A3: collision and constraint without the force of the fit. Guided as with it, and home
// sooner.
TEST(FitInHand, IsNotFeltWhereItIsNotRendered) {
  const auto fit = MakeFit("H7/p6");
  haptics::TickOptions without;
  without.renders_fits = false;
  const std::vector<Moment> with_fit = Trial(fit, -1, 1).Run(40);
  const std::vector<Moment> moments = Trial(fit, -1, 1, without).Run(40);
  ASSERT_FALSE(moments.empty());
  EXPECT_EQ(moments.back().out.state, HoldState::kSeated);
  for (const Moment& moment : moments) {
    ASSERT_EQ(moment.out.axial_true, 0);
    ASSERT_EQ(moment.out.axial_felt, 0);
  }
  EXPECT_LT(moments.size(), with_fit.size());
}

// N5: what breaks a press fit loose is mu pi E (1 - c_0^2) delta l, W(6) with W(7); here of smooth
// surfaces, in newtons that no table of ours has.
TEST(FitInHand, BreakawayIsTheClosedForm) {
  for (const double turn_back : {8e-3, 25e-3, 40e-3}) {
    const auto fit = MakeFit("H7/p6", 0);
    Trial trial(fit, turn_back, 4);
    const std::vector<Moment> moments = trial.Run(40);
    const Rest rest = FindRest(moments);
    const double depth = moments[rest.end].out.insertion_depth;
    EXPECT_NEAR(depth, kLength - turn_back, 2e-3);
    const double closed =
        0.15 * std::numbers::pi * 210e9 * (1 - 0.25) * 10.75e-6 * depth;  // H7/p6 in mid zone
    EXPECT_NEAR(CalcBreakaway(moments, rest), closed, 0.02 * closed);
  }
}

// The same of a rough transition fit, and of a pair that slides more easily than it breaks loose.
TEST(FitInHand, BreakawayOfATransitionFitAndOfAPairThatSlips) {
  const auto rough = MakeFit("H7/k6");
  Trial trial(rough, 10e-3, 5);
  const std::vector<Moment> moments = trial.Run(40);
  const Rest rest = FindRest(moments);
  const double expected = rough->CalcReleaseForce(moments[rest.end].out.insertion_depth);
  ASSERT_GT(expected, 100);
  EXPECT_NEAR(CalcBreakaway(moments, rest), expected, 0.02 * expected);

  fits::FitForceParameters p;
  p.nominal_diameter = p.hole_diameter = 0.04;
  p.shaft_diameter = 0.04 + 20e-6;
  p.length = kLength;
  p.friction = {0.12, 0.2, 0.1, 0.2};
  const auto slippery = std::make_shared<const fits::FitForce>(*fits::FitForce::Make(p));
  Trial other(slippery, 10e-3, 6);
  const std::vector<Moment> loose = other.Run(40);
  const Rest still = FindRest(loose);
  const double depth = loose[still.end].out.insertion_depth;
  const double normal = slippery->CalcNormalForce(depth);
  EXPECT_NEAR(CalcBreakaway(loose, still), 0.2 * normal, 0.02 * 0.2 * normal);
  // In with 0.12, out with 0.1 of it while it slides.
  int in = 0;
  int out = 0;
  for (std::size_t i = 1; i < loose.size(); ++i) {
    const haptics::TickOutput& o = loose[i].out;
    const double speed = (CalcHeight(loose[i]) - CalcHeight(loose[i - 1])) / kDt;
    const double there = slippery->CalcNormalForce(o.insertion_depth);
    if (there < 3000 || o.state != HoldState::kMating) {
      continue;
    }
    if (speed < -3e-3) {
      ++in;
      ASSERT_NEAR(o.axial_true, 0.12 * there, 0.03 * 0.12 * there);
    } else if (speed > 5e-3 && loose[i - 1].out.insertion_depth > o.insertion_depth) {
      ++out;
      ASSERT_NEAR(-o.axial_true, 0.1 * there, 0.05 * 0.1 * there);
    }
  }
  EXPECT_GT(in, 200);
  EXPECT_GT(out, 50);
}

// W9, N4: the largest press fit of the rig, 78 kN, is felt as a few newtons and comes out by hand.
TEST(FitInHand, StrongestPressFitComesOutByHand) {
  fits::FitForceParameters p;
  p.nominal_diameter = p.hole_diameter = 0.04;
  p.shaft_diameter = 0.04 + 42e-6;
  p.length = kLength;
  p.roughness = 0;
  Trial trial(std::make_shared<const fits::FitForce>(*fits::FitForce::Make(p)), 2e-3, 7);
  const std::vector<Moment> moments = trial.Run(60);
  double most_true = 0;
  double most_felt = 0;
  for (const Moment& m : moments) {
    most_true = std::max(most_true, std::abs(m.out.axial_true));
    most_felt = std::max(most_felt, std::abs(m.out.axial_felt));
  }
  EXPECT_GT(most_true, 74'000);
  EXPECT_LT(most_felt, 0.85 * trial.rig().options.device.max_force);
  EXPECT_GT(most_felt, 5);
  EXPECT_EQ(moments.back().out.insertion_depth, 0);
}

// W10: with the paper's factors, interference is felt with up to 6 N, and proportional to the
// truth.
TEST(FitInHand, PaperMapShowsThePapersRange) {
  haptics::TickOptions options;
  options.force_map = haptics::ForceMapKind::kPaper;
  const auto fit = MakeFit("H7/p6", 0);
  const double factor = fits::FindPaperScale(fits::FitKind::kInterference).factor;
  Trial trial(fit, 3e-3, 8, options, fits::FitKind::kInterference);
  const std::vector<Moment> moments = trial.Run(60);
  double most = 0;
  for (const Moment& m : moments) {
    most = std::max(most, m.out.axial_felt);
    if (m.out.axial_felt > 0) {
      ASSERT_NEAR(m.out.axial_felt, factor * m.out.axial_true, 0.35);  // Its side rubs, too.
    }
  }
  EXPECT_NEAR(most, 6 * 47.0 / 50, 0.3);  // Turned back 3 mm before the end.
}

// W12: what the simulated observer is given is what the tick gives to the hand.
TEST(FitInHand, FeelsWhatTheObserverIsShown) {
  for (const auto map : {haptics::ForceMapKind::kPublished, haptics::ForceMapKind::kPaper}) {
    for (const fits::FitKind kind : {fits::FitKind::kInterference, fits::FitKind::kTransition}) {
      haptics::TickOptions options;
      options.force_map = map;
      const auto fit = MakeFit(kind == fits::FitKind::kInterference ? "H7/p6" : "H7/k6");
      Trial trial(fit, 5e-3, 9, options, kind);
      const std::vector<Moment> moments = trial.Run(40);
      int compared = 0;
      for (std::size_t i = 1; i < moments.size(); ++i) {
        const haptics::TickOutput& out = moments[i].out;
        const double speed = (CalcHeight(moments[i]) - CalcHeight(moments[i - 1])) / kDt;
        const double least = CalcFeltForce(*fit, kind, out.insertion_depth, 0, map, options.device);
        if (out.state != HoldState::kMating || speed > -2e-3 || least < 0.3) {
          continue;
        }
        // The side's friction: at most of a hand that is 3 mm beside the axis.
        const double most =
            CalcFeltForce(*fit, kind, out.insertion_depth, 0.45, map, options.device);
        ++compared;
        ASSERT_GE(out.axial_felt, 0.98 * least);
        ASSERT_LE(out.axial_felt, 1.02 * most);
      }
      EXPECT_GT(compared, 300);
    }
  }
}

}  // namespace
}  // namespace hvas::study
