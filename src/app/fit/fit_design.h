#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/fit/fit_arguments.h"
#include "base/result.h"
#include "fits/fit_search.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** What a joint has to hold. */
struct FitDemand {
  double nominal_mm{0};
  double torque{0};    ///< About the axis [N m], >= 0.
  double axial{0};     ///< Along it, at the same time [N], >= 0.
  double safety{1.5};  ///< Against slip, >= 1.
  fits::FitBasis basis{fits::FitBasis::kHole};
};

/** The interference that a demand needs and a joint bears, and the fits between. */
struct FitDesign {
  FitDemand demand;
  double required_pressure{0}, largest_pressure{0};          ///< [Pa]
  double required_interference{0}, largest_interference{0};  ///< Diametral, before smoothing [m].
  bool is_hub_brittle{false};  ///< Then the largest pressure has kBrittleSafety against fracture.
  LengthUnit unit{LengthUnit::kMillimetre};  ///< The unit of the answer.
  std::vector<FitCard> proposals;  ///< Common ones first, then the widest tolerances; a few.
};

/** Goes from p = S sqrt(F^2 + (2 T / D_F)^2) / (pi D_F l_F nu) (DIN 7190-1) to U, and to ISO 286's
 fits whose least interference is at least that, and whose largest leaves both parts elastic (von
 Mises), and a brittle hub with its safety against fracture.
 @param joint  Its sizes, materials, roughness and friction; the fits in it do not matter.
 Errors: kInvalid for a demand out of range, kUnsupported where the joint would yield. */
[[nodiscard]] Result<FitDesign> DesignFit(const FitDemand& demand, const FitArguments& joint);

/** Adds `hvas fit design` and `hvas fit materials`. */
void AddFitDesign(CLI::App* fit, int* status);

}  // namespace hvas::app
