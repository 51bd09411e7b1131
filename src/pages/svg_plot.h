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
  kFaintArea,  ///< A fainter area.
  kMarks,      ///< A ring at each point.
  kDots,       ///< A filled dot at each point.
  kSolid,      ///< An opaque area.
};

/** What is drawn in one colour under one name; without a name it is not in the legend. Points that
 are not finite interrupt a line. */
struct PlotSeries {
  std::string name;
  PlotStyle style{PlotStyle::kLine};
  int color{0};  ///< 0 to 4.
  std::vector<PlotPoint> points;
};

/** A word in the plot, about its point. */
struct PlotText {
  PlotPoint at;
  std::string text;
  bool is_on_solid{false};  ///< It stands on kSolid, in the colour of the page.
};

/** Axes with series. Labels carry their units. */
struct PlotPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string right_label;  ///< Label of a second scale on the right; empty: none.
  double right_factor{1};   ///< What one of y is on the right, > 0.
  std::vector<PlotSeries> series;
  std::optional<PlotRange> x;          ///< All points without.
  std::optional<PlotRange> y;          ///< All points and zero without.
  std::vector<std::string> x_names{};  ///< What stands at x = 0, 1, ..., instead of numbers.
  std::vector<std::string> y_names{};  ///< Names along y, counted downwards.
  std::vector<PlotText> texts{};
};

struct PlotFigure {
  std::string title;
  std::vector<std::string> notes;  ///< Paragraphs under the title.
  std::vector<PlotPanel> panels;   ///< One below the other.
  std::string description;         ///< What is to be seen, for who does not see it.
  std::string id;                  ///< Another one for each figure of a page: letters, digits, '-'.
  double width{760};               ///< [px], 400 or more.
};

[[nodiscard]] std::string ToSvg(const PlotFigure& figure);

}  // namespace hvas::pages
