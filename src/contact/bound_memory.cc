#include "contact/bound_memory.h"

#include <algorithm>
#include <limits>

namespace hvas::contact {

BoundMemory::BoundMemory() : bounds_(kPairs * kMost), far_(kFar) {}

// Returns the pair's entry, or the one that has not been used for the longest time.
std::size_t BoundMemory::PlaceOf(const SampledPair& pair) const noexcept {
  for (std::size_t i = 0; i < kPairs; ++i) {
    const std::size_t place = (next_ + i) % kPairs;
    if (entries_[place].used_at != 0 && entries_[place].pair == pair) {
      return place;
    }
  }
  const auto* const oldest =
      std::min_element(entries_.begin(), entries_.end(),
                       [](const Entry& a, const Entry& b) { return a.used_at < b.used_at; });
  return static_cast<std::size_t>(oldest - entries_.begin());
}

BoundView BoundMemory::Find(const SampledPair& pair, const Mat3& R, const Vec3& p, double extent,
                            std::size_t count) noexcept {
  // [m]: above it a sum in single precision is wrong by more than a fifth of kBoundRounding.
  constexpr double kLongest = 0.25;
  if (count > kMost) {
    return {};
  }
  const std::size_t place = PlaceOf(pair);
  Entry& entry = entries_[place];
  const bool is_known = entry.used_at != 0 && entry.pair == pair;
  if (!is_known && entry.used_at == query_) {
    return {};
  }
  next_ = (place + 1) % kPairs;
  entry.used_at = query_;
  float* const bounds = bounds_.data() + place * kMost;
  // A rotation by t moves a point at distance r by 2 r sin(t/2), which is r times the Frobenius
  // norm of the change of the matrix over the square root of two.
  entry.moved += (p - entry.p).norm() + extent * ((R - entry.R).norm() * 0.7071067811865476);
  if (!is_known || !(entry.moved < kLongest)) {
    entry.turn = is_known ? entry.turn : 0;
    entry.pair = pair;
    entry.moved = 0;
    entry.since = ++clears_;
    std::fill(bounds, bounds + count, -std::numeric_limits<float>::infinity());
  }
  entry.R = R;
  entry.p = p;
  return {bounds, static_cast<float>(entry.moved), ++entry.turn, entry.since};
}

}  // namespace hvas::contact
