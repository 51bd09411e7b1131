#pragma once

#include <vector>

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::mates {

/** Two parts that share space as drawn. */
struct SharedVolume {
  /** What is made of it. */
  enum class Cause {
    kPressFit,  ///< A mate with a fit explains it.
    kThread,    ///< A threaded joint explains it.
    kOverlap,   ///< Nothing does: a part that goes in needs an allowance for it.
  };

  product::OccurrenceId a;
  product::OccurrenceId b;
  double volume{0};  ///< [m^3]
  double depth{0};   ///< The deepest point of one inside the other, from its surface [m].
  Cause cause{Cause::kOverlap};
  product::MateId mate;  ///< The mate that explains it; else invalid.
};

[[nodiscard]] const char* ToString(SharedVolume::Cause cause);

/** Measures the space that two parts share: rays along the three axes of W through the boxes'
 overlap, 32 by 32 of each, of which the direction with the most hits counts for the volume. That is
 good to some percent where the overlap is wider than a step of the rays. The depth is that of the
 mates' radii where they explain the overlap; else it is good to the deviation of the meshes.
 @returns zero volume where they share none. */
[[nodiscard]] SharedVolume MeasureSharedVolume(const product::Product& product,
                                               product::OccurrenceId a, product::OccurrenceId b);

/** Lists the pairs of parts whose mates have a drawn interference above 1 um, or that lie in one
 another deeper than 50 um, in the order of their ids. Incomplete when the watch ends it. */
[[nodiscard]] std::vector<SharedVolume> ListSharedVolumes(const product::Product& product,
                                                          WorkWatch* watch = nullptr);

}  // namespace hvas::mates
