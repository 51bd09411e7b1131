#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/kernel.h"
#include "spatial/pose.h"

namespace hvas::contact {

/** Two shapes whose distances are remembered: the samples of one in the field of the other. */
struct SampledPair {
  std::uint64_t sampled{0};  ///< Serial numbers of the shapes.
  std::uint64_t field{0};
  std::uint32_t body{0};  ///< Number of the scene's body.
  std::uint32_t self{0};  ///< The held part as a body of the scene, where it is one.
  bool is_reverse{false};
  std::uint64_t sampled_made{0};  ///< Serial numbers of their faces as made; 0: as drawn.
  std::uint64_t field_made{0};

  friend bool operator==(const SampledPair&, const SampledPair&) = default;
};

/** What queries remember for the ones that follow: how far the parts of a shell were from a field,
 and how far single samples were whose distance took a search through triangles.
 A part that was d away is not met before the shapes have moved d, so that it need not be looked at
 until then. Answers are those of a query that remembers nothing; one in a new place is as slow.
 Fixed size, RT-safe. */
class BoundMemory {
 public:
  BoundMemory();

  /** Begins a query: what it asks for is kept until it ends. */
  void Begin() noexcept { ++query_; }

  /** Returns the bounds of a pair, moved on to where its shapes are now; empty where there is no
   room for them.
   @param R, p  Take the sampled shape's coordinates to the field's.
   @param extent  No sample is further than this from the origin of its frame [m].
   @param count  Bounds: eight for each node of the shell. */
  [[nodiscard]] BoundView Find(const SampledPair& pair, const Mat3& R, const Vec3& p, double extent,
                               std::size_t count) noexcept;

  /** Whether a sample was so far away that it is beyond a distance [m] still.
   @param view  Of its pair, in this query. */
  [[nodiscard]] bool IsBeyond(const BoundView& view, std::uint32_t point,
                              double distance) const noexcept {
    const FarSample& sample = far_[SlotOf(view, point)];
    return sample.point == point && sample.since == view.since &&
           static_cast<double>(sample.bound) > static_cast<double>(view.moved) + distance;
  }

  /** Remembers that a sample is at least so far away [m]. */
  void SetFar(const BoundView& view, std::uint32_t point, double distance) noexcept {
    const float bound = view.moved + static_cast<float>(distance);
    far_[SlotOf(view, point)] = {point, view.since, bound - kBoundRounding};
  }

 private:
  static constexpr std::size_t kPairs = 64;   ///< The least used one makes way. A choice.
  static constexpr std::size_t kMost = 8192;  ///< Bounds of a pair: 50,000 samples. A choice.

  static constexpr std::size_t kFar = 1U << 14U;  ///< Samples, the last ones. A choice.

  struct FarSample {
    std::uint32_t point{0};
    std::uint32_t since{0};
    float bound{0};  ///< What it is away, and BoundView::moved when that was found [m].
  };

  // Samples of one leaf stand side by side.
  static std::size_t SlotOf(const BoundView& view, std::uint32_t point) noexcept {
    constexpr std::uint32_t kSpread = 0x9e3779b9U;  // 2^32 over the golden ratio.
    return (point + 8 * (view.since * kSpread >> 8U)) % kFar;
  }

  struct Entry {
    SampledPair pair;
    Mat3 R{Mat3::Identity()};
    Vec3 p{Vec3::Zero()};
    double moved{0};           // [m] since the bounds were cleared.
    std::uint64_t used_at{0};  // Number of the query; 0: never.
    std::uint32_t turn{0};
    std::uint32_t since{0};
  };

  [[nodiscard]] std::size_t PlaceOf(const SampledPair& pair) const noexcept;

  std::array<Entry, kPairs> entries_;
  std::vector<float> bounds_;   // kMost an entry.
  std::vector<FarSample> far_;  // By SlotOf().
  std::uint32_t clears_{0};     // How often bounds were cleared.
  std::uint64_t query_{0};
  std::size_t next_{0};  // Where the pair after the last one was: queries ask in one order.
};

}  // namespace hvas::contact
