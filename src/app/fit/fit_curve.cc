#include "app/fit/fit_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/csv_row.h"
#include "base/random.h"
#include "base/units.h"
#include "fits/press_stroke.h"
#include "pages/svg_plot.h"

namespace hvas::app {
namespace {

using pages::PlotFigure;
using pages::PlotPanel;
using pages::PlotRange;
using pages::PlotSeries;
using pages::PlotStyle;

constexpr int kCurveSteps = 200;  // Steps of a plotted curve: a choice.

/** The fits of all cards at once, at the clearances that `pick` says. */
template <typename Pick>
Result<fits::PressStroke> MakeStroke(const std::vector<FitCard>& cards, const Pick& pick) {
  std::vector<fits::StrokeLand> lands;
  for (std::size_t k = 0; k < cards.size(); ++k) {
    const FitCardOptions& o = cards[k].options;
    fits::StrokeLand land{o.press, o.start, o.lead_in_angle, {}};
    pick(k, &land);
    lands.push_back(std::move(land));
  }
  return fits::PressStroke::Make(std::move(lands));
}

/** The stroke with the clearance of the diameters at a share between the limits; 0: the least. */
Result<fits::PressStroke> MakeStrokeAt(const std::vector<FitCard>& cards, double share) {
  return MakeStroke(cards, [&](std::size_t k, fits::StrokeLand* land) {
    const fits::FitLimits& limits = *cards[k].limits;
    land->press.interference =
        -(limits.min_clearance + share * (limits.max_clearance - limits.min_clearance));
  });
}

/** A tight pair of the batch: at its first quartile, with B from the seed. In transition fits it is
 one that has steps to show. */
Result<fits::PressStroke> MakeTightStroke(FitCurve* curve) {
  Random random(curve->options.seed);
  return MakeStroke(curve->cards, [&](std::size_t k, fits::StrokeLand* land) {
    const auto& quantiles = curve->batch.lands[k].clearance_curve;
    land->press = WithDrawnRoughness(land->press);
    curve->pair_clearances.push_back(quantiles[quantiles.size() / 4]);
    land->clearances =
        fits::DrawClearances(curve->pair_clearances.back(),
                             0.5 * (land->press.hub_roughness + land->press.shaft_roughness),
                             curve->options.stations, random.NextBits());
  });
}

/** A pair that was measured along its length, with B from the seed. */
Result<fits::PressStroke> MakeMeasuredStroke(FitCurve* curve) {
  Random random(curve->options.seed);
  const FitPopulationOptions& options = curve->options;
  return MakeStroke(curve->cards, [&](std::size_t /*fit*/, fits::StrokeLand* land) {
    land->press = WithDrawnRoughness(land->press);
    std::vector<double> clearances;
    double sum = 0;
    for (int j = 0; j <= options.stations; ++j) {
      const double depth = land->press.length * j / options.stations;
      clearances.push_back(fits::InterpolateDiameter(options.hole_along, depth) -
                           fits::InterpolateDiameter(options.shaft_along, depth));
      sum += clearances.back();
    }
    curve->pair_clearances.push_back(sum / static_cast<double>(clearances.size()));
    land->clearances = fits::DrawClearances(
        clearances, 0.5 * (land->press.hub_roughness + land->press.shaft_roughness),
        random.NextBits());
  });
}

/** The batch at any depth: linear between its steps. */
fits::ForceBand InterpolateBand(const fits::Population& batch, double depth) {
  const double end = batch.bands.back().depth;
  const double steps = static_cast<double>(batch.bands.size() - 1);
  const double at = std::clamp(depth / end, 0.0, 1.0) * steps;
  const std::size_t i = std::min(static_cast<std::size_t>(at), batch.bands.size() - 2);
  const double part = at - static_cast<double>(i);
  const fits::ForceBand& a = batch.bands[i];
  const fits::ForceBand& b = batch.bands[i + 1];
  fits::ForceBand band{depth, a.mean + part * (b.mean - a.mean), {}};
  for (std::size_t q = 0; q < band.quantiles.size(); ++q) {
    band.quantiles[q] = a.quantiles[q] + part * (b.quantiles[q] - a.quantiles[q]);
  }
  return band;
}

FitCurve::Forces CalcForces(const fits::PressStroke& stroke, double depth) {
  const fits::StrokeForce force = stroke.CalcForce(depth);
  return {force.in, force.release};
}

/** The area between two quantiles. */
PlotSeries MakeBand(const FitCurve& curve, std::string name, PlotStyle style, std::size_t low,
                    std::size_t high, double factor) {
  PlotSeries series{std::move(name), style, 0, {}};
  for (const FitCurve::Point& p : curve.points) {
    series.points.push_back({units::ToMm(p.depth), factor * p.band.quantiles[high]});
  }
  for (auto p = curve.points.rbegin(); p != curve.points.rend(); ++p) {
    series.points.push_back({units::ToMm(p->depth), factor * p->band.quantiles[low]});
  }
  return series;
}

/** A line over the depth, pressing in above zero and pulling out below. */
template <typename Forces>
void AddLines(const FitCurve& curve, const std::string& name, PlotStyle style, int color,
              const Forces& forces, PlotPanel* panel) {
  PlotSeries in{name, style, color, {}};
  PlotSeries out{"", style, color, {}};
  for (const FitCurve::Point& p : curve.points) {
    const FitCurve::Forces f = forces(p);
    in.points.push_back({units::ToMm(p.depth), f.in});
    out.points.push_back({units::ToMm(p.depth), -f.out});
  }
  panel->series.push_back(std::move(in));
  panel->series.push_back(std::move(out));
}

PlotPanel MakeForcePanel(const FitCurve& curve) {
  PlotPanel panel;
  panel.title = "Axial force over depth";
  panel.x_label = "depth of the shaft, mm";
  panel.y_label = "pulling out  \xE2\x86\x90  axial force, N  \xE2\x86\x92  pressing in";
  const double out = -curve.release_ratio;
  panel.series = {MakeBand(curve, "0.1 to 99.9 % of the batch", PlotStyle::kFaintArea, 0, 4, 1),
                  MakeBand(curve, "5 to 95 %", PlotStyle::kArea, 1, 3, 1),
                  MakeBand(curve, "", PlotStyle::kFaintArea, 0, 4, out),
                  MakeBand(curve, "", PlotStyle::kArea, 1, 3, out)};
  AddLines(
      curve, "median", PlotStyle::kThin, 0,
      [&](const FitCurve::Point& p) {
        return FitCurve::Forces{p.band.quantiles[2], curve.release_ratio * p.band.quantiles[2]};
      },
      &panel);
  AddLines(
      curve, "a tight pair with roughness", PlotStyle::kLine, 1,
      [](const FitCurve::Point& p) { return p.pair; }, &panel);
  AddLines(
      curve, "largest interference of the limits, without roughness", PlotStyle::kDashed, 2,
      [](const FitCurve::Point& p) { return p.most; }, &panel);
  if (curve.options.press_force > 0) {
    const double f = curve.options.press_force;
    panel.series.push_back({"force limit of the press",
                            PlotStyle::kDashed,
                            3,
                            {{units::ToMm(curve.points.front().depth), f},
                             {units::ToMm(curve.points.back().depth), f}}});
  }
  return panel;
}

/** On its own scale, for the steps of a rough transition fit. */
PlotPanel MakePairPanel(const FitCurve& curve) {
  PlotPanel panel;
  panel.title = curve.options.hole_along.empty()
                    ? "Tight pair (first quartile): diametral clearance"
                    : "Measured pair: mean diametral clearance";
  for (std::size_t k = 0; k < curve.pair_clearances.size(); ++k) {
    panel.title +=
        fmt::format("{} {:+.1f} um", k > 0 ? "," : "", units::ToUm(curve.pair_clearances[k]));
  }
  panel.x_label = "depth of the shaft, mm";
  panel.y_label = "axial force, N";
  PlotSeries in{"pressing in", PlotStyle::kLine, 1, {}};
  PlotSeries out{"pulling out", PlotStyle::kDashed, 3, {}};
  for (const FitCurve::Point& p : curve.points) {
    in.points.push_back({units::ToMm(p.depth), p.pair.in});
    out.points.push_back({units::ToMm(p.depth), -p.pair.out});
  }
  panel.series = {std::move(in), std::move(out)};
  return panel;
}

PlotPanel MakeClearancePanel(const FitCurve& curve) {
  PlotPanel panel;
  panel.title = "Clearance of the batch";
  panel.x_label = "diametral clearance, um (negative: interference)";
  panel.y_label = "assemblies with less, %";
  panel.y = PlotRange{0, 100};
  double low = 0;
  double high = 0;
  for (std::size_t k = 0; k < curve.cards.size(); ++k) {
    PlotSeries series{curve.cards[k].Title(), PlotStyle::kLine, static_cast<int>(k % 5), {}};
    const auto& quantiles = curve.batch.lands[k].clearance_curve;
    for (std::size_t i = 0; i < quantiles.size(); ++i) {
      const double x_um = units::ToUm(quantiles[i]);
      series.points.push_back(
          {x_um, 100 * static_cast<double>(i) / static_cast<double>(quantiles.size() - 1)});
      low = std::min(low, x_um);
      high = std::max(high, x_um);
    }
    panel.series.push_back(std::move(series));
  }
  panel.x = PlotRange{std::floor(low - 1), std::ceil(high + 1)};
  panel.series.push_back({"no clearance", PlotStyle::kDashed, 4, {{0, 0}, {0, 100}}});
  return panel;
}

}  // namespace

Result<FitCurve> MakeFitCurve(const std::vector<FitCard>& cards,
                              const FitPopulationOptions& options, double step) {
  FitCurve curve;
  curve.cards = cards;
  curve.options = options;
  curve.options.depths = kCurveSteps;
  Result<fits::Population> batch = DrawPopulation(cards, curve.options);
  if (!batch) {
    return Unexpected(batch.error());
  }
  curve.batch = *std::move(batch);
  const Result<fits::PressStroke> least = MakeStrokeAt(cards, 1);
  const Result<fits::PressStroke> mean = MakeStrokeAt(cards, 0.5);
  const Result<fits::PressStroke> most = MakeStrokeAt(cards, 0);
  const Result<fits::PressStroke> pair =
      curve.options.hole_along.empty() ? MakeTightStroke(&curve) : MakeMeasuredStroke(&curve);
  for (const auto* stroke : {&least, &mean, &most, &pair}) {
    if (!*stroke) {
      return Unexpected(stroke->error());
    }
  }
  const fits::PressFitParameters& p = cards.front().options.press;
  curve.release_ratio = p.friction_in > 0 ? p.friction_release / p.friction_in : 1;
  curve.work_most = most->CalcWork();
  const double way = most->end() - most->begin();
  const double steps = step > 0 ? std::ceil(way / step - 1e-9) : kCurveSteps;
  if (!(steps <= 1e6)) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("steps of {:g} mm make {:.0f} points", units::ToMm(step), steps), {},
                "choose a larger --step: at most a million points");
  }
  const int count = static_cast<int>(steps);
  for (int i = 0; i <= count; ++i) {
    // From the end backwards, so that the last point is the full depth.
    const double back = (step > 0 ? step : way / count) * (count - i);
    const double depth = i > 0 ? most->end() - back : most->begin();
    curve.points.push_back({depth, CalcForces(*least, depth), CalcForces(*mean, depth),
                            CalcForces(*most, depth), CalcForces(*pair, depth),
                            InterpolateBand(curve.batch, depth)});
  }
  return curve;
}

std::string ToCsv(const FitCurve& curve) {
  std::string csv =
      "depth_mm,least_in_n,least_out_n,mean_in_n,mean_out_n,most_in_n,most_out_n,pair_in_n,"
      "pair_out_n,batch_mean_in_n,batch_0.1pct_in_n,batch_5pct_in_n,batch_50pct_in_n,"
      "batch_95pct_in_n,batch_99.9pct_in_n\n";
  for (const FitCurve::Point& p : curve.points) {
    CsvRow row;
    row.Rounded(units::ToMm(p.depth) + 0.0, 6);
    for (const FitCurve::Forces& f : {p.least, p.mean, p.most, p.pair}) {
      row.Rounded(f.in, 9).Rounded(f.out, 9);
    }
    row.Rounded(p.band.mean, 7);
    for (const double quantile : p.band.quantiles) {
      row.Rounded(quantile, 7);
    }
    csv += row.End();
  }
  return csv;
}

std::string ToSvg(const FitCurve& curve) {
  PlotFigure figure;
  for (const FitCard& card : curve.cards) {
    figure.title += (figure.title.empty() ? "" : " and ") + card.Title();
    const LengthText lengths(card.options.unit);
    figure.notes.push_back(fmt::format("{}: diametral clearance {} to {} {}; {}.", card.Title(),
                                       lengths.SignedSmall(card.limits->min_clearance),
                                       lengths.SignedSmall(card.limits->max_clearance),
                                       lengths.small_unit(), card.JointText()));
  }
  figure.notes.push_back(fmt::format("{} assemblies, {}, seed {}: {}.", curve.batch.count,
                                     SpreadText(curve.options), curve.options.seed,
                                     SharesText(curve.batch, curve.options)));
  figure.notes.push_back(fmt::format(
      "Largest interference of the limits: {:.0f} N at the end, {:.1f} J for pressing in.",
      curve.points.back().most.in, curve.work_most));
  figure.panels = {MakeForcePanel(curve), MakePairPanel(curve), MakeClearancePanel(curve)};
  return ToSvg(figure);
}

}  // namespace hvas::app
