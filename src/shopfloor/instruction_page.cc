#include "shopfloor/instruction_page.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "orders/order_search.h"
#include "pages/embedded_image.h"
#include "pages/html_page.h"
#include "shopfloor/most_sequence.h"
#include "shopfloor/motion_code.h"
#include "shopfloor/step_picture.h"

namespace hvas::shopfloor {
namespace {

using pages::Escape;
using pages::MakeTile;
using product::OccurrenceId;

constexpr const char* kStyle = R"(
.head{margin-bottom:1.5rem}
.step{display:grid;grid-template-columns:minmax(0,11fr) minmax(0,9fr);gap:1.25rem;padding:1.25rem 0;border-top:1px solid var(--rule);break-inside:avoid}
.step h3{margin:0 0 .5rem;font-size:1.1rem}
.step .number{color:var(--soft);font-weight:400}
.view{position:relative;background:var(--tile);border-radius:.5rem;overflow:hidden}
.view img{display:block;width:100%;height:auto}
.view svg{position:absolute;inset:0;width:100%;height:100%}
.way{fill:none;stroke:#b3261e;stroke-width:4}.view .head{fill:#b3261e}
dl.facts{display:grid;grid-template-columns:auto 1fr;gap:.2rem .8rem;margin:0}
dl.facts dt{color:var(--soft)}dl.facts dd{margin:0;overflow-wrap:anywhere}
.warning{border-left:4px solid var(--bad);padding-left:.6rem;margin:.6rem 0}
details{margin-top:.6rem}summary{cursor:pointer;color:var(--soft)}
details td,details th{white-space:normal}
@media(max-width:46rem){.step{grid-template-columns:minmax(0,1fr)}}
@media print{.step{grid-template-columns:minmax(0,1fr) minmax(0,1fr);padding:.5rem 0}details,.viewer{display:none}.view{background:none;border:1px solid #ccc}}
)";

class PageMaker {
 public:
  PageMaker(const simulation::Model& model, const WorkPlan& plan, const InstructionOptions& options)
      : model_(model), plan_(plan), options_(options), words_(WordsOf(options.language)) {}

  [[nodiscard]] Result<std::string> Make() {
    const std::string title = fmt::format(fmt::runtime(words_.title), model_.product->name);
    std::string body;
    if (!options_.head.empty()) {
      body += "<header class=\"head\">" + options_.head + "</header>\n";
    }
    body += fmt::format("<h1>{}</h1>\n", Escape(title)) + MakeTiles() + MakeBill();
    if (!options_.viewer.empty()) {
      body += fmt::format("<section class=\"viewer\"><h2>{}</h2>{}</section>\n", words_.view3d,
                          options_.viewer);
    }
    body += fmt::format("<h2>{}</h2>\n", words_.work);
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
      if (options_.stop.stop_requested()) {
        return Fail(ErrorCode::kCancelled, "the instructions were stopped before their last step",
                    model_.product->source, "start them again");
      }
      body += MakeStep(i);
      if (options_.progress) {
        options_.progress(static_cast<double>(i + 1) / static_cast<double>(plan_.steps.size()));
      }
    }
    body += MakeLeftOut();
    body += fmt::format("<p class=\"soft\">{}</p>\n", words_.time_note);
    if (!options_.record.empty()) {
      body += fmt::format("<p class=\"soft\">{}</p>\n",
                          fmt::format(fmt::runtime(words_.recorded_note), Escape(options_.record)));
    }
    return pages::MakeHtmlPage(title, body, kStyle, ToString(options_.language));
  }

 private:
  [[nodiscard]] std::string NameOf(OccurrenceId id) const {
    return Escape(ShortNameOf(model_, id));
  }

  [[nodiscard]] std::string NamesOf(const std::vector<OccurrenceId>& parts) const {
    return Escape(ShortNamesOf(model_, parts));
  }

  [[nodiscard]] std::string MakeTiles() const {
    std::set<std::string> tools;
    int turns = 0;
    double most = 0;
    for (const WorkStep& step : plan_.steps) {
      most += SumSeconds(ListMostSequences(step.motions));
      if (!step.tool.empty()) {
        tools.insert(TranslateTool(step.tool, options_.language));
      }
      turns += step.is_turned ? 1 : 0;
    }
    int parts = 0;
    for (const BillLine& line : plan_.bill) {
      parts += line.count;
    }
    std::string names;
    for (const std::string& tool : tools) {
      names += (names.empty() ? "" : ", ") + Escape(tool);
    }
    std::string tiles =
        MakeTile(words_.parts, std::to_string(parts)) +
        MakeTile(words_.steps, std::to_string(plan_.steps.size())) +
        MakeTile(words_.turns, std::to_string(turns)) +
        MakeTile(fmt::format("{}, MODAPTS", words_.time),
                 fmt::format("{:.0f} s", orders::kModSeconds * plan_.mods)) +
        MakeTile(fmt::format("{}, BasicMOST", words_.time), fmt::format("{:.0f} s", most));
    if (!options_.record.empty()) {
      double recorded = 0;
      for (const auto& [id, seconds] : options_.recorded_s) {
        recorded += seconds;
      }
      tiles += MakeTile(words_.recorded_time, fmt::format("{:.0f} s", recorded));
    }
    if (!plan_.left_out.empty()) {
      tiles += MakeTile(words_.left_out, std::to_string(plan_.left_out.size()));
    }
    return fmt::format("<dl class=\"tiles\">{}</dl>\n{}", tiles,
                       names.empty() ? "" : fmt::format("<p>{}: {}</p>\n", words_.tools, names));
  }

  [[nodiscard]] std::string MakeBill() const {
    std::string html = fmt::format(
        "<h2>{}</h2>\n<div class=\"scroll\"><table><tr><th>{}</th><th class=\"l\">{}</th>"
        "<th>{}</th><th>{}</th><th class=\"l\">{}</th></tr>\n",
        words_.bill, words_.position, words_.name, words_.count, words_.mass, words_.material);
    int position = 0;
    for (const BillLine& line : plan_.bill) {
      html += fmt::format(
          "<tr><td>{}</td><td class=\"l\">{}</td><td>{}</td><td>{:.4g}</td><td class=\"l\">{}"
          "</td></tr>\n",
          ++position, Escape(line.name), line.count, 1e3 * line.mass, Escape(line.material));
    }
    return html + "</table></div>\n";
  }

  [[nodiscard]] const char* DescribeWay(const WorkStep& step) const {
    constexpr double kAlong = 0.98;   // Cosine of 11 degrees: a choice.
    constexpr double kAcross = 0.17;  // Sine of 10 degrees.
    if (!step.way.empty()) {
      return words_.turning_way;
    }
    const double rise = step.out_W.dot(step.up_W);
    return rise > kAlong              ? words_.from_above
           : rise < -kAlong           ? words_.from_below
           : std::abs(rise) < kAcross ? words_.from_side
                                      : words_.oblique;
  }

  static void AddFact(const char* name, const std::string& value, std::string* facts) {
    *facts += fmt::format("<dt>{}</dt><dd>{}</dd>", name, value);
  }

  /** How long the parts of a step were in hands in the record; 0 where there is none [s]. */
  [[nodiscard]] double SumRecorded(const WorkStep& step) const {
    double sum = 0;
    for (const OccurrenceId id : step.leading) {
      const auto found = options_.recorded_s.find(id);
      sum += found == options_.recorded_s.end() ? 0 : found->second;
    }
    return sum;
  }

  [[nodiscard]] std::string FormatSeconds(double seconds) const {
    return fmt::format(fmt::runtime(words_.seconds), seconds);
  }

  [[nodiscard]] std::string MakeFacts(const WorkStep& step) const {
    std::string facts;
    if (step.kind == WorkStep::Kind::kInsert) {
      AddFact(words_.way, DescribeWay(step), &facts);
    }
    for (const WorkFit& fit : step.fits) {
      const char* kind = fit.kind == product::FitKind::kInterference ? words_.interference
                         : fit.kind == product::FitKind::kTransition ? words_.transition
                                                                     : words_.clearance;
      AddFact(words_.fit,
              fmt::format(fmt::runtime(words_.fit_in), Escape(fit.code), kind, NameOf(fit.other)) +
                  (fit.is_proposed ? words_.proposed : ""),
              &facts);
    }
    constexpr double kLeastTold = 5;  // Hands do not mind less [N]: a choice.
    if (step.press > simulation::kMostHandForce) {
      AddFact(words_.force, fmt::format(fmt::runtime(words_.press), FormatForce(step.press)),
              &facts);
    } else if (step.force > kLeastTold) {
      AddFact(words_.force, fmt::format(fmt::runtime(words_.by_hand), FormatForce(step.force)),
              &facts);
    }
    if (!step.tool.empty()) {
      AddFact(words_.tool, Escape(TranslateTool(step.tool, options_.language)), &facts);
    }
    for (const WorkThread& thread : step.threads) {
      std::string text = thread.torque > 0 ? fmt::format(fmt::runtime(words_.tighten), thread.size,
                                                         thread.torque, 1e-3 * thread.preload)
                                           : fmt::format(fmt::runtime(words_.run_in), thread.size);
      if (thread.turns > 0) {
        text += fmt::format(fmt::runtime(words_.turns_of), thread.turns);
      }
      AddFact(words_.torque, text, &facts);
    }
    if (!step.holds.empty()) {
      AddFact(words_.hold, fmt::format(fmt::runtime(words_.until), NamesOf(step.holds)), &facts);
    }
    if (step.moved_aside.is_valid()) {
      AddFact(words_.aside, fmt::format(fmt::runtime(words_.moved_aside), NameOf(step.moved_aside)),
              &facts);
    }
    if (step.mods > 0) {
      const double recorded = SumRecorded(step);
      AddFact(words_.step_time,
              fmt::format("{} (MODAPTS), {} (BasicMOST)",
                          FormatSeconds(orders::kModSeconds * step.mods),
                          FormatSeconds(SumSeconds(ListMostSequences(step.motions)))) +
                  (recorded > 0 ? "; " + fmt::format(fmt::runtime(words_.recorded), recorded) : ""),
              &facts);
    }
    return facts.empty() ? "" : "<dl class=\"facts\">" + facts + "</dl>";
  }

  [[nodiscard]] std::string DescribeArrow(const OrderArrow& arrow) const {
    const std::string then = NameOf(arrow.then_part);
    const bool is_own = arrow.other == arrow.then_part;
    switch (arrow.reason) {
      case ArrowReason::kMeets:
        return is_own ? fmt::format(fmt::runtime(words_.before_own_meets), then)
                      : fmt::format(fmt::runtime(words_.before_meets), then, NameOf(arrow.other));
      case ArrowReason::kMate:
        return is_own ? fmt::format(fmt::runtime(words_.before_own_mate), then)
                      : fmt::format(fmt::runtime(words_.before_mate), then, NameOf(arrow.other));
      default:
        return fmt::format(fmt::runtime(words_.before_other), then);
    }
  }

  [[nodiscard]] std::string MakeWarnings(const WorkStep& step) const {
    std::string html;
    if (step.is_turned) {
      html += fmt::format("<p class=\"warning\">{}</p>", words_.turn_product);
    }
    // Parts of one name say the same of others.
    std::vector<std::string> told;
    for (const OrderArrow& arrow : step.before) {
      const std::string text = DescribeArrow(arrow);
      if (std::find(told.begin(), told.end(), text) == told.end()) {
        told.push_back(text);
      }
    }
    constexpr std::size_t kTold = 2;  // More are for the plan: a choice.
    for (std::size_t i = 0; i < std::min(kTold, told.size()); ++i) {
      html += fmt::format(
          "<p class=\"warning\"><b>{}:</b> {}{}</p>", words_.order, told[i],
          i + 1 == kTold && told.size() > kTold ? fmt::format(" (+{})", told.size() - kTold) : "");
    }
    return html;
  }

  [[nodiscard]] std::string MakeMotions(const WorkStep& step) const {
    if (step.motions.empty()) {
      return {};
    }
    std::string rows;
    for (const orders::HandMotion& motion : step.motions) {
      rows += fmt::format("<tr><td>{}</td><td class=\"l\">{}</td><td>{}</td><td>{:.3f}</td></tr>",
                          Escape(motion.code), Escape(DescribeMotion(motion, options_.language)),
                          motion.mods, orders::kModSeconds * motion.mods);
    }
    std::string sequences;
    for (const MostSequence& sequence : ListMostSequences(step.motions)) {
      sequences +=
          fmt::format("<tr><td>{}</td><td class=\"l\">{}</td><td>{:.0f}</td><td>{:.3f}</td></tr>",
                      sequence.code, Escape(DescribeSequence(sequence.purpose, options_.language)),
                      sequence.seconds / kTmuSeconds, sequence.seconds);
    }
    return fmt::format(
        "<details><summary>{}</summary><table><tr><th>MODAPTS</th><th></th><th>MOD</th>"
        "<th>s</th></tr>{}</table><table><tr><th>BasicMOST</th><th></th><th>TMU</th><th>s</th>"
        "</tr>{}</table></details>",
        words_.elements, rows, sequences);
  }

  [[nodiscard]] std::string MakeView(const WorkStep& step) {
    const StepPicture picture = DrawStep(model_, step, last_to_eye_);
    last_to_eye_ = picture.to_eye;
    if (picture.png.empty()) {
      return {};
    }
    const std::string& name = model_.product->occurrences[step.leading.front().index()].name;
    return fmt::format(
        "<div class=\"view\">{}<svg viewBox=\"0 0 {} {}\" aria-hidden=\"true\">{}</svg></div>",
        pages::MakeImage(picture.png, fmt::format(fmt::runtime(words_.picture), name),
                         picture.width, picture.height),
        picture.width, picture.height, picture.svg);
  }

  [[nodiscard]] std::string MakeStep(std::size_t i) {
    const WorkStep& step = plan_.steps[i];
    return fmt::format(
        "<section class=\"step\" id=\"step-{}\">{}<div><h3><span class=\"number\">{}</span> {}"
        "</h3>{}{}{}</div></section>\n",
        i + 1, MakeView(step), fmt::format(fmt::runtime(words_.step), i + 1),
        Escape(DescribeStep(model_, step, options_.language)), MakeFacts(step), MakeWarnings(step),
        MakeMotions(step));
  }

  [[nodiscard]] std::string MakeLeftOut() const {
    if (plan_.left_out.empty()) {
      return {};
    }
    std::string html = fmt::format("<p class=\"warning\">{}</p><ul>", words_.left_out_note);
    for (const OccurrenceId id : plan_.left_out) {
      html += fmt::format("<li>{}</li>", NameOf(id));
    }
    return html + "</ul>\n";
  }

  const simulation::Model& model_;
  const WorkPlan& plan_;
  const InstructionOptions& options_;
  const InstructionWords& words_;
  Vec3 last_to_eye_{Vec3::Zero()};
};

}  // namespace

Result<std::string> MakeInstructionPage(const simulation::Model& model, const WorkPlan& plan,
                                        const InstructionOptions& options) {
  return PageMaker(model, plan, options).Make();
}

}  // namespace hvas::shopfloor
