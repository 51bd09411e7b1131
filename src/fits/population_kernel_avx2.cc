// Compiled with -mavx2.
#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void CalcForcesAvx2(const PopulationBlock& block) noexcept {
  CalcForces(block);
}

}  // namespace hvas::fits
