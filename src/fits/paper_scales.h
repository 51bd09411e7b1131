#pragma once

#include <string_view>

#include "fits/iso286.h"

/** Paper W's force display: what its figure 8 shows of each fit, and the factors k_r and k_s that
 bring the true forces of W(8) and W(9) into those ranges (W9, W10). The paper prints neither the
 factors nor the sizes of its parts; the factors here follow from its ranges and its rig: 40 mm,
 hub 80 mm, 50 mm long, steel, mu 0.15, Rz 6.3 um. They serve to reproduce the paper: each kind of
 fit has its own, so that forces of different fits cannot be compared by feel. */
namespace hvas::fits {

struct PaperScale {
  FitKind kind{FitKind::kClearance};
  std::string_view fit;     ///< The fit of the paper's experiment.
  std::string_view symbol;  ///< "k_r", "k_s"; empty for the clearance fit, shown as it is.
  double largest_shown{0};  ///< The upper end of the axial force in figure 8 [N].
  double true_force{0};     ///< Force at full depth, for which the factor is [N].
  double factor{1};         ///< largest_shown / true_force; 1 for the clearance fit.
};

/** The scale of the paper's rig: H7/p6 at its mean interference of 21.5 um (39,893.3 N), H7/k6 with
 hole and shaft of one size and roughness alone (2,329 N in the mean of many). RT-safe. */
[[nodiscard]] const PaperScale& FindPaperScale(FitKind kind) noexcept;

/** The factor that shows another pair's force at full depth [N] at the upper end of its range; that
 of the rig where there is no force. RT-safe. */
[[nodiscard]] double CalcPaperFactor(FitKind kind, double true_force) noexcept;

/** The shaft and bushing of its experiments, both of steel (4.2.3). */
struct PaperRig {
  double diameter{40e-3};      ///< [m]
  double hub_diameter{80e-3};  ///< [m]
  double length{50e-3};        ///< [m]
  double friction{0.15};
  double roughness{6.3e-6};  ///< Rz [m].
  int stations{20};          ///< Intervals of the roughness along the length.
};

inline constexpr PaperRig kPaperRig{};

/** Stiffness of contact k_p and of the constraint to the axis k_q in the paper [N/m]. */
inline constexpr double kPaperContactStiffness = 700;
inline constexpr double kPaperAxisStiffness = 500;

}  // namespace hvas::fits
