#include "fits/population.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <thread>

#include <fmt/format.h>

#include "base/random.h"
#include "base/units.h"
#include "fits/population_kernel.h"

namespace hvas::fits {
namespace {

constexpr int kBlock = 4096;  // Assemblies; its forces stay in the second-level cache.
constexpr std::size_t kBins = 2048;

Result<void> Check(const PopulationParameters& p) {
  const auto fail = [](std::string what, std::string remedy) {
    return Fail(ErrorCode::kInvalid, std::move(what), "population", std::move(remedy));
  };
  if (p.lands.empty()) {
    return fail("a population needs a fit", "give at least one");
  }
  if (p.count < 1 || p.threads < 1) {
    return fail(fmt::format("{} assemblies on {} threads", p.count, p.threads),
                "give at least one of each");
  }
  if (p.depths < 1 || p.depths > kMaxStations) {
    return fail(fmt::format("{} steps of depth", p.depths),
                fmt::format("give 1 to {}", kMaxStations));
  }
  for (const PopulationLand& land : p.lands) {
    if (land.stations < 1 || land.stations > kMaxStations || !(land.start >= 0) ||
        !std::isfinite(land.start)) {
      return fail(fmt::format("{} stations from {:g} mm", land.stations, units::ToMm(land.start)),
                  fmt::format("give 1 to {} stations, and a depth of 0 or more", kMaxStations));
    }
  }
  return {};
}

/** Counts of values between two bounds in equal steps; those at the lower bound apart, for of many
 a fit has no force at all. */
class Histogram {
 public:
  Histogram() : counts_(kBins + 1, 0) {}

  void SetRange(double low, double high) {
    low_ = static_cast<float>(low);
    width_ = high > low ? (high - low) / kBins : 0;
    per_width_ = static_cast<float>(width_ > 0 ? 1 / width_ : 0);
  }

  void Add(float value) {
    const float step = std::min((value - low_) * per_width_, static_cast<float>(kBins - 1));
    const auto above = static_cast<std::int32_t>(value > low_);
    ++counts_[static_cast<std::size_t>(static_cast<std::int32_t>(std::max(step, 0.0F)) + above)];
  }

  void Merge(const Histogram& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      counts_[i] += other.counts_[i];
    }
  }

  /** Linear within a step. */
  [[nodiscard]] double Quantile(double share) const {
    double left = share * static_cast<double>(
                              std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0}));
    left -= counts_.front();
    for (std::size_t i = 1; i < counts_.size() && left > 0; ++i) {
      if (left <= counts_[i]) {
        return static_cast<double>(low_) +
               (static_cast<double>(i - 1) + left / counts_[i]) * width_;
      }
      left -= counts_[i];
    }
    return static_cast<double>(low_);
  }

 private:
  std::vector<std::uint32_t> counts_;  // The first: at the lower bound or below.
  float low_{0};
  float per_width_{0};
  double width_{0};
};

/** A land with everything that does not change from pair to pair. */
struct PreparedLand {
  const PopulationLand* source;
  double smoothing_loss;      // Of the diametral interference [m].
  double yield_interference;  // Effective, diametral, at the elastic limit [m].
  float half_roughness_um;
  float force_per_interval;
  Limits clearance;  // Diametral, what the sizes allow [m].
  std::vector<LandDepth> depths;
};

Result<PreparedLand> Prepare(const PopulationLand& land, double end, int depth_count) {
  PressFitParameters press = land.press;
  press.interference = 0;
  const Result<PressFit> fit = CalcPressFit(press);
  if (!fit) {
    return Unexpected(fit.error());
  }
  PreparedLand p{&land, fit->smoothing_loss, 0, 0, 0, {}, {}};
  p.yield_interference = std::min(fit->hub_limit.von_mises, fit->shaft_limit.von_mises) /
                         fit->pressure_per_interference;
  p.half_roughness_um =
      static_cast<float>(units::ToUm(0.25 * (press.hub_roughness + press.shaft_roughness)));
  // p = (p / U) 2 max(0, -S); F grows by mu pi D p dl.
  const double interval = press.length / land.stations;
  p.force_per_interval =
      static_cast<float>(press.friction_in * std::numbers::pi * press.joint_diameter * interval *
                         2 * fit->pressure_per_interference * units::FromUm(1));
  p.clearance = {land.hole.bounds().lower - land.shaft.bounds().upper,
                 land.hole.bounds().upper - land.shaft.bounds().lower};
  for (int d = 0; d <= depth_count; ++d) {
    const double u = (end * d / depth_count - land.start) / interval;
    // Steps that meet a station up to rounding are that station.
    const double near = std::round(u);
    const double at = std::abs(u - near) < 1e-9 ? near : u;
    if (!(at > 0)) {
      p.depths.push_back({-1, 0});
    } else if (at >= land.stations) {
      p.depths.push_back({land.stations - 1, 1});
    } else {
      const double below = std::ceil(at) - 1;
      p.depths.push_back({static_cast<std::int32_t>(below), static_cast<float>(at - below)});
    }
  }
  return p;
}

/** What one thread counts. */
struct Counts {
  std::vector<Histogram> clearances;  // By land.
  std::vector<Histogram> forces;      // By depth.
  std::vector<std::int64_t> interference, yield;
  std::int64_t any_interference{0};
  std::int64_t any_yield{0};
  std::int64_t over_press{0};
};

/** Sums of a block, added up in the blocks' order so that rounding is the same for any threads. */
struct BlockSums {
  std::vector<double> clearance, clearance_squared;  // By land, from the middle of its range.
  std::vector<double> force;                         // By depth.
};

class Batch {
 public:
  Batch(const PopulationParameters& parameters, std::vector<PreparedLand> lands)
      : parameters_(parameters),
        lands_(std::move(lands)),
        depth_count_(parameters.depths + 1),
        calc_forces_(ChooseCalcForces()) {
    block_count_ = (parameters.count + kBlock - 1) / kBlock;
    sums_.resize(static_cast<std::size_t>(block_count_));
    for (std::size_t d = 0; d < static_cast<std::size_t>(depth_count_); ++d) {
      double highest = 0;
      for (const PreparedLand& land : lands_) {
        const double worst_um =
            std::max(0.0, units::ToUm(-0.5 * (land.clearance.lower + land.smoothing_loss)) +
                              static_cast<double>(land.half_roughness_um));
        const LandDepth at = land.depths[d];
        highest += worst_um * static_cast<double>(land.force_per_interval) *
                   (at.interval < 0 ? 0.0 : at.interval + static_cast<double>(at.part));
      }
      highest_.push_back(highest);
    }
  }

  Population Run();

 private:
  [[nodiscard]] Counts MakeCounts() const;
  void RunBlocks(std::int64_t first, Counts* counts);
  void DrawClearances(std::int64_t block, std::vector<std::vector<float>>* clearances_um,
                      Counts* counts);
  void CountForces(std::int64_t block, const std::vector<float>& forces, Counts* counts);

  [[nodiscard]] int CountIn(std::int64_t block) const {
    return static_cast<int>(std::min<std::int64_t>(kBlock, parameters_.count - block * kBlock));
  }

  [[nodiscard]] std::uint64_t SeedOf(std::int64_t block) const {
    return Random(parameters_.seed + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(block))
        .NextBits();
  }

  const PopulationParameters& parameters_;
  std::vector<PreparedLand> lands_;
  int depth_count_;
  ForcesFunction calc_forces_;
  std::int64_t block_count_{0};
  std::vector<double> highest_;  // By depth [N].
  std::vector<BlockSums> sums_;
};

Counts Batch::MakeCounts() const {
  Counts counts;
  for (const PreparedLand& land : lands_) {
    const double half = 0.5 * (land.clearance.upper - land.clearance.lower);
    counts.clearances.emplace_back().SetRange(-half, half);
  }
  for (const double highest : highest_) {
    counts.forces.emplace_back().SetRange(0, highest);
  }
  counts.interference.resize(lands_.size());
  counts.yield.resize(lands_.size());
  return counts;
}

void Batch::DrawClearances(std::int64_t block, std::vector<std::vector<float>>* clearances_um,
                           Counts* counts) {
  BlockSums& sums = sums_[static_cast<std::size_t>(block)];
  sums.clearance.assign(lands_.size(), 0);
  sums.clearance_squared.assign(lands_.size(), 0);
  Random random(SeedOf(block));
  const int count = CountIn(block);
  for (int i = 0; i < count; ++i) {
    bool has_interference = false;
    bool yields = false;
    for (std::size_t k = 0; k < lands_.size(); ++k) {
      const PreparedLand& land = lands_[k];
      // Two numbers of 32 bits, never 0 or 1.
      const std::uint64_t bits = random.NextBits();
      const double u = (static_cast<double>(bits >> 32U) + 0.5) * 0x1p-32;
      const double v = (static_cast<double>(bits & 0xffffffffU) + 0.5) * 0x1p-32;
      const double clearance = land.source->hole.Quantile(u) - land.source->shaft.Quantile(v);
      const double from_middle = clearance - 0.5 * (land.clearance.lower + land.clearance.upper);
      sums.clearance[k] += from_middle;
      sums.clearance_squared[k] += from_middle * from_middle;
      counts->clearances[k].Add(static_cast<float>(from_middle));
      const double smoothed = clearance + land.smoothing_loss;
      const bool interferes = clearance < 0;
      const bool yields_here = -smoothed > land.yield_interference;
      counts->interference[k] += interferes ? 1 : 0;
      counts->yield[k] += yields_here ? 1 : 0;
      has_interference = has_interference || interferes;
      yields = yields || yields_here;
      (*clearances_um)[k][static_cast<std::size_t>(i)] =
          static_cast<float>(units::ToUm(0.5 * smoothed));
    }
    counts->any_interference += has_interference ? 1 : 0;
    counts->any_yield += yields ? 1 : 0;
  }
}

void Batch::CountForces(std::int64_t block, const std::vector<float>& forces, Counts* counts) {
  const int count = CountIn(block);
  BlockSums& sums = sums_[static_cast<std::size_t>(block)];
  sums.force.assign(static_cast<std::size_t>(depth_count_), 0);
  for (std::size_t d = 0; d < sums.force.size(); ++d) {
    const float* row = forces.data() + d * kBlock;
    for (int i = 0; i < count; ++i) {
      counts->forces[d].Add(row[i]);
    }
    // Eight sums at a time, which compilers make one of vectors.
    float partial[kLanes] = {};
    for (int i = 0; i + kLanes <= count; i += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        partial[lane] += row[i + lane];
      }
    }
    for (const float p : partial) {
      sums.force[d] += static_cast<double>(p);
    }
    for (int i = count - count % kLanes; i < count; ++i) {
      sums.force[d] += static_cast<double>(row[i]);
    }
  }
  // Forces never fall with depth: the last one is the largest.
  const float* last = forces.data() + (sums.force.size() - 1) * kBlock;
  for (int i = 0; i < count; ++i) {
    counts->over_press += static_cast<double>(last[i]) > parameters_.press_force ? 1 : 0;
  }
}

void Batch::RunBlocks(std::int64_t first, Counts* counts) {
  std::vector<std::vector<float>> clearances_um(lands_.size(), std::vector<float>(kBlock));
  std::vector<float> forces(static_cast<std::size_t>(depth_count_) * kBlock);
  std::vector<LandView> views;
  for (std::size_t k = 0; k < lands_.size(); ++k) {
    const PreparedLand& land = lands_[k];
    views.push_back({land.source->stations, land.half_roughness_um, land.force_per_interval,
                     clearances_um[k].data(), land.depths.data()});
  }
  for (std::int64_t block = first; block < block_count_; block += parameters_.threads) {
    DrawClearances(block, &clearances_um, counts);
    calc_forces_({views.data(), static_cast<std::int32_t>(views.size()), depth_count_, kBlock,
                  ~SeedOf(block), forces.data()});
    CountForces(block, forces, counts);
  }
}

Population Batch::Run() {
  std::vector<Counts> counts(static_cast<std::size_t>(parameters_.threads), MakeCounts());
  std::vector<std::thread> threads;
  for (int t = 1; t < parameters_.threads; ++t) {
    threads.emplace_back(
        [this, t, &counts] { RunBlocks(t, &counts[static_cast<std::size_t>(t)]); });
  }
  RunBlocks(0, counts.data());
  for (std::thread& thread : threads) {
    thread.join();
  }
  Counts& all = counts.front();
  for (std::size_t t = 1; t < counts.size(); ++t) {
    for (std::size_t k = 0; k < lands_.size(); ++k) {
      all.clearances[k].Merge(counts[t].clearances[k]);
      all.interference[k] += counts[t].interference[k];
      all.yield[k] += counts[t].yield[k];
    }
    for (std::size_t d = 0; d < all.forces.size(); ++d) {
      all.forces[d].Merge(counts[t].forces[d]);
    }
    all.any_interference += counts[t].any_interference;
    all.any_yield += counts[t].any_yield;
    all.over_press += counts[t].over_press;
  }

  const auto n = static_cast<double>(parameters_.count);
  Population result;
  result.count = parameters_.count;
  result.any_interference_share = static_cast<double>(all.any_interference) / n;
  result.any_yield_share = static_cast<double>(all.any_yield) / n;
  result.over_press_share = static_cast<double>(all.over_press) / n;
  for (std::size_t k = 0; k < lands_.size(); ++k) {
    double sum = 0;
    double squares = 0;
    for (const BlockSums& block : sums_) {
      sum += block.clearance[k];
      squares += block.clearance_squared[k];
    }
    LandStatistics land;
    const Limits& range = lands_[k].clearance;
    land.mean_clearance = 0.5 * (range.lower + range.upper) + sum / n;
    land.sigma_clearance = std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
    for (std::size_t q = 0; q < kBandShares.size(); ++q) {
      land.clearance_quantiles[q] =
          0.5 * (range.lower + range.upper) + all.clearances[k].Quantile(kBandShares[q]);
    }
    land.interference_share = static_cast<double>(all.interference[k]) / n;
    land.yield_share = static_cast<double>(all.yield[k]) / n;
    result.lands.push_back(land);
  }
  double end = 0;
  for (const PopulationLand& land : parameters_.lands) {
    end = std::max(end, land.start + land.press.length);
  }
  for (std::size_t d = 0; d < all.forces.size(); ++d) {
    ForceBand band;
    band.depth = end * static_cast<double>(d) / parameters_.depths;
    for (const BlockSums& block : sums_) {
      band.mean += block.force[d];
    }
    band.mean /= n;
    for (std::size_t q = 0; q < kBandShares.size(); ++q) {
      band.quantiles[q] = all.forces[d].Quantile(kBandShares[q]);
    }
    result.bands.push_back(band);
  }
  return result;
}

}  // namespace

Result<Population> CalcPopulation(const PopulationParameters& parameters) {
  if (Result<void> check = Check(parameters); !check) {
    return Unexpected(check.error());
  }
  double end = 0;
  for (const PopulationLand& land : parameters.lands) {
    end = std::max(end, land.start + land.press.length);
  }
  std::vector<PreparedLand> lands;
  for (const PopulationLand& land : parameters.lands) {
    Result<PreparedLand> prepared = Prepare(land, end, parameters.depths);
    if (!prepared) {
      return Unexpected(prepared.error());
    }
    lands.push_back(*std::move(prepared));
  }
  return Batch(parameters, std::move(lands)).Run();
}

}  // namespace hvas::fits
