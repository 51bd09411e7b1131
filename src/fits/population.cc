#include "fits/population.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <thread>

#include <fmt/format.h>

#include "base/random.h"
#include "base/units.h"
#include "fits/population_kernel.h"

namespace hvas::fits {
namespace {

constexpr int kCurveSteps = 200;  // Steps of a curve, half a percent each: a choice.
constexpr int kBlock = 2048;      // Assemblies; what is counted of them stays in the cache.

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

constexpr std::size_t kBins = kForceBins;  // The kernel counts clearances in so many.

double CalcMiddle(const Limits& limits) {
  return 0.5 * (limits.lower + limits.upper);
}

double CalcWidth(const Limits& limits) {
  return limits.upper - limits.lower;
}

/** Counts of values between two bounds in equal steps; those at the lower bound apart, for many
 fits have no force at all. */
class Histogram {
 public:
  void SetRange(double low, double high) {
    low_ = low;
    width_ = high > low ? (high - low) / kBins : 0;
    // A little less, so that rounding in single precision reaches no bin beyond the last.
    per_width_ = width_ > 0 ? (1 - kSlack) / width_ : 0;
    width_ /= 1 - kSlack;
  }

  /** Several of a row at once. Neighbours go to tables of their own: counting equal ones in one
   would wait for its memory every time. */
  void AddBins(const std::uint16_t* bins, int count) {
    int i = 0;
    for (; i + static_cast<int>(kTables) <= count; i += kTables) {
      for (std::size_t t = 0; t < kTables; ++t) {
        ++counts_[t][bins[i + static_cast<int>(t)]];
      }
    }
    for (; i < count; ++i) {
      ++counts_[0][bins[i]];
    }
  }

  void AddAtLowest(int count) { counts_[0][0] += static_cast<std::uint32_t>(count); }

  void Merge(const Histogram& other) {
    for (std::size_t t = 0; t < kTables; ++t) {
      for (std::size_t i = 0; i <= kBins; ++i) {
        counts_[t][i] += other.counts_[t][i];
      }
    }
  }

  /** The values below which the shares lie, linear within a step. */
  [[nodiscard]] std::vector<double> Quantiles(std::span<const double> shares) const {
    std::vector<double> counts(kBins + 1);
    double total = 0;
    for (std::size_t i = 0; i <= kBins; ++i) {
      for (const auto& table : counts_) {
        counts[i] += static_cast<double>(table[i]);
      }
      total += counts[i];
    }
    std::vector<double> quantiles;
    for (const double share : shares) {
      double left = share * total - counts[0];
      double value = low_;
      for (std::size_t i = 1; i <= kBins && left > 0; ++i) {
        if (left <= counts[i]) {
          value = low_ + (static_cast<double>(i - 1) + left / counts[i]) * width_;
        }
        left -= counts[i];
      }
      quantiles.push_back(value);
    }
    return quantiles;
  }

  [[nodiscard]] double bins_per_unit() const { return per_width_; }

 private:
  static constexpr std::size_t kTables = 4;  // Tables that are looked at side by side: a choice.
  static constexpr double kSlack = 1e-4;     // Of 256 sums, each rounded by 2^-24, 1.5e-5.

  std::array<std::array<std::uint32_t, kBins + 1>, kTables> counts_{};  // 0: the lower bound.
  double low_{0};
  double width_{0};
  double per_width_{0};
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
  // p = (p / U) 2 max(0, -S); F grows by mu O p dl, O the outline.
  const double interval = press.length / land.stations;
  p.force_per_interval = static_cast<float>(press.friction_in * fit->outline * interval * 2 *
                                            fit->pressure_per_interference * units::FromUm(1));
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
  std::vector<float> force;                          // By depth and lane.
};

class Batch {
 public:
  Batch(const PopulationParameters& parameters, std::vector<PreparedLand> lands)
      : parameters_(parameters),
        lands_(std::move(lands)),
        depth_count_(parameters.depths + 1),
        kernel_(ChoosePopulationKernel()) {
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
  /** Runs all blocks, by several threads. */
  [[nodiscard]] Counts CountAll();
  [[nodiscard]] LandStatistics CalcLand(const Counts& all, std::size_t k) const;
  [[nodiscard]] ForceBand CalcBand(const Counts& all, std::size_t d) const;
  void DrawClearances(std::int64_t block, std::vector<std::vector<float>>* clearances_um,
                      Counts* counts);

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
  PopulationKernel kernel_;
  std::int64_t block_count_{0};
  std::vector<double> highest_;  // By depth [N].
  std::vector<BlockSums> sums_;
};

Counts Batch::MakeCounts() const {
  Counts counts;
  for (const PreparedLand& land : lands_) {
    const double half = 0.5 * CalcWidth(land.clearance);
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
  const auto count = static_cast<std::size_t>(CountIn(block));
  std::array<std::uint32_t, 2 * kBlock> bits;
  const std::span<const std::uint32_t> hole_bits(bits.data(), count);
  const std::span<const std::uint32_t> shaft_bits(bits.data() + kBlock, count);
  std::array<float, kBlock> hole_um{};
  std::array<float, kBlock> shaft_um{};
  std::array<std::uint16_t, kBlock> bins;
  std::array<std::uint8_t, kBlock> marks{};
  for (std::size_t k = 0; k < lands_.size(); ++k) {
    const PreparedLand& land = lands_[k];
    kernel_.draw_bits(SeedOf(block) + k, 2 * kBlock, bits.data());
    const PopulationLand& source = *land.source;
    const double hole_middle = CalcMiddle(source.hole.bounds());
    const double shaft_middle = CalcMiddle(source.shaft.bounds());
    source.hole.ToDeviations(hole_bits, hole_middle, {hole_um.data(), count});
    source.shaft.ToDeviations(shaft_bits, shaft_middle, {shaft_um.data(), count});
    SizeBlock work{hole_um.data(),
                   shaft_um.data(),
                   static_cast<std::int32_t>(count),
                   static_cast<float>(units::ToUm(hole_middle - shaft_middle)),
                   static_cast<float>(units::ToUm(land.smoothing_loss)),
                   static_cast<float>(units::ToUm(land.yield_interference)),
                   static_cast<float>(units::ToUm(-0.5 * CalcWidth(land.clearance))),
                   static_cast<float>(units::FromUm(counts->clearances[k].bins_per_unit())),
                   (*clearances_um)[k].data(),
                   bins.data(),
                   marks.data(),
                   0,
                   0,
                   0,
                   0};
    kernel_.take_sizes(&work);
    sums.clearance.push_back(units::FromUm(work.sum_um));
    sums.clearance_squared.push_back(units::FromUm(units::FromUm(work.sum_um2)));
    counts->interference[k] += work.interferences;
    counts->yield[k] += work.yields;
    counts->clearances[k].AddBins(bins.data(), static_cast<int>(count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    counts->any_interference += marks[i] & kInterferes;
    counts->any_yield += (marks[i] & kYields) / kYields;
  }
}

void Batch::RunBlocks(std::int64_t first, Counts* counts) {
  std::vector<std::vector<float>> clearances_um(lands_.size(), std::vector<float>(kBlock));
  const auto depths = static_cast<std::size_t>(depth_count_);
  std::vector<std::uint16_t> bins(depths * kBlock);
  std::vector<float> bins_per_newton;
  for (const Histogram& histogram : counts->forces) {
    bins_per_newton.push_back(static_cast<float>(histogram.bins_per_unit()));
  }
  std::vector<LandView> views;
  for (std::size_t k = 0; k < lands_.size(); ++k) {
    const PreparedLand& land = lands_[k];
    views.push_back({land.source->stations, land.half_roughness_um, land.force_per_interval,
                     clearances_um[k].data(), land.depths.data()});
  }
  const auto press_force = static_cast<float>(
      std::min(parameters_.press_force, static_cast<double>(std::numeric_limits<float>::max())));
  for (std::int64_t block = first; block < block_count_; block += parameters_.threads) {
    DrawClearances(block, &clearances_um, counts);
    std::vector<float>& sums = sums_[static_cast<std::size_t>(block)].force;
    sums.resize(depths * kLanes);
    PopulationBlock work{views.data(),
                         static_cast<std::int32_t>(views.size()),
                         depth_count_,
                         CountIn(block),
                         ~SeedOf(block),
                         press_force,
                         bins_per_newton.data(),
                         bins.data(),
                         kBlock,
                         sums.data(),
                         0};
    kernel_.count_forces(&work);
    for (std::size_t d = 0; d < depths; ++d) {
      if (bins_per_newton[d] > 0) {
        counts->forces[d].AddBins(bins.data() + d * kBlock, CountIn(block));
      } else {
        counts->forces[d].AddAtLowest(CountIn(block));
      }
    }
    // Forces never fall with depth: the last one is the largest.
    counts->over_press += work.over_press;
  }
}

Counts Batch::CountAll() {
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
  return std::move(all);
}

LandStatistics Batch::CalcLand(const Counts& all, std::size_t k) const {
  const auto n = static_cast<double>(parameters_.count);
  double sum = 0;
  double squares = 0;
  for (const BlockSums& block : sums_) {
    sum += block.clearance[k];
    squares += block.clearance_squared[k];
  }
  LandStatistics land;
  const Limits& range = lands_[k].clearance;
  land.mean_clearance = CalcMiddle(range) + sum / n;
  land.sigma_clearance = std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
  // What bounds a distribution that has no end says nothing of the batch: half a step in.
  std::vector<double> shares(kBandShares.begin(), kBandShares.end());
  for (int i = 0; i <= kCurveSteps; ++i) {
    shares.push_back(std::clamp(static_cast<double>(i), 0.5, kCurveSteps - 0.5) / kCurveSteps);
  }
  std::vector<double> quantiles = all.clearances[k].Quantiles(shares);
  for (double& quantile : quantiles) {
    quantile += CalcMiddle(range);
  }
  std::copy_n(quantiles.begin(), kBandShares.size(), land.clearance_quantiles.begin());
  land.clearance_curve.assign(quantiles.begin() + kBandShares.size(), quantiles.end());
  land.interference_share = static_cast<double>(all.interference[k]) / n;
  land.yield_share = static_cast<double>(all.yield[k]) / n;
  return land;
}

ForceBand Batch::CalcBand(const Counts& all, std::size_t d) const {
  double end = 0;
  for (const PopulationLand& land : parameters_.lands) {
    end = std::max(end, land.start + land.press.length);
  }
  ForceBand band;
  band.depth = end * static_cast<double>(d) / parameters_.depths;
  for (const BlockSums& block : sums_) {
    for (int lane = 0; lane < kLanes; ++lane) {
      band.mean += static_cast<double>(block.force[d * kLanes + static_cast<std::size_t>(lane)]);
    }
  }
  band.mean /= static_cast<double>(parameters_.count);
  const std::vector<double> quantiles = all.forces[d].Quantiles(kBandShares);
  std::copy(quantiles.begin(), quantiles.end(), band.quantiles.begin());
  return band;
}

Population Batch::Run() {
  const Counts all = CountAll();
  const auto n = static_cast<double>(parameters_.count);
  Population result;
  result.count = parameters_.count;
  result.any_interference_share = static_cast<double>(all.any_interference) / n;
  result.any_yield_share = static_cast<double>(all.any_yield) / n;
  result.over_press_share = static_cast<double>(all.over_press) / n;
  for (std::size_t k = 0; k < lands_.size(); ++k) {
    result.lands.push_back(CalcLand(all, k));
  }
  for (std::size_t d = 0; d < all.forces.size(); ++d) {
    result.bands.push_back(CalcBand(all, d));
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
