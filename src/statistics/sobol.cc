#include "statistics/sobol.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

#include "base/random.h"
#include "statistics/samples.h"

namespace hvas::statistics {
namespace {

constexpr int kFewestResamples = 100;   // An end of a 95 % interval is the third of these.
constexpr int kMostResamples = 10'000;  // The intervals do not become better: a choice.
constexpr std::size_t kFewestRows = 2;  // A variance needs two.

Result<void> CheckSobolSample(const SobolSample& sample, const SobolOptions& options) {
  const auto refuse = [](const char* message, const char* remedy) {
    return Fail(ErrorCode::kInvalid, message, "Sobol indices", remedy);
  };
  const std::size_t rows = sample.a.size();
  const auto is_as_long = [rows](const auto& values) { return values.size() == rows; };
  if (rows < kFewestRows) {
    return refuse("there are fewer than two rows", "give two rows or more");
  }
  if (!is_as_long(sample.b) || !std::all_of(sample.ab.begin(), sample.ab.end(), is_as_long)) {
    return refuse("the samples differ in size", "give as many values for A, B and each AB_i");
  }
  if (options.resamples < kFewestResamples || options.resamples > kMostResamples) {
    return refuse("the number of bootstrap samples is out of range", "give 100 to 10,000");
  }
  for (const auto& values : sample.ab) {
    if (const auto good = CheckSample(values); !good) {
      return good;
    }
  }
  const auto good = CheckSample(sample.a);
  return good ? CheckSample(sample.b) : good;
}

struct Estimate {
  double first{0};
  double total{0};
};

/** Estimates the indices from some rows, of which one may be there several times.
 @param mean  Of f over A and B, which is taken off. */
std::vector<Estimate> EstimateFrom(const SobolSample& sample, std::span<const std::size_t> rows,
                                   double mean) {
  const auto n = static_cast<double>(rows.size());
  double sum = 0;
  double squares = 0;
  for (const std::size_t j : rows) {
    const double a = sample.a[j] - mean;
    const double b = sample.b[j] - mean;
    sum += a + b;
    squares += a * a + b * b;
  }
  const double variance = squares / (2 * n) - (sum / (2 * n)) * (sum / (2 * n));
  std::vector<Estimate> estimates(sample.ab.size());
  if (!(variance > 0)) {
    return estimates;
  }
  for (std::size_t i = 0; i < sample.ab.size(); ++i) {
    double first = 0;
    double total = 0;
    for (const std::size_t j : rows) {
      const double change = sample.ab[i][j] - sample.a[j];
      first += (sample.b[j] - mean) * change;
      total += change * change;
    }
    estimates[i] = {first / n / variance, total / (2 * n) / variance};
  }
  return estimates;
}

Interval FindInterval(std::vector<double> values, double confidence) {
  std::sort(values.begin(), values.end());
  return {CalcQuantile(values, 0.5 * (1 - confidence)),
          CalcQuantile(values, 0.5 * (1 + confidence))};
}

}  // namespace

Result<std::vector<SobolIndex>> CalcSobol(const SobolSample& sample, const SobolOptions& options) {
  Result<void> good = CheckSobolSample(sample, options);
  good = good ? CheckConfidence(options.confidence) : good;
  if (!good) {
    return Unexpected(good.error());
  }
  const std::size_t count = sample.a.size();
  const double mean = (std::accumulate(sample.a.begin(), sample.a.end(), 0.0) +
                       std::accumulate(sample.b.begin(), sample.b.end(), 0.0)) /
                      (2 * static_cast<double>(count));
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  const auto estimates = EstimateFrom(sample, rows, mean);
  const auto resamples = static_cast<std::size_t>(options.resamples);
  std::vector<std::vector<double>> firsts(estimates.size(), std::vector<double>(resamples));
  auto totals = firsts;
  Random random(options.seed);
  for (std::size_t k = 0; k < resamples; ++k) {
    for (std::size_t& row : rows) {
      row = static_cast<std::size_t>(random.Uniform() * static_cast<double>(count));
    }
    const auto again = EstimateFrom(sample, rows, mean);
    for (std::size_t i = 0; i < again.size(); ++i) {
      firsts[i][k] = again[i].first;
      totals[i][k] = again[i].total;
    }
  }
  std::vector<SobolIndex> indices;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    indices.push_back({estimates[i].first, estimates[i].total,
                       FindInterval(std::move(firsts[i]), options.confidence),
                       FindInterval(std::move(totals[i]), options.confidence)});
  }
  return indices;
}

}  // namespace hvas::statistics
