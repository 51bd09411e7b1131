#include "app/fit/fit_paper.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "app/output/text_table.h"
#include "base/csv_row.h"
#include "base/random.h"
#include "base/units.h"
#include "fits/paper_scales.h"
#include "fits/press_stroke.h"
#include "mates/make_fit.h"
#include "pages/svg_plot.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using pages::PlotFigure;
using pages::PlotPanel;
using pages::PlotRange;
using pages::PlotSeries;
using pages::PlotStyle;

constexpr double kSpeed = 0.01;   // Of the hand; the paper does not say [m/s].
constexpr int kPaperSteps = 500;  // Steps of the plotted curves: a choice.

/** How far the hand is off the axis in the clearance fit: up to and down from random values. */
class WanderingHand {
 public:
  explicit WanderingHand(std::uint64_t seed) {
    Random random(seed);
    for (double& offset : offsets_) {
      offset = kLargest * random.Uniform();
    }
    offsets_[kTurns / 2] = kLargest;  // Somewhere it is there.
  }

  [[nodiscard]] double At(double share) const {
    const double at = share * (kTurns - 1);
    const auto i = std::min(static_cast<std::size_t>(at), std::size_t{kTurns - 2});
    const double turn = 0.5 - 0.5 * std::cos(std::numbers::pi * (at - static_cast<double>(i)));
    return offsets_[i] + turn * (offsets_[i + 1] - offsets_[i]);
  }

 private:
  // The hand wanders between so many random places along the way: a choice, not measured.
  static constexpr int kTurns = 13;
  // 2 N across at k_p, so 0.3 N along with mu 0.15.
  static constexpr double kLargest = 2.0 / fits::kPaperContactStiffness;
  double offsets_[kTurns];
};

/** Diametral clearance of the pair that stands for a fit: the mean of its limits, and in the
 transition fit hole and shaft of one size. */
double CalcMeanClearance(const fits::FitLimits& limits) {
  return limits.kind == fits::FitKind::kTransition
             ? 0
             : 0.5 * (limits.min_clearance + limits.max_clearance);
}

Result<PaperCurve> MakeCurve(const char* experiment, fits::FitKind kind, std::uint64_t seed) {
  const fits::PaperScale& scale = fits::FindPaperScale(kind);
  const fits::FitLimits limits =
      *fits::CalcFitLimits(*fits::ParseFit(scale.fit), fits::kPaperRig.diameter);
  fits::StrokeLand land;
  land.press.joint_diameter = fits::kPaperRig.diameter;
  land.press.hub_diameter = fits::kPaperRig.hub_diameter;
  land.press.length = fits::kPaperRig.length;
  land.press.friction_in = land.press.friction_release = fits::kPaperRig.friction;
  const double clearance = CalcMeanClearance(limits);
  land.clearances =
      fits::DrawClearances(clearance, fits::kPaperRig.roughness, fits::kPaperRig.stations, seed);
  const Result<fits::PressStroke> stroke = fits::PressStroke::Make({land});
  if (!stroke) {
    return Unexpected(stroke.error());
  }
  const WanderingHand hand(seed);
  PaperCurve curve{experiment,
                   kind,
                   fits::CalcPaperFactor(kind, stroke->CalcForce(fits::kPaperRig.length).in),
                   {}};
  for (int i = 0; i <= kPaperSteps; ++i) {
    const double share = static_cast<double>(i) / kPaperSteps;
    const double depth = fits::kPaperRig.length * share;
    // W(5): what presses sideways is the hand beyond the clearance.
    const double across =
        kind == fits::FitKind::kClearance
            ? fits::kPaperContactStiffness * std::max(0.0, hand.At(share) - 0.5 * clearance)
            : 0;
    const double force = stroke->CalcForce(depth).in + fits::kPaperRig.friction * across;
    curve.points.push_back({depth, depth / kSpeed, force, curve.factor * force});
  }
  return curve;
}

std::string Name(const PaperCurve& curve) {
  return fmt::format("{}, {} ({} fit)", curve.experiment, fits::FindPaperScale(curve.kind).fit,
                     ToString(mates::ToKind(curve.kind)));
}

std::string FactorText(const PaperCurve& curve) {
  const std::string_view symbol = fits::FindPaperScale(curve.kind).symbol;
  return symbol.empty() ? "shown unscaled" : fmt::format("{} = {:.3g}", symbol, curve.factor);
}

}  // namespace

Result<std::vector<PaperCurve>> MakePaperCurves(std::uint64_t seed) {
  std::vector<PaperCurve> curves;
  for (const auto& [experiment, kind] :
       {std::pair("B1", fits::FitKind::kClearance), std::pair("B2", fits::FitKind::kInterference),
        std::pair("B3", fits::FitKind::kTransition)}) {
    Result<PaperCurve> curve = MakeCurve(experiment, kind, seed);
    if (!curve) {
      return Unexpected(curve.error());
    }
    curves.push_back(*std::move(curve));
  }
  return curves;
}

std::string ToText(const std::vector<PaperCurve>& curves) {
  TextTable table({"axial force, largest", "shown, N", "true, N", "factor"});
  for (const PaperCurve& curve : curves) {
    double shown = 0;
    double true_force = 0;
    for (const PaperCurve::Point& p : curve.points) {
      shown = std::max(shown, p.shown);
      true_force = std::max(true_force, p.true_force);
    }
    table.Add({Name(curve), fmt::format("{:.3f}", shown), fmt::format("{:.3f}", true_force),
               FactorText(curve)});
  }
  return table.ToText();
}

std::string ToCsv(const std::vector<PaperCurve>& curves) {
  std::string csv = "experiment,fit,factor,depth_mm,time_s,true_n,shown_n\n";
  for (const PaperCurve& curve : curves) {
    for (const PaperCurve::Point& p : curve.points) {
      csv += CsvRow()
                 .Text(curve.experiment)
                 .Text(fits::FindPaperScale(curve.kind).fit)
                 .Rounded(curve.factor, 9)
                 .Rounded(units::ToMm(p.depth), 6)
                 .Rounded(p.time, 6)
                 .Rounded(p.true_force, 9)
                 .Rounded(p.shown, 9)
                 .End();
    }
  }
  return csv;
}

std::string ToSvg(const std::vector<PaperCurve>& curves) {
  PlotFigure figure;
  figure.title = "Assembly forces of paper W (its figure 8)";
  figure.notes = {
      "Shaft and bushing of 40 mm, bushing 80 mm outside and 50 mm long, steel, mu 0.15, Rz 6.3 "
      "um, 20 stations; inserted at a constant 10 mm/s. Left: as the paper's device displays it; "
      "right: in true newtons.",
      "The paper prints neither sizes nor factors. Here B2 has its mean interference, B3 hole and "
      "shaft of one size, and the factors bring the force at the end to the paper's 6 N and 4 N. "
      "In "
      "B1 the hand wanders up to 2.9 mm off the axis against 700 N/m; friction makes the axial "
      "force."};
  for (const PaperCurve& curve : curves) {
    PlotPanel panel;
    panel.title = fmt::format("{}: {}", Name(curve), FactorText(curve));
    panel.x_label = "time, s (10 mm of depth each)";
    panel.y_label = "axial force as shown, N";
    panel.right_label = "true axial force, N";
    panel.right_factor = 1 / curve.factor;
    PlotSeries series{"", PlotStyle::kLine, static_cast<int>(figure.panels.size()), {}};
    for (const PaperCurve::Point& p : curve.points) {
      series.points.push_back({p.time, p.shown});
    }
    panel.y = PlotRange{0, 1.1 * fits::FindPaperScale(curve.kind).largest_shown};
    panel.series.push_back(std::move(series));
    figure.panels.push_back(std::move(panel));
  }
  return ToSvg(figure);
}

}  // namespace hvas::app
