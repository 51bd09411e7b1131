#pragma once

#include <functional>
#include <string>
#include <vector>

#include "method.h"
#include "timing.h"

namespace hvas::bench {

/** A method as the table of speed names it. */
struct Entrant {
  std::string name;        ///< Methods of --methods.
  int poses{kTrackPoses};  ///< Poses of each track, evenly spread: the slow ones are asked fewer.
  int passes{5};
  std::function<std::unique_ptr<Method>()> make;
};

struct SpeedRow {
  std::string track, method;
  std::size_t scene{0};
  int poses{0}, passes{0};
  Spread time;         ///< Median of the least time of each pose over the passes [s].
  double ratio{0};     ///< Ratio of the median to that of the first entrant on the same poses.
  double contacts{0};  ///< Mean over the poses.
  double touching{0};  ///< Part of the poses with a contact.
  Spread depth;        ///< Depth of the deepest contact of each pose [m].
  Spread points;       ///< Tested.
  Spread candidates;
  Spread bodies;
};

/** The least time of each pose, over passes over all of the track's poses `stride` apart [s]. */
struct PoseTimes {
  std::vector<double> least;
  std::vector<std::size_t> contacts;
  std::vector<double> deepest;  ///< [m]
  std::vector<Effort> effort;
};

[[nodiscard]] PoseTimes Measure(Method* method, const Track& track, int poses, int passes);

/** Runs all entrants over a track in a scene. The first is what the others are compared with; its
 row compares all poses, the ratios of others those that they were asked. */
[[nodiscard]] std::vector<SpeedRow> RunTrack(const Track& track,
                                             const std::vector<PlacedPart>& scene,
                                             const std::vector<Entrant>& entrants);

}  // namespace hvas::bench
