#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/fit/fit_card.h"
#include "app/fit/fit_population.h"
#include "base/result.h"
#include "fits/insertion.h"

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace hvas::app {

/** The arguments of `hvas fit` as they are typed: mm, um, degrees. Lists have one value for each
 fit, or one for all. */
struct FitArguments {
  std::vector<std::string> fits;
  std::vector<double> length_mm, hub_mm, bore_mm, start_mm;
  double breadth_mm{0};  // 0: round.
  double chamfer_deg{0};
  std::string material, hub_material, shaft_material;
  double chamfer_width_mm{0};
  double friction{-1};      // Below 0: by the pair of materials.
  double friction_out{-1};  // Below 0: as friction.
  bool is_oiled{false};
  bool is_shrunk{false};
  double rz_um{0};
  double hub_rz_um{-1}, shaft_rz_um{-1};
  std::string smoothing{"din2017"};
  FitPopulationOptions population;
  bool has_population{false};
  std::string spread{"paper"};
  double cp{0}, cpk{0};
  std::string sizes;
  std::string along;
  std::optional<double> hub_c, shaft_c;
  double room_c{20};
  double join_speed_mm_s{20};
  std::string curve, jamming;
  double step_mm{0};
  double at_mm{0};
  std::vector<double> load{0, 1, 0};  // N, N, N mm.
  std::optional<LengthUnit> unit;     // The unit of the answer; none: that of the fits.
  bool is_json{false};
};

/** Transforms options in millimetres: what is typed with another unit ("2in") becomes millimetres.
 */
[[nodiscard]] const CLI::Validator& Millimetres();

/** --unit, of the answer. */
void AddUnitOption(CLI::App* command, std::optional<LengthUnit>* unit);

/** Adds them to the command. */
void AddFitArguments(CLI::App* fit, FitArguments* arguments);

/** Errors: kInvalid, naming an option that has no effect beside the others, and the one it needs.
 */
[[nodiscard]] Result<void> CheckEffects(const CLI::App& fit);

/** Refuses those whose effect depends on the fits: heat and cold need interference, chamfers
 that widen the entry clearance, and a length both classes. */
[[nodiscard]] Result<void> CheckEffects(const FitArguments& arguments,
                                        const std::vector<FitCard>& cards);

/** The cards that they ask for, one for each fit. */
[[nodiscard]] Result<std::vector<FitCard>> MakeCards(const FitArguments& arguments);

/** Adds the sizes of a file, where the arguments name one. */
[[nodiscard]] Result<FitPopulationOptions> MakePopulationOptions(const FitArguments& arguments);

[[nodiscard]] fits::PegLoad MakeLoad(const FitArguments& arguments);

}  // namespace hvas::app
