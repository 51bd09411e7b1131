#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"
#include "fits/iso286.h"
#include "fits/population.h"
#include "fits/press_fit.h"

namespace hvas::app {

/** "40 H7/p6", "1.5in H7/g6", or one class alone, "40 H7". */
struct SizedFit {
  double nominal{0};  ///< [m]
  std::optional<fits::ToleranceClass> hole;
  std::optional<fits::ToleranceClass> shaft;
};

/** Errors: kInvalid, with what a fit looks like. */
[[nodiscard]] Result<SizedFit> ParseSizedFit(std::string_view text);

/** What a card is about. */
struct FitCardOptions {
  SizedFit fit;
  fits::PressFitParameters press;  ///< Without interference, which comes from the limits.
  std::string hub_material, shaft_material;
  int stations{20};
  std::int64_t population{0};  ///< Assemblies to draw; 0: none.
  std::uint64_t seed{0};
  double press_force{0};  ///< [N]; 0: any.
  double room_c{20};
};

/** A fit's limits, and with a length what it takes to press it together. */
struct FitCard {
  FitCardOptions options;
  std::optional<fits::Limits> hole, shaft;
  std::optional<fits::FitLimits> limits;
  /** Press fits at the least, the mean and the largest interference; with a length only. */
  std::optional<fits::PressFit> least, mean, most;
  std::optional<fits::Population> population;
};

/** Errors: those of ISO 286, of the press fit, and of the population. */
[[nodiscard]] Result<FitCard> MakeFitCard(const FitCardOptions& options);

[[nodiscard]] std::string ToText(const FitCard& card);
[[nodiscard]] nlohmann::ordered_json ToJson(const FitCard& card);

}  // namespace hvas::app
