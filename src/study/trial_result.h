#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "spatial/pose.h"

namespace hvas::study {

enum class Outcome : std::uint8_t {
  kDone,      ///< The part is in its place.
  kTimedOut,  ///< It was not when the time was up.
  kNotDone,   ///< The experimenter, or the simulated person, gave it up.
};

inline constexpr std::array<std::string_view, 3> kOutcomes{"done", "timed_out", "not_done"};

/** What the hand feels of the mating, in a frame whose z axis is the way out (X15). */
struct MatingSample {
  double t{0};                ///< Before the part is in its place, or the trial over; <= 0 [s].
  Vec3 f{Vec3::Zero()};       ///< [N]
  Vec3 torque{Vec3::Zero()};  ///< About the hand's point [N m].
};

/** What one trial amounted to. */
struct TrialResult {
  Outcome outcome{Outcome::kNotDone};
  /** By the tick clock, from the first tick of the trial to the one in which the part is in its
   place, or to its end [s]. None where nobody moved anything: identification by a simulated
   observer. */
  std::optional<double> time;
  int collisions{0};    ///< Times that something was met before a mate guided the part.
  double peak_felt{0};  ///< [N]
  double peak_true{0};  ///< [N]
  double insertion{0};  ///< [m]
  std::vector<MatingSample> mating;
};

}  // namespace hvas::study
