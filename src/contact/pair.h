#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#else
#include <algorithm>
#include <cmath>
#endif

namespace hvas::contact {

/** Two numbers in double precision. Every operation rounds once, with vector instructions and
 without, so that both give the same bits. */
#if defined(__SSE2__)
class Pair {
 public:
  Pair(double low, double high) : v_(_mm_set_pd(high, low)) {}

  explicit Pair(double both) : v_(_mm_set1_pd(both)) {}

  explicit Pair(const double* from) : v_(_mm_loadu_pd(from)) {}

  friend Pair operator+(Pair a, Pair b) { return Pair(_mm_add_pd(a.v_, b.v_)); }

  friend Pair operator-(Pair a, Pair b) { return Pair(_mm_sub_pd(a.v_, b.v_)); }

  friend Pair operator*(Pair a, Pair b) { return Pair(_mm_mul_pd(a.v_, b.v_)); }

  [[nodiscard]] Pair Abs() const { return Pair(_mm_andnot_pd(_mm_set1_pd(-0.0), v_)); }

  friend Pair Least(Pair a, Pair b) { return Pair(_mm_min_pd(a.v_, b.v_)); }

  [[nodiscard]] Pair Root() const { return Pair(_mm_sqrt_pd(v_)); }

  /** Zero where it is less. */
  [[nodiscard]] Pair Positive() const { return Pair(_mm_max_pd(v_, _mm_setzero_pd())); }

  [[nodiscard]] double low() const { return _mm_cvtsd_f64(v_); }

  [[nodiscard]] double high() const { return _mm_cvtsd_f64(_mm_unpackhi_pd(v_, v_)); }

 private:
  explicit Pair(__m128d v) : v_(v) {}

  __m128d v_;
};
#else
class Pair {
 public:
  Pair(double low, double high) : low_(low), high_(high) {}

  explicit Pair(double both) : low_(both), high_(both) {}

  explicit Pair(const double* from) : low_(from[0]), high_(from[1]) {}

  friend Pair operator+(Pair a, Pair b) { return {a.low_ + b.low_, a.high_ + b.high_}; }

  friend Pair operator-(Pair a, Pair b) { return {a.low_ - b.low_, a.high_ - b.high_}; }

  friend Pair operator*(Pair a, Pair b) { return {a.low_ * b.low_, a.high_ * b.high_}; }

  [[nodiscard]] Pair Abs() const { return {std::abs(low_), std::abs(high_)}; }

  friend Pair Least(Pair a, Pair b) {
    return {std::min(a.low_, b.low_), std::min(a.high_, b.high_)};
  }

  [[nodiscard]] Pair Root() const { return {std::sqrt(low_), std::sqrt(high_)}; }

  /** Zero where it is less. */
  [[nodiscard]] Pair Positive() const { return {std::max(low_, 0.0), std::max(high_, 0.0)}; }

  [[nodiscard]] double low() const { return low_; }

  [[nodiscard]] double high() const { return high_; }

 private:
  double low_;
  double high_;
};
#endif

}  // namespace hvas::contact
