#pragma once

#include <cstdint>

/** The inner loop of a population on plain arrays, so that one source compiles for several
 instruction sets. Lengths in micrometres, forces in newtons, single precision. */
namespace hvas::fits {

inline constexpr int kLanes = 8;          // Floats of an AVX2 register.
inline constexpr int kMaxStations = 256;  // Bounds the room of a block.

/** Where a depth of the common grid lies on a land. */
struct LandDepth {
  std::int32_t interval;  ///< The interval between this station and the next; -1 above the land.
  float part;             ///< Part of the interval, 0 to 1.
};

struct LandView {
  std::int32_t stations;     ///< Intervals of B, 1 to kMaxStations.
  float half_roughness_um;   ///< Rz / 2.
  float force_per_interval;  ///< Force of a micrometre of radial interference over an interval [N].
  /** Radial, of each assembly; negative is interference. Beyond the last assembly of a block, up to
   a multiple of kLanes, kFarApart_um. */
  const float* mean_clearance_um;
  const LandDepth* depths;  ///< One for each depth of the grid.
};

inline constexpr int kForceBins = 2048;      // Counts of 16 bits have room for more: a choice.
inline constexpr float kFarApart_um = 1e6F;  // [um]: a metre apart is no contact.

/** The sizes of a land's parts in a block. */
struct SizeBlock {
  const float* hole_um;   ///< Deviations from the middle of what is possible.
  const float* shaft_um;  ///< Deviations of the shafts.
  std::int32_t assembly_count;
  float middle_um;    ///< Middle of the clearances of the diameters that are possible.
  float loss_um;      ///< What smoothing adds to each.
  float yield_um;     ///< Interference after smoothing beyond which a part yields.
  float lowest_um;    ///< Lowest of the clearances, from the middle.
  float bins_per_um;  ///< No clearance makes kForceBins or more; 0 where only one is possible.
  // Results.
  float* mean_clearance_um;  ///< Ordered as in LandView.
  std::uint16_t* bins;       ///< 0 at the lowest clearance, else 1 to kForceBins.
  std::uint8_t* marks;       ///< kInterferes and kYields are added.
  double sum_um;             ///< Sum of clearances, from the middle.
  double sum_um2;            ///< Sum of their squares.
  std::int32_t interferences;
  std::int32_t yields;
};

// Bits of a mark.
inline constexpr std::uint8_t kInterferes = 1;
inline constexpr std::uint8_t kYields = 2;

struct PopulationBlock {
  const LandView* lands;
  std::int32_t land_count;
  std::int32_t depth_count;
  std::int32_t assembly_count;  ///< Room for a multiple of kLanes is everywhere.
  std::uint64_t seed;           ///< Seed of this block.
  float press_force;            ///< [N]
  /** Each depth's scale: no force makes kForceBins or more, rounding included. 0 where no force is
   possible. */
  const float* bins_per_newton;
  // Results.
  std::uint16_t* bins;  ///< Rows of `stride`, by depth: 0 without force, else 1 to kForceBins.
  std::int32_t stride;
  float* sums;              ///< Forces of each depth, in kLanes partial sums [N].
  std::int32_t over_press;  ///< Assemblies whose force at the last depth exceeds the press.
};

/** Random bits for a multiple of kLanes, from a stream of their own. */
void DrawBitsScalar(std::uint64_t seed, std::int32_t count, std::uint32_t* bits) noexcept;
void DrawBitsAvx2(std::uint64_t seed, std::int32_t count, std::uint32_t* bits) noexcept;

/** Puts holes and shafts together. */
void TakeSizesScalar(SizeBlock* block) noexcept;
void TakeSizesAvx2(SizeBlock* block) noexcept;

/** Draws B of every assembly and sorts the forces at the depths of the grid into bins. */
void CountForcesScalar(PopulationBlock* block) noexcept;
void CountForcesAvx2(PopulationBlock* block) noexcept;

/** Both kinds give the same bits. */
struct PopulationKernel {
  void (*draw_bits)(std::uint64_t, std::int32_t, std::uint32_t*);
  void (*take_sizes)(SizeBlock*);
  void (*count_forces)(PopulationBlock*);
};

/** The fastest that this machine runs. */
[[nodiscard]] PopulationKernel ChoosePopulationKernel() noexcept;

}  // namespace hvas::fits
