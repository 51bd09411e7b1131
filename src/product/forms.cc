#include "product/forms.h"

#include "product/rings.h"
#include "product/round_forms.h"

namespace hvas::product {

std::vector<Form> FindForms(const Part& part, const FaceAdjacency& adjacency, double tolerance) {
  const RingSet rings = FindRings(part, adjacency, tolerance);
  const std::vector<RingChain> chains = FindChains(part, adjacency, rings, tolerance);
  return FindRoundForms(part, rings, chains, tolerance);
}

}  // namespace hvas::product
