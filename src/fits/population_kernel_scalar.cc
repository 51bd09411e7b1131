#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void TakeSizesScalar(SizeBlock* block) noexcept {
  TakeSizes(block);
}

void CountForcesScalar(PopulationBlock* block) noexcept {
  CountForces(block);
}

PopulationKernel ChoosePopulationKernel() noexcept {
#ifdef HVAS_HAS_AVX2_POPULATION
  if (__builtin_cpu_supports("avx2")) {
    return {TakeSizesAvx2, CountForcesAvx2};
  }
#endif
  return {TakeSizesScalar, CountForcesScalar};
}

}  // namespace hvas::fits
