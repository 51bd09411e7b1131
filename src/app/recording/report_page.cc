#include "app/recording/report_page.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <ctime>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/product/drawing_errors_report.h"
#include "base/parse_json.h"
#include "base/units.h"
#include "evidence/picture.h"
#include "evidence/session_data.h"
#include "pages/embedded_image.h"
#include "pages/html_page.h"
#include "pages/svg_plot.h"
#include "record/session_file.h"
#include "session/hand_names.h"
#include "session/json_values.h"

namespace hvas::app {
namespace {

using evidence::Hold;
using evidence::Summary;
using pages::Escape;
using pages::MakeTile;
using pages::PlotFigure;
using pages::PlotSeries;
using pages::PlotStyle;
using units::ToMm;

// Pixels of pictures, and rows that a table of incidents has: choices for a page that is read.
constexpr int kPictureWidth = 900;
constexpr int kPictureHeight = 560;
constexpr int kWaysHeight = 480;
constexpr std::size_t kMaxIncidents = 60;
constexpr int kColors = 5;  // of svg_plot.h

constexpr const char* kStyle = R"(
.over{position:relative}.over svg{position:absolute;inset:0}.over img{opacity:.55}
.w0{stroke:#0b62c4}.w1{stroke:#bb430a}.w2{stroke:#1b7f3b}.w3{stroke:#6b4fb3}.w4{stroke:#6a737d}
.way{fill:none;stroke-width:1.6;stroke-linejoin:round;opacity:.85}
@media(prefers-color-scheme:dark){.w0{stroke:#6cb0ff}.w1{stroke:#ff9c66}.w2{stroke:#6fd08c}.w3{stroke:#b9a3ff}.w4{stroke:#aeb6bf}}
)";

std::string MetaOf(const Summary& summary, const std::string& key) {
  const auto found = summary.meta.find(key);
  return found == summary.meta.end() ? std::string() : found->second;
}

std::string NameOf(const Summary& summary, std::uint32_t occurrence) {
  const std::string path = evidence::NameOf(summary.paths, occurrence);
  const std::size_t slash = path.find('/');  // the product's own name goes without saying
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::string FormatDuration(double seconds) {
  return seconds < 120 ? fmt::format("{:.1f} s", seconds)
                       : fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60),
                                     std::floor(std::fmod(seconds, 60)));
}

std::string FormatDate(const std::string& unix_ns) {
  const std::time_t seconds = std::strtoll(unix_ns.c_str(), nullptr, 10) / 1'000'000'000;
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &utc);
  return {text.data(), size};
}

/** Occurrences whose last hold ended in their place. */
std::set<std::uint32_t> FindSeated(const Summary& summary) {
  std::set<std::uint32_t> seated;
  for (const Hold& hold : summary.holds) {
    if (hold.is_seated) {
      seated.insert(hold.occurrence);
    } else {
      seated.erase(hold.occurrence);
    }
  }
  return seated;
}

/** The session took a product apart: parts were to leave their place. */
bool IsDisassembly(const Summary& summary) {
  return MetaOf(summary, "task") == "disassembly";
}

std::string MakeHead(const Summary& summary, std::size_t left_out) {
  const std::string name = Escape(MetaOf(summary, "product"));
  std::set<std::uint32_t> taken;
  double peak_felt = 0;
  double peak_true = 0;
  int collisions = 0;
  for (const Hold& hold : summary.holds) {
    taken.insert(hold.occurrence);
    peak_felt = std::max(peak_felt, hold.peak_felt);
    peak_true = std::max(peak_true, hold.peak_true);
    collisions += hold.collisions;
  }
  const bool is_apart = IsDisassembly(summary);
  const std::size_t seated = FindSeated(summary).size();
  const std::size_t done = is_apart ? taken.size() - seated : seated;
  std::string html = fmt::format(
      "<h1>{}</h1><p class=\"soft\">{} of {}, {}</p>", name, is_apart ? "Disassembly" : "Assembly",
      Escape(MetaOf(summary, "source")), FormatDate(MetaOf(summary, record::kMetaStarted)));
  html += fmt::format(
      "<p class=\"verdict\">{} of {} parts that were taken up {} their place{}.</p>",
      done == taken.size() ? fmt::format("<span class=\"good\">All {}</span>", done)
                           : fmt::format("<span class=\"bad\">{}</span>", done),
      taken.size(), is_apart ? "left" : "came to",
      summary.is_complete ? "" : "; the record is incomplete, or the session still runs");
  if (left_out > 0) {
    html += fmt::format(
        "<p class=\"verdict\"><span class=\"bad\">{}</span> {} no way in: see <a "
        "href=\"#left-out\">what stops {}</a>.</p>",
        left_out, left_out == 1 ? "part has" : "parts have", left_out == 1 ? "it" : "them");
  }
  if (summary.product && !summary.product->drawing_errors.empty()) {
    const std::size_t errors = summary.product->drawing_errors.size();
    html += fmt::format(
        "<p class=\"verdict\"><span class=\"bad\">{} {} of the drawing</span>: see <a "
        "href=\"#drawing-errors\">which parts are drawn in one another</a>.</p>",
        errors, errors == 1 ? "error" : "errors");
  }
  if (!summary.damage.empty()) {
    html += fmt::format(
        "<p class=\"verdict\"><span class=\"bad\">This record is damaged</span>: {}. This page "
        "tells of what could be read.</p>",
        Escape(summary.damage));
  }
  html += "<dl class=\"tiles\">";
  html += MakeTile("Time", FormatDuration(summary.duration));
  html += MakeTile("Hands", std::to_string(summary.hands.size()));
  html += MakeTile("Largest force felt", fmt::format("{:.1f} N", peak_felt));
  html += MakeTile("Largest true force", fmt::format("{:.4g} N", peak_true));
  html += MakeTile("Collisions", std::to_string(collisions));
  html += MakeTile("Safety and devices", fmt::format("{} events", summary.incidents.size()));
  return html + "</dl>";
}

std::string MakeImage(const product::Product& product, const evidence::Projection& projection,
                      const std::string& what) {
  return pages::MakeImage(evidence::MakePicture(product, projection), what, projection.width(),
                          projection.height());
}

std::string MakeProductPicture(const Summary& summary) {
  if (!summary.product) {
    return {};
  }
  const evidence::Projection projection(summary.product->box_W, kPictureWidth, kPictureHeight);
  return fmt::format(
      "<figure>{}</figure>",
      MakeImage(*summary.product, projection,
                summary.product->name + ", put together, from the front right above"));
}

/** The ways of the parts over a faint picture of the product. */
std::string MakeWays(const Summary& summary) {
  spatial::Box box;
  for (const Hold& hold : summary.holds) {
    for (const Vec3& p : hold.points) {
      box.Add(p);
    }
  }
  if (summary.holds.empty() || !(box.size().norm() > 0)) {
    return {};
  }
  if (summary.product) {
    box.Add(summary.product->box_W.low);
    box.Add(summary.product->box_W.high);
  }
  const evidence::Projection projection(box, kPictureWidth, kWaysHeight);
  std::string lines;
  for (std::size_t i = 0; i < summary.holds.size(); ++i) {
    const Hold& hold = summary.holds[i];
    lines += fmt::format("<polyline class=\"way w{}\" points=\"", i % kColors);
    for (const Vec3& p : hold.points) {
      const Vec3 pixel = projection.Project(p);
      lines += fmt::format("{:.1f},{:.1f} ", pixel.x(), pixel.y());
    }
    lines += fmt::format("\"><title>{}: {:.2f} m</title></polyline>",
                         Escape(NameOf(summary, hold.occurrence)), hold.path);
  }
  return fmt::format(
      "<h2>Ways of the parts</h2><figure><div{}>{}<svg viewBox=\"0 0 {} {}\" "
      "role=\"img\" aria-label=\"Ways of the parts\">{}</svg></div><figcaption>From where each "
      "part "
      "was taken up to where it was let go, by its centre of mass; from the front right above."
      "</figcaption></figure>",
      summary.product ? " class=\"over\"" : "",
      summary.product ? MakeImage(*summary.product, projection, "") : std::string(), kPictureWidth,
      kWaysHeight, lines);
}

std::string MakeSequence(const Summary& summary) {
  std::string html =
      "<h2>Sequence</h2><div class=\"scroll\"><table><thead><tr><th>Part</th><th>Hand</th>"
      "<th>Taken<br>[s]</th><th>In hand<br>[s]</th><th>Way<br>[m]</th><th>True force<br>[N]</th>"
      "<th>Felt force<br>[N]</th><th>Inserted<br>[mm]</th><th>Collisions</th>"
      "<th>In contact<br>[s]</th><th>Outcome</th></tr></thead><tbody>";
  for (const Hold& hold : summary.holds) {
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.3f}</td><td>{:.4g}</td>"
        "<td>{:.2f}</td><td>{:.2f}</td><td>{}</td><td>{:.2f}</td><td class=\"{}\">{}</td></tr>",
        Escape(NameOf(summary, hold.occurrence)), session::OrdinalOfHand(hold.hand),
        1e-9 * static_cast<double>(hold.start_ns),
        1e-9 * static_cast<double>(hold.end_ns - hold.start_ns), hold.path, hold.peak_true,
        hold.peak_felt, ToMm(hold.insertion), hold.collisions,
        1e-9 * static_cast<double>(hold.contact_ns),
        hold.is_seated == IsDisassembly(summary) ? "bad" : "good",
        hold.is_seated ? "in place" : "let go");
  }
  return html +
         "</tbody></table></div><p><small>Largest forces of each hold. A collision is contact "
         "after "
         "a tenth of a second without.</small></p>";
}

std::string MakeForces(const Summary& summary) {
  std::string html = "<h2>Forces</h2>";
  for (std::size_t hand = 0; hand < summary.hands.size(); ++hand) {
    PlotSeries felt{"felt", PlotStyle::kLine, 0, {}};
    PlotSeries real{"true", PlotStyle::kThin, 1, {}};
    PlotSeries depth{"", PlotStyle::kLine, 2, {}};
    for (const evidence::ForceBin& bin : summary.hands[hand].bins) {
      felt.points.push_back({bin.t, bin.felt_force});
      real.points.push_back({bin.t, bin.true_force});
      depth.points.push_back({bin.t, ToMm(bin.insertion)});
    }
    PlotFigure figure;
    if (summary.hands.size() > 1) {
      figure.title = fmt::format("{} hand", session::OrdinalOfHand(hand));
      figure.title.front() = static_cast<char>(std::toupper(figure.title.front()));
    }
    const std::string x = "session time [s]";
    figure.panels.push_back({"Force rendered to the hand", x, "felt [N]", "", 1, {felt}, {}, {}});
    figure.panels.push_back({"True force", x, "true [N]", "", 1, {real}, {}, {}});
    figure.panels.push_back({"Depth of insertion", x, "depth [mm]", "", 1, {depth}, {}, {}});
    html += "<figure>" + ToSvg(figure) + "</figure>";
  }
  return html;
}

std::string MakeFits(const Summary& summary) {
  if (summary.fits.empty()) {
    return {};
  }
  std::string html =
      "<h2>Fits and sizes</h2><div class=\"scroll\"><table><thead><tr><th>Shaft in hole</th>"
      "<th class=\"l\">Fit</th><th>Nominal<br>[mm]</th><th>Hole<br>[mm]</th><th>Shaft<br>[mm]</th>"
      "<th>Actual clearance<br>[&micro;m]</th><th>With the surface<br>[&micro;m]</th><th>Force to "
      "press in<br>[N]</th></tr></thead><tbody>";
  for (const evidence::FitSummary& fit : summary.fits) {
    html += fmt::format(
        "<tr><td>{}</td><td class=\"l\">{}</td><td>{:g}</td><td>{:.4f}</td><td>{:.4f}</td>"
        "<td>{:+.1f}</td><td>{:+.1f} to {:+.1f}</td><td>{:.4g}</td></tr>",
        Escape(fit.name), Escape(fit.code), ToMm(fit.nominal), ToMm(fit.hole), ToMm(fit.shaft),
        units::ToUm(fit.hole - fit.shaft), units::ToUm(fit.least_clearance),
        units::ToUm(fit.largest_clearance), fit.max_force);
  }
  return html + fmt::format(
                    "</tbody></table></div><p><small>Diameters as drawn from their tolerances for "
                    "this session (seed {}), or as measured; clearances are diametral, of the mean "
                    "diameters, and of the places with the least and the most of the surface; "
                    "negative is interference.</small></p>",
                    Escape(MetaOf(summary, "seed")));
}

/** The parts that gave on the way of one; empty where none did. */
std::string MakeGiven(const Summary& summary) {
  if (summary.given.empty()) {
    return {};
  }
  std::string html =
      "<h2>Parts that gave</h2><div class=\"scroll\"><table><thead><tr><th>Part</th>"
      "<th class=\"l\">How far</th><th class=\"l\">On the way of</th></tr></thead><tbody>";
  for (const evidence::GivenPart& part : summary.given) {
    html +=
        fmt::format("<tr><td>{}</td><td class=\"l\">{}</td><td class=\"l\">{}</td></tr>",
                    Escape(NameOf(summary, part.occurrence)), evidence::Describe(part),
                    part.moved == part.occurrence ? "itself" : Escape(NameOf(summary, part.moved)));
  }
  return html +
         "</tbody></table></div><p><small>The furthest in the session, by the poses of its ticks."
         "</small></p>";
}

/** What contact left out for lack of room; empty where it left out nothing. */
std::string MakeContactLimits(const Summary& summary) {
  std::int64_t truncated = 0;
  std::int64_t crowded = 0;
  for (const evidence::HandSummary& hand : summary.hands) {
    truncated += hand.truncated_ticks;
    crowded += hand.crowded_ticks;
  }
  if (truncated + crowded == 0) {
    return {};
  }
  return fmt::format(
      "<p><small>Contact had more points or contacts than a tick has room for in {} ticks, and a "
      "loose part stood still because as many as may move did in {}.</small></p>",
      truncated, crowded);
}

std::string MakeLoops(const Summary& summary) {
  std::string html =
      "<h2>Energy and rates</h2><div class=\"scroll\"><table><thead><tr><th>Hand</th>"
      "<th>Ticks</th><th>Rate<br>[Hz]</th><th>Oldest physics<br>[ms]</th>"
      "<th>Ticks with less<br>than all contact</th><th>Energy from the hand<br>[J]</th>"
      "<th>Energy to the hand<br>[J]</th></tr></thead><tbody>";
  for (std::size_t i = 0; i < summary.hands.size(); ++i) {
    const evidence::HandSummary& hand = summary.hands[i];
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{:.0f}</td><td>{:.1f}</td><td>{}</td><td>{}</td><td>{}</td>"
        "</tr>",
        i == 0 ? "first" : "second", hand.ticks, hand.period > 0 ? 1 / hand.period : 0,
        1e3 * hand.longest_model_age, hand.shed_ticks,
        hand.has_energy ? fmt::format("{:.3f}", hand.energy_in) : "-",
        hand.has_energy ? fmt::format("{:.3f}", hand.energy_out) : "-");
  }
  const std::string dropped = MetaOf(summary, record::kMetaDropped);
  return html +
         fmt::format(
             "</tbody></table></div><p><small>Energy is accounted for with a device that "
             "shows forces, of the last stretch. Ticks that the record lacks: {}.</small></p>",
             dropped.empty() ? "unknown, because the record is incomplete" : Escape(dropped)) +
         MakeContactLimits(summary);
}

/** What an event says, in words. */
std::string Explain(const record::Event& event) {
  const auto json = ParseJson<nlohmann::json>(event.json);
  if (event.kind == "flight" || !json.is_object()) {
    return "the last second of ticks was kept";
  }
  if (event.kind == "safety") {
    std::string text;
    const auto* reasons = session::FieldOf(json, "reasons");
    for (const auto& reason : reasons != nullptr ? *reasons : nlohmann::json::array()) {
      text += (text.empty() ? "" : "; ") + (reason.is_string() ? reason.get<std::string>() : "");
    }
    return text;
  }
  if (event.kind == "device") {
    return session::TextOr(json, "condition", "");
  }
  return fmt::format("the tick leaves out level {}", session::IndexOr(json, "level", 0));
}

std::string MakeIncidents(const Summary& summary) {
  std::string html = "<h2>Safety and devices</h2>";
  if (summary.incidents.empty()) {
    return html +
           "<p>Nothing happened that the safety gate had to act on, or that a device told of."
           "</p>";
  }
  html +=
      "<div class=\"scroll\"><table><thead><tr><th>Time [s]</th><th class=\"l\">What</th>"
      "<th class=\"l\">Part in the hand</th><th class=\"l\">Details</th></tr></thead><tbody>";
  for (std::size_t i = 0; i < std::min(summary.incidents.size(), kMaxIncidents); ++i) {
    const record::Event& event = summary.incidents[i];
    html += fmt::format(
        "<tr><td>{:.3f}</td><td class=\"l\">{}</td><td class=\"l\">{}</td><td class=\"l\">{}</td>"
        "</tr>",
        1e-9 * static_cast<double>(event.t_ns), Escape(event.kind),
        event.occurrence == record::kNoOccurrence ? "-" : Escape(NameOf(summary, event.occurrence)),
        Escape(Explain(event)));
  }
  html += "</tbody></table></div>";
  if (summary.incidents.size() > kMaxIncidents) {
    html += fmt::format("<p><small>The first {} of {}; all are in the record.</small></p>",
                        kMaxIncidents, summary.incidents.size());
  }
  return html;
}

std::string MakeSource(const Summary& summary) {
  std::string devices;
  for (std::size_t hand = 0; hand < std::max<std::size_t>(1, summary.hands.size()); ++hand) {
    const std::string address = MetaOf(summary, session::MakeDeviceKey(hand));
    devices += fmt::format("{} in the {}{}: {}", hand == 0 ? "device" : ",",
                           session::OrdinalOfHand(hand), hand == 0 ? " hand" : "",
                           address.empty() ? "simulated, or a pointer" : Escape(address));
  }
  return fmt::format(
      "<h2>About this session</h2><p>Condition {}; force map {}; seed {}; {}.</p><p "
      "class=\"soft\"><small>Digest {}. Whether the record runs again bit for bit is "
      "told by hvas replay --verify.</small></p>",
      Escape(MetaOf(summary, "condition")), Escape(MetaOf(summary, "force_map")),
      Escape(MetaOf(summary, "seed")), devices,
      summary.is_complete ? Escape(MetaOf(summary, record::kMetaDigest))
                          : "missing, because the record is incomplete");
}

}  // namespace

std::string MakeReportPage(const Summary& summary, const ReportedLeftOut& left_out) {
  return pages::MakeHtmlPage(
      MetaOf(summary, "product") + ": assembly report",
      MakeHead(summary, left_out.count) +
          (summary.product ? MakeDrawingErrorsSection(*summary.product) : std::string()) +
          MakeProductPicture(summary) + left_out.section + MakeSequence(summary) +
          MakeWays(summary) + MakeForces(summary) + MakeFits(summary) + MakeGiven(summary) +
          MakeLoops(summary) + MakeIncidents(summary) + MakeSource(summary),
      kStyle);
}

}  // namespace hvas::app
