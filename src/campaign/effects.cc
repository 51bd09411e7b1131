#include "campaign/effects.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/random.h"

namespace hvas::campaign {
namespace {

constexpr std::size_t kBins = 10;  // A yield of each has a tenth of the runs: a choice.

std::size_t FindBin(std::uint64_t value) {
  return static_cast<std::size_t>((value >> 32U) * kBins >> 32U);
}

bool IsOrdered(const Factor& factor) {
  return factor.kind != FactorKind::kSurface;
}

/** The deviation in the middle of a bin [m]; 0 for what is no size. */
double FindMiddle(const FitModel& fits, const Factor& factor, std::size_t bin) {
  const FittedMate& mate = fits.mates()[factor.mate];
  const double u = (static_cast<double>(bin) + 0.5) / kBins;
  if (factor.kind == FactorKind::kHole) {
    return mate.hole->Quantile(u);
  }
  return factor.kind == FactorKind::kShaft ? mate.shaft->Quantile(u) : 0;
}

/** Evaluates a product at points of Saltelli's design. */
class DesignPoints {
 public:
  DesignPoints(const PreparedCell* cell, const Plan* plan) : fits_(&cell->fits), plan_(plan) {}

  [[nodiscard]] std::vector<MadeFit> Make(const std::vector<std::uint64_t>& values) const {
    std::vector<MadeFit> made;
    for (std::size_t i = 0; i < fits_->mates().size(); ++i) {
      made.push_back(fits_->CalcFit(i, values));
    }
    return made;
  }

  [[nodiscard]] RunResult Judge(const std::vector<MadeFit>& made) const {
    return fits_->Judge(made, *plan_);
  }

  /** Judges the product that differs from another one by the value of one factor. */
  [[nodiscard]] RunResult JudgeChanged(std::vector<MadeFit> made, std::size_t factor,
                                       const std::vector<std::uint64_t>& values) const {
    const std::size_t mate = fits_->factors()[factor].mate;
    made[mate] = fits_->CalcFit(mate, values);
    return Judge(made);
  }

 private:
  const FitModel* fits_;
  const Plan* plan_;
};

struct Outputs {
  statistics::SobolSample complete, force;
};

bool HasSpread(const statistics::SobolSample& sample) {
  const auto [low, high] = std::minmax_element(sample.a.begin(), sample.a.end());
  return *low < *high;
}

}  // namespace

EffectCounts::EffectCounts(std::shared_ptr<const PreparedCell> cell)
    : cell_(std::move(cell)), values_(cell_->fits.factors().size()) {
  for (const Factor& factor : cell_->fits.factors()) {
    std::vector<EffectBin> bins(IsOrdered(factor) ? kBins : 0);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      bins[b].deviation = FindMiddle(cell_->fits, factor, b);
    }
    bins_.push_back(std::move(bins));
  }
}

void EffectCounts::Add(const RunResult& row) {
  cell_->fits.DrawFactors(static_cast<std::uint64_t>(row.seed), values_);
  ++runs_;
  force_sum_ += row.force;
  square_sum_ += row.force * row.force;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    if (!bins_[i].empty()) {
      EffectBin& bin = bins_[i][FindBin(values_[i])];
      ++bin.runs;
      bin.complete += row.is_complete ? 1 : 0;
      bin.force_sum += row.force;
    }
  }
}

std::vector<MainEffect> EffectCounts::CalcEffects() const {
  const auto n = static_cast<double>(runs_);
  const double mean = force_sum_ / n;
  const double variance = square_sum_ / n - mean * mean;
  std::vector<MainEffect> effects;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    if (bins_[i].empty()) {
      continue;
    }
    MainEffect effect{cell_->fits.factors()[i].name, bins_[i]};
    double least_yield = 1;
    double most_yield = 0;
    double least_force = std::numeric_limits<double>::infinity();
    double most_force = 0;
    double between = 0;
    for (const EffectBin& bin : bins_[i]) {
      if (bin.runs == 0) {
        continue;
      }
      const auto runs = static_cast<double>(bin.runs);
      const double yield = static_cast<double>(bin.complete) / runs;
      const double force = bin.force_sum / runs;
      least_yield = std::min(least_yield, yield);
      most_yield = std::max(most_yield, yield);
      least_force = std::min(least_force, force);
      most_force = std::max(most_force, force);
      between += runs / n * (force - mean) * (force - mean);
    }
    effect.yield_range = most_yield - least_yield;
    effect.force_range = most_force - least_force;
    effect.force_ratio = variance > 0 ? std::min(1.0, between / variance) : 0;
    effects.push_back(std::move(effect));
  }
  std::stable_sort(effects.begin(), effects.end(), [](const MainEffect& a, const MainEffect& b) {
    return std::pair(a.yield_range, a.force_range) > std::pair(b.yield_range, b.force_range);
  });
  return effects;
}

Result<std::vector<SobolOfFactor>> CalcSobolOfFactors(const PreparedCell& cell, const Plan& plan,
                                                      const std::stop_token& stop) {
  const DesignPoints points(&cell, &plan);
  const std::size_t count = cell.fits.factors().size();
  Outputs outputs;
  outputs.complete.ab.resize(count);
  outputs.force.ab.resize(count);
  Random random(plan.seeds.first);
  std::vector<std::uint64_t> a(count);
  std::vector<std::uint64_t> b(count);
  const auto add = [](const RunResult& result, std::vector<double>* complete,
                      std::vector<double>* force) {
    complete->push_back(result.is_complete ? 1 : 0);
    force->push_back(result.force);
  };
  for (int row = 0; row < plan.sensitivity->samples; ++row) {
    if (stop.stop_requested()) {
      return Fail(ErrorCode::kCancelled, "the sensitivities were stopped", plan.file.string());
    }
    std::generate(a.begin(), a.end(), [&random] { return random.NextBits(); });
    std::generate(b.begin(), b.end(), [&random] { return random.NextBits(); });
    const auto made = points.Make(a);
    add(points.Judge(made), &outputs.complete.a, &outputs.force.a);
    add(points.Judge(points.Make(b)), &outputs.complete.b, &outputs.force.b);
    for (std::size_t i = 0; i < count; ++i) {
      std::swap(a[i], b[i]);
      add(points.JudgeChanged(made, i, a), &outputs.complete.ab[i], &outputs.force.ab[i]);
      std::swap(a[i], b[i]);
    }
  }
  const statistics::SobolOptions options{plan.sensitivity->resamples, plan.seeds.first, 0.95};
  std::vector<SobolOfFactor> indices(count);
  for (std::size_t i = 0; i < count; ++i) {
    indices[i].factor = cell.fits.factors()[i].name;
  }
  const auto set =
      [&](const statistics::SobolSample& sample,
          std::optional<statistics::SobolIndex> SobolOfFactor::*member) -> Result<void> {
    if (count == 0 || !HasSpread(sample)) {
      return {};
    }
    const auto found = statistics::CalcSobol(sample, options);
    if (!found) {
      return Unexpected(found.error());
    }
    for (std::size_t i = 0; i < count; ++i) {
      indices[i].*member = (*found)[i];
    }
    return {};
  };
  Result<void> done = set(outputs.complete, &SobolOfFactor::complete);
  done = done ? set(outputs.force, &SobolOfFactor::force) : done;
  return done ? Result<std::vector<SobolOfFactor>>(std::move(indices)) : Unexpected(done.error());
}

}  // namespace hvas::campaign
