#pragma once

#include <cstdint>

/** The inner loop of a population on plain arrays, so that one source compiles for several
 instruction sets. Lengths in micrometres, forces in newtons, single precision. */
namespace hvas::fits {

inline constexpr int kLanes = 8;
inline constexpr int kMaxStations = 256;

/** Where a depth of the common grid lies on a land. */
struct LandDepth {
  std::int32_t interval;  ///< Between this station and the next; -1 above the land.
  float part;             ///< Of the interval, 0 to 1.
};

struct LandView {
  std::int32_t stations;           ///< Intervals of B, 1 to kMaxStations.
  float half_roughness_um;         ///< Rz / 2.
  float force_per_interval;        ///< Of a micrometre of radial interference over an interval [N].
  const float* mean_clearance_um;  ///< Radial, of each assembly; negative is interference.
  const LandDepth* depths;         ///< As many as the grid has.
};

inline constexpr int kForceBins = 2048;

struct PopulationBlock {
  const LandView* lands;
  std::int32_t land_count;
  std::int32_t depth_count;
  std::int32_t assembly_count;   ///< Room for a multiple of kLanes is everywhere.
  std::uint64_t seed;            ///< Of this block.
  float press_force;             ///< [N]
  const float* bins_per_newton;  ///< Of each depth; 0 where no force is possible.
  // Results.
  std::uint16_t* bins;  ///< Rows of `stride`, by depth: 0 without force, else 1 to kForceBins.
  std::int32_t stride;
  float* sums;              ///< Forces of each depth, in kLanes partial sums [N].
  std::int32_t over_press;  ///< Assemblies whose force at the last depth exceeds the press.
};

/** Draws B of every assembly and sorts the forces at the depths of the grid into bins. Both give
 the same bits. */
void CountForcesScalar(PopulationBlock* block) noexcept;
void CountForcesAvx2(PopulationBlock* block) noexcept;

using CountForcesFunction = void (*)(PopulationBlock*);

/** The fastest that this machine runs. */
[[nodiscard]] CountForcesFunction ChooseCountForces() noexcept;

}  // namespace hvas::fits
