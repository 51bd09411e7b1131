#include "app/shopfloor/dfa_report.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/assembly/run_report.h"
#include "app/fit/csv_table.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "orders/hand_time.h"
#include "pages/html_page.h"

namespace hvas::app {
namespace {

using pages::Escape;
using pages::MakeTile;
using shopfloor::DfaRow;
using shopfloor::DfaSheet;
using shopfloor::DfaTimes;

/** The code, and whose time it has where that is another one. */
std::string DescribeCode(const std::string& code, const shopfloor::CodeTime& time) {
  return time.code == code ? code : fmt::format("{} (time of {})", code, time.code);
}

/** Why parts are proposed as needed or not, as a question where it is one. */
std::string DescribeNeed(const shopfloor::NeedOfPart& need) {
  if (need.is_first) {
    return "needed: the first part";
  }
  if (need.is_fastener) {
    return "not needed: it only fastens others";
  }
  std::string reasons;
  for (const auto* reason : {&need.moves, &need.material, &need.apart}) {
    if (*reason) {
      reasons += (reasons.empty() ? "" : "; ") + **reason;
    }
  }
  return reasons.empty()
             ? "perhaps not needed: does it have to move, to be of another material, or "
               "to be apart?"
             : "proposed as needed: " + reasons;
}

std::string DescribeSums(const DfaSheet& sheet) {
  return fmt::format(
      "{} parts, {} of them needed at least, {:.2f} s; index {:.2f} % with {:.2f} s for an ideal "
      "part ({:.2f} % with {:.0f} s, as many worksheets have it)",
      sheet.parts, sheet.min_parts, sheet.seconds, 100 * sheet.CalcIndex(shopfloor::kIdealSeconds),
      shopfloor::kIdealSeconds, 100 * sheet.CalcIndex(shopfloor::kIdealSecondsRounded),
      shopfloor::kIdealSecondsRounded);
}

constexpr const char* kProposed =
    "The needed parts are proposals: what has to move, to be of another material or to be apart, "
    "only the engineer knows. Write the worksheet with -o sheet.csv, correct its column min_parts, "
    "and calculate it again with --worksheet sheet.csv.";

}  // namespace

Result<DfaSheet> ReadDfaSheet(const std::filesystem::path& file) {
  const auto table = CsvTable::Read(file, CsvTable::kAnyDelimiter);
  if (!table) {
    return Unexpected(table.error());
  }
  if (const auto complete =
          table->Require({"part", "count", "handling_code", "insertion_code", "min_parts"});
      !complete) {
    return Unexpected(complete.error());
  }
  std::vector<DfaRow> rows;
  for (std::size_t i = 0; i < table->row_count(); ++i) {
    const auto count = table->GetNumber(i, "count");
    const auto needed = table->GetNumber(i, "min_parts");
    constexpr double kMost = 1e6;  // More parts are in no product: a choice.
    const auto is_count = [](const std::optional<double>& number) {
      return number && *number >= 0 && *number <= kMost && std::floor(*number) == *number;
    };
    if (!is_count(count) || !is_count(needed)) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("line {}: count and min_parts are no whole numbers", table->LineOf(i)),
          file.string(), "write how many parts there are, and how many are needed");
    }
    rows.push_back({std::string(table->Get(i, "part")), static_cast<int>(*count),
                    std::string(table->Get(i, "handling_code")),
                    std::string(table->Get(i, "insertion_code")), static_cast<int>(*needed)});
  }
  auto sheet = shopfloor::MakeDfaSheet(std::move(rows));
  if (!sheet) {
    sheet.error().where = fmt::format("{}: {}", file.string(), sheet.error().where);
  }
  return sheet;
}

std::string MakeDfaTable(const DfaReport& report) {
  CsvTable table;
  for (std::size_t i = 0; i < report.sheet->rows.size(); ++i) {
    const DfaRow& row = report.sheet->rows[i];
    const DfaTimes& times = report.sheet->times[i];
    table.AddRow();
    table.Set(i, "part", row.part);
    table.Set(i, "count", std::to_string(row.count));
    table.Set(i, "handling_code", row.handling);
    table.Set(i, "handling_s", fmt::format("{}", times.handling.seconds));
    table.Set(i, "insertion_code", row.insertion);
    table.Set(i, "insertion_s", fmt::format("{}", times.insertion.seconds));
    table.Set(i, "operation_s", fmt::format("{:.2f}", times.seconds));
    table.Set(i, "min_parts", std::to_string(row.min_parts));
    if (report.rating != nullptr) {
      const shopfloor::RatedParts& rated = report.rating->groups[i];
      table.Set(i, "chosen_by",
                rated.handled_as + "; " + rated.inserted_as + "; " + DescribeNeed(rated.need));
    }
  }
  return table.ToText();
}

nlohmann::ordered_json MakeDfaJson(const DfaReport& report) {
  const DfaSheet& sheet = *report.sheet;
  nlohmann::ordered_json json{{"title", report.title},
                              {"rows", nlohmann::ordered_json::array()},
                              {"parts", sheet.parts},
                              {"min_parts", sheet.min_parts},
                              {"total_s", sheet.seconds},
                              {"index", sheet.CalcIndex(shopfloor::kIdealSeconds)},
                              {"index_with_3_s", sheet.CalcIndex(shopfloor::kIdealSecondsRounded)}};
  for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
    const DfaRow& row = sheet.rows[i];
    const DfaTimes& times = sheet.times[i];
    nlohmann::ordered_json one{{"part", row.part},
                               {"count", row.count},
                               {"handling_code", row.handling},
                               {"handling_s", times.handling.seconds},
                               {"handling_time_of", times.handling.code},
                               {"insertion_code", row.insertion},
                               {"insertion_s", times.insertion.seconds},
                               {"insertion_time_of", times.insertion.code},
                               {"operation_s", times.seconds},
                               {"min_parts", row.min_parts}};
    if (report.rating != nullptr) {
      const shopfloor::RatedParts& rated = report.rating->groups[i];
      one["alpha_deg"] = rated.symmetry.alpha_deg;
      one["beta_deg"] = rated.symmetry.beta_deg;
      one["size_mm"] = units::ToMm(rated.size);
      one["thickness_mm"] = units::ToMm(rated.thickness);
      one["handled_as"] = rated.handled_as;
      one["inserted_as"] = rated.inserted_as;
      one["need"] = DescribeNeed(rated.need);
    }
    json["rows"].push_back(std::move(one));
  }
  if (report.rating != nullptr) {
    json["modapts_s"] = orders::kModSeconds * report.modapts_mods;
    json["advice"] = nlohmann::ordered_json::array();
    for (const shopfloor::DfaAdvice& advice : report.rating->advice) {
      json["advice"].push_back({{"text", advice.text}, {"saves_s", advice.seconds}});
    }
  }
  return json;
}

void PrintDfa(const DfaReport& report) {
  TextTable table({"part", "count", "handling", "s", "insertion", "s", "all [s]", "needed"});
  for (std::size_t i = 0; i < report.sheet->rows.size(); ++i) {
    const DfaRow& row = report.sheet->rows[i];
    const DfaTimes& times = report.sheet->times[i];
    std::string below;
    if (report.rating != nullptr) {
      const shopfloor::RatedParts& rated = report.rating->groups[i];
      below =
          fmt::format("{}; {}; {}", rated.handled_as, rated.inserted_as, DescribeNeed(rated.need));
    }
    table.Add({row.part, std::to_string(row.count), DescribeCode(row.handling, times.handling),
               fmt::format("{:.2f}", times.handling.seconds),
               DescribeCode(row.insertion, times.insertion),
               fmt::format("{:.2f}", times.insertion.seconds), fmt::format("{:.2f}", times.seconds),
               std::to_string(row.min_parts)},
              below);
  }
  fmt::print("{}\n{}", table.ToText(), Wrap(DescribeSums(*report.sheet) + ".", 0));
  if (report.rating == nullptr) {
    return;
  }
  fmt::print("{}", Wrap(fmt::format("Time of the hands by MODAPTS, for the same order: {:.1f} s.",
                                    orders::kModSeconds * report.modapts_mods),
                        0));
  if (!report.rating->advice.empty()) {
    fmt::print("\nWhat would save most:\n");
  }
  constexpr std::size_t kTold = 8;  // As many as a reader compares: a choice; JSON has all.
  for (std::size_t i = 0; i < std::min(kTold, report.rating->advice.size()); ++i) {
    const shopfloor::DfaAdvice& advice = report.rating->advice[i];
    fmt::print("{}", Wrap(fmt::format("{:6.2f} s  {}", advice.seconds, advice.text), 10));
  }
  fmt::print("\n{}", Wrap(kProposed, 0));
}

std::string MakeDfaPage(const DfaReport& report) {
  const DfaSheet& sheet = *report.sheet;
  std::string body = fmt::format(
      "<h1>{}: design for assembly</h1>\n<dl class=\"tiles\">{}{}{}{}{}</dl>\n",
      Escape(report.title), MakeTile("parts", std::to_string(sheet.parts)),
      MakeTile("needed at least", std::to_string(sheet.min_parts)),
      MakeTile("time of the worksheet", fmt::format("{:.2f} s", sheet.seconds)),
      MakeTile("index", fmt::format("{:.2f} %", 100 * sheet.CalcIndex(shopfloor::kIdealSeconds))),
      report.rating == nullptr
          ? ""
          : MakeTile("time by MODAPTS",
                     fmt::format("{:.1f} s", orders::kModSeconds * report.modapts_mods)));
  body += fmt::format("<p>{}.</p>\n", Escape(DescribeSums(sheet)));
  body +=
      "<h2>Worksheet</h2>\n<div class=\"scroll\"><table><tr><th>part</th><th>count</th>"
      "<th class=\"l\">handling</th><th>[s]</th><th class=\"l\">insertion</th><th>[s]</th>"
      "<th>all [s]</th><th>needed</th></tr>\n";
  for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
    const DfaRow& row = sheet.rows[i];
    const DfaTimes& times = sheet.times[i];
    std::string handled = shopfloor::DescribeHandling(row.handling);
    std::string inserted = shopfloor::DescribeInsertion(row.insertion);
    std::string need;
    if (report.rating != nullptr) {
      const shopfloor::RatedParts& rated = report.rating->groups[i];
      handled = rated.handled_as;
      inserted = rated.inserted_as;
      need = fmt::format("<br><span class=\"soft\">{}</span>", Escape(DescribeNeed(rated.need)));
    }
    body += fmt::format(
        "<tr><td>{}{}</td><td>{}</td><td class=\"l\">{}<br><span class=\"soft\">{}</span></td>"
        "<td>{:.2f}</td><td class=\"l\">{}<br><span class=\"soft\">{}</span></td><td>{:.2f}</td>"
        "<td>{:.2f}</td><td>{}</td></tr>\n",
        Escape(row.part), need, row.count, DescribeCode(row.handling, times.handling),
        Escape(handled), times.handling.seconds, DescribeCode(row.insertion, times.insertion),
        Escape(inserted), times.insertion.seconds, times.seconds, row.min_parts);
  }
  body += "</table></div>\n";
  if (report.rating != nullptr) {
    body += "<h2>What would save most</h2>\n<ul>\n";
    for (const shopfloor::DfaAdvice& advice : report.rating->advice) {
      body += fmt::format("<li>{:.2f} s: {}</li>\n", advice.seconds, Escape(advice.text));
    }
    body += fmt::format("</ul>\n<p class=\"soft\">{}</p>\n", Escape(kProposed));
  }
  body +=
      "<p class=\"soft\">Codes and index by Boothroyd and Dewhurst; times of codes that stand in "
      "public worksheets. For a code without a public time that of a harder one is taken, which is "
      "named. The time by MODAPTS is that of the plan's hands, 0.129 s a MOD. Neither was "
      "measured.</p>\n";
  return pages::MakeHtmlPage(report.title + ": design for assembly", body);
}

}  // namespace hvas::app
