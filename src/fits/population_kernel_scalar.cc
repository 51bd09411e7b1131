#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void DrawBitsScalar(std::uint64_t seed, std::int32_t count, std::uint32_t* bits) noexcept {
  DrawBits(seed, count, bits);
}

void TakeSizesScalar(SizeBlock* block) noexcept {
  TakeSizes(block);
}

void CountForcesScalar(PopulationBlock* block) noexcept {
  CountForces(block);
}

PopulationKernel ChoosePopulationKernel() noexcept {
#ifdef HVAS_HAS_AVX2_POPULATION
  if (__builtin_cpu_supports("avx2")) {
    return {DrawBitsAvx2, TakeSizesAvx2, CountForcesAvx2};
  }
#endif
  return {DrawBitsScalar, TakeSizesScalar, CountForcesScalar};
}

}  // namespace hvas::fits
