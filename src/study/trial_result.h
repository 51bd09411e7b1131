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
  kDone,      ///< The part was seated.
  kTimedOut,  ///< The time limit was reached first.
  kNotDone,   ///< The experimenter, or the simulated person, gave up.
};

inline constexpr std::array<std::string_view, 3> kOutcomes{"done", "timed_out", "not_done"};

/** Wrench on the hand during mating, in a frame whose z axis is the direction of extraction
 (X15). */
struct MatingSample {
  double t{0};                ///< Time relative to seating, or to the trial's end; <= 0 [s].
  Vec3 f{Vec3::Zero()};       ///< Force [N].
  Vec3 torque{Vec3::Zero()};  ///< Torque about Ho [N m].
};

/** The pair of parts of a trial: of the fit that is felt most. */
struct TrialPair {
  double hole_diameter{0};         ///< Mean over the length [m].
  double shaft_diameter{0};        ///< Mean over the length [m].
  std::vector<double> clearances;  ///< S(l) at equal steps from the mouth inwards, radial [m].
};

/** Measurements of one trial. */
struct TrialResult {
  Outcome outcome{Outcome::kNotDone};
  /** Duration by the tick clock, from the trial's first tick to the one in which the part is
   seated, or to its end [s]. None where nothing was moved: identification by a simulated
 observer. */
  std::optional<double> time;
  int collisions{0};              ///< Number of contacts that began before a mate guided the part.
  double peak_felt{0};            ///< Largest force rendered to the hand [N].
  double peak_true{0};            ///< Largest unscaled force on the part [N].
  double insertion{0};            ///< Insertion depth [m].
  std::optional<TrialPair> pair;  ///< None where nothing is fitted, or an older version wrote it.
  std::vector<MatingSample> mating;
};

}  // namespace hvas::study
