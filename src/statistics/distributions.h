#pragma once

#include <cstdint>

/** The distributions that the tests need, from Boost.Math. All arguments are finite. */
namespace hvas::statistics {

/** P(Z >= z) of the standard normal distribution. */
[[nodiscard]] double CalcNormalUpper(double z);

/** The z that the share p of a standard normal distribution is below. @pre 0 < p < 1. */
[[nodiscard]] double CalcNormalQuantile(double p);

/** P(X >= x) of chi-square. @pre x >= 0, dof > 0. */
[[nodiscard]] double CalcChiSquareUpper(double x, double dof);

/** P(X >= x) of Fisher's F. @pre x >= 0, dof1, dof2 > 0. */
[[nodiscard]] double CalcFisherUpper(double x, double dof1, double dof2);

/** The t that the share p is below. @pre 0 < p < 1, dof > 0. */
[[nodiscard]] double CalcStudentQuantile(double p, double dof);

/** P(T <= t) of the non-central t distribution. @pre dof > 0. */
[[nodiscard]] double CalcNonCentralStudent(double t, double dof, double non_centrality);

/** P(X >= k) of n trials with probability p. @pre 0 <= k <= n, 0 <= p <= 1. */
[[nodiscard]] double CalcBinomialUpper(std::int64_t k, std::int64_t n, double p);

/** P(X <= k). @pre as above. */
[[nodiscard]] double CalcBinomialLower(std::int64_t k, std::int64_t n, double p);

/** The x that the share p of a beta distribution is below. @pre a, b > 0, 0 < p < 1. */
[[nodiscard]] double CalcBetaQuantile(double p, double a, double b);

}  // namespace hvas::statistics
