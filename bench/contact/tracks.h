#pragma once

#include <set>
#include <vector>

#include "parts.h"
#include "spatial/box.h"
#include "spatial/pose.h"

namespace hvas::bench {

inline constexpr int kTrackPoses = 2000;  ///< Two seconds at 1 kHz.

struct PlacedPart {
  std::size_t part;
  spatial::Pose X_WB;
};

/** A held part that moves among others: smooth, with noise of a hand below 8 Hz, always touching
 or within a millimetre. The same on every machine. */
struct Track {
  const char* name;
  const char* description;
  std::size_t held;
  std::vector<PlacedPart> others;
  std::vector<spatial::Pose> poses;  ///< X_WH.
};

/** T1: shaft into bushing; T2: drive gear into the pump's housing, meshing with the driven gear;
 T3: cover over the shafts, dowels and studs, at last pressed 1.8 mm into what it sits on. */
[[nodiscard]] std::vector<Track> MakeTracks();

/** The parts of a track and those that fill its scenes. */
[[nodiscard]] std::set<std::size_t> ListParts(const Track& track);

/** The track's own parts first (as many as there is room for), then concave filler cells around
 what the held part sweeps, nearest first, up to `count` in all. */
[[nodiscard]] std::vector<PlacedPart> MakeScene(const Track& track,
                                                const std::vector<BenchPart>& parts,
                                                std::size_t count);

}  // namespace hvas::bench
