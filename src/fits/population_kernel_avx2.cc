// Compiled with -mavx2.
#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void DrawBitsAvx2(std::uint64_t seed, std::int32_t count, std::uint32_t* bits) noexcept {
  DrawBits(seed, count, bits);
}

void TakeSizesAvx2(SizeBlock* block) noexcept {
  TakeSizes(block);
}

void CountForcesAvx2(PopulationBlock* block) noexcept {
  CountForces(block);
}

}  // namespace hvas::fits
