#include "campaign/campaign_page.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "pages/html_page.h"
#include "pages/svg_plot.h"

namespace hvas::campaign {
namespace {

using pages::Escape;
using pages::MakeTile;
using pages::PlotFigure;
using pages::PlotPanel;
using pages::PlotSeries;
using pages::PlotStyle;

constexpr std::size_t kMostRowsOfPage = 200;  // Rows of a table on a page: a choice.
constexpr std::size_t kMostCurves = 5;        // Colours of a plot.
constexpr std::size_t kMostFactors = 40;      // Rows of a table of effects: a choice.

using Cells = std::vector<std::string>;

std::string FormatPercent(double share) {
  return fmt::format("{:.3f} %", 100 * share);
}

std::string FormatForce(double force) {
  return force < 100 ? fmt::format("{:.3g}", force) : fmt::format("{:.0f}", force);
}

std::string MakeRow(const Cells& cells, const char* element) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    html += fmt::format("<{0}{2}>{1}</{0}>", element, cells[i], i == 0 ? " class=\"l\"" : "");
  }
  return html + "</tr>";
}

std::string MakeTable(const std::string& title, const Cells& head, const std::vector<Cells>& rows) {
  if (rows.empty()) {
    return {};
  }
  std::string html = fmt::format(
      "<h2>{0}</h2><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table>"
      "<thead>{1}</thead><tbody>",
      title, MakeRow(head, "th"));
  for (const Cells& cells : rows) {
    html += MakeRow(cells, "td");
  }
  return html + "</tbody></table></div>";
}

std::string MakeTiles(const Summary& summary) {
  std::int64_t complete = 0;
  for (const CellSummary& cell : summary.cells) {
    complete += cell.complete;
  }
  std::string html = "<dl class=\"tiles\">";
  html += MakeTile("Runs", fmt::format("{} of {}", summary.runs_done, summary.runs));
  if (summary.runs_done > 0) {
    html += MakeTile("Can be assembled", FormatPercent(static_cast<double>(complete) /
                                                       static_cast<double>(summary.runs_done)));
  }
  html += MakeTile("Combinations", std::to_string(summary.cells.size()));
  html += MakeTile("Digest", "<code>" + summary.digest.substr(0, 12) + "</code>");
  html += "</dl>";
  if (!summary.is_complete()) {
    html += fmt::format(
        "<p class=\"verdict bad\">{} shards are missing, and {} are damaged: the "
        "results are those of the others.</p>",
        summary.missing.size(), summary.damaged.size());
  }
  return summary.notes.empty() ? html
                               : html + "<p class=\"soft\">" + Escape(summary.notes) + "</p>";
}

std::string MakeCellTable(const Summary& summary) {
  std::vector<Cells> rows;
  for (const CellSummary& cell : summary.cells) {
    if (rows.size() == kMostRowsOfPage) {
      break;
    }
    Cells cells{Escape(cell.name), std::to_string(cell.runs), FormatPercent(cell.yield->share),
                FormatPercent(cell.yield->ci.low) + " to " + FormatPercent(cell.yield->ci.high)};
    for (const double force : cell.force_quantiles) {
      cells.push_back(FormatForce(force));
    }
    cells.push_back(FormatForce(cell.force_max));
    cells.push_back(fmt::format("{:.1f}", units::ToUm(cell.clearance_min)));
    cells.push_back(
        cell.failures.empty()
            ? "\u2013"
            : Escape(fmt::format("{} {}",
                                 kCauses[static_cast<std::size_t>(cell.failures.front().cause)],
                                 cell.failures.front().name)));
    rows.push_back(std::move(cells));
  }
  Cells head{"Combination", "Runs", "Complete", "95 %<br>interval"};
  for (const double share : kForceShares) {
    head.push_back(fmt::format("Force<br>{:g} %<br>[N]", 100 * share));
  }
  head.insert(head.end(), {"Largest<br>[N]", "Least<br>clearance<br>[um]", "Fails first"});
  return MakeTable("Combinations", head, rows);
}

std::string MakeFailureTable(const Summary& summary) {
  std::vector<Cells> rows;
  for (const CellSummary& cell : summary.cells) {
    for (const FailureCount& failure : cell.failures) {
      if (rows.size() < kMostRowsOfPage) {
        rows.push_back(
            {Escape(cell.name), std::string(kCauses[static_cast<std::size_t>(failure.cause)]),
             Escape(failure.name), std::to_string(failure.count),
             FormatPercent(static_cast<double>(failure.count) / static_cast<double>(cell.runs))});
      }
    }
  }
  return MakeTable("What fails first", {"Combination", "Cause", "Fit or part", "Runs", "Share"},
                   rows);
}

/** Axes of shares of complete products over something else. */
PlotPanel MakeYieldPanel(const std::string& x_label) {
  PlotPanel panel;
  panel.x_label = x_label;
  panel.y_label = "complete [%]";
  panel.y = pages::PlotRange{0, 100};
  return panel;
}

/** Yield over the sum of all tolerances, one mark for each combination. */
std::string PlotToleranceYield(const Summary& summary) {
  PlotSeries marks{"combinations", PlotStyle::kDots, 0, {}};
  for (const CellSummary& cell : summary.cells) {
    if (cell.tolerance) {
      marks.points.push_back({units::ToUm(*cell.tolerance), 100 * cell.yield->share});
    }
  }
  if (marks.points.size() < 2) {
    return {};
  }
  const auto [narrow, wide] =
      std::minmax_element(marks.points.begin(), marks.points.end(),
                          [](const auto& a, const auto& b) { return a.x < b.x; });
  constexpr double kMargin_um = 5;  // [um] beside the marks, so that each is seen whole: a choice.
  const pages::PlotRange range{narrow->x - kMargin_um, wide->x + kMargin_um};
  PlotFigure figure;
  figure.title = "Yield over tolerance";
  figure.description = "Share of complete products over the sum of the widths of all zones.";
  figure.id = "tolerance";
  PlotPanel panel = MakeYieldPanel("sum of the tolerances of all fits [um]");
  panel.x = range;
  panel.series.push_back(std::move(marks));
  figure.panels.push_back(std::move(panel));
  return pages::ToSvg(figure);
}

/** Yield over the deviations of the sizes that matter most, for one combination. */
std::string PlotSizeYield(const CellSummary& cell, std::size_t number) {
  PlotPanel panel = MakeYieldPanel("deviation of the size from nominal [um]");
  for (const MainEffect& effect : cell.effects) {
    const bool is_size = effect.bins.front().deviation != effect.bins.back().deviation;
    if (!is_size || panel.series.size() == kMostCurves) {
      continue;
    }
    PlotSeries curve{effect.factor, PlotStyle::kLine, static_cast<int>(panel.series.size()), {}};
    for (const EffectBin& bin : effect.bins) {
      if (bin.runs > 0) {
        curve.points.push_back(
            {units::ToUm(bin.deviation),
             100.0 * static_cast<double>(bin.complete) / static_cast<double>(bin.runs)});
      }
    }
    panel.series.push_back(std::move(curve));
  }
  if (panel.series.empty()) {
    return {};
  }
  PlotFigure figure;
  figure.title = "Yield over the sizes in their tolerances: " + cell.name;
  figure.notes = {"Each point has a tenth of the runs; all other sizes vary."};
  figure.description = "Share of complete products over the deviations of the sizes.";
  figure.id = fmt::format("sizes-{}", number);
  figure.panels.push_back(std::move(panel));
  return pages::ToSvg(figure);
}

/** Force over the share of products that need no more. */
std::string PlotForces(const Summary& summary) {
  PlotPanel panel;
  panel.x_label = "share of the products [%]";
  panel.y_label = "force that is enough [N]";
  for (const CellSummary& cell : summary.cells) {
    if (panel.series.size() == kMostCurves) {
      break;
    }
    PlotSeries curve{cell.name, PlotStyle::kLine, static_cast<int>(panel.series.size()), {}};
    for (std::size_t i = 0; i < kForceShares.size(); ++i) {
      curve.points.push_back({100 * kForceShares[i], cell.force_quantiles[i]});
    }
    panel.series.push_back(std::move(curve));
  }
  PlotFigure figure;
  figure.title = "Force";
  if (summary.cells.size() > kMostCurves) {
    figure.notes = {"The first five combinations; the table has all."};
  }
  figure.description = "Quantiles of the largest force of a product.";
  figure.id = "forces";
  figure.panels.push_back(std::move(panel));
  return pages::ToSvg(figure);
}

/** Cost against yield, where the plan has several fits. */
std::string MakePareto(const Plan& plan, const Summary& summary) {
  PlotSeries best{"not dominated", PlotStyle::kDots, 0, {}};
  PlotSeries others{"dominated", PlotStyle::kMarks, 1, {}};
  std::vector<Cells> rows;
  for (const CellSummary& cell : summary.cells) {
    if (!cell.cost_rank || rows.size() == kMostRowsOfPage) {
      continue;
    }
    (cell.is_best ? best : others)
        .points.push_back({static_cast<double>(*cell.cost_rank), 100 * cell.yield->share});
    rows.push_back({Escape(cell.name), std::to_string(*cell.cost_rank),
                    FormatPercent(cell.yield->share), cell.is_best ? "yes" : "\u2013"});
  }
  if (plan.fits.size() < 2 || rows.empty()) {
    return {};
  }
  std::sort(rows.begin(), rows.end(), [](const Cells& a, const Cells& b) {
    return std::stoi(a[1]) != std::stoi(b[1]) ? std::stoi(a[1]) < std::stoi(b[1]) : a < b;
  });
  PlotFigure figure;
  figure.title = "Cost class against yield";
  figure.notes = {
      "The cost class is a rank, not money: for each hole and shaft 18 less its IT grade, summed. "
      "It orders fits of one product, and nothing else."};
  figure.description = "Share of complete products over the cost class of their fits.";
  figure.id = "pareto";
  PlotPanel panel = MakeYieldPanel("cost class (rank)");
  for (PlotSeries* series : {&best, &others}) {
    if (!series->points.empty()) {
      panel.series.push_back(std::move(*series));
    }
  }
  figure.panels.push_back(std::move(panel));
  return pages::ToSvg(figure) +
         MakeTable("Cost class", {"Combination", "Cost class", "Complete", "Not dominated"}, rows);
}

std::string MakeEffectTable(const CellSummary& cell) {
  std::vector<Cells> rows;
  for (const MainEffect& effect : cell.effects) {
    if (rows.size() < kMostFactors) {
      rows.push_back({Escape(effect.factor), FormatPercent(effect.yield_range),
                      FormatForce(effect.force_range), fmt::format("{:.3f}", effect.force_ratio)});
    }
  }
  return MakeTable("Main effects: " + Escape(cell.name),
                   {"Factor", "Range of<br>the yield", "Range of the<br>mean force [N]",
                    "Share of the<br>variance of force"},
                   rows);
}

std::string FormatIndex(const std::optional<statistics::SobolIndex>& index, bool is_total) {
  if (!index) {
    return "<span class=\"soft\">no variance</span>";
  }
  const statistics::Interval& ci = is_total ? index->total_ci : index->first_ci;
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", is_total ? index->total : index->first, ci.low,
                     ci.high);
}

std::string MakeSobolTable(const CellSummary& cell) {
  std::vector<const SobolOfFactor*> factors;
  for (const SobolOfFactor& factor : cell.sobol) {
    factors.push_back(&factor);
  }
  const auto weight = [](const SobolOfFactor* factor) {
    return (factor->force ? factor->force->total : 0) +
           (factor->complete ? factor->complete->total : 0);
  };
  std::stable_sort(factors.begin(), factors.end(),
                   [&](const auto* a, const auto* b) { return weight(a) > weight(b); });
  factors.resize(std::min(factors.size(), kMostFactors));
  std::vector<Cells> rows;
  rows.reserve(factors.size());
  for (const SobolOfFactor* factor : factors) {
    rows.push_back({Escape(factor->factor), FormatIndex(factor->force, false),
                    FormatIndex(factor->force, true), FormatIndex(factor->complete, false),
                    FormatIndex(factor->complete, true)});
  }
  return MakeTable("Sobol's indices: " + Escape(cell.name),
                   {"Factor", "Force, first", "Force, total", "Complete, first", "Complete, total"},
                   rows);
}

std::string MakeWorstTable(const Plan& plan, const Summary& summary) {
  std::vector<Cells> rows;
  for (const WorstRun& worst : summary.worst) {
    const RunResult& r = worst.result;
    rows.push_back({"<code>" + Escape(worst.play) + "</code>", std::to_string(r.run),
                    Escape(DescribeCell(plan, FindCell(plan, r.cell))), std::to_string(r.seed),
                    std::string(kCauses[static_cast<std::size_t>(r.cause)]), FormatForce(r.force),
                    fmt::format("{:.3g}", r.utilisation)});
  }
  return MakeTable("Worst runs",
                   {"Command that plays it", "Run", "Combination", "Seed", "Cause", "Force<br>[N]",
                    "Utilisation"},
                   rows);
}

}  // namespace

std::string MakeCampaignPage(const Plan& plan, const Summary& summary) {
  const std::string title = "Campaign " + plan.id;
  std::string body = "<h1>" + Escape(title) + "</h1>" + MakeTiles(summary);
  body += MakeCellTable(summary);
  body += PlotToleranceYield(summary);
  for (std::size_t i = 0; i < std::min(summary.cells.size(), kMostCurves); ++i) {
    body += PlotSizeYield(summary.cells[i], i);
  }
  if (summary.runs_done > 0) {
    body += PlotForces(summary);
  }
  body += MakeFailureTable(summary) + MakePareto(plan, summary);
  for (std::size_t i = 0; i < std::min(summary.cells.size(), kMostCurves); ++i) {
    body += MakeEffectTable(summary.cells[i]) + MakeSobolTable(summary.cells[i]);
  }
  body += MakeWorstTable(plan, summary);
  body += fmt::format(
      "<p class=\"soft\">{} runs, method {}. Quantiles of forces are within half a per cent. "
      "Intervals of shares: Clopper and Pearson. Sobol's indices: first order by Saltelli (2010), "
      "total by Jansen (1999), intervals by the bootstrap. Digest of all rows: {}.</p>",
      summary.runs_done, kMethods[static_cast<std::size_t>(plan.method)], summary.digest);
  return pages::MakeHtmlPage(title, body);
}

}  // namespace hvas::campaign
