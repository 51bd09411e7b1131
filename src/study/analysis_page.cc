#include "study/analysis_page.h"

#include <cmath>

#include <fmt/format.h>

#include "pages/html_page.h"
#include "study/figures.h"

namespace hvas::study {
namespace {

using pages::Escape;
using pages::MakeTile;

constexpr const char* kNone = "<span class=\"soft\">not defined</span>";

/** Formats a number with four significant digits and a typographic minus. */
std::string Format(double value) {
  std::string text = fmt::format("{:.4g}", value);
  if (text.front() == '-') {
    text.replace(0, 1, "\u2212");
  }
  return text;
}

std::string Format(const std::optional<double>& value) {
  return value ? Format(*value) : kNone;
}

std::string Format(const std::optional<statistics::Interval>& interval) {
  return interval ? Format(interval->low) + " to " + Format(interval->high) : kNone;
}

std::string FormatPOf(const std::optional<double>& p) {
  return p ? Escape(FormatP(*p)) : kNone;
}

/** Makes the unit as the second line of a column's head: " [s]". */
std::string UnitOf(const Table& table) {
  return table.unit.empty() ? "" : "<br>[" + Escape(table.unit) + "]";
}

std::string MakeRow(const std::vector<std::string>& cells) {
  std::string html = "<tr>";
  for (const std::string& cell : cells) {
    html += "<td>" + cell + "</td>";
  }
  return html + "</tr>";
}

std::string MakeTable(const std::string& caption, const std::vector<std::string>& head,
                      const std::string& rows) {
  std::string html = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                     caption + "\"><table><thead><tr>";
  for (const std::string& cell : head) {
    html += "<th scope=\"col\">" + cell + "</th>";
  }
  return html + "</tr></thead><tbody>" + rows + "</tbody></table></div>";
}

std::string PairName(const Analysis& analysis, const PairResult& pair) {
  return Escape(analysis.table.conditions[pair.first]) + " \u2013 " +
         Escape(analysis.table.conditions[pair.second]);
}

std::string MakeHead(const Analysis& analysis) {
  std::size_t different = 0;
  for (const PairResult& pair : analysis.pairs) {
    different += pair.is_different ? 1 : 0;
  }
  std::string html = "<dl class=\"tiles\">";
  html += MakeTile("Participants", std::to_string(analysis.table.rows.size()));
  html += MakeTile("Conditions", std::to_string(analysis.conditions.size()));
  if (analysis.friedman && analysis.friedman->p) {
    html += MakeTile("Friedman p", Escape(FormatP(*analysis.friedman->p)));
    html += MakeTile("Kendall's W", fmt::format("{:.3f}", *analysis.friedman->kendall_w));
  }
  html += MakeTile("Pairs that differ", fmt::format("{} of {}", different, analysis.pairs.size()));
  html += "</dl>";
  const std::string told = DescribeFriedman(analysis);
  return told.empty() ? html : html + "<p class=\"verdict\">" + Escape(told) + "</p>";
}

std::string MakeConditions(const Analysis& analysis) {
  const std::string unit = UnitOf(analysis.table);
  const std::string level = fmt::format("{:g} %", 100 * (1 - analysis.options.alpha));
  std::string rows;
  for (const ConditionResult& condition : analysis.conditions) {
    const statistics::Summary& s = condition.summary;
    rows += MakeRow({Escape(condition.name), std::to_string(s.n), Format(s.mean), Format(s.mean_ci),
                     Format(s.sd), Format(s.min), Format(s.lower_quartile), Format(s.median),
                     Format(s.upper_quartile), Format(s.max)});
  }
  std::string html = "<h3>Conditions</h3>" +
                     MakeTable("Conditions",
                               {"Condition", "n", "Mean" + unit, level + "<br>of the mean" + unit,
                                "SD" + unit, "Least" + unit, "Lower<br>quartile" + unit,
                                "Median" + unit, "Upper<br>quartile" + unit, "Largest" + unit},
                               rows);
  if (!analysis.options.of) {
    return html;
  }
  rows.clear();
  for (const ConditionResult& condition : analysis.conditions) {
    const statistics::Share& share = *condition.share;
    rows += MakeRow({Escape(condition.name), std::to_string(share.right),
                     std::to_string(share.trials), fmt::format("{:.1f} %", 100 * share.share),
                     fmt::format("{:.1f} to {:.1f} %", 100 * share.ci.low, 100 * share.ci.high),
                     FormatPOf(share.chance_p)});
  }
  return html + "<h3>Right answers</h3>" +
         MakeTable("Right answers",
                   {"Condition", "Right", "Trials", "Share", level + " of the share",
                    fmt::format("p against chance ({:.3g} %)", 100 * analysis.chance)},
                   rows);
}

std::string MakeDifferences(const Analysis& analysis) {
  const std::string unit = UnitOf(analysis.table);
  const std::string level = fmt::format("{:g} %", 100 * (1 - analysis.options.alpha));
  std::string rows;
  for (const PairResult& pair : analysis.pairs) {
    const statistics::Summary& s = pair.difference.summary;
    std::optional<statistics::Interval> d_z_ci;
    std::optional<double> d_z;
    if (pair.d_z) {
      d_z = pair.d_z->d_z;
      d_z_ci = pair.d_z->ci;
    }
    rows += MakeRow({PairName(analysis, pair), std::to_string(s.n), Format(s.mean),
                     Format(s.mean_ci), Format(s.median),
                     pair.difference.percent ? Format(*pair.difference.percent) + " %" : kNone,
                     Format(d_z), Format(d_z_ci), Format(pair.wilcoxon.rank_biserial),
                     Format(pair.wilcoxon.r)});
  }
  return "<h3>Differences and their size</h3>" +
         MakeTable("Differences",
                   {"Second minus first", "n", "Mean" + unit, level + "<br>of the mean" + unit,
                    "Median" + unit, "Of the<br>first mean", "Cohen's<br>d<sub>z</sub>",
                    level + "<br>of d<sub>z</sub>", "Rank<br>biserial", "r =<br>Z/&radic;n"},
                   rows);
}

std::string MakeTests(const Analysis& analysis) {
  std::string rows;
  for (const PairResult& pair : analysis.pairs) {
    const statistics::Wilcoxon& w = pair.wilcoxon;
    rows += MakeRow(
        {PairName(analysis, pair), std::to_string(w.n), std::to_string(w.zero_count), Format(w.z),
         FormatPOf(w.p), Escape(FormatP(pair.bonferroni_p)), Escape(FormatP(pair.holm_p)),
         FormatPOf(w.exact_p), FormatPOf(pair.exact_bonferroni_p), FormatPOf(pair.exact_holm_p),
         fmt::format("<span class=\"{} l\">{}</span>", pair.is_different ? "good" : "soft",
                     Escape(DescribePair(analysis, pair)))});
  }
  return "<h3>Wilcoxon signed ranks</h3>" +
         MakeTable("Wilcoxon signed ranks",
                   {"Pair", "Not<br>zero", "Zero", "Z", "p", "Bonferroni<br>p", "Holm<br>p",
                    "Exact<br>p", "Exact<br>Bonferroni p", "Exact<br>Holm p", "Difference"},
                   rows);
}

std::string MakeParagraphs(const std::vector<std::string>& texts, const char* style) {
  std::string html;
  for (const std::string& text : texts) {
    html += fmt::format("<p class=\"{}\"><small>{}</small></p>", style, Escape(text));
  }
  return html;
}

std::string MakeFigure(const std::string& svg) {
  return "<figure>" + svg + "</figure>";
}

}  // namespace

std::string MakeAnalysisHtml(const Analysis& analysis, const std::string& id) {
  const Table& table = analysis.table;
  std::string title = table.quantity;
  if (!title.empty() && title.front() >= 'a' && title.front() <= 'z') {
    title.front() = static_cast<char>(title.front() - 'a' + 'A');
  }
  std::string html = fmt::format("<section id=\"{}\"><h2>{}</h2>", id, Escape(title));
  html += MakeHead(analysis);
  if (analysis.options.direction != Direction::kNotStated) {
    html += analysis.options.direction == Direction::kHigherIsBetter ? "<p>Higher is better.</p>"
                                                                     : "<p>Lower is better.</p>";
  }
  html += MakeParagraphs(analysis.notes, "note");
  html += MakeFigure(DrawBoxes(analysis, id + "-boxes"));
  html += MakeConditions(analysis);
  html += MakeTests(analysis) + MakeDifferences(analysis);
  html += MakeFigure(DrawMeans(analysis, id + "-means"));
  html += MakeFigure(DrawPairs(analysis, id + "-pairs"));
  html += MakeParagraphs(DescribeConventions(analysis), "soft");
  return html + "</section>";
}

std::string MakeIdentificationHtml(const Identification& identification, const std::string& id) {
  const statistics::Confusion& confusion = identification.confusion;
  const double level = 100 * identification.confidence;
  const auto tell_ci = [](const statistics::Share& share) {
    return fmt::format("{:.1f} to {:.1f} %", 100 * share.ci.low, 100 * share.ci.high);
  };
  std::string html =
      fmt::format("<section id=\"{}\"><h2>Identification</h2><dl class=\"tiles\">", id);
  html += MakeTile("Participants", std::to_string(identification.participant_count));
  html += MakeTile("Answers", std::to_string(confusion.accuracy.trials));
  html += MakeTile("Right", fmt::format("{:.1f} %", 100 * confusion.accuracy.share));
  html += MakeTile(fmt::format("{:g} % interval", level), tell_ci(confusion.accuracy));
  html +=
      MakeTile("Cohen's kappa", confusion.kappa ? fmt::format("{:.3f}", *confusion.kappa) : kNone);
  if (confusion.accuracy.chance_p) {
    html += MakeTile(fmt::format("p against chance ({:.3g} %)", 100 * *identification.chance),
                     Escape(FormatP(*confusion.accuracy.chance_p)));
  }
  html += "</dl>" + MakeFigure(DrawConfusion(identification, id + "-confusion"));
  std::string rows;
  for (std::size_t i = 0; i < identification.names.size(); ++i) {
    const std::optional<statistics::Share>& recall = confusion.recall[i];
    if (recall) {
      rows += MakeRow({Escape(identification.names[i]), std::to_string(recall->trials),
                       std::to_string(recall->right), fmt::format("{:.1f} %", 100 * recall->share),
                       tell_ci(*recall), FormatPOf(recall->chance_p)});
    }
  }
  html += MakeTable("Right answers",
                    {"Shown", "Times", "Right", "Share", fmt::format("{:g} % of the share", level),
                     "p against chance"},
                    rows);
  return html +
         MakeParagraphs(
             {fmt::format("Intervals by Clopper and Pearson; they, and p against chance, treat all "
                          "answers as independent, also those of one participant.")},
             "soft") +
         "</section>";
}

}  // namespace hvas::study
