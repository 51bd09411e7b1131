#include "fits/population.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"
#include "fits/fit_force.h"
#include "fits/population_kernel.h"

namespace hvas::fits {
namespace {

SizeDistribution Exactly(double deviation_um) {
  return *SizeDistribution::FromMeasured(std::vector{units::FromUm(deviation_um)});
}

/** Paper W's rig: 40 mm, hub 80 mm, 50 mm long, steel, mu 0.15, N = 20. */
PopulationLand MakeLand(SizeDistribution hole, SizeDistribution shaft, double rz_um) {
  PopulationLand land{std::move(hole), std::move(shaft), 0, 20, {}};
  land.press.joint_diameter = 0.04;
  land.press.hub_diameter = 0.08;
  land.press.length = 0.05;
  land.press.hub_roughness = land.press.shaft_roughness = units::FromUm(rz_um);
  return land;
}

PopulationLand MakeLand(const char* fit, double rz_um) {
  const FitLimits limits = *CalcFitLimits(*ParseFit(fit), 0.04);
  return MakeLand(SizeDistribution::FromZone(limits.hole), SizeDistribution::FromZone(limits.shaft),
                  rz_um);
}

PopulationParameters MakeBatch(std::vector<PopulationLand> lands, std::int64_t count = 200'000) {
  PopulationParameters p;
  p.lands = std::move(lands);
  p.count = count;
  p.seed = 17;
  return p;
}

// W(8): without spread every assembly has the force of the closed form at every depth.
TEST(Population, WithoutSpreadIsThePressFit) {
  const Population batch = *CalcPopulation(MakeBatch({MakeLand(Exactly(0), Exactly(42), 0)}, 5000));
  ASSERT_EQ(batch.bands.size(), 21U);
  for (const ForceBand& band : batch.bands) {
    const double expected = 77931.133 * band.depth / 0.05;
    EXPECT_NEAR(band.mean, expected, 1e-5 * 77931);  // Single precision, summed.
    for (const double q : band.quantiles) {
      EXPECT_NEAR(q, expected, 77931.0 / 2048 + 1);
    }
  }
  EXPECT_EQ(batch.any_interference_share, 1);
  EXPECT_NEAR(batch.lands[0].mean_clearance, -42e-6, 1e-15);
  EXPECT_NEAR(batch.lands[0].sigma_clearance, 0, 1e-15);
}

// W2: the moments of the clearance are those of the two sizes, within five sampling errors.
TEST(Population, MomentsOfTheClearanceAgreeWithTheSizes) {
  const Limits hole{0, 25e-6};
  const Limits shaft{2e-6, 18e-6};
  const SizeDistribution holes[] = {SizeDistribution::FromZone(hole),
                                    *SizeDistribution::FromCapability(hole, 1.33, 1, true),
                                    SizeDistribution::Uniform(hole),
                                    *SizeDistribution::FromMeasured(std::vector{1e-6, 4e-6, 9e-6})};
  const SizeDistribution shafts = SizeDistribution::FromZone(shaft);
  for (const SizeDistribution& h : holes) {
    const Population batch = *CalcPopulation(MakeBatch({MakeLand(h, shafts, 6.3)}));
    const double sigma = std::sqrt(h.variance() + shafts.variance());
    const double n = static_cast<double>(batch.count);
    EXPECT_NEAR(batch.lands[0].mean_clearance, h.mean() - shafts.mean(), 5 * sigma / std::sqrt(n));
    EXPECT_NEAR(batch.lands[0].sigma_clearance, sigma, 5 * sigma / std::sqrt(2 * n));
  }
}

// N4: P(S < 0) of paper W's fits with normal sizes, sigma a sixth of the zone.
TEST(Population, SharesOfInterferenceAreThoseOfTheNormalDistribution) {
  struct Case {
    const char* fit;
    double share;
  };

  for (const Case& c : {Case{"H7/p6", 1.000}, Case{"H7/k6", 0.307}, Case{"H7/g6", 0}}) {
    const FitLimits limits = *CalcFitLimits(*ParseFit(c.fit), 0.04);
    const Population batch = *CalcPopulation(
        MakeBatch({MakeLand(*SizeDistribution::FromCapability(limits.hole, 1, 1, true),
                            *SizeDistribution::FromCapability(limits.shaft, 1, 1, true), 6.3)}));
    EXPECT_NEAR(batch.any_interference_share, c.share, 0.0055) << c.fit;
    // Of a single land the share is its own, and the curve of its clearance crosses zero there.
    ASSERT_EQ(batch.lands.size(), 1U);
    EXPECT_EQ(batch.lands[0].interference_share, batch.any_interference_share) << c.fit;
    const std::vector<double>& curve = batch.lands[0].clearance_curve;
    ASSERT_FALSE(curve.empty());
    EXPECT_TRUE(std::is_sorted(curve.begin(), curve.end()));
    const auto below = std::lower_bound(curve.begin(), curve.end(), 0.0) - curve.begin();
    EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(curve.size()), c.share, 0.03)
        << c.fit;
  }
}

// Fits-and-insertion 2.4: S_0 = 0, -1, -3.15 um with Rz 6.3 um, N = 20, by another Monte Carlo.
TEST(Population, MeanForcesOfRoughTransitionFitsAgreeWithAnotherMonteCarlo) {
  struct Case {
    double interference_um, mean, low, high;
  };

  for (const Case& c : {Case{0, 2329, 1095, 3748}, Case{2, 4590, 0, 0}, Case{6.3, 11696, 0, 0}}) {
    const Population batch =
        *CalcPopulation(MakeBatch({MakeLand(Exactly(0), Exactly(c.interference_um), 6.3)}));
    const ForceBand& end = batch.bands.back();
    EXPECT_NEAR(end.mean, c.mean, 0.01 * c.mean);
    if (c.low > 0) {
      EXPECT_NEAR(end.quantiles[1], c.low, 0.02 * c.high);
      EXPECT_NEAR(end.quantiles[3], c.high, 0.02 * c.high);
    }
  }
}

// The same forces as single assemblies by FitForce, one by one, with a generator of its own.
TEST(Population, BandsAgreeWithSingleAssemblies) {
  const Population batch = *CalcPopulation(MakeBatch({MakeLand("H7/k6", 6.3)}));
  const FitLimits limits = *CalcFitLimits(*ParseFit("H7/k6"), 0.04);
  const SizeDistribution hole = SizeDistribution::FromZone(limits.hole);
  const SizeDistribution shaft = SizeDistribution::FromZone(limits.shaft);
  Random random(99);
  constexpr int kCount = 20000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kCount; ++i) {
    FitForceParameters p;
    p.nominal_diameter = 0.04;
    p.hole_diameter = 0.04 + hole.Quantile(random.Uniform());
    p.shaft_diameter = 0.04 + shaft.Quantile(random.Uniform());
    p.length = 0.05;
    p.seed = random.NextBits();
    const double force = FitForce::Make(p)->CalcAxialResistance(0.025);
    sum += force;
    squares += force * force;
  }
  const double mean = sum / kCount;
  const double error = std::sqrt((squares / kCount - mean * mean) / kCount);
  EXPECT_NEAR(batch.bands[10].mean, mean, 5 * error);
}

// W(8): where every pair interferes all along, the force is linear in the sizes and in B: its mean
// and its spread are sums of theirs. Trapezoids give the N + 1 values of B weights of 1/2 at the
// ends.
TEST(Population, MomentsOfTheForceOfATightFitAreAnalytic) {
  const FitLimits limits = *CalcFitLimits(*ParseFit("H7/s6"), 0.04);
  const SizeDistribution hole = SizeDistribution::Uniform({limits.hole.lower, 17e-6});
  const SizeDistribution shaft = SizeDistribution::FromZone(limits.shaft);
  const Population batch = *CalcPopulation(MakeBatch({MakeLand(hole, shaft, 6.3)}, 400'000));
  const double per_metre = 3711.01e6;  // Of radial interference at full depth [N/m].
  const double mean = per_metre * 0.5 * (shaft.mean() - hole.mean());
  const double of_b = 6.3e-6 * 6.3e-6 / 12 * (19 + 2 * 0.25) / (20 * 20);
  const double sigma = per_metre * std::sqrt(0.25 * (shaft.variance() + hole.variance()) + of_b);
  const ForceBand& end = batch.bands.back();
  EXPECT_NEAR(end.mean, mean, 5 * sigma / std::sqrt(400'000.0) + 1e-5 * mean);
  // By its 5 and 95 % quantiles: a uniform and a normal size make nearly a normal distribution.
  const double spread = (end.quantiles[3] - end.quantiles[1]) / (2 * 1.645);
  EXPECT_NEAR(spread, sigma, 0.03 * sigma);
  EXPECT_EQ(batch.any_interference_share, 1);
}

TEST(Population, FiguresDoNotDependOnTheNumberOfThreads) {
  PopulationParameters p = MakeBatch({MakeLand("H7/k6", 6.3), MakeLand("H7/p6", 3.2)}, 50'001);
  p.press_force = 40e3;
  const Population one = *CalcPopulation(p);
  for (const int threads : {2, 3, 7}) {
    p.threads = threads;
    const Population many = *CalcPopulation(p);
    EXPECT_EQ(one.over_press_share, many.over_press_share);
    for (std::size_t d = 0; d < one.bands.size(); ++d) {
      EXPECT_EQ(one.bands[d].mean, many.bands[d].mean);
      EXPECT_EQ(one.bands[d].quantiles, many.bands[d].quantiles);
    }
    for (std::size_t k = 0; k < one.lands.size(); ++k) {
      EXPECT_EQ(one.lands[k].mean_clearance, many.lands[k].mean_clearance);
      EXPECT_EQ(one.lands[k].sigma_clearance, many.lands[k].sigma_clearance);
      EXPECT_EQ(one.lands[k].clearance_quantiles, many.lands[k].clearance_quantiles);
    }
  }
}

// Two lands one behind the other: their forces add up at each depth.
TEST(Population, SeveralLandsAddUpAlongTheDepth) {
  PopulationLand first = MakeLand(Exactly(0), Exactly(20), 0);
  first.press.length = 0.02;
  PopulationLand second = MakeLand(Exactly(0), Exactly(10), 0);
  second.press.length = 0.02;
  second.start = 0.03;
  PopulationParameters p = MakeBatch({first, second}, 4096);
  p.depths = 25;
  const Population batch = *CalcPopulation(p);
  const double per_metre = 3711.01e6 / 0.05;  // Of radial interference, N/m per m.
  for (const ForceBand& band : batch.bands) {
    const double expected =
        per_metre * (10e-6 * std::min(band.depth, 0.02) + 5e-6 * std::max(0.0, band.depth - 0.03));
    EXPECT_NEAR(band.mean, expected, 1e-5 * 22266);
  }
}

TEST(Population, CountsWhatExceedsThePressAndWhatYields) {
  PopulationParameters p = MakeBatch(
      {MakeLand(Exactly(0), *SizeDistribution::FromMeasured(std::vector{10e-6, 42e-6}), 0)},
      40'000);
  p.press_force = 50e3;
  p.lands[0].press.hub.yield_strength = 150e6;
  const Population batch = *CalcPopulation(p);
  const double error = 5 * std::sqrt(0.25 / 40'000);
  EXPECT_NEAR(batch.over_press_share, 0.5, error);
  EXPECT_EQ(batch.over_press_share, batch.any_yield_share);
}

#ifdef HVAS_HAS_AVX2_POPULATION
/** Clearances of assemblies, room up to a multiple of kLanes filled as blocks have to. */
std::vector<float> DrawPaddedClearances(int count) {
  Random random(4);
  std::vector<float> clearance_um(static_cast<std::size_t>(count + kLanes), kFarApart_um);
  for (int i = 0; i < count; ++i) {
    clearance_um[static_cast<std::size_t>(i)] = static_cast<float>(random.Uniform(-20, 20));
  }
  return clearance_um;
}

/** What a kernel makes of a block of lands. */
struct Counted {
  std::vector<std::uint16_t> bins;
  std::vector<float> sums;
  std::int32_t over{0};

  Counted(void (*function)(PopulationBlock*), const std::vector<LandView>& lands, int depths,
          int count) {
    const int stride = count + kLanes;
    const std::vector<float> bins_per_newton(static_cast<std::size_t>(depths), 0.3F);
    bins.resize(static_cast<std::size_t>(depths * stride));
    sums.resize(static_cast<std::size_t>(depths * kLanes));
    PopulationBlock block{lands.data(),
                          static_cast<std::int32_t>(lands.size()),
                          depths,
                          count,
                          123,
                          300,
                          bins_per_newton.data(),
                          bins.data(),
                          stride,
                          sums.data(),
                          0};
    function(&block);
    over = block.over_press;
  }
};

void ExpectSame(const Counted& a, const Counted& b) {
  EXPECT_EQ(a.bins, b.bins);
  EXPECT_EQ(std::memcmp(a.sums.data(), b.sums.data(), a.sums.size() * sizeof(float)), 0);
  EXPECT_EQ(a.over, b.over);
  EXPECT_GT(a.over, 5);
}

// Depths between the stations and several lands; and depths at the stations of one.
// The generator as published: https://prng.di.unimi.it/xoshiro128plusplus.c, seeded by SplitMix64.
TEST(Population, BitsAreThoseOfThePublishedGenerator) {
  constexpr std::uint64_t kSeed = 0x0123456789abcdefULL;
  constexpr std::int32_t kCount = 100 * kLanes;
  std::uint64_t state = kSeed;
  const auto split_mix = [&state] {
    std::uint64_t z = state += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
  };
  std::array<std::array<std::uint32_t, 4>, kLanes> lanes{};
  for (std::size_t word = 0; word < 4; ++word) {
    for (auto& lane : lanes) {
      lane[word] = split_mix();
    }
  }
  std::vector<std::uint32_t> bits(kCount);
  DrawBitsScalar(kSeed, kCount, bits.data());
  const auto rotate = [](std::uint32_t x, int k) { return (x << k) | (x >> (32 - k)); };
  for (std::size_t i = 0; i < bits.size(); ++i) {
    std::array<std::uint32_t, 4>& s = lanes[i % kLanes];
    ASSERT_EQ(bits[i], rotate(s[0] + s[3], 7) + s[0]) << i;
    const std::uint32_t t = s[1] << 9;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = rotate(s[3], 11);
  }
}

TEST(Population, BothKernelsGiveTheSameBits) {
  if (!__builtin_cpu_supports("avx2")) {
    return;  // Nothing to compare on this machine.
  }
  constexpr int kCount = 61;
  const std::vector<float> clearance_um = DrawPaddedClearances(kCount);
  const std::vector<LandDepth> between{{-1, 0}, {0, 1}, {3, 0.37F}, {6, 1}};
  const LandView land{7, 3.15F, 12.5F, clearance_um.data(), between.data()};
  const std::vector<LandView> lands{land, {5, 1.6F, 7.5F, clearance_um.data(), between.data()}};
  ExpectSame(Counted(CountForcesScalar, lands, 4, kCount),
             Counted(CountForcesAvx2, lands, 4, kCount));
  const std::vector<LandDepth> at{{-1, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 1}};
  const std::vector<LandView> one{{4, 3.15F, 12.5F, clearance_um.data(), at.data()}};
  ExpectSame(Counted(CountForcesScalar, one, 5, kCount), Counted(CountForcesAvx2, one, 5, kCount));
}

TEST(Population, BothKernelsTakeTheSameSizes) {
  if (!__builtin_cpu_supports("avx2")) {
    return;  // Nothing to compare on this machine.
  }
  constexpr int kCount = 61;
  const std::vector<float> hole_um = DrawPaddedClearances(kCount);
  std::vector<float> shaft_um = hole_um;
  std::reverse(shaft_um.begin(), shaft_um.begin() + kCount);

  struct Taken {
    std::vector<float> clearance_um = std::vector<float>(kCount + kLanes);
    std::vector<std::uint16_t> bins = std::vector<std::uint16_t>(kCount + kLanes);
    std::vector<std::uint8_t> marks = std::vector<std::uint8_t>(kCount + kLanes);
    SizeBlock block;
  };

  const auto take = [&](void (*function)(SizeBlock*)) {
    Taken taken;
    taken.block = {hole_um.data(), shaft_um.data(), kCount,  2.5F, 3, 10, -40.5F, 25,
                   nullptr,        nullptr,         nullptr, 0,    0, 0,  0};
    taken.block.mean_clearance_um = taken.clearance_um.data();
    taken.block.bins = taken.bins.data();
    taken.block.marks = taken.marks.data();
    function(&taken.block);
    return taken;
  };
  const Taken a = take(TakeSizesScalar);
  const Taken b = take(TakeSizesAvx2);
  std::vector<std::uint32_t> bits(64);
  std::vector<std::uint32_t> same(64);
  DrawBitsScalar(5, 64, bits.data());
  DrawBitsAvx2(5, 64, same.data());
  EXPECT_EQ(bits, same);
  EXPECT_EQ(a.clearance_um, b.clearance_um);
  EXPECT_EQ(a.bins, b.bins);
  EXPECT_EQ(a.marks, b.marks);
  EXPECT_EQ(a.block.sum_um, b.block.sum_um);
  EXPECT_EQ(a.block.sum_um2, b.block.sum_um2);
  int interferences = 0;
  int yields = 0;
  for (int i = 0; i < kCount; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double clearance_um = static_cast<double>(hole_um[k] - shaft_um[k]) + 2.5;
    interferences += clearance_um < 0 ? 1 : 0;
    yields += clearance_um + 3 < -10 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(a.clearance_um[k]), 0.5 * (clearance_um + 3), 1e-5);
    EXPECT_EQ(a.bins[k], static_cast<int>((clearance_um - 2.5 + 40.5) * 25 + 1));
  }
  EXPECT_EQ(a.clearance_um[kCount], kFarApart_um);
  EXPECT_EQ(a.block.interferences, interferences);
  EXPECT_EQ(b.block.yields, yields);
  EXPECT_GT(yields, 5);
}
#endif

// The way for depths at the stations of one land, and the way for any depths, have the same forces.
TEST(Population, DepthsBetweenStationsAgreeWithDepthsAtThem) {
  PopulationParameters p = MakeBatch({MakeLand("H7/k6", 6.3)}, 50'000);
  p.depths = 20;
  const Population at = *CalcPopulation(p);
  p.depths = 40;
  const Population between = *CalcPopulation(p);
  for (std::size_t d = 0; d < at.bands.size(); ++d) {
    const ForceBand& a = at.bands[d];
    const ForceBand& b = between.bands[2 * d];
    EXPECT_NEAR(a.mean, b.mean, 1e-5 * at.bands.back().mean);
    for (std::size_t q = 0; q < a.quantiles.size(); ++q) {
      EXPECT_NEAR(a.quantiles[q], b.quantiles[q], 1e-3 * a.quantiles.back() + 1e-9);
    }
  }
}

TEST(Population, RefusesWhatIsNoBatch) {
  EXPECT_FALSE(CalcPopulation(MakeBatch({})));
  EXPECT_FALSE(CalcPopulation(MakeBatch({MakeLand("H7/k6", 6.3)}, 0)));
  PopulationLand land = MakeLand("H7/k6", 6.3);
  land.stations = 1000;
  EXPECT_FALSE(CalcPopulation(MakeBatch({land})));
  land = MakeLand("H7/k6", 6.3);
  land.press.hub_diameter = 0.01;
  EXPECT_FALSE(CalcPopulation(MakeBatch({land})));
}

TEST(SizeDistribution, NormalQuantileInvertsTheErrorFunction) {
  for (const double u : {1e-9, 1e-4, 0.01, 0.0243, 0.2, 0.5, 0.8, 0.99, 1 - 1e-6}) {
    const double x = NormalQuantile(u);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)), u, 1e-8 * u + 1e-12);
  }
}

// Tables in single precision: within 2e-4 sigma of the inverse everywhere.
TEST(SizeDistribution, DeviationsOfBitsAreQuantilesOfTheirShare) {
  const SizeDistribution d = *SizeDistribution::FromCapability({0, 60e-6}, 1, 1, true);
  std::vector<std::uint32_t> bits{0, 1, 0x01000000, 0x00ffffff, 0x7fffffff, 0x80000000, 0xffffffff};
  Random random(8);
  for (int i = 0; i < 20'000; ++i) {
    bits.push_back(static_cast<std::uint32_t>(random.NextBits()));
  }
  std::vector<float> deviations_um(bits.size());
  d.ToDeviations(bits, 20e-6, deviations_um);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const double share = (bits[i] + 0.5) / 4294967296.0;
    EXPECT_NEAR(static_cast<double>(deviations_um[i]), units::ToUm(d.Quantile(share)) - 20,
                10 * 2e-4);
  }
}

TEST(SizeDistribution, CapabilityPutsTheShareOutsideThatCpkSays) {
  const Limits zone{0, 25e-6};
  // C_p = C_pk = 1: 3 sigma to either limit; C_pk 2/3: 2 sigma to the nearer one.
  const SizeDistribution centred = *SizeDistribution::FromCapability(zone, 1, 1, true);
  EXPECT_NEAR(centred.Quantile(0.00134990), zone.lower, 1e-11);
  EXPECT_NEAR(centred.mean(), 12.5e-6, 1e-18);
  const SizeDistribution shifted = *SizeDistribution::FromCapability(zone, 1, 2.0 / 3, true);
  EXPECT_NEAR(shifted.Quantile(1 - 0.02275013), zone.upper, 1e-11);
  const SizeDistribution down = *SizeDistribution::FromCapability(zone, 1, 2.0 / 3, false);
  EXPECT_NEAR(down.Quantile(0.02275013), zone.lower, 1e-11);
  EXPECT_FALSE(SizeDistribution::FromCapability(zone, 1, 1.2, true));
  EXPECT_FALSE(SizeDistribution::FromMeasured({}));
}

}  // namespace
}  // namespace hvas::fits
