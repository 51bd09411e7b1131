// Compiled with -mavx2.
#include "fits/population_kernel.inl.h"

namespace hvas::fits {

void TakeSizesAvx2(SizeBlock* block) noexcept {
  TakeSizes(block);
}

void CountForcesAvx2(PopulationBlock* block) noexcept {
  CountForces(block);
}

}  // namespace hvas::fits
