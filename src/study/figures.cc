#include "study/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "pages/svg_plot.h"

namespace hvas::study {
namespace {

using pages::PlotFigure;
using pages::PlotPanel;
using pages::PlotPoint;
using pages::PlotSeries;
using pages::PlotStyle;

/** Makes the label of an axis: "completion time [s]". */
std::string LabelOf(const Table& table) {
  return table.unit.empty() ? table.quantity : fmt::format("{} [{}]", table.quantity, table.unit);
}

PlotFigure MakeFigure(std::string title, std::string note, std::string description,
                      const std::string& id) {
  PlotFigure figure;
  figure.title = std::move(title);
  figure.notes = {std::move(note)};
  figure.description = std::move(description);
  figure.id = id;
  return figure;
}

std::vector<PlotPoint> MakeRectangle(double left, double right, double low, double high) {
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

/** Makes an error bar: a vertical line with caps at both ends. */
std::vector<PlotPoint> MakeBracket(double x, double half_width, double low, double high) {
  const double gap = std::nan("");
  return {{x, low},
          {x, high},
          {gap, gap},
          {x - half_width, low},
          {x + half_width, low},
          {gap, gap},
          {x - half_width, high},
          {x + half_width, high}};
}

/** Collects the values of one condition, without missing ones. */
std::vector<double> ValuesOf(const Table& table, std::size_t column) {
  std::vector<double> values;
  for (const Row& row : table.rows) {
    if (row.values[column]) {
      values.push_back(*row.values[column]);
    }
  }
  return values;
}

/** Calculates the offsets of dots, so that equal or near values lie side by side. */
std::vector<PlotPoint> SpreadDots(const std::vector<double>& values, double x, double range) {
  constexpr int kRows = 60;        // dots that fit above each other in a plot
  constexpr double kStep = 0.035;  // distance of neighbours, as a share of the distance of names
  constexpr double kWidest = 0.3;  // Share of the distance of names: a choice.
  std::map<long, std::vector<double>> rows;
  for (const double value : values) {
    rows[range > 0 ? std::lround(kRows * value / range) : 0].push_back(value);
  }
  std::vector<PlotPoint> points;
  for (const auto& [row, members] : rows) {
    const auto count = static_cast<double>(members.size());
    const double step = std::min(kStep, kWidest / count);
    for (std::size_t i = 0; i < members.size(); ++i) {
      points.push_back({x + step * (static_cast<double>(i) - 0.5 * (count - 1)), members[i]});
    }
  }
  return points;
}

/** Calculates Tukey's whiskers: the last values within 1.5 interquartile ranges of the box. */
statistics::Interval FindWhiskers(const std::vector<double>& values,
                                  const statistics::Summary& summary) {
  const double reach = 1.5 * (summary.upper_quartile - summary.lower_quartile);
  statistics::Interval whiskers{summary.lower_quartile, summary.upper_quartile};
  for (const double value : values) {
    if (value >= summary.lower_quartile - reach && value <= summary.upper_quartile + reach) {
      whiskers.low = std::min(whiskers.low, value);
      whiskers.high = std::max(whiskers.high, value);
    }
  }
  return whiskers;
}

int ColorOf(std::size_t index) {
  constexpr std::size_t kColors = 5;  // number of colours in svg_plot.h
  return static_cast<int>(index % kColors);
}

}  // namespace

std::string DrawBoxes(const Analysis& analysis, const std::string& id) {
  const Table& table = analysis.table;
  PlotPanel panel;
  panel.y_label = LabelOf(table);
  panel.x_names = table.conditions;
  double low = 0;
  double high = 0;
  for (const ConditionResult& condition : analysis.conditions) {
    low = std::min(low, condition.summary.min);
    high = std::max(high, condition.summary.max);
  }
  std::string description = "Box plot. ";
  for (std::size_t i = 0; i < analysis.conditions.size(); ++i) {
    constexpr double kHalf = 0.22;  // Half a box, of the way from name to name: a choice.
    const statistics::Summary& summary = analysis.conditions[i].summary;
    const std::vector<double> values = ValuesOf(table, i);
    const auto x = static_cast<double>(i);
    const int color = ColorOf(i);
    const statistics::Interval whiskers = FindWhiskers(values, summary);
    const double gap = std::nan("");
    panel.series.push_back(
        {"", PlotStyle::kFaintArea, color,
         MakeRectangle(x - kHalf, x + kHalf, summary.lower_quartile, summary.upper_quartile)});
    std::vector<PlotPoint> outline = panel.series.back().points;
    outline.push_back(outline.front());
    panel.series.push_back({"", PlotStyle::kThin, color, outline});
    panel.series.push_back({"",
                            PlotStyle::kThin,
                            color,
                            {{x, whiskers.low},
                             {x, summary.lower_quartile},
                             {gap, gap},
                             {x, summary.upper_quartile},
                             {x, whiskers.high}}});
    panel.series.push_back({"", PlotStyle::kDots, color, SpreadDots(values, x, high - low)});
    panel.series.push_back(
        {"", PlotStyle::kLine, color, {{x - kHalf, summary.median}, {x + kHalf, summary.median}}});
    description +=
        fmt::format("{}: median {:.4g}, quartiles {:.4g} and {:.4g}, from {:.4g} to {:.4g}. ",
                    table.conditions[i], summary.median, summary.lower_quartile,
                    summary.upper_quartile, summary.min, summary.max);
  }
  PlotFigure figure = MakeFigure("Spread",
                                 "Median, quartiles, whiskers to the last value within 1.5 "
                                 "interquartile ranges; one dot for each value.",
                                 std::move(description), id);
  figure.panels = {std::move(panel)};
  return ToSvg(figure);
}

std::string DrawPairs(const Analysis& analysis, const std::string& id) {
  const Table& table = analysis.table;
  PlotPanel panel;
  panel.y_label = LabelOf(table);
  panel.x_names = table.conditions;
  PlotSeries lines{"a participant", PlotStyle::kThin, 4, {}};
  PlotSeries dots{"", PlotStyle::kDots, 4, {}};
  PlotSeries medians{"median", PlotStyle::kLine, 0, {}};
  PlotSeries median_marks{"", PlotStyle::kMarks, 0, {}};
  for (const Row& row : table.rows) {
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      lines.points.push_back({static_cast<double>(i), row.values[i].value_or(std::nan(""))});
      dots.points.push_back(lines.points.back());
    }
    lines.points.push_back({std::nan(""), std::nan("")});
  }
  std::string description = "One line for each participant. Medians: ";
  for (std::size_t i = 0; i < analysis.conditions.size(); ++i) {
    medians.points.push_back({static_cast<double>(i), analysis.conditions[i].summary.median});
    description +=
        fmt::format("{} {:.4g}{}", table.conditions[i], analysis.conditions[i].summary.median,
                    i + 1 < analysis.conditions.size() ? ", " : ".");
  }
  median_marks.points = medians.points;
  panel.series = {lines, dots, medians, median_marks};
  PlotFigure figure =
      MakeFigure("Participants", "Values of each participant, joined over the conditions.",
                 std::move(description), id);
  figure.panels = {std::move(panel)};
  return ToSvg(figure);
}

std::string DrawMeans(const Analysis& analysis, const std::string& id) {
  const bool is_share = analysis.options.of.has_value();
  const double level = 100 * (1 - analysis.options.alpha);
  PlotPanel panel;
  panel.y_label = is_share ? "right answers [%]" : "mean " + LabelOf(analysis.table);
  panel.x_names = analysis.table.conditions;
  if (is_share) {
    panel.y = pages::PlotRange{0, 100};
  }
  std::string description = is_share ? "Bars of shares. " : "Bars of means. ";
  for (std::size_t i = 0; i < analysis.conditions.size(); ++i) {
    const ConditionResult& condition = analysis.conditions[i];
    const double mean = is_share ? 100 * condition.share->share : condition.summary.mean;
    std::optional<statistics::Interval> ci = condition.summary.mean_ci;
    if (is_share) {
      ci = statistics::Interval{100 * condition.share->ci.low, 100 * condition.share->ci.high};
    }
    const auto x = static_cast<double>(i);
    panel.series.push_back(
        {"", PlotStyle::kArea, ColorOf(i), MakeRectangle(x - 0.28, x + 0.28, 0, mean)});
    if (ci) {
      panel.series.push_back(
          {"", PlotStyle::kLine, ColorOf(i), MakeBracket(x, 0.06, ci->low, ci->high)});
    }
    description += fmt::format("{}: {:.4g}", condition.name, mean);
    description +=
        ci ? fmt::format(", {:g} % interval {:.4g} to {:.4g}. ", level, ci->low, ci->high)
           : std::string(". ");
  }
  if (is_share) {
    const double chance = 100 * analysis.chance;
    panel.series.push_back(
        {fmt::format("by guessing: {:.3g} %", chance),
         PlotStyle::kDashed,
         4,
         {{-0.5, chance}, {static_cast<double>(analysis.conditions.size()) - 0.5, chance}}});
  }
  PlotFigure figure = MakeFigure(
      is_share ? "Right answers" : "Means",
      is_share ? fmt::format("Shares of all trials, with {:g} % intervals by Clopper and Pearson.",
                             level)
               : fmt::format("Means with {:g} % intervals of Student's t distribution.", level),
      std::move(description), id);
  figure.panels = {std::move(panel)};
  return ToSvg(figure);
}

std::string DrawConfusion(const Identification& identification, const std::string& id) {
  // Shares from which cells are drawn ever fuller: choices.
  constexpr std::array<double, 3> kFaint{0.005, 0.2, 0.6};
  const std::vector<std::string>& names = identification.names;
  PlotPanel panel;
  panel.x_label = "answered";
  panel.y_label = "shown";
  panel.x_names = names;
  panel.y_names = names;
  std::string description = "Confusion matrix. ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& row = identification.confusion.counts[i];
    double shown = 0;
    for (const std::int64_t count : row) {
      shown += static_cast<double>(count);
    }
    for (std::size_t j = 0; j < names.size(); ++j) {
      const double share = shown > 0 ? static_cast<double>(row[j]) / shown : 0;
      const auto x = static_cast<double>(j);
      const auto y = static_cast<double>(i);
      const int color = i == j ? 0 : 1;
      const auto field = MakeRectangle(x - 0.47, x + 0.47, y - 0.47, y + 0.47);
      if (share >= kFaint[0]) {
        panel.series.push_back({"",
                                share >= kFaint[2]   ? PlotStyle::kSolid
                                : share >= kFaint[1] ? PlotStyle::kArea
                                                     : PlotStyle::kFaintArea,
                                color, field});
      }
      panel.texts.push_back(
          {{x, y}, fmt::format("{} ({:.0f} %)", row[j], 100 * share), share >= kFaint[2]});
      description += fmt::format("{} taken for {}: {}. ", names[i], names[j], row[j]);
    }
  }
  PlotFigure figure = MakeFigure(
      "Confusion matrix", "Counts and row shares of answers; correct answers on the diagonal.",
      std::move(description), id);
  figure.panels = {std::move(panel)};
  return ToSvg(figure);
}

}  // namespace hvas::study
