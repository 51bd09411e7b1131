#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "app/fit/sized_fit.h"
#include "base/result.h"
#include "fits/iso286.h"
#include "fits/press_fit.h"
#include "fits/thermal_joining.h"

namespace hvas::app {

/** What a card is about. */
struct FitCardOptions {
  SizedFit fit;
  fits::PressFitParameters press;  ///< Lacks the interference, which comes from the limits.
  std::string hub_material, shaft_material;
  double friction_slip{0.15};                ///< nu_rl, while it slides out.
  std::string friction_source;               ///< Where the coefficients are from.
  double start{0};                           ///< Depth at which this fit begins to engage [m].
  double lead_in_angle{0};                   ///< Angle of the chamfer from the axis [rad]; 0: none.
  double chamfer_width{0};                   ///< Width of both parts together, radially [m].
  double room_c{20};                         ///< ISO 1: where sizes are measured [C].
  LengthUnit unit{LengthUnit::kMillimetre};  ///< The unit of the answer.
  fits::JoiningMaterial hub_joining, shaft_joining;
  std::optional<double> hub_c,
      shaft_c;                        ///< Temperatures to join at; room_c where only one is given.
  double join_speed{0.02};            ///< Speed of the shaft while it is joined [m/s].
  double hub_heat{0}, shaft_heat{0};  ///< Heat capacities of a volume [J/(m3 K)].
};

/** A fit's limits, and with a length what it takes to press it together. */
struct FitCard {
  FitCardOptions options;
  std::optional<fits::Limits> hole, shaft;
  std::optional<fits::FitLimits> limits;
  /** Press fits at the least, the mean and the largest interference; with a length only. */
  std::optional<fits::PressFit> least, mean, most;

  /** "40 mm H7/p6". */
  [[nodiscard]] std::string Title() const;

  /** "joint 50 mm long, hub 80 mm S355JR, ...", with a length only. */
  [[nodiscard]] std::string JointText() const;
};

/** Errors: those of ISO 286 and of the press fit. */
[[nodiscard]] Result<FitCard> MakeFitCard(const FitCardOptions& options);

[[nodiscard]] std::string ToText(const FitCard& card);
[[nodiscard]] nlohmann::ordered_json ToJson(const FitCard& card);

}  // namespace hvas::app
