#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#else
#include <algorithm>
#include <cmath>
#endif

namespace hvas::contact {

/** Four numbers in single precision. Every operation rounds once, with vector instructions and
 without, so that both give the same bits. */
#if defined(__SSE2__)
class Quad {
 public:
  explicit Quad(float all) : v_(_mm_set1_ps(all)) {}

  explicit Quad(const float* from) : v_(_mm_loadu_ps(from)) {}

  friend Quad operator+(Quad a, Quad b) { return Quad(_mm_add_ps(a.v_, b.v_)); }

  friend Quad operator-(Quad a, Quad b) { return Quad(_mm_sub_ps(a.v_, b.v_)); }

  friend Quad operator*(Quad a, Quad b) { return Quad(_mm_mul_ps(a.v_, b.v_)); }

  friend Quad Most(Quad a, Quad b) { return Quad(_mm_max_ps(a.v_, b.v_)); }

  friend Quad operator/(Quad a, Quad b) { return Quad(_mm_div_ps(a.v_, b.v_)); }

  [[nodiscard]] Quad Root() const { return Quad(_mm_sqrt_ps(v_)); }

  /** Bit i is set where number i of a is no more than that of b. */
  friend unsigned BitsAtMost(Quad a, Quad b) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.v_, b.v_)));
  }

  void Store(float* to) const { _mm_storeu_ps(to, v_); }

 private:
  explicit Quad(__m128 v) : v_(v) {}

  __m128 v_;
};
#else
class Quad {
 public:
  explicit Quad(float all) : v_{all, all, all, all} {}

  explicit Quad(const float* from) : v_{from[0], from[1], from[2], from[3]} {}

  friend Quad operator+(Quad a, Quad b) {
    return Map([&](int i) { return a.v_[i] + b.v_[i]; });
  }

  friend Quad operator-(Quad a, Quad b) {
    return Map([&](int i) { return a.v_[i] - b.v_[i]; });
  }

  friend Quad operator*(Quad a, Quad b) {
    return Map([&](int i) { return a.v_[i] * b.v_[i]; });
  }

  friend Quad Most(Quad a, Quad b) {
    return Map([&](int i) { return std::max(b.v_[i], a.v_[i]); });
  }

  friend Quad operator/(Quad a, Quad b) {
    return Map([&](int i) { return a.v_[i] / b.v_[i]; });
  }

  [[nodiscard]] Quad Root() const {
    return Map([&](int i) { return std::sqrt(v_[i]); });
  }

  /** Bit i is set where number i of a is no more than that of b. */
  friend unsigned BitsAtMost(Quad a, Quad b) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 4; ++i) {
      bits |= (a.v_[i] <= b.v_[i] ? 1U : 0U) << i;
    }
    return bits;
  }

  void Store(float* to) const { std::copy(v_, v_ + 4, to); }

 private:
  template <typename Operation>
  static Quad Map(Operation operation) {
    const float all[4] = {operation(0), operation(1), operation(2), operation(3)};
    return Quad(all);
  }

  float v_[4];
};
#endif

}  // namespace hvas::contact
