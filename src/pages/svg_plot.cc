#include "pages/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "pages/html_page.h"

namespace hvas::pages {
namespace {

// Pixels around and inside a plot: choices by eye.
constexpr double kLeft = 86;
constexpr double kRight = 24;
constexpr double kRightWithScale = 96;
constexpr double kMargin = 20;
constexpr double kPlotHeight = 300;
constexpr double kLetter = 7.4;     // Mean width of a letter of 13 px; enough for wide sans serifs.
constexpr double kLineHeight = 18;  // Pixels, of text of 13 px.

// Plain classes, no variables: they are read by what draws SVG outside of browsers, too.
constexpr std::string_view kFigureStyle =
    ".page{fill:#fff}text{fill:#1d2126;font-family:system-ui,sans-serif;font-size:13px}"
    ".note{fill:#4a525b}.title{font-size:17px;font-weight:600}"
    ".panel{font-weight:600}.axis{stroke:#4a525b;fill:none}.grid{stroke:#dfe3e8}"
    ".zero{stroke:#8a939d}"
    ".line{fill:none;stroke-width:2;stroke-linejoin:round}"
    ".dashed{fill:none;stroke-width:2;stroke-dasharray:7 4}"
    ".thin{fill:none;stroke-width:1}.area{fill-opacity:.3}.faint{fill-opacity:.13}"
    ".mark{fill:none;stroke-width:2.5}.dot{fill-opacity:.75}.onsolid{fill:#fff}"
    ".s0{stroke:#0b62c4}.s1{stroke:#bb430a}.s2{stroke:#1b7f3b}.s3{stroke:#6b4fb3}.s4{stroke:#"
    "6a737d}"
    ".f0{fill:#0b62c4}.f1{fill:#bb430a}.f2{fill:#1b7f3b}.f3{fill:#6b4fb3}.f4{fill:#6a737d}"
    "@media(prefers-color-scheme:dark){.page{fill:#15181c}text{fill:#e8ebee}"
    ".note{fill:#aeb6bf}.onsolid{fill:#15181c}.axis{stroke:#aeb6bf}.grid{stroke:#2d333a}.zero{"
    "stroke:#77808a}"
    ".s0{stroke:#6cb0ff}.s1{stroke:#ff9c66}.s2{stroke:#6fd08c}.s3{stroke:#b9a3ff}.s4{stroke:#"
    "aeb6bf}"
    ".f0{fill:#6cb0ff}.f1{fill:#ff9c66}.f2{fill:#6fd08c}.f3{fill:#b9a3ff}.f4{fill:#aeb6bf}}";

/** Letters, not bytes, of UTF-8. */
double WidthOf(std::string_view text) {
  return kLetter * static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) {
           return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
         }));
}

std::vector<std::string> WrapTo(const std::string& text, double width) {
  std::vector<std::string> lines(1);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (!lines.back().empty() && WidthOf(lines.back() + " " + word) > width) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

std::string Text(double x, double y, std::string_view text, std::string_view attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes,
                     Escape(text));
}

std::string Segment(PlotPoint from, PlotPoint to, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", from.x,
                     from.y, to.x, to.y, style);
}

/** 1, 2 or 5 times a power of ten, so that about `count` steps make a range. */
double FindStep(const PlotRange& range, int count) {
  const double rough = (range.high - range.low) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * 0.999) {
      return factor * power;
    }
  }
  return 10 * power;
}

std::string TickText(double value, double step) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  std::string text = fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0.0 : value, digits);
  // Thousands apart, or long numbers cannot be read.
  const std::size_t end = std::min(text.find('.'), text.size());
  const std::size_t begin = text.front() == '-' ? 1 : 0;
  for (std::size_t at = end; at > begin + 3 && end - begin > 4;) {
    at -= 3;
    text.insert(at, "\xE2\x80\xAF");  // Narrow space.
  }
  return text;
}

bool IsFinite(const PlotPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

PlotRange FindRange(const PlotPanel& panel, double PlotPoint::*coordinate, bool has_zero) {
  PlotRange range{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  for (const PlotSeries& series : panel.series) {
    for (const PlotPoint& p : series.points) {
      if (IsFinite(p)) {
        range.low = std::min(range.low, p.*coordinate);
        range.high = std::max(range.high, p.*coordinate);
      }
    }
  }
  if (has_zero || !(range.low <= range.high)) {
    range.low = std::min(range.low, 0.0);
    range.high = std::max(range.high, 0.0);
  }
  if (!(range.high > range.low)) {
    range.high = range.low + 1;
  }
  return range;
}

/** A panel's axes on the page. */
class Axes {
 public:
  Axes(const PlotPanel& panel, double width, double top) : width_(width), top_(top) {
    label_ = panel.x_label.empty() ? 24 : 44;
    right_ = width - (panel.right_label.empty() ? kRight : kRightWithScale);
    for (const std::string& name : panel.x_names) {
      const auto lines = static_cast<double>(WrapTo(name, NameWidth(panel)).size());
      more_lines_ = std::max(more_lines_, lines - 1);
    }
    x_ = RangeOf(panel.x_names).value_or(panel.x.value_or(FindRange(panel, &PlotPoint::x, false)));
    y_ = panel.y.value_or(FindRange(panel, &PlotPoint::y, true));
    if (!panel.y_names.empty()) {
      const PlotRange names = *RangeOf(panel.y_names);
      y_ = {names.high, names.low};
    } else if (!panel.y) {  // A little air above and below, and whole ticks.
      const double step = FindStep(y_, 6);
      y_.high = y_.high > 0 ? step * std::ceil(y_.high / step * 1.02) : 0;
      y_.low = y_.low < 0 ? step * std::floor(y_.low / step * 1.02) : 0;
    }
  }

  [[nodiscard]] PlotPoint ToPage(const PlotPoint& p) const {
    return {kLeft + (p.x - x_.low) / (x_.high - x_.low) * (right_ - kLeft),
            bottom() - (p.y - y_.low) / (y_.high - y_.low) * kPlotHeight};
  }

  [[nodiscard]] double bottom() const { return top_ + kPlotHeight; }

  /** Under the labels. */
  [[nodiscard]] double end() const { return bottom() + label_ + more_lines_ * kLineHeight; }

  [[nodiscard]] std::string Draw(const PlotPanel& panel) const {
    std::string svg;
    svg += DrawTicksOfX(panel) + DrawTicksOfY(panel);
    if (panel.y_names.empty() && y_.low < 0 && y_.high > 0) {
      const double at = ToPage({0, 0}).y;
      svg += Segment({kLeft, at}, {right_, at}, "class=\"zero\"");
    }
    svg += Text(0.5 * (kLeft + right_), bottom() + 37 + more_lines_ * kLineHeight, panel.x_label,
                "text-anchor=\"middle\"");
    svg += Turned(kMargin, panel.y_label);
    if (!panel.right_label.empty()) {
      const PlotRange right{y_.low * panel.right_factor, y_.high * panel.right_factor};
      for (const double value : Ticks(right)) {
        const double at = ToPage({0, value / panel.right_factor}).y;
        svg += Segment({right_, at}, {right_ + 5, at}, "class=\"axis\"");
        svg += Text(right_ + 9, at + 4, TickText(value, FindStep(right, 6)), "class=\"note\"");
      }
      svg += Turned(width_ - 10, panel.right_label);
    }
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"axis\"/>\n",
        kLeft, top_, right_ - kLeft, kPlotHeight);
    return svg;
  }

  /** To be cut to, by what leaves it. */
  [[nodiscard]] std::string Clip(std::string_view id) const {
    return fmt::format(
        "<clipPath id=\"{}\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>"
        "</clipPath>\n",
        id, kLeft, top_, right_ - kLeft, kPlotHeight);
  }

 private:
  /** Half a step around names; none without. */
  [[nodiscard]] static std::optional<PlotRange> RangeOf(const std::vector<std::string>& names) {
    return names.empty() ? std::nullopt
                         : std::optional(PlotRange{-0.5, static_cast<double>(names.size()) - 0.5});
  }

  [[nodiscard]] double NameWidth(const PlotPanel& panel) const {
    return (right_ - kLeft) / static_cast<double>(panel.x_names.size()) - 8;
  }

  [[nodiscard]] std::string DrawTicksOfX(const PlotPanel& panel) const {
    std::string svg;
    for (std::size_t i = 0; i < panel.x_names.size(); ++i) {
      double y = bottom() + 17;
      for (const std::string& line : WrapTo(panel.x_names[i], NameWidth(panel))) {
        svg += Text(ToPage({static_cast<double>(i), 0}).x, y, line, "text-anchor=\"middle\"");
        y += kLineHeight;
      }
    }
    if (!panel.x_names.empty()) {
      return svg;
    }
    for (const double x : Ticks(x_)) {
      const double at = ToPage({x, 0}).x;
      svg += Segment({at, top_}, {at, bottom()}, "class=\"grid\"");
      svg += Text(at, bottom() + 17, TickText(x, FindStep(x_, 6)),
                  "class=\"note\" text-anchor=\"middle\"");
    }
    return svg;
  }

  [[nodiscard]] std::string DrawTicksOfY(const PlotPanel& panel) const {
    std::string svg;
    for (std::size_t i = 0; i < panel.y_names.size(); ++i) {
      const std::vector<std::string> lines = WrapTo(panel.y_names[i], kLeft - kMargin - 10);
      double y = ToPage({0, static_cast<double>(i)}).y + 4 -
                 0.5 * kLineHeight * static_cast<double>(lines.size() - 1);
      for (const std::string& line : lines) {
        svg += Text(kLeft - 7, y, line, "text-anchor=\"end\"");
        y += kLineHeight;
      }
    }
    if (!panel.y_names.empty()) {
      return svg;
    }
    for (const double y : Ticks(y_)) {
      const double at = ToPage({0, y}).y;
      svg += Segment({kLeft, at}, {right_, at}, "class=\"grid\"");
      svg += Text(kLeft - 7, at + 4, TickText(y, FindStep(y_, 6)),
                  "class=\"note\" text-anchor=\"end\"");
    }
    return svg;
  }

  [[nodiscard]] static std::vector<double> Ticks(const PlotRange& range) {
    std::vector<double> ticks;
    const double step = FindStep(range, 6);
    const double slack = 1e-9 * (range.high - range.low);
    const double first = std::ceil((range.low - slack) / step);
    const int count = static_cast<int>(std::floor((range.high + slack) / step) - first) + 1;
    ticks.reserve(static_cast<std::size_t>(std::max(0, count)));
    for (int i = 0; i < count; ++i) {
      ticks.push_back((first + i) * step);
    }
    return ticks;
  }

  [[nodiscard]] std::string Turned(double x, std::string_view text) const {
    const double y = top_ + 0.5 * kPlotHeight;
    return Text(
        x, y, text,
        fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y));
  }

  double width_;
  double top_;
  double right_;
  double label_;          // Height of ticks and label.
  double more_lines_{0};  // Of names that are wrapped.
  PlotRange x_, y_;
};

bool IsArea(PlotStyle style) {
  return style == PlotStyle::kArea || style == PlotStyle::kFaintArea || style == PlotStyle::kSolid;
}

bool IsFilled(PlotStyle style) {
  return IsArea(style) || style == PlotStyle::kDots;
}

/** How a series looks, as an attribute. */
std::string ClassOf(const PlotSeries& series) {
  constexpr std::array<std::string_view, 8> kClasses{"line",  "dashed", "thin", "area",
                                                     "faint", "mark",   "dot",  "solid"};
  return fmt::format("class=\"{} {}{}\"", kClasses[static_cast<std::size_t>(series.style)],
                     IsFilled(series.style) ? 'f' : 's', series.color);
}

std::string DrawSeries(const PlotSeries& series, const Axes& axes) {
  const std::string style = ClassOf(series);
  std::string svg;
  if (series.style == PlotStyle::kMarks || series.style == PlotStyle::kDots) {
    const double radius = series.style == PlotStyle::kMarks ? 6 : 3.2;
    for (const PlotPoint& point : series.points) {
      if (IsFinite(point)) {
        const PlotPoint p = axes.ToPage(point);
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", p.x, p.y, radius,
                           style);
      }
    }
    return svg;
  }
  const bool is_area = IsArea(series.style);
  std::string path;
  bool is_down = false;
  for (const PlotPoint& point : series.points) {
    if (!IsFinite(point)) {
      is_down = is_area && is_down;
      continue;
    }
    const PlotPoint p = axes.ToPage(point);
    path += fmt::format("{}{:.2f} {:.2f}", is_down ? "L" : "M", p.x, p.y);
    is_down = true;
  }
  return path.empty() ? ""
                      : fmt::format("<path d=\"{}{}\" {}/>\n", path, is_area ? "Z" : "", style);
}

/** The legend in rows under `top`, and the height it takes. */
std::string DrawLegend(const PlotPanel& panel, double page_width, double top, double* height) {
  constexpr double kSwatch = 26;  // Pixels of a line in the legend.
  std::string svg;
  double x = kLeft;
  double y = top;
  bool is_empty = true;
  for (const PlotSeries& series : panel.series) {
    if (series.name.empty()) {
      continue;
    }
    const double width = kSwatch + 8 + WidthOf(series.name) + 18;
    if (x > kLeft && x + width > page_width - kRight) {
      x = kLeft;
      y += kLineHeight + 2;
    }
    const std::string style = ClassOf(series);
    switch (series.style) {
      case PlotStyle::kArea:
      case PlotStyle::kFaintArea:
      case PlotStyle::kSolid:
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"11\" {}/>\n",
                           x, y + 2, kSwatch, style);
        break;
      case PlotStyle::kMarks:
      case PlotStyle::kDots:
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", x + kSwatch / 2,
                           y + 7, series.style == PlotStyle::kMarks ? 5.0 : 3.2, style);
        break;
      default:
        svg += Segment({x, y + 7}, {x + kSwatch, y + 7}, style);
    }
    svg += Text(x + kSwatch + 6, y + 12, series.name, "");
    x += width;
    is_empty = false;
  }
  *height = is_empty ? 0 : y + kLineHeight + 4 - top;
  return svg;
}

}  // namespace

std::string ToSvg(const PlotFigure& figure) {
  std::string body;
  double y = kMargin + 14;
  body += Text(kMargin, y, figure.title, "class=\"title\"");
  y += 8;
  for (const std::string& note : figure.notes) {
    for (const std::string& line : WrapTo(note, figure.width - 2 * kMargin)) {
      y += kLineHeight;
      body += Text(kMargin, y, line, "class=\"note\"");
    }
  }
  int number = 0;
  for (const PlotPanel& panel : figure.panels) {
    y += 30;
    if (!panel.title.empty()) {
      body += Text(kLeft, y, panel.title, "class=\"panel\"");
      y += 8;
    }
    double legend = 0;
    body += DrawLegend(panel, figure.width, y, &legend);
    const Axes axes(panel, figure.width, y + legend + 4);
    const std::string id = fmt::format("{}p{}", figure.id, number);
    body += axes.Clip(id);
    std::string shapes;
    for (const PlotSeries& series : panel.series) {
      shapes += DrawSeries(series, axes);
    }
    body += axes.Draw(panel);
    body += fmt::format("<g clip-path=\"url(#{})\">\n{}</g>\n", id, shapes);
    for (const PlotText& text : panel.texts) {
      const PlotPoint p = axes.ToPage(text.at);
      body += Text(
          p.x, p.y + 4, text.text,
          text.is_on_solid ? "class=\"onsolid\" text-anchor=\"middle\"" : "text-anchor=\"middle\"");
    }
    y = axes.end();
    ++number;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" role=\"img\">\n<title>{2}</title>\n{5}<style>{3}</style>\n"
      "<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n{4}</svg>\n",
      figure.width, y + kMargin, Escape(figure.title), kFigureStyle, body,
      figure.description.empty() ? ""
                                 : fmt::format("<desc>{}</desc>\n", Escape(figure.description)));
}

}  // namespace hvas::pages
