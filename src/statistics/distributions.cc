#include "statistics/distributions.h"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "base/check.h"

namespace hvas::statistics {
namespace {

namespace math = boost::math;

// No exceptions: callers keep to the preconditions, and look at what may still not converge.
using Policy =
    math::policies::policy<math::policies::domain_error<math::policies::ignore_error>,
                           math::policies::pole_error<math::policies::ignore_error>,
                           math::policies::overflow_error<math::policies::ignore_error>,
                           math::policies::evaluation_error<math::policies::ignore_error>>;

}  // namespace

double CalcNormalUpper(double z) {
  return math::cdf(math::complement(math::normal_distribution<double, Policy>(), z));
}

double CalcNormalQuantile(double p) {
  HVAS_ASSERT(0 < p && p < 1);
  return math::quantile(math::normal_distribution<double, Policy>(), p);
}

double CalcChiSquareUpper(double x, double dof) {
  HVAS_ASSERT(x >= 0 && dof > 0);
  return math::cdf(math::complement(math::chi_squared_distribution<double, Policy>(dof), x));
}

double CalcFisherUpper(double x, double dof1, double dof2) {
  HVAS_ASSERT(x >= 0 && dof1 > 0 && dof2 > 0);
  return math::cdf(math::complement(math::fisher_f_distribution<double, Policy>(dof1, dof2), x));
}

double CalcStudentQuantile(double p, double dof) {
  HVAS_ASSERT(0 < p && p < 1 && dof > 0);
  return math::quantile(math::students_t_distribution<double, Policy>(dof), p);
}

double CalcNonCentralStudent(double t, double dof, double non_centrality) {
  HVAS_ASSERT(dof > 0);
  return math::cdf(math::non_central_t_distribution<double, Policy>(dof, non_centrality), t);
}

double CalcBinomialUpper(std::int64_t k, std::int64_t n, double p) {
  HVAS_ASSERT(0 <= k && k <= n && 0 <= p && p <= 1);
  if (k <= 0) {
    return 1;
  }
  const math::binomial_distribution<double, Policy> binomial(static_cast<double>(n), p);
  return math::cdf(math::complement(binomial, static_cast<double>(k - 1)));
}

double CalcBinomialLower(std::int64_t k, std::int64_t n, double p) {
  HVAS_ASSERT(0 <= k && k <= n && 0 <= p && p <= 1);
  const math::binomial_distribution<double, Policy> binomial(static_cast<double>(n), p);
  return math::cdf(binomial, static_cast<double>(k));
}

double CalcBetaQuantile(double p, double a, double b) {
  HVAS_ASSERT(a > 0 && b > 0 && 0 < p && p < 1);
  return math::quantile(math::beta_distribution<double, Policy>(a, b), p);
}

}  // namespace hvas::statistics
