#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void CountForcesScalar(PopulationBlock* block) noexcept {
  CountForces(block);
}

CountForcesFunction ChooseCountForces() noexcept {
#ifdef HVAS_HAS_AVX2_POPULATION
  if (__builtin_cpu_supports("avx2")) {
    return CountForcesAvx2;
  }
#endif
  return CountForcesScalar;
}

}  // namespace hvas::fits
