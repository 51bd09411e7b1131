#pragma once

#include <vector>

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::mates {

/** Two faces of which one lies inside the other's part. */
struct FaceOverlap {
  product::FaceId a;       ///< Face of the first part.
  product::FaceId b;       ///< Face of the second part.
  double depth{0};         ///< [m]
  bool is_coaxial{false};  ///< Shaft and hole about one axis: the depth is the radii's difference.
};

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
  product::MateId mate;            ///< The mate that explains it; else invalid.
  std::vector<FaceOverlap> faces;  ///< Faces that lie in one another, the deepest first.
};

[[nodiscard]] const char* ToString(SharedVolume::Cause cause);

/** Measures the space that two parts share: rays along the three axes of the smaller part through
 the boxes' overlap, 32 by 32 of each or as many as lie 2 mm apart (64 at most), of which the
 direction with the most hits counts for the volume; once more through the box of what they find.
 That is good to some percent where the overlap is wider than a step of the rays. The depth is that
 of the mates' radii where they explain the overlap, that of the radii of cylinders about one axis;
 else it is good to the deviation of the meshes.
 @returns zero volume where they share none. */
[[nodiscard]] SharedVolume MeasureSharedVolume(const product::Product& product,
                                               product::OccurrenceId a, product::OccurrenceId b);

/** Lists the pairs of parts whose mates have a drawn interference above 1 um, or that lie in one
 another deeper than 50 um, in the order of their ids. Incomplete when the watch ends it. */
[[nodiscard]] std::vector<SharedVolume> ListSharedVolumes(const product::Product& product,
                                                          WorkWatch* watch = nullptr);

}  // namespace hvas::mates
