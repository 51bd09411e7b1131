#pragma once

#include <vector>

#include "base/random.h"
#include "fits/iso286.h"

/** Actual sizes of a batch (W2): a normal distribution over the whole micrometres of the tolerance
 zone, its mean in the middle and its standard deviation a sixth of the zone. Each micrometre has
 the probability of the interval of 1 um around it; what lies outside the zone is cut off and the
 rest normalised (of a 12 um zone 0.998846 lies inside). */
namespace hvas::fits {

/** Probabilities of 0, 1, .. zone_um micrometres above the lower limit; one where zone_um <= 0. */
[[nodiscard]] std::vector<double> CalcSizeProbabilities(int zone_um);

/** A deviation from the nominal size [m]: the lower limit plus a whole number of micrometres. */
[[nodiscard]] double DrawDeviation(const Limits& limits, Random* random);

}  // namespace hvas::fits
