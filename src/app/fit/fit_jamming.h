#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "app/fit/fit_card.h"
#include "base/result.h"
#include "fits/insertion.h"

namespace hvas::app {

/** Whether a shaft on its way in jams or wedges: the diagrams, and where it is in them (N5). */
struct FitJamming {
  FitCard card;
  fits::PegInHole pair;  ///< Has the mean clearance, or half of the largest in a transition fit.
  fits::PegInHole worst_pair;  ///< The pair with the least clearance, which wedges first.
  double l{0};         ///< The distance from the tip's corner to the rim, along the shaft [m].
  fits::PegLoad load;  ///< Acts at the middle of the tip.
  double lambda{0};
  bool is_sliding{false};
  bool can_wedge{false};
};

/** @param l  [m]; 0: half of the joint. Errors: kUnsupported for a fit without clearance, which
 cannot tilt; kInvalid for an l outside of the joint, or a load that does not push in. */
[[nodiscard]] Result<FitJamming> MakeFitJamming(const FitCard& card, double l,
                                                const fits::PegLoad& load);

[[nodiscard]] std::string ToText(const FitJamming& jamming);
[[nodiscard]] nlohmann::ordered_json ToJson(const FitJamming& jamming);
[[nodiscard]] std::string ToSvg(const FitJamming& jamming);

}  // namespace hvas::app
