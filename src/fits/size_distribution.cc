#include "fits/size_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/actual_size.h"

namespace hvas::fits {
namespace {

constexpr double kNormalReach = 6.5;     // Of a 32-bit uniform number, 6.24.
constexpr std::size_t kGuideSize = 256;  // Entries that say where a search begins: a choice.

/** A share in (0, 1) of 32 random bits. */
double ToShare(std::uint32_t bits) noexcept {
  return (static_cast<double>(bits) + 0.5) * 0x1p-32;
}

/** Standard normal quantiles at equal steps of the share, for the middle of the distribution:
 linear between them they are right to 2e-4 sigma where they are used. */
class NormalTable {
 public:
  NormalTable() {
    for (std::uint32_t i = kTail; i < kSteps - kTail; ++i) {
      const double from = NormalQuantile(static_cast<double>(i) / kSteps);
      const double to = NormalQuantile(static_cast<double>(i + 1) / kSteps);
      steps_[i] = {static_cast<float>(from), static_cast<float>((to - from) / kPerStep)};
    }
  }

  [[nodiscard]] float operator()(std::uint32_t bits) const noexcept {
    const std::uint32_t i = bits / kPerStep;
    if (i < kTail || i >= kSteps - kTail) {
      return static_cast<float>(NormalQuantile(ToShare(bits)));
    }
    return steps_[i].from + static_cast<float>(bits % kPerStep) * steps_[i].slope;
  }

 private:
  struct Step {
    float from;
    float slope;  // For each of the lower bits.
  };

  // The quantile is straight within each of 4096 steps of 2^20, but for 16 at either end, where it
  // bends too much. Choices; the test of this room has the errors.
  static constexpr std::uint32_t kSteps = 4096;
  static constexpr std::uint32_t kTail = 16;
  static constexpr std::uint32_t kPerStep = 1U << 20U;
  std::array<Step, kSteps> steps_{};
};

}  // namespace

SizeDistribution SizeDistribution::FromZone(const Limits& limits) {
  // Zones are whole micrometres but for the finest grades, which lose a part of one here.
  const int zone_um = static_cast<int>(std::floor(units::ToUm(limits.upper - limits.lower) + 1e-6));
  const std::vector<double> probabilities = CalcSizeProbabilities(zone_um);
  std::vector<double> values;
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    values.push_back(limits.lower + units::FromUm(static_cast<double>(k)));
  }
  return FromValues(std::move(values), probabilities);
}

Result<SizeDistribution> SizeDistribution::FromCapability(const Limits& limits, double cp,
                                                          double cpk, bool is_shifted_up) {
  const double width = limits.upper - limits.lower;
  if (!(width > 0) || !(cpk > 0) || !(cpk <= cp) || !std::isfinite(cp)) {
    return Fail(
        ErrorCode::kInvalid,
        fmt::format("C_p {:g} and C_pk {:g} are not valid capabilities for a zone of {:g} um", cp,
                    cpk, units::ToUm(width)),
        "process capability", "give 0 < C_pk <= C_p, for example 1.33 and 1.0");
  }
  SizeDistribution d;
  d.kind_ = Kind::kNormal;
  d.sigma_ = width / (6 * cp);
  const double shift = 0.5 * width - 3 * d.sigma_ * cpk;
  d.mean_ = 0.5 * (limits.lower + limits.upper) + (is_shifted_up ? shift : -shift);
  d.variance_ = d.sigma_ * d.sigma_;
  d.bounds_ = {d.mean_ - kNormalReach * d.sigma_, d.mean_ + kNormalReach * d.sigma_};
  return d;
}

SizeDistribution SizeDistribution::Uniform(const Limits& limits) {
  SizeDistribution d;
  const double width = limits.upper - limits.lower;
  d.mean_ = 0.5 * (limits.lower + limits.upper);
  d.variance_ = width * width / 12;
  d.bounds_ = limits;
  return d;
}

Result<SizeDistribution> SizeDistribution::FromMeasured(std::span<const double> deviations) {
  if (deviations.empty() || !std::all_of(deviations.begin(), deviations.end(),
                                         [](double d) { return std::isfinite(d); })) {
    return Fail(ErrorCode::kInvalid, "measured sizes are missing or not finite", "measured sizes",
                "give at least one size");
  }
  std::vector<double> values(deviations.begin(), deviations.end());
  std::sort(values.begin(), values.end());
  const std::vector<double> probabilities(values.size(), 1.0 / static_cast<double>(values.size()));
  return FromValues(std::move(values), probabilities);
}

SizeDistribution SizeDistribution::FromValues(std::vector<double> values,
                                              std::span<const double> probabilities) {
  SizeDistribution d;
  d.kind_ = Kind::kValues;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += probabilities[i];
    d.cumulative_.push_back(sum);
    d.mean_ += probabilities[i] * values[i];
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    d.variance_ += probabilities[i] * (values[i] - d.mean_) * (values[i] - d.mean_);
  }
  d.cumulative_.back() = 1;
  d.bounds_ = {values.front(), values.back()};
  for (std::size_t g = 0; g < kGuideSize; ++g) {
    const double u = static_cast<double>(g) / kGuideSize;
    d.guide_.push_back(static_cast<std::uint32_t>(
        std::upper_bound(d.cumulative_.begin(), d.cumulative_.end() - 1, u) -
        d.cumulative_.begin()));
  }
  d.values_ = std::move(values);
  return d;
}

double SizeDistribution::Quantile(double u) const noexcept {
  switch (kind_) {
    case Kind::kNormal:
      return mean_ + sigma_ * NormalQuantile(u);
    case Kind::kUniform:
      return bounds_.lower + u * (bounds_.upper - bounds_.lower);
    case Kind::kValues:
      break;
  }
  std::size_t i = guide_[static_cast<std::size_t>(u * kGuideSize)];
  while (cumulative_[i] <= u && i + 1 < values_.size()) {
    ++i;
  }
  return values_[i];
}

void SizeDistribution::ToDeviations(std::span<const std::uint32_t> bits, double origin,
                                    std::span<float> deviations_um) const noexcept {
  if (kind_ != Kind::kNormal) {
    for (std::size_t i = 0; i < bits.size(); ++i) {
      deviations_um[i] = static_cast<float>(units::ToUm(Quantile(ToShare(bits[i])) - origin));
    }
    return;
  }
  static const NormalTable table;
  const auto mean_um = static_cast<float>(units::ToUm(mean_ - origin));
  const auto sigma_um = static_cast<float>(units::ToUm(sigma_));
  for (std::size_t i = 0; i < bits.size(); ++i) {
    deviations_um[i] = mean_um + sigma_um * table(bits[i]);
  }
}

double NormalQuantile(double u) noexcept {
  // Acklam's rational approximation of the normal quantile, whose relative error is below 1.2e-9;
  // kTail is where the tail's formula takes over.
  constexpr double kA[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                           1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr double kB[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                           6.680131188771972e+01, -1.328068155288572e+01};
  constexpr double kC[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                           -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr double kD[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                           3.754408661907416e+00};
  constexpr double kTail = 0.02425;
  if (u > 1 - kTail) {
    return -NormalQuantile(1 - u);
  }
  if (u < kTail) {
    const double q = std::sqrt(-2 * std::log(u));
    return (((((kC[0] * q + kC[1]) * q + kC[2]) * q + kC[3]) * q + kC[4]) * q + kC[5]) /
           ((((kD[0] * q + kD[1]) * q + kD[2]) * q + kD[3]) * q + 1);
  }
  const double q = u - 0.5;
  const double r = q * q;
  return (((((kA[0] * r + kA[1]) * r + kA[2]) * r + kA[3]) * r + kA[4]) * r + kA[5]) * q /
         (((((kB[0] * r + kB[1]) * r + kB[2]) * r + kB[3]) * r + kB[4]) * r + 1);
}

}  // namespace hvas::fits
