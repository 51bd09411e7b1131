#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "fits/iso286.h"

namespace hvas::app {

/** One of paper W's force curves (its figure 8): the axial force while the shaft goes in at an even
 speed, in newtons and as the paper's device shows it (W10). */
struct PaperCurve {
  struct Point {
    double depth{0};       ///< [m]
    double time{0};        ///< [s]
    double true_force{0};  ///< [N]
    double shown{0};       ///< What the paper's factor makes of it [N].
  };

  std::string experiment;  ///< "B1", ...
  fits::FitKind kind{fits::FitKind::kClearance};
  double factor{1};  ///< k_r, k_s.
  std::vector<Point> points;
};

/** Its three curves for its rig, in its order: clearance, interference, transition. Sizes and
 factors are not printed: see fits/paper_scales.h for what stands in for them. In the clearance fit
 the hand wanders up to 2.9 mm off the axis, against k_p. */
[[nodiscard]] Result<std::vector<PaperCurve>> MakePaperCurves(std::uint64_t seed);

[[nodiscard]] std::string ToText(const std::vector<PaperCurve>& curves);
[[nodiscard]] std::string ToCsv(const std::vector<PaperCurve>& curves);
[[nodiscard]] std::string ToSvg(const std::vector<PaperCurve>& curves);

}  // namespace hvas::app
