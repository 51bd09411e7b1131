#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hvas {

/** Counts of durations in logarithmic buckets: 32 a factor of two, so a quantile is at most 1/32
 (3.1 %) above the true one; below 64 ns it is exact, and the largest value is kept exactly.

 Add() is RT-safe. One thread at a time; threads keep one each and Merge() them afterwards. */
class LatencyHistogram {
 public:
  /** Counts a duration [ns]; a negative one counts as 0. */
  void Add(std::int64_t duration_ns) noexcept {
    const auto value_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(duration_ns, 0));
    ++buckets_[BucketOf(value_ns)];
    ++count_;
    sum_ns_ += static_cast<double>(value_ns);
    max_ns_ = std::max(max_ns_, value_ns);
  }

  void Merge(const LatencyHistogram& other) noexcept {
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      buckets_[i] += other.buckets_[i];
    }
    count_ += other.count_;
    sum_ns_ += other.sum_ns_;
    max_ns_ = std::max(max_ns_, other.max_ns_);
  }

  /** The smallest duration [ns] that at least the share p in [0, 1] of all values do not exceed,
   rounded up to its bucket's end; 0 when empty. */
  [[nodiscard]] std::int64_t Quantile(double p) const noexcept {
    if (count_ == 0) {
      return 0;
    }
    const double share = std::ceil(std::clamp(p, 0.0, 1.0) * static_cast<double>(count_));
    const auto rank = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(share), 1, count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      seen += buckets_[i];
      if (seen >= rank) {
        return static_cast<std::int64_t>(std::min(LastOf(i), max_ns_));
      }
    }
    return max_ns();
  }

  /** Counts the values that are no longer than this, and those in its bucket. */
  [[nodiscard]] std::uint64_t CountUpTo(std::int64_t duration_ns) const noexcept {
    const std::size_t last =
        BucketOf(static_cast<std::uint64_t>(std::max<std::int64_t>(duration_ns, 0)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i <= last; ++i) {
      seen += buckets_[i];
    }
    return seen;
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  [[nodiscard]] std::int64_t max_ns() const noexcept { return static_cast<std::int64_t>(max_ns_); }

  [[nodiscard]] double mean_ns() const noexcept {
    return count_ == 0 ? 0.0 : sum_ns_ / static_cast<double>(count_);
  }

 private:
  // A value v >= 32 with its leading bit at e (>= 5) goes to octave e - 5, slot (v >> (e - 5)) in
  // [32, 64). Values below 64 have a bucket of their own.
  static constexpr std::uint32_t kSlotBits = 5;
  static constexpr std::uint64_t kSlots = std::uint64_t{1} << kSlotBits;
  static constexpr std::size_t kOctaves = 64 - kSlotBits;

  static std::size_t BucketOf(std::uint64_t value_ns) noexcept {
    const auto width = static_cast<std::uint32_t>(std::bit_width(value_ns | (kSlots - 1)));
    const std::uint32_t shift = width > kSlotBits ? width - kSlotBits - 1 : 0;
    return shift * kSlots + (value_ns >> shift);
  }

  /** Largest value of a bucket. */
  static std::uint64_t LastOf(std::size_t bucket) noexcept {
    if (bucket < 2 * kSlots) {
      return bucket;
    }
    const std::size_t shift = bucket / kSlots - 1;
    return ((bucket - shift * kSlots + 1) << shift) - 1;
  }

  std::array<std::uint64_t, (kOctaves + 1) * kSlots> buckets_{};
  std::uint64_t count_{0};
  std::uint64_t max_ns_{0};
  double sum_ns_{0};
};

}  // namespace hvas
