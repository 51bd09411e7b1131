#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"
#include "paths/path.h"

namespace hvas::paths {

/** A body that stands beside the path of a part. */
struct Neighbour {
  const contact::Shape* shape{nullptr};
  spatial::Pose X_WN;
};

/** The least distance between a part on its path and one neighbour. */
struct Clearance {
  std::size_t neighbour{0};    ///< Index of the neighbour.
  double distance{0};          ///< Distance of the drawn faces; negative: depth of an overlap [m].
  std::size_t pose{0};         ///< Index of the pose at which the distance is least.
  Vec3 p_WC{Vec3::Zero()};     ///< Point of the nearest place.
  Vec3 nhat_W{Vec3::UnitZ()};  ///< Direction from the neighbour to the part there.
};

struct ClearanceOptions {
  std::size_t count{5};                           ///< The nearest neighbours that are listed.
  std::function<void(double fraction)> progress;  ///< Called by the calling thread; may be null.
  std::stop_token stop;
};

/** Calculates the least distances between a part on its path and the bodies beside it, on the exact
 faces of both (contact::Scene). Poses that cannot be nearer are skipped: no distance changes by
 more than the largest displacement of a point of the part. Where no point of the part moves further
 than h from one pose to the next, the distance between two poses is at most h / 2 less than what
 is returned.
 @param path  Poses X_WB; see Resample().
 @returns the nearest neighbours, by distance.
 Errors: kInvalid without a pose; kCancelled after a stop. */
[[nodiscard]] Result<std::vector<Clearance>> CalcClearances(
    const contact::Shape& part, const Path& path, const std::vector<Neighbour>& neighbours,
    const ClearanceOptions& options);

}  // namespace hvas::paths
