#include "product/forms.h"

#include <algorithm>

#include "product/edge_forms.h"
#include "product/hole_patterns.h"
#include "product/prismatic_forms.h"
#include "product/rings.h"
#include "product/round_forms.h"

namespace hvas::product {

std::vector<Form> FindForms(const Part& part, const FaceAdjacency& adjacency, double tolerance,
                            RecognitionLimits* limits) {
  // Positions of a pattern come from drawings; a few roundings of its decimals are no difference.
  constexpr double kPatternTolerance = 10e-6;  // [m]
  const RingSet rings = FindRings(part, adjacency, tolerance);
  const std::vector<Ring> partials = FindPartialCylinders(part, adjacency, rings, tolerance);
  const std::vector<RingChain> chains = FindChains(part, adjacency, rings, tolerance);
  std::vector<Form> forms = FindRoundForms(part, rings, chains, tolerance);
  const auto append = [&forms](const std::vector<Form>& more) {
    forms.insert(forms.end(), more.begin(), more.end());
  };
  const std::vector<Form> chamfers = FindEdgeChamfers(part, adjacency, forms);
  const std::vector<Form> patterns =
      FindHolePatterns(forms, std::max(tolerance, kPatternTolerance), limits);
  const std::vector<Form> slots = FindSlots(part, adjacency, partials, tolerance);
  append(slots);
  append(FindPockets(part, adjacency, rings, partials, slots, limits));
  append(FindSeats(part, limits));
  append(FindFillets(part, adjacency, rings, partials, slots));
  append(chamfers);
  append(patterns);
  return forms;
}

}  // namespace hvas::product
