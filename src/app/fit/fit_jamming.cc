#include "app/fit/fit_jamming.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/length_text.h"
#include "app/output/text_layout.h"
#include "base/units.h"
#include "pages/svg_plot.h"

namespace hvas::app {
namespace {

using pages::PlotFigure;
using pages::PlotPanel;
using pages::PlotRange;
using pages::PlotSeries;
using pages::PlotStyle;

double CalcRadius(const FitJamming& j) {
  return 0.5 * j.pair.peg_diameter;
}

double FrictionOf(const FitJamming& j) {
  return j.card.options.press.friction_in;
}

/** Where the load is in the diagram. */
fits::DiagramPoint PlaceOf(const FitJamming& j) {
  return {j.load.f_x / j.load.f_z, j.load.m / (CalcRadius(j) * j.load.f_z)};
}

/** Below this tilt nothing wedges, whatever the sizes within their limits are [rad]. */
double CalcSafeTilt(const FitJamming& j) {
  return std::max(0.0, fits::CalcWedgingTilt(j.worst_pair, FrictionOf(j)));
}

std::string DescribeVerdict(const FitJamming& j) {
  return fmt::format("{}; {}", j.is_sliding ? "slides on" : "jams",
                     j.can_wedge ? "may wedge at this depth" : "cannot wedge at this depth");
}

PlotPanel MakeJammingPanel(const FitJamming& j) {
  PlotPanel panel;
  panel.title = fmt::format("Jamming, two-point contact at l = {:g} mm (lambda = {:.3g})",
                            units::ToMm(j.l), j.lambda);
  panel.x_label = "F_x / F_z (transverse over axial force), 1";
  panel.y_label = "M / (r F_z), 1";
  PlotSeries inside{"inside: slides on", PlotStyle::kArea, 2, {}};
  double wide = 0;
  double high = 0;
  for (const fits::DiagramPoint& p : fits::CalcJammingDiagram(j.lambda, FrictionOf(j))) {
    inside.points.push_back({p.f_x_over_f_z, p.m_over_r_f_z});
    wide = std::max(wide, std::abs(p.f_x_over_f_z));
    high = std::max(high, std::abs(p.m_over_r_f_z));
  }
  PlotSeries border{"", PlotStyle::kLine, 2, inside.points};
  border.points.push_back(border.points.front());
  const fits::DiagramPoint at = PlaceOf(j);
  panel.x = PlotRange{-1.15 * std::max(wide, std::abs(at.f_x_over_f_z)),
                      1.15 * std::max(wide, std::abs(at.f_x_over_f_z))};
  panel.y = PlotRange{-1.15 * std::max(high, std::abs(at.m_over_r_f_z)),
                      1.15 * std::max(high, std::abs(at.m_over_r_f_z))};
  panel.series = {std::move(inside),
                  std::move(border),
                  {"", PlotStyle::kThin, 4, {{panel.x->low, 0}, {panel.x->high, 0}}},
                  {"", PlotStyle::kThin, 4, {{0, panel.y->low}, {0, panel.y->high}}},
                  {fmt::format("load: {}", j.is_sliding ? "slides on" : "jams"),
                   PlotStyle::kMarks,
                   j.is_sliding ? 0 : 1,
                   {{at.f_x_over_f_z, at.m_over_r_f_z}}}};
  return panel;
}

PlotPanel MakeWedgingPanel(const FitJamming& j) {
  constexpr int kSteps = 300;  // Steps of the plotted curve: a choice.
  const double length = j.card.options.press.length;
  const double least = fits::CalcLeastTwoPointLength(j.pair);
  const double largest_deg = units::ToDeg(fits::CalcLargestTilt(j.pair));
  const double wedging = std::min(length, FrictionOf(j) * j.pair.peg_diameter);
  PlotPanel panel;
  panel.title = "Wedging: tilt at which both sides touch";
  panel.x_label = "l, from the tip's corner to the rim, mm";
  panel.y_label = "tilt, deg";
  const double top = 1.1 * largest_deg;
  panel.x = PlotRange{0, units::ToMm(length)};
  panel.y = PlotRange{0, top};
  PlotSeries curve{"two-point contact", PlotStyle::kLine, 0, {}};
  for (int i = 0; i <= kSteps; ++i) {
    // Closer together where the curve is steep.
    const double part = static_cast<double>(i) / kSteps;
    const double l = least + (length - least) * part * part;
    if (l <= length) {
      curve.points.push_back({units::ToMm(l), units::ToDeg(fits::CalcTwoPointTilt(j.pair, l))});
    }
  }
  panel.series = {
      {fmt::format("may wedge: l up to {:.3g} mm (mu d)", units::ToMm(wedging)),
       PlotStyle::kFaintArea,
       1,
       {{0, 0}, {units::ToMm(wedging), 0}, {units::ToMm(wedging), top}, {0, top}}},
      std::move(curve),
      {fmt::format("largest tilt that enters: {:.3g} deg", largest_deg),
       PlotStyle::kDashed,
       3,
       {{0, largest_deg}, {units::ToMm(length), largest_deg}}},
      {fmt::format("no wedging below {:.3g} deg, with the smallest clearance either",
                   units::ToDeg(CalcSafeTilt(j))),
       PlotStyle::kDashed,
       2,
       {{0, units::ToDeg(CalcSafeTilt(j))}, {units::ToMm(length), units::ToDeg(CalcSafeTilt(j))}}},
      {"this depth",
       PlotStyle::kMarks,
       j.can_wedge ? 1 : 0,
       {{units::ToMm(j.l), units::ToDeg(fits::CalcTwoPointTilt(j.pair, j.l))}}}};
  return panel;
}

}  // namespace

Result<FitJamming> MakeFitJamming(const FitCard& card, double l, const fits::PegLoad& load) {
  const auto fail = [&card](ErrorCode code, std::string what, std::string remedy) {
    return Fail(code, std::move(what), card.Title(), std::move(remedy));
  };
  if (!card.most) {
    return fail(ErrorCode::kInvalid, "a jamming diagram needs a hole, a shaft and a length",
                "give both classes and --length");
  }
  const double clearance = card.limits->kind == fits::FitKind::kClearance
                               ? 0.5 * (card.limits->min_clearance + card.limits->max_clearance)
                               : 0.5 * card.limits->max_clearance;
  if (!(clearance > 0)) {
    return fail(ErrorCode::kUnsupported,
                "a fit without clearance cannot tilt, and therefore cannot jam",
                "choose a clearance or transition fit, such as H7/g6");
  }
  const double nominal = card.options.fit.nominal;
  FitJamming j{card,
               {nominal + clearance, nominal},
               {nominal + std::max(0.0, card.limits->min_clearance), nominal},
               l,
               load};
  j.l = l > 0 ? l : 0.5 * card.options.press.length;
  const double least = fits::CalcLeastTwoPointLength(j.pair);
  if (!(j.l >= least) || !(j.l <= card.options.press.length)) {
    return fail(ErrorCode::kInvalid,
                fmt::format("at l = {:g} mm there is no two-point contact", units::ToMm(j.l)),
                fmt::format("give --at from {:.3f} to {:g} mm", units::ToMm(least),
                            units::ToMm(card.options.press.length)));
  }
  if (!(load.f_z > 0) || !std::isfinite(load.f_x + load.f_z + load.m)) {
    return fail(
        ErrorCode::kInvalid, "the load does not push the shaft into the hole",
        "give --load F_x,F_z,M with a positive F_z: transverse and axial force [N], moment [N mm]");
  }
  if (!(FrictionOf(j) > 0)) {
    return fail(ErrorCode::kInvalid, "there is no jamming without friction",
                "give a positive --mu");
  }
  j.lambda = fits::CalcLambda(j.l, CalcRadius(j), FrictionOf(j));
  j.is_sliding = fits::IsSliding(load, j.l, CalcRadius(j), FrictionOf(j));
  j.can_wedge = fits::CanWedge(j.pair, j.l, FrictionOf(j));
  return j;
}

std::string ToText(const FitJamming& j) {
  const LengthText lengths(j.card.options.unit);
  return Fold(fmt::format(
      "jamming at l = {} with F_x {:g} N, F_z {:g} N, M {:g} N mm, clearance {} {}, mu {:g}:\n"
      "  {}; both sides touch at a tilt of {:.4f} deg; lambda {:.4g}\n"
      "  no wedging below {:.4f} deg in the worst case, the smallest clearance\n",
      lengths.Size(j.l), j.load.f_x, j.load.f_z, 1e3 * j.load.m,
      lengths.Small(j.pair.hole_diameter - j.pair.peg_diameter), lengths.small_unit(),
      FrictionOf(j), DescribeVerdict(j), units::ToDeg(fits::CalcTwoPointTilt(j.pair, j.l)),
      j.lambda, units::ToDeg(CalcSafeTilt(j))));
}

nlohmann::ordered_json ToJson(const FitJamming& j) {
  nlohmann::ordered_json vertices = nlohmann::ordered_json::array();
  for (const fits::DiagramPoint& p : fits::CalcJammingDiagram(j.lambda, FrictionOf(j))) {
    vertices.push_back({p.f_x_over_f_z, p.m_over_r_f_z});
  }
  return {{"l_mm", units::ToMm(j.l)},
          {"clearance_um", units::ToUm(j.pair.hole_diameter - j.pair.peg_diameter)},
          {"load", {{"f_x_n", j.load.f_x}, {"f_z_n", j.load.f_z}, {"m_nmm", 1e3 * j.load.m}}},
          {"lambda", j.lambda},
          {"vertices", vertices},
          {"is_sliding", j.is_sliding},
          {"can_wedge", j.can_wedge},
          {"two_point_tilt_deg", units::ToDeg(fits::CalcTwoPointTilt(j.pair, j.l))},
          {"largest_tilt_deg", units::ToDeg(fits::CalcLargestTilt(j.pair))},
          {"wedging_tilt_deg", units::ToDeg(CalcSafeTilt(j))}};
}

std::string ToSvg(const FitJamming& j) {
  const LengthText lengths(j.card.options.unit);
  PlotFigure figure;
  figure.title = j.card.Title() + ": jamming and wedging";
  figure.notes = {
      fmt::format("Diametral clearance {} {}, mu {:g}. Load at the centre of the tip: F_x {:g} N, "
                  "F_z {:g} N, M {:g} N mm: {}.",
                  lengths.Small(j.pair.hole_diameter - j.pair.peg_diameter), lengths.small_unit(),
                  FrictionOf(j), j.load.f_x, j.load.f_z, 1e3 * j.load.m, DescribeVerdict(j))};
  figure.panels = {MakeJammingPanel(j), MakeWedgingPanel(j)};
  return ToSvg(figure);
}

}  // namespace hvas::app
