#include "app/assembly/plan_report.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "app/assembly/gap_reason_json.h"
#include "app/assembly/left_out.h"
#include "app/assembly/plan_file.h"
#include "app/assembly/run_report.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "pages/html_page.h"
#include "shopfloor/order_arrow.h"

namespace hvas::app {
namespace {

using assembly::BestOrder;
using orders::FoundOrder;
using orders::FreeMove;
using orders::OrderCounts;
using pages::Escape;
using pages::MakeTile;
using product::OccurrenceId;
using shopfloor::ArrowReason;
using shopfloor::ListArrows;
using shopfloor::OrderArrow;

std::string DescribeReason(const PlanReport& report, const OrderArrow& arrow) {
  const auto other = [&] { return PathOf(*report.model, arrow.other); };
  switch (arrow.reason) {
    case ArrowReason::kMeets:
      return fmt::format("it would meet {} {:.1f} mm before its place", other(),
                         units::ToMm(arrow.travelled));
    case ArrowReason::kMate:
      return fmt::format("a mate with {} leaves it no way in", other());
    case ArrowReason::kMovedAside:
      return fmt::format("{} is moved aside for it, which was found without it", other());
    case ArrowReason::kGiving:
      return "parts give on its way, which was found without it";
    case ArrowReason::kTurning:
      return "its way turns, and was found without it";
  }
  return {};
}

nlohmann::ordered_json MakeIds(const std::vector<OccurrenceId>& ids) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const OccurrenceId id : ids) {
    json.push_back(id.value());
  }
  return json;
}

nlohmann::ordered_json ToJson(const OrderCounts& counts) {
  return {{"turns", counts.turns},
          {"direction_changes", counts.direction_changes},
          {"tool_changes", counts.tool_changes},
          {"loose", counts.loose},
          {"cramped", counts.cramped},
          {"reach_m", counts.reach},
          {"force_n", counts.force},
          {"hand_time_s", counts.hand_time()}};
}

/** Leading parts of the moves, as an order has them. */
std::vector<OccurrenceId> ListLeaders(const assembly::OrderPlan& plan, const FoundOrder& order) {
  std::vector<OccurrenceId> leaders;
  for (const std::size_t move : order.moves) {
    leaders.push_back(plan.rules.moves[move].parts.front());
  }
  return leaders;
}

nlohmann::ordered_json ToJson(const PlanReport& report, const FoundOrder& order) {
  nlohmann::ordered_json json{{"cost", order.cost}};
  json.update(ToJson(order.counts));
  const std::vector<FoundOrder>& orders = report.plan->search.orders;
  const auto place = static_cast<std::size_t>(&order - orders.data());
  if (place < orders.size() && place < report.plan->statics.size()) {
    json["held_states"] = report.plan->statics[place].held_states;
    json["states_looked_at"] = report.plan->statics[place].looked_at;
  }
  json["parts"] = MakeIds(ListLeaders(*report.plan, order));
  return json;
}

/** What has to be held after a move of the best order; none where it was not looked at. */
std::optional<std::vector<OccurrenceId>> HoldsAfter(const assembly::OrderPlan& plan,
                                                    std::size_t place) {
  if (plan.statics.empty()) {
    return std::nullopt;
  }
  return plan.statics.front().holds[place];
}

nlohmann::ordered_json MakeMovesJson(const PlanReport& report) {
  const assembly::OrderPlan& plan = *report.plan;
  const FoundOrder& best = BestOrder(plan);
  const std::vector<orders::HandWork> work = orders::ListHandWork(plan.rules, best);
  nlohmann::ordered_json moves = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < best.moves.size(); ++i) {
    const std::size_t m = best.moves[i];
    const FreeMove& move = plan.rules.moves[m];
    const sequence::SequenceStep& step = move.ways[best.ways[i]].step;
    const Vec3 direction = step.extraction_W + Vec3::Zero();  // A zero has no sign for people.
    nlohmann::ordered_json json{{"id", step.occurrence.value()},
                                {"name", PathOf(*report.model, step.occurrence)},
                                {"members", MakeIds(step.members)},
                                {"out", {direction.x(), direction.y(), direction.z()}},
                                {"engaged_mm", units::ToMm(step.engage_distance)},
                                {"turns", !step.way.empty()},
                                {"ways", move.ways.size()},
                                {"reach_mm", units::ToMm(work[i].reach)},
                                {"force_n", work[i].force},
                                {"fits_n", work[i].press},
                                {"hand_time_s", orders::kModSeconds * work[i].mods}};
    if (move.aside) {
      json["moved_aside"] = MakeAsideJson(*report.model, *move.aside);
    }
    if (!move.tool.empty()) {
      json["tool"] = move.tool;
      json["in_tool_space"] = MakeIds(orders::ListInToolSpace(plan.rules, best, i));
    }
    if (!plan.statics.empty()) {
      const Vec3 up_W = plan.statics.front().up_W[i] + Vec3::Zero();
      json["up"] = {up_W.x(), up_W.y(), up_W.z()};
    }
    if (const auto& holds = HoldsAfter(plan, i)) {
      json["holds"] = MakeIds(*holds);
    }
    moves.push_back(std::move(json));
  }
  return moves;
}

nlohmann::ordered_json MakeArrowsJson(const PlanReport& report) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const OrderArrow& arrow : ListArrows(report.plan->rules)) {
    const auto leader = [&](std::size_t move) {
      return report.plan->rules.moves[move].parts.front().value();
    };
    json.push_back({{"first", leader(arrow.first)},
                    {"then", leader(arrow.then)},
                    {"certain", arrow.is_certain},
                    {"implied", arrow.is_implied},
                    {"reason", DescribeReason(report, arrow)}});
  }
  return json;
}

std::string DescribeCounts(const OrderCounts& counts, double cost) {
  return fmt::format(
      "cost {:.4g}: {} turns of the product, {} changes of direction, {} of tool, {} "
      "parts that nothing holds, {} fasteners whose tool has less room than in other orders; in "
      "all moves together the hand reaches in by {:.2f} m, needs {:.3g} N and takes about {:.0f} s",
      cost, counts.turns, counts.direction_changes, counts.tool_changes, counts.loose,
      counts.cramped, counts.reach, counts.force, counts.hand_time());
}

/** The paths of a few parts. */
std::string DescribeParts(const simulation::Model& model, const std::vector<OccurrenceId>& parts) {
  constexpr std::size_t kNamed = 3;  // As many as fit into a line or two: a choice.
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, parts.size()); ++i) {
    text += (i == 0 ? "" : ", ") + PathOf(model, parts[i]);
  }
  return parts.size() > kNamed ? text + fmt::format(" and {} more", parts.size() - kNamed) : text;
}

/** How the fixture holds the base at first; empty where that is not known. */
std::string DescribeFixture(const PlanReport& report) {
  const assembly::OrderPlan& plan = *report.plan;
  if (plan.statics.empty() || plan.statics.front().up_W.empty()) {
    return {};
  }
  const std::string margin = plan.standing_margin > 0
                                 ? fmt::format("it stands by itself, and tips at {:.0f} degrees",
                                               units::ToDeg(plan.standing_margin))
                                 : "it does not stand by itself, and has to be held";
  return fmt::format("Fixture: {} with {} upwards; {}.",
                     PathOf(*report.model, sequence::FindBase(report.model->sequence)),
                     sequence::DescribeDirection(plan.statics.front().up_W.front()), margin);
}

/** The side that is upwards from a move of the best order on, where the product is turned for it;
 empty where it is not. */
std::string DescribeTurn(const assembly::OrderPlan& plan, std::size_t place) {
  if (plan.statics.empty() || place == 0) {
    return {};
  }
  const std::vector<Vec3>& ups = plan.statics.front().up_W;
  return ups[place] != ups[place - 1] ? sequence::DescribeDirection(ups[place]) : "";
}

std::string DescribeHolds(const assembly::OrderPlan& plan, std::size_t order) {
  return order < plan.statics.size()
             ? fmt::format(", something to hold in {} of {} states",
                           plan.statics[order].held_states, plan.statics[order].looked_at)
             : std::string();
}

void PrintOrder(const std::string& name, const FoundOrder& order, const std::string& more) {
  fmt::print("{}", Wrap(name + DescribeCounts(order.counts, order.cost) + more + ".", 0));
}

std::string DescribeSearch(const assembly::OrderPlan& plan) {
  return fmt::format("{} orders found with {} tries{}", plan.search.orders.size(),
                     plan.search.tries, plan.search.is_ended_early ? ", ended early" : "");
}

/** A move of the best order as tables show it. */
struct MoveRow {
  std::string part;  // The leading part, and how many move with it.
  std::string way;
  std::string aside;          // Says what is moved aside to let it pass; empty: nothing is.
  std::string tool;           // Empty: none.
  std::string turned;         // The side that is then upwards; empty: it is not turned before it.
  std::string in_tool_space;  // Says what stands where the tool turns; empty: nothing does.
  std::string holds;          // What has to be held after it; empty: nothing, or not known.
  std::vector<OrderArrow> arrows;  // What it has to come before, but for what others imply.
};

std::vector<MoveRow> ListRows(const PlanReport& report) {
  const simulation::Model& model = *report.model;
  const assembly::OrderPlan& plan = *report.plan;
  const FoundOrder& best = BestOrder(plan);
  const std::vector<OrderArrow> arrows = ListArrows(plan.rules);
  std::vector<MoveRow> rows;
  for (std::size_t i = 0; i < best.moves.size(); ++i) {
    const std::size_t m = best.moves[i];
    const sequence::SequenceStep& step = plan.rules.moves[m].ways[best.ways[i]].step;
    MoveRow& row = rows.emplace_back();
    row.part = PathOf(model, step.occurrence);
    row.part += step.members.empty() ? "" : fmt::format(" and {} more", step.members.size());
    row.way = step.way.empty() ? sequence::DescribeDirection(step.extraction_W) : "turns";
    if (const auto& aside = plan.rules.moves[m].aside) {
      row.aside =
          fmt::format("{} {} aside by {:.1f} mm", PathOf(model, aside->occurrence),
                      aside->way.empty() ? "moved" : "turned", units::ToMm(aside->engage_distance));
    }
    row.tool = plan.rules.moves[m].tool;
    row.turned = DescribeTurn(plan, i);
    const auto in_tool_space = orders::ListInToolSpace(plan.rules, best, i);
    if (!in_tool_space.empty()) {
      row.in_tool_space =
          fmt::format("no room for a {} beside {}", plan.rules.moves[m].tool_of_space,
                      DescribeParts(model, in_tool_space));
    }
    const auto& holds = HoldsAfter(plan, i);
    row.holds = holds ? DescribeParts(model, *holds) : "";
    std::copy_if(arrows.begin(), arrows.end(), std::back_inserter(row.arrows),
                 [m](const OrderArrow& arrow) { return arrow.first == m && !arrow.is_implied; });
  }
  return rows;
}

/** The leading part of what comes after a move. */
const std::string& PathOfLater(const PlanReport& report, const OrderArrow& arrow) {
  return PathOf(*report.model, report.plan->rules.moves[arrow.then].parts.front());
}

std::string MakeOrderTable(const PlanReport& report) {
  std::string html =
      "<h2>Order</h2>\n<div class=\"scroll\"><table><tr><th>#</th><th class=\"l\">part</th>"
      "<th class=\"l\">way out</th><th class=\"l\">tool</th><th class=\"l\">to hold after it</th>"
      "<th class=\"l\">has to come before</th></tr>\n";
  html += fmt::format(
      "<tr><td>0</td><td class=\"l\">{}</td><td "
      "class=\"l\">base</td><td></td><td></td><td></td></tr>\n",
      Escape(PathOf(*report.model, sequence::FindBase(report.model->sequence))));
  int number = 0;
  for (const MoveRow& row : ListRows(report)) {
    std::string before;
    for (const OrderArrow& arrow : row.arrows) {
      if (arrow.reason != ArrowReason::kMeets && arrow.reason != ArrowReason::kMate) {
        continue;
      }
      before += fmt::format(
          "{}{}<span class=\"soft\">, {}{}</span>", before.empty() ? "" : "<br>",
          Escape(PathOfLater(report, arrow)),
          arrow.reason == ArrowReason::kMate
              ? "a mate leaves no way in"
              : fmt::format("met {:.1f} mm before the place", units::ToMm(arrow.travelled)),
          arrow.is_certain ? "" : ", on this way");
    }
    if (!row.turned.empty()) {
      html += fmt::format(
          "<tr><td></td><td class=\"l\" colspan=\"5\">turn the product, {} "
          "upwards</td></tr>\n",
          row.turned);
    }
    const std::string tool = row.in_tool_space.empty()
                                 ? Escape(row.tool)
                                 : fmt::format("{}<span class=\"soft\">, {}</span>",
                                               Escape(row.tool), Escape(row.in_tool_space));
    html += fmt::format(
        "<tr><td>{}</td><td class=\"l\">{}</td><td class=\"l\">{}</td><td class=\"l\">{}</td>"
        "<td class=\"l\">{}</td><td class=\"l\">{}</td></tr>\n",
        ++number,
        Escape(row.part) +
            (row.aside.empty()
                 ? ""
                 : fmt::format("<br><span class=\"soft\">with {}</span>", Escape(row.aside))),
        row.way, tool, Escape(row.holds), before);
  }
  return html + "</table></div>\n";
}

std::string MakeComparison(const assembly::OrderPlan& plan) {
  std::string html = "<h2>Orders compared</h2>\n<ul>\n";
  for (std::size_t i = 0; i < plan.search.orders.size(); ++i) {
    const FoundOrder& order = plan.search.orders[i];
    html += fmt::format("<li>{}{}</li>\n", DescribeCounts(order.counts, order.cost),
                        DescribeHolds(plan, i));
  }
  return html + fmt::format("<li>{} <span class=\"soft\">(as first found)</span></li>\n</ul>\n",
                            DescribeCounts(plan.search.planned.counts, plan.search.planned.cost));
}

}  // namespace

nlohmann::ordered_json MakePlanJson(const PlanReport& report) {
  const simulation::Model& model = *report.model;
  const assembly::OrderPlan& plan = *report.plan;
  nlohmann::ordered_json json{{"product", model.product->name},
                              {"source", model.product->source},
                              {"seed", model.seed},
                              {"preparation_s", report.preparation_s},
                              {"planning_s", report.planning_s},
                              {"base", PathOf(model, sequence::FindBase(model.sequence))},
                              {"moves", MakeMovesJson(report)},
                              {"arrows", MakeArrowsJson(report)},
                              {"weights",
                               {{"turn", report.weights.turn},
                                {"direction_change", report.weights.direction_change},
                                {"tool_change", report.weights.tool_change},
                                {"loose", report.weights.loose},
                                {"cramped", report.weights.cramped},
                                {"reach_per_m", report.weights.reach},
                                {"force_per_n", report.weights.force},
                                {"hand_time_per_s", report.weights.hand_time}}}};
  if (!plan.statics.empty()) {
    json["base_tips_at_deg"] = units::ToDeg(plan.standing_margin);
  }
  json["orders"] = nlohmann::ordered_json::array();
  for (const FoundOrder& order : plan.search.orders) {
    json["orders"].push_back(ToJson(report, order));
  }
  json["planned"] = ToJson(report, plan.search.planned);
  json["search"] = {{"tries", plan.search.tries},
                    {"width", plan.search.width},
                    {"ended_early", plan.search.is_ended_early}};
  json["left_out"] = nlohmann::ordered_json::array();
  for (const sequence::SequenceGap& gap : model.sequence.gaps) {
    json["left_out"].push_back({{"id", gap.occurrence.value()},
                                {"name", PathOf(model, gap.occurrence)},
                                {"reason", gap.reason}});
    if (const auto* reason = FindReason({&model, &plan.reasons}, gap.occurrence)) {
      json["left_out"].back()["why"] = MakeGapReasonJson(model, *reason);
    }
  }
  json["followed"] =
      MakeFollowedPlan(*model.product, orders::ListSteps(plan.rules, BestOrder(plan)));
  return json;
}

/** What stands below a row: what comes before it, what is done with it, and what it needs. */
std::string DescribeBelow(const PlanReport& report, const MoveRow& row) {
  std::string below;
  if (!row.arrows.empty()) {
    const OrderArrow& first = row.arrows.front();
    below = fmt::format("before {}: {}", PathOfLater(report, first), DescribeReason(report, first));
    below +=
        row.arrows.size() > 1 ? fmt::format("; and before {} more", row.arrows.size() - 1) : "";
  }
  if (!row.aside.empty()) {
    below = fmt::format("with {}{}{}", row.aside, below.empty() ? "" : "; ", below);
  }
  if (!row.holds.empty()) {
    below += (below.empty() ? "hold " : "; hold ") + row.holds;
  }
  if (!row.turned.empty()) {
    below = fmt::format("turn the product first, {} upwards{}{}", row.turned,
                        below.empty() ? "" : "; ", below);
  }
  if (!row.in_tool_space.empty()) {
    below += (below.empty() ? "" : "; ") + row.in_tool_space;
  }
  return below;
}

void PrintPlanTable(const PlanReport& report) {
  const simulation::Model& model = *report.model;
  const assembly::OrderPlan& plan = *report.plan;
  TextTable table({"  #", "part", "way", "tool"}, 2);
  table.Add({"  0", PathOf(model, sequence::FindBase(model.sequence)), "base", ""});
  int number = 0;
  for (const MoveRow& row : ListRows(report)) {
    table.Add({fmt::format("{:3}", ++number), row.part, row.way, row.tool},
              DescribeBelow(report, row));
  }
  fmt::print("{}\n", table.ToText());
  const std::string fixture = DescribeFixture(report);
  if (!fixture.empty()) {
    fmt::print("{}", Wrap(fixture, 0));
  }
  PrintOrder("Best order: ", BestOrder(plan), DescribeHolds(plan, 0));
  PrintOrder("As first found: ", plan.search.planned, "");
  for (std::size_t i = 1; i < plan.search.orders.size(); ++i) {
    PrintOrder(fmt::format("Alternative {}: ", i), plan.search.orders[i], DescribeHolds(plan, i));
  }
  PrintLeftOut({&model, &plan.reasons});
  fmt::print("{}", Wrap(fmt::format("{}; preparation {:.1f} s, planning {:.1f} s.",
                                    DescribeSearch(plan), report.preparation_s, report.planning_s),
                        0));
}

std::string MakePlanPage(const PlanReport& report) {
  const simulation::Model& model = *report.model;
  const assembly::OrderPlan& plan = *report.plan;
  const FoundOrder& best = BestOrder(plan);
  std::string body = fmt::format(
      "<h1>{}: plan of the assembly</h1>\n<ul class=\"tiles\">{}{}{}{}{}{}</ul>\n",
      Escape(model.product->name), MakeTile("moves", fmt::format("{}", best.moves.size())),
      MakeTile("left out", fmt::format("{}", model.sequence.gaps.size())),
      MakeTile("turns of the product", fmt::format("{}", best.counts.turns)),
      MakeTile("changes of direction", fmt::format("{}", best.counts.direction_changes)),
      MakeTile("changes of tool", fmt::format("{}", best.counts.tool_changes)),
      MakeTile("time of the hand, about", fmt::format("{:.0f} s", best.counts.hand_time())));
  const std::string fixture = DescribeFixture(report);
  body += fixture.empty() ? "" : fmt::format("<p>{}</p>\n", Escape(fixture));
  body +=
      MakeOrderTable(report) + MakeComparison(plan) + MakeLeftOutSection({&model, &plan.reasons});
  body += fmt::format("<p class=\"soft\">{}. No order is proved to be the best.</p>\n",
                      DescribeSearch(plan));
  return pages::MakeHtmlPage(model.product->name + ": plan of the assembly", body);
}

}  // namespace hvas::app
