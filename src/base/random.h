#pragma once

#include <cstdint>

namespace hvas {

/** A small generator with the same stream on every machine and compiler (std distributions differ).

 xoshiro256** seeded by SplitMix64; Blackman and Vigna, ACM TOMS 47(4), 2021. */
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /** The next 64 random bits. */
  std::uint64_t NextBits();
  /** Uniform in [0, 1). */
  double Uniform();
  /** Uniform in [low, high). */
  double Uniform(double low, double high);
  /** Standard normal (polar method of Marsaglia). */
  double Normal();

 private:
  std::uint64_t state_[4];
};

}  // namespace hvas
