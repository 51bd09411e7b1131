#pragma once

#include <utility>
#include <vector>

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::mates {

/** Features of the parts of Mate::a and Mate::b. */
using FeaturePair = std::pair<product::FeatureId, product::FeatureId>;

/** Breaks a mate down to its faces (X2, layer J): those pairs of faces of the features which face
 each other when the mate is fulfilled. Around an axis they share part of the length and of the
 turn, on a plane an area, around a centre a direction. In the order of the features' faces. Ends
 early when the watch says so. */
[[nodiscard]] std::vector<product::SurfaceConstraint> FindSurfacePairs(
    const product::Product& product, const product::Mate& mate,
    const std::vector<FeaturePair>& features, WorkWatch* watch = nullptr);

/** Finds the pairs of the mate's own two features. */
[[nodiscard]] std::vector<product::SurfaceConstraint> FindSurfacePairs(
    const product::Product& product, const product::Mate& mate, WorkWatch* watch = nullptr);

/** What two planes have in common. */
struct PlaneOverlap {
  double area{0};           ///< [m^2]
  Vec3 p_MQ{Vec3::Zero()};  ///< Its centroid, in the frame of Mate::a.
};

/** Overlap of the planes of a face-face mate when it is fulfilled. */
[[nodiscard]] PlaneOverlap CalcPlaneOverlap(const product::Product& product,
                                            const product::Mate& mate);

/** Area of the ball that the socket's faces lie around, at the ball's radius [m^2], by 512 evenly
 spread directions from the centre of the frames. */
[[nodiscard]] double CalcSphereOverlap(const product::Product& product, const product::Mate& mate);

}  // namespace hvas::mates
