#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/** Plots as SVG: axes with ticks, legend, light and dark by what the reader prefers. Same figure,
 same bytes. */
namespace hvas::pages {

struct PlotPoint {
  double x{0};
  double y{0};
};

struct PlotRange {
  double low{0};
  double high{0};
};

enum class PlotStyle : std::uint8_t {
  kLine,
  kDashed,
  kThin,
  kArea,       ///< The points go round it.
  kFaintArea,  ///< The same, fainter.
  kMarks,      ///< A ring at each point.
};

/** What is drawn in one colour under one name; without a name it is not in the legend. Points that
 are not finite interrupt a line. */
struct PlotSeries {
  std::string name;
  PlotStyle style{PlotStyle::kLine};
  int color{0};  ///< 0 to 4.
  std::vector<PlotPoint> points;
};

/** Axes with series. Labels carry their units. */
struct PlotPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string right_label;  ///< Of a second scale on the right; empty: none.
  double right_factor{1};   ///< What one of y is on the right, > 0.
  std::vector<PlotSeries> series;
  std::optional<PlotRange> x;  ///< All points without.
  std::optional<PlotRange> y;  ///< All points and zero without.
};

struct PlotFigure {
  std::string title;
  std::vector<std::string> notes;  ///< Paragraphs under the title.
  std::vector<PlotPanel> panels;   ///< One below the other.
};

[[nodiscard]] std::string ToSvg(const PlotFigure& figure);

}  // namespace hvas::pages
