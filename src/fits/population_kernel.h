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

struct PopulationBlock {
  const LandView* lands;
  std::int32_t land_count;
  std::int32_t depth_count;
  std::int32_t assembly_count;  ///< A multiple of kLanes.
  std::uint64_t seed;           ///< Of this block.
  float* forces;                ///< depth_count rows of assembly_count.
};

/** Draws B of every assembly and writes the forces at the depths of the grid. Both give the same
 bits. */
void CalcForcesScalar(const PopulationBlock& block) noexcept;
void CalcForcesAvx2(const PopulationBlock& block) noexcept;

using ForcesFunction = void (*)(const PopulationBlock&);

/** The fastest that this machine runs. */
[[nodiscard]] ForcesFunction ChooseCalcForces() noexcept;

}  // namespace hvas::fits
