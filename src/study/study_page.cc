#include "study/study_page.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/units.h"
#include "pages/html_page.h"
#include "pages/svg_plot.h"
#include "study/analysis_page.h"
#include "study/figures.h"

namespace hvas::study {
namespace {

using pages::Escape;
using pages::MakeTile;
using pages::PlotFigure;
using pages::PlotPanel;
using pages::PlotSeries;
using pages::PlotStyle;

constexpr double kAlpha = 0.05;  // The usual level of significance.

constexpr const char* kStyle = R"(
.simulated{border-left:4px solid #bb430a;padding:.5rem .9rem;margin:1rem 0}
@media(prefers-color-scheme:dark){.simulated{border-color:#ff9c66}}
)";

constexpr const char* kSimulated =
    "<p class=\"simulated\"><strong>Simulated.</strong> These are no people: an arm that follows "
    "reaches, feels the force and searches, with a skill drawn for each participant. The numbers "
    "show that the study runs, and what a program does in it; they stand for nobody.</p>";

class StudyPage {
 public:
  StudyPage(const StudyFolder& folder, const std::vector<Participant>& participants)
      : folder_(folder), protocol_(folder.protocol()), participants_(participants) {
    simulated_ = static_cast<std::size_t>(
        std::count_if(participants.begin(), participants.end(),
                      [](const Participant& p) { return p.is_simulated; }));
  }

  Result<std::string> Make() {
    std::string body = "<h1>" + Escape(protocol_.title.en) + "</h1>";
    if (simulated_ > 0) {
      body += kSimulated;
    }
    body += MakeTiles() + MakeStudy() + MakeTimes();
    for (std::size_t b = 0; b < protocol_.blocks.size(); ++b) {
      const Result<std::string> part =
          protocol_.blocks[b].is_identification ? MakeIdentification(b) : MakeTimesAnalysis(b);
      if (!part) {
        return part;
      }
      body += *part;
    }
    body += MakeForces();
    const auto questions = MakeQuestions();
    if (!questions) {
      return questions;
    }
    body += *questions + MakeParticipants() + MakeHow();
    return pages::MakeHtmlPage(protocol_.title.en, body, kStyle);
  }

 private:
  [[nodiscard]] std::string DescribeSample() const {
    if (simulated_ == 0) {
      return "people";
    }
    return simulated_ == participants_.size() ? "simulated" : "people and simulated";
  }

  [[nodiscard]] std::string MakeTiles() const {
    std::size_t trials = 0;
    for (const Participant& participant : participants_) {
      trials += participant.session->done().size();
    }
    std::string tiles = "<ul class=\"tiles\">";
    tiles += MakeTile("participants, " + DescribeSample(), fmt::format("{}", participants_.size()));
    tiles += MakeTile("trials", fmt::format("{}", trials));
    tiles += MakeTile("conditions", fmt::format("{}", protocol_.conditions.size()));
    tiles += MakeTile("seed", fmt::format("{}", folder_.seed()));
    return tiles + "</ul>";
  }

  [[nodiscard]] std::string MakeStudy() const {
    std::string html = "<section><h2>The study</h2>";
    if (!protocol_.about.empty()) {
      html += "<p>" + Escape(protocol_.about) + "</p>";
    }
    html += fmt::format("<p>Protocol <code>{}</code>, digest <code>{}</code>.", protocol_.id,
                        protocol_.digest);
    if (!protocol_.source.empty()) {
      html += " After " + Escape(protocol_.source) + ".";
    }
    html +=
        "</p><div class=\"scroll\"><table><thead><tr><th class=\"l\">condition</th>"
        "<th class=\"l\">what is on</th><th>fit</th><th>its force</th><th>felt stiffness at most "
        "[N/m]</th><th>capture</th><th>time limit [s]</th></tr></thead><tbody>";
    for (const Condition& c : protocol_.conditions) {
      const bool has_mates = c.method == Method::kConstraint || c.method == Method::kHybrid;
      const bool has_force = c.method != Method::kPicking;
      html += fmt::format(
          "<tr><td class=\"l\">{}: {}</td><td class=\"l\">{}</td><td>{}</td><td>{}</td><td>{}</td>"
          "<td>{}</td><td>{:g}</td></tr>",
          c.id, Escape(c.name.en), Escape(DescribeMethod(c)),
          Escape(c.fit.empty() ? "as drawn" : c.fit),
          !has_mates                                     ? "-"
          : !c.renders_fits                              ? "not felt"
          : c.force_map == haptics::ForceMapKind::kPaper ? "rendered, with the paper's factors"
                                                         : "felt",
          has_force ? fmt::format("{:g}", c.coupling) : "-",
          has_mates
              ? fmt::format("{:g}&deg;, {:g} mm; faces {:g} mm", units::ToDeg(c.capture.angle),
                            units::ToMm(c.capture.axis_distance),
                            units::ToMm(c.capture.face_distance))
              : "-",
          c.time_limit);
    }
    return html + "</tbody></table></div></section>";
  }

  static std::string DescribeMethod(const Condition& condition) {
    const bool is_picked = condition.constraints == Constraints::kPicked;
    return ToText(condition.method) + (is_picked ? "; the axis is picked first" : "");
  }

  static std::string ToText(Method method) {
    switch (method) {
      case Method::kPicking:
        return "constraints set with the mouse";
      case Method::kCollision:
        return "collision only";
      case Method::kConstraint:
        return "constraints only; parts can interpenetrate";
      case Method::kHybrid:
        break;
    }
    return "collision and constraints";
  }

  /** Ids of conditions, the fastest first. */
  template <typename Time>
  std::string OrderBy(std::vector<ConditionTimes> times, const Time& time) const {
    std::stable_sort(times.begin(), times.end(),
                     [&](const auto& a, const auto& b) { return time(a) < time(b); });
    std::string text;
    for (const ConditionTimes& one : times) {
      text += (text.empty() ? "" : " &lt; ") + protocol_.conditions[one.condition].id;
    }
    return text;
  }

  [[nodiscard]] double PublishedOf(const ConditionTimes& times) const {
    return protocol_.conditions[times.condition].published_mean.value_or(0);
  }

  /** Mean times beside the published ones, and their order. */
  [[nodiscard]] std::string MakeTimes() const {
    const std::vector<ConditionTimes> times = SummariseTimes(protocol_, participants_);
    std::string html = fmt::format(
        "<section><h2>Mean times</h2><p>From the first tick of a trial to the one in which the "
        "part "
        "is in its place, {}: of all trials that were done; and of all trials, with the time limit "
        "for those that were not.</p>"
        "<div class=\"scroll\"><table><thead><tr><th class=\"l\">condition</th><th>trials</th>"
        "<th>done</th><th>mean of done, {} [s]</th><th>mean of all [s]</th><th>published, people "
        "[s]</th></tr></thead><tbody>",
        DescribeSample(), DescribeSample());
    std::vector<ConditionTimes> both;
    for (const ConditionTimes& one : times) {
      const auto& published = protocol_.conditions[one.condition].published_mean;
      html += fmt::format(
          "<tr><td class=\"l\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
          protocol_.conditions[one.condition].id, one.trials, one.done,
          one.done > 0 ? fmt::format("{:.2f}", one.mean) : "-",
          one.trials > 0 ? fmt::format("{:.2f}", one.restricted_mean) : "-",
          published ? fmt::format("{:g}", *published) : "not printed");
      if (one.done > 0 && published) {
        both.push_back(one);
      }
    }
    html += "</tbody></table></div>";
    if (both.size() > 1) {
      const std::string here = OrderBy(both, [](const auto& t) { return t.restricted_mean; });
      const std::string there = OrderBy(both, [&](const auto& t) { return PublishedOf(t); });
      html += fmt::format(
          "<p class=\"verdict\">Order here ({}, of all): {}. Order published: {}. {}</p>",
          DescribeSample(), here, there,
          here == there ? "They agree." : "They do <strong>not</strong> agree.");
      html += MakePercents(both);
    }
    return html + "</section>";
  }

  /** How far below each other the means are, as paper X has it. */
  [[nodiscard]] std::string MakePercents(const std::vector<ConditionTimes>& both) const {
    const auto fastest = *std::min_element(
        both.begin(), both.end(),
        [&](const auto& a, const auto& b) { return PublishedOf(a) < PublishedOf(b); });
    std::string html = "<ul>";
    for (const ConditionTimes& one : both) {
      if (one.condition != fastest.condition) {
        html += fmt::format("<li>{} below {}: {:.1f} % here, {:.1f} % published.</li>",
                            protocol_.conditions[fastest.condition].id,
                            protocol_.conditions[one.condition].id,
                            100 * (1 - fastest.restricted_mean / one.restricted_mean),
                            100 * (1 - PublishedOf(fastest) / PublishedOf(one)));
      }
    }
    return html + "</ul>";
  }

  [[nodiscard]] std::string NameOf(const Block& block) const {
    return Escape(block.name.empty() ? block.id : block.name.en);
  }

  /** Nothing where there are too few for a comparison. */
  Result<std::string> MakeTimesAnalysis(std::size_t b) const {
    const Table table = RemoveEmptyRows(MakeTimesTable(protocol_, b, participants_));
    std::string html = fmt::format("<h2>Times: {}</h2>", NameOf(protocol_.blocks[b]));
    if (table.rows.size() < 2 || table.conditions.size() < 2 || !HasAllColumns(table)) {
      return html + "<p>There are too few results to compare.</p>";
    }
    AnalysisOptions options;
    options.alpha = kAlpha;
    options.direction = Direction::kLowerIsBetter;
    const auto analysis = Analyse(table, options);
    if (!analysis) {
      return Unexpected(analysis.error());
    }
    return html + "<p>Of each participant the mean of the trials that were done.</p>" +
           MakeAnalysisHtml(*analysis, "t" + protocol_.blocks[b].id);
  }

  static bool HasAllColumns(const Table& table) {
    for (std::size_t c = 0; c < table.conditions.size(); ++c) {
      if (std::none_of(table.rows.begin(), table.rows.end(),
                       [c](const Row& row) { return row.values[c].has_value(); })) {
        return false;
      }
    }
    return true;
  }

  Result<std::string> MakeIdentification(std::size_t b) const {
    const Block& block = protocol_.blocks[b];
    std::string html = fmt::format("<h2>{}</h2>", NameOf(block));
    const std::vector<IdentificationAnswer> answers = CollectAnswers(protocol_, b, participants_);
    if (answers.empty()) {
      return html + "<p>Nobody has answered yet.</p>";
    }
    if (simulated_ > 0) {
      html +=
          "<p>The simulated participants are shown the felt force of an insertion and compare it "
          "with what they learned, within published thresholds of perception; nothing moves, so "
          "these trials have no times.</p>";
    }
    const auto identification = AnalyseIdentification(answers, kAlpha);
    if (!identification) {
      return Unexpected(identification.error());
    }
    html += MakeIdentificationHtml(*identification, "i" + block.id);
    const Table table = RemoveEmptyRows(MakeRightAnswersTable(protocol_, b, participants_));
    if (table.rows.size() >= 2 && table.conditions.size() >= 2 && HasAllColumns(table)) {
      AnalysisOptions options;
      options.alpha = kAlpha;
      options.of = block.repetitions;
      options.direction = Direction::kHigherIsBetter;
      const auto analysis = Analyse(table, options);
      if (!analysis) {
        return Unexpected(analysis.error());
      }
      html += MakeAnalysisHtml(*analysis, "r" + block.id);
    }
    return html + MakePublishedShares(block, answers);
  }

  [[nodiscard]] std::string MakePublishedShares(
      const Block& block, const std::vector<IdentificationAnswer>& answers) const {
    std::string rows;
    for (const std::size_t c : block.conditions) {
      const Condition& condition = protocol_.conditions[c];
      if (!condition.published_right_share) {
        continue;
      }
      int shown = 0;
      int right = 0;
      for (const IdentificationAnswer& answer : answers) {
        const bool is_this = answer.shown == AnswerNameOf(condition);
        shown += is_this ? 1 : 0;
        right += is_this && answer.answered == answer.shown ? 1 : 0;
      }
      rows += fmt::format("<tr><td class=\"l\">{}</td><td>{:.1f}</td><td>{:.1f}</td></tr>",
                          Escape(AnswerNameOf(condition)), 100.0 * right / std::max(1, shown),
                          100 * *condition.published_right_share);
    }
    if (rows.empty()) {
      return "";
    }
    return fmt::format(
        "<div class=\"scroll\"><table><thead><tr><th class=\"l\">shown</th><th>right, {} [%]</th>"
        "<th>right, published, people [%]</th></tr></thead><tbody>{}</tbody></table></div>",
        DescribeSample(), rows);
  }

  /** The last trial of a condition that has forces, of the first participant who has one. */
  [[nodiscard]] const DoneTrial* FindExample(std::size_t condition, std::string* whose) const {
    for (const Participant& participant : participants_) {
      const auto& done = participant.session->done();
      for (auto it = done.rbegin(); it != done.rend(); ++it) {
        const bool is_of = participant.session->schedule()[it->index].condition == condition;
        if (is_of && !it->result.mating.empty() && it->result.outcome == Outcome::kDone) {
          *whose = participant.id;
          return &*it;
        }
      }
    }
    return nullptr;
  }

  static PlotSeries MakeSeries(const std::string& name, int color, const TrialResult& result,
                               double (*get)(const MatingSample&)) {
    PlotSeries series{name, PlotStyle::kLine, color, {}};
    for (const MatingSample& sample : result.mating) {
      series.points.push_back({sample.t, get(sample)});
    }
    return series;
  }

  static PlotPanel MakePanel(const std::string& title, const std::string& y_label) {
    PlotPanel panel;
    panel.title = title;
    panel.x_label = "before the part is in its place [s]";
    panel.y_label = y_label;
    return panel;
  }

  static std::string PlotForces(const std::string& condition, const TrialResult& result) {
    PlotPanel forces = MakePanel(condition + ": force on the hand", "force [N]");
    forces.series = {MakeSeries("F_x", 0, result, [](const MatingSample& s) { return s.f.x(); }),
                     MakeSeries("F_y", 1, result, [](const MatingSample& s) { return s.f.y(); }),
                     MakeSeries("F_z", 2, result, [](const MatingSample& s) { return s.f.z(); })};
    PlotPanel torques = MakePanel(condition + ": torque on the hand", "torque [N m]");
    torques.series = {
        MakeSeries("T_x", 0, result, [](const MatingSample& s) { return s.torque.x(); }),
        MakeSeries("T_y", 1, result, [](const MatingSample& s) { return s.torque.y(); })};
    PlotFigure figure;
    figure.panels = {forces, torques};
    figure.description =
        "Force and torque on the hand over the last seconds of a trial under condition " +
        condition;
    figure.id = "f" + condition;
    return pages::ToSvg(figure);
  }

  [[nodiscard]] std::string MakeForces() const {
    std::string html = fmt::format(
        "<section><h2>Forces of the mating</h2><p>Of the last {:g} s of a trial; z is the way out "
        "of the hole, so that a force that draws the part in is negative. One trial of each "
        "condition is drawn, the last of the first participant; the table is of all.</p>",
        protocol_.mating_window);
    html += MakeSteadiness();
    for (std::size_t c = 0; c < protocol_.conditions.size(); ++c) {
      std::string whose;
      if (const DoneTrial* example = FindExample(c, &whose)) {
        html += fmt::format("<figure>{}<figcaption>{}, trial {} of {}{}</figcaption></figure>",
                            PlotForces(protocol_.conditions[c].id, example->result),
                            Escape(protocol_.conditions[c].name.en), example->index + 1, whose,
                            simulated_ > 0 ? ", simulated" : "");
      }
    }
    return html + "</section>";
  }

  /** How steady the force is: from one sample to the next, a hundredth of a second later. */
  [[nodiscard]] std::string MakeSteadiness() const {
    std::string html =
        "<div class=\"scroll\"><table><thead><tr><th class=\"l\">condition</th><th>trials</th>"
        "<th>largest force [N]</th><th>mean across the axis [N]</th><th>mean along it [N]</th>"
        "<th>change in 10 ms, r.m.s. [N]</th></tr></thead><tbody>";
    for (std::size_t c = 0; c < protocol_.conditions.size(); ++c) {
      std::size_t trials = 0;
      std::size_t samples = 0;
      std::size_t changes = 0;
      double largest = 0;
      double across = 0;
      double along = 0;
      double squares = 0;
      ForEachResult(c, [&](const TrialResult& result) {
        ++trials;
        for (std::size_t i = 0; i < result.mating.size(); ++i) {
          const Vec3& f = result.mating[i].f;
          largest = std::max(largest, f.norm());
          across += std::hypot(f.x(), f.y());
          along += f.z();
          ++samples;
          if (i > 0) {
            squares += (f - result.mating[i - 1].f).squaredNorm();
            ++changes;
          }
        }
      });
      if (samples > 0 && changes > 0) {
        const auto n = static_cast<double>(samples);
        html += fmt::format(
            "<tr><td class=\"l\">{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td>"
            "<td>{:.3f}</td></tr>",
            protocol_.conditions[c].id, trials, largest, across / n, along / n,
            std::sqrt(squares / static_cast<double>(changes)));
      }
    }
    return html + "</tbody></table></div>";
  }

  template <typename Visit>
  void ForEachResult(std::size_t condition, const Visit& visit) const {
    for (const Participant& participant : participants_) {
      for (const DoneTrial& done : participant.session->done()) {
        if (participant.session->schedule()[done.index].condition == condition &&
            !done.result.mating.empty()) {
          visit(done.result);
        }
      }
    }
  }

  Result<std::string> MakeQuestions() const {
    if (protocol_.questions.empty()) {
      return "";
    }
    std::string html = "<section><h2>Answers</h2>";
    if (simulated_ > 0) {
      html +=
          "<p>Simulated participants answer no questions: they have no opinions, and numbers made "
          "up for them would only say what was made up.</p>";
    }
    Table table = RemoveEmptyRows(MakeScalesTable(protocol_, participants_));
    DropEmptyColumns(&table);
    if (table.rows.empty()) {
      return html + (simulated_ < participants_.size() ? "<p>Nobody has answered yet.</p>" : "") +
             "</section>";
    }
    html +=
        "<div class=\"scroll\"><table><thead><tr><th class=\"l\">question</th><th>answers</th>"
        "<th>minimum</th><th>first quartile</th><th>median</th><th>third quartile</th>"
        "<th>maximum</th><th>mean</th></tr></thead><tbody>";
    for (std::size_t c = 0; c < table.conditions.size(); ++c) {
      std::vector<double> values;
      for (const Row& row : table.rows) {
        if (row.values[c]) {
          values.push_back(*row.values[c]);
        }
      }
      const auto s = statistics::Summarise(values);
      if (!s) {
        return Unexpected(s.error());
      }
      html += fmt::format(
          "<tr><td class=\"l\">{}</td><td>{}</td><td>{:g}</td><td>{:g}</td><td>{:g}</td>"
          "<td>{:g}</td><td>{:g}</td><td>{:.2f}</td></tr>",
          Escape(TextOf(table.conditions[c])), values.size(), s->min, s->lower_quartile, s->median,
          s->upper_quartile, s->max, s->mean);
    }
    html += "</tbody></table></div>";
    if (table.rows.size() >= 2 && table.conditions.size() >= 2) {
      const auto analysis = Analyse(table, {});
      if (!analysis) {
        return Unexpected(analysis.error());
      }
      html += "<figure>" + DrawBoxes(*analysis, "questions") + "</figure>";
    }
    return html + "</section>";
  }

  static void DropEmptyColumns(Table* table) {
    for (std::size_t c = table->conditions.size(); c-- > 0;) {
      const bool is_empty = std::none_of(table->rows.begin(), table->rows.end(),
                                         [c](const Row& row) { return row.values[c].has_value(); });
      if (is_empty) {
        const auto at = static_cast<std::ptrdiff_t>(c);
        table->conditions.erase(table->conditions.begin() + at);
        for (Row& row : table->rows) {
          row.values.erase(row.values.begin() + at);
        }
      }
    }
  }

  [[nodiscard]] std::string TextOf(const std::string& question) const {
    for (const Question& one : protocol_.questions) {
      if (one.id == question) {
        return one.text.en;
      }
    }
    return question;
  }

  /** Who took part, how far they came, and what was left out. */
  [[nodiscard]] std::string MakeParticipants() const {
    std::string html =
        "<section><h2>Participants, interruptions, exclusions</h2><div class=\"scroll\"><table>"
        "<thead><tr><th class=\"l\">participant</th><th class=\"l\">phase</th><th>trials</th>"
        "<th>in time</th><th>timed out</th><th>not done</th><th class=\"l\">interruptions</th>"
        "</tr></thead><tbody>";
    for (const Participant& participant : participants_) {
      std::array<int, kOutcomes.size()> outcomes{};
      for (const DoneTrial& done : participant.session->done()) {
        ++outcomes.at(static_cast<std::size_t>(done.result.outcome));
      }
      std::string interruptions;
      for (const std::string& reason : participant.session->interruptions()) {
        interruptions += (interruptions.empty() ? "" : "; ") + Escape(reason);
      }
      html += fmt::format(
          "<tr><td class=\"l\">{}{}</td><td class=\"l\">{}</td><td>{} of {}</td><td>{}</td>"
          "<td>{}</td><td>{}</td><td class=\"l\">{}</td></tr>",
          participant.id, participant.is_simulated ? " (simulated)" : "",
          ToString(participant.session->phase()), participant.session->done().size(),
          participant.session->schedule().size(), outcomes[0], outcomes[1], outcomes[2],
          interruptions.empty() ? "none" : interruptions);
    }
    return html +
           "</tbody></table></div><p>Trials that timed out or were not done have no completion "
           "time: they are counted, and left out of the means. Nobody else was left out.</p>"
           "</section>";
  }

  [[nodiscard]] std::string MakeHow() const {
    std::string html = fmt::format(
        "<section><h2>How it can be done again</h2><p>Orders, skills, sizes and trials are drawn "
        "from seed {}; the protocol with digest <code>{}</code> is in the study's folder.",
        folder_.seed(), protocol_.digest);
    if (simulated_ > 0) {
      html += fmt::format(
          " <code>hvas study run protocol.yaml --simulated {} --seed {}</code> "
          "gives the same journals, byte by byte.",
          simulated_, folder_.seed());
    }
    return html + "</p></section>";
  }

  const StudyFolder& folder_;
  const Protocol& protocol_;
  const std::vector<Participant>& participants_;
  std::size_t simulated_{0};
};

}  // namespace

Result<std::string> MakeStudyPage(const StudyFolder& folder,
                                  const std::vector<Participant>& participants) {
  return StudyPage(folder, participants).Make();
}

}  // namespace hvas::study
