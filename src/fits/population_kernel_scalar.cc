#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void CalcForcesScalar(const PopulationBlock& block) noexcept {
  CalcForces(block);
}

ForcesFunction ChooseCalcForces() noexcept {
#ifdef HVAS_HAS_AVX2_POPULATION
  if (__builtin_cpu_supports("avx2")) {
    return CalcForcesAvx2;
  }
#endif
  return CalcForcesScalar;
}

}  // namespace hvas::fits
