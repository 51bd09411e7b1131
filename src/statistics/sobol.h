#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "statistics/summary.h"

namespace hvas::statistics {

/** Values of a function of d independent inputs at the points of Saltelli's design: rows of two
 samples A and B of the inputs, and for each input i the rows of A with its column from B. */
struct SobolSample {
  std::vector<double> a;                ///< f at the rows of A.
  std::vector<double> b;                ///< f at the rows of B.
  std::vector<std::vector<double>> ab;  ///< f at the rows of AB_i, one vector for each input.
};

/** Shares of the variance of f that an input explains. */
struct SobolIndex {
  double first{0};    ///< S_i, by the input alone.
  double total{0};    ///< ST_i, with all of its interactions.
  Interval first_ci;  ///< Percentile interval of the bootstrap.
  Interval total_ci;
};

struct SobolOptions {
  int resamples{500};       ///< Bootstrap samples of rows, 100 to 10,000.
  std::uint64_t seed{1};    ///< Any number: the bootstrap samples follow from it.
  double confidence{0.95};  ///< Share of the intervals, in (0, 1): the usual one.
};

/** Estimates the indices of Sobol (Mathematics and Computers in Simulation 55, 2001):
     S_i  = mean(f_B (f_ABi - f_A)) / V    Saltelli et al., Computer Physics Communications 181,
                                            2010, with f less its mean, which leaves it as it is
     ST_i = mean((f_A - f_ABi)^2) / (2 V)  Jansen, Computer Physics Communications 117, 1999
 with V the variance of f over A and B. Intervals are of the bootstrap over rows. An estimate of S_i
 can be a little below zero. All are zero where f is constant.
 Errors: kInvalid for fewer than two rows, samples of different size, values that are not finite,
 or options out of range. */
[[nodiscard]] Result<std::vector<SobolIndex>> CalcSobol(const SobolSample& sample,
                                                        const SobolOptions& options = {});

}  // namespace hvas::statistics
