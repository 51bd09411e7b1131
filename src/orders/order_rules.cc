#include "orders/order_rules.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "orders/fastener_tool.h"
#include "orders/state_statics.h"
#include "orders/tool_space.h"

namespace hvas::orders {
namespace {

using product::OccurrenceId;

// The ways of one move that are kept: more have never been of use in an order. A choice.
constexpr std::size_t kMostWaysOfMove = 8;

class RuleFinder {
 public:
  RuleFinder(const simulation::Model& model, const OrderRuleOptions& options)
      : model_(model),
        options_(options),
        input_(simulation::MakeSequenceInput(model, &scene_)),
        extraction_(input_, &model.sequence),
        tools_(FindTools(*model.product)) {}

  OrderRules Find() {
    SplitSteps();
    ShowAll();
    RankUpSides();
    EffortFinder efforts(model_, &extraction_, move_of_);
    for (std::size_t m = 0; m < rules_.moves.size(); ++m) {
      FindWays(m);
      FindHolders(m);
      FindToolSpace(m);
      FindEffort(m, &efforts);
      if (options_.progress) {
        options_.progress(static_cast<double>(m + 1) / static_cast<double>(rules_.moves.size()));
      }
    }
    return std::move(rules_);
  }

 private:
  /** What is put together by itself comes first, as Reorder() has it; the rest may change. */
  void SplitSteps() {
    const std::vector<sequence::SequenceStep>& steps = model_.sequence.steps;
    const auto last_park =
        std::find_if(steps.rbegin(), steps.rend(), [](const sequence::SequenceStep& step) {
          return step.kind == sequence::SequenceStep::Kind::kPark;
        });
    std::optional<sequence::SequenceStep> aside;
    for (auto step = steps.begin(); step != steps.end(); ++step) {
      if (step < last_park.base() || step->kind == sequence::SequenceStep::Kind::kBase) {
        rules_.first.push_back(*step);
        continue;
      }
      if (step->kind == sequence::SequenceStep::Kind::kAside) {
        aside = *step;
        continue;
      }
      if (step->kind == sequence::SequenceStep::Kind::kReturn) {
        rules_.moves.back().back = *step;
        continue;
      }
      FreeMove move;
      move.parts = sequence::UnitOf(*step);
      for (const OccurrenceId part : move.parts) {
        move_of_[part] = rules_.moves.size();
      }
      units_.push_back(move.parts);
      move.ways.push_back({*step, {}, {}, {}});
      move.aside = std::exchange(aside, std::nullopt);
      rules_.moves.push_back(std::move(move));
    }
  }

  void ShowAll() {
    for (const simulation::Body& body : model_.bodies) {
      extraction_.SetPresent({body.occurrence}, false);
    }
    extraction_.SetPresent(input_.fixtures, true);
    extraction_.SetPresent({sequence::FindBase(model_.sequence)}, true);
    for (const FreeMove& move : rules_.moves) {
      extraction_.SetPresent(move.parts, true);
    }
  }

  /** Finds what stands in a way. @returns false where what never moves does. */
  bool FindObstacles(std::size_t m, OrderedWay* way) {
    const OccurrenceId base = sequence::FindBase(model_.sequence);
    way->obstacles = extraction_.ListObstacles(rules_.moves[m].parts, way->step.extraction_W, base);
    for (const sequence::Obstacle& obstacle : way->obstacles) {
      const auto found = move_of_.find(obstacle.occurrence);
      if (found == move_of_.end()) {
        return false;
      }
      way->moves.push_back(found->second);
    }
    std::sort(way->moves.begin(), way->moves.end());
    way->moves.erase(std::unique(way->moves.begin(), way->moves.end()), way->moves.end());
    return true;
  }

  void Bind(std::size_t m) {
    FreeMove& move = rules_.moves[m];
    move.is_bound = true;
    OrderedWay& way = move.ways.front();
    way.obstacles.clear();
    way.moves.clear();
    for (std::size_t later = m + 1; later < rules_.moves.size(); ++later) {
      way.moves.push_back(later);
    }
  }

  void FindWays(std::size_t m) {
    FreeMove& move = rules_.moves[m];
    OrderedWay& planned = move.ways.front();
    const bool is_straight =
        planned.step.way.empty() && planned.step.kind != sequence::SequenceStep::Kind::kAssume;
    // A way on which parts give meets what gives.
    if (!is_straight || move.aside || !FindObstacles(m, &planned) ||
        (!planned.moves.empty() && planned.moves.front() < m)) {
      Bind(m);
      return;
    }
    if (planned.moves.empty()) {
      return;  // No other way can be freer.
    }
    const sequence::SequenceStep step = planned.step;  // More ways move the planned one in memory.
    for (const Vec3& direction : extraction_.ListDirections(move.parts)) {
      if (move.ways.size() == kMostWaysOfMove || options_.stop.stop_requested()) {
        break;
      }
      OrderedWay way;
      way.step = step;
      way.step.extraction_W = direction;
      const bool is_known = direction.dot(step.extraction_W) > 1 - 1e-9;
      if (is_known || !FindObstacles(m, &way)) {
        continue;
      }
      // What another way needs as well is of no use.
      const bool is_of_use =
          std::none_of(move.ways.begin(), move.ways.end(), [&way](const OrderedWay& other) {
            return std::includes(way.moves.begin(), way.moves.end(), other.moves.begin(),
                                 other.moves.end());
          });
      if (is_of_use) {
        way.step.engage_distance = extraction_.CalcEngageDistance(move.parts, direction);
        move.ways.push_back(std::move(way));
      }
    }
  }

  void FindHolders(std::size_t m) {
    FreeMove& move = rules_.moves[m];
    for (const OccurrenceId part : move.parts) {
      for (const OccurrenceId neighbour : model_.sequence.neighbours[part.index()]) {
        const auto found = move_of_.find(neighbour);
        if (found == move_of_.end()) {
          move.is_held_by_base = move.is_held_by_base || extraction_.is_present(neighbour);
        } else if (found->second != m) {
          move.neighbours.push_back(found->second);
        }
      }
    }
    std::sort(move.neighbours.begin(), move.neighbours.end());
    move.neighbours.erase(std::unique(move.neighbours.begin(), move.neighbours.end()),
                          move.neighbours.end());
  }

  void FindToolSpace(std::size_t m) {
    FreeMove& move = rules_.moves[m];
    const sequence::SequenceStep& step = move.ways.front().step;
    const FastenerTool& tool = tools_[step.occurrence.index()];
    if (move.parts.size() != 1 || tool.name.empty()) {
      return;
    }
    move.tool = tool.name;
    if (!tool.drive) {
      return;
    }
    const product::Product& product = *model_.product;
    const ToolSpace space =
        MakeToolSpace(*tool.drive, product.occurrences[step.occurrence.index()].X_WB,
                      step.extraction_W, step.engage_distance);
    move.tool_of_space = space.tool;
    for (const product::Occurrence& other : product.occurrences) {
      if (other.id == step.occurrence || !extraction_.is_present(other.id) ||
          !IsInToolSpace(space, product.part_of(other.id), other.X_WB)) {
        continue;
      }
      move.in_tool_space.push_back(other.id);
      const auto found = move_of_.find(other.id);
      if (found != move_of_.end()) {
        move.moves_in_tool_space.push_back(found->second);
      }
    }
    std::sort(move.moves_in_tool_space.begin(), move.moves_in_tool_space.end());
    move.moves_in_tool_space.erase(
        std::unique(move.moves_in_tool_space.begin(), move.moves_in_tool_space.end()),
        move.moves_in_tool_space.end());
  }

  void FindEffort(std::size_t m, EffortFinder* efforts) {
    FreeMove& move = rules_.moves[m];
    move.weight = efforts->CalcWeight(move.parts);
    move.motions = efforts->ListMotions(move.parts, !move.tool.empty());
    move.mods = SumMods(move.motions);
    for (OrderedWay& way : move.ways) {
      way.effort = efforts->Find(units_, m, way.step.extraction_W);
    }
  }

  void RankUpSides() {
    std::array<int, kUpSides>& sides = rules_.up_sides;
    std::array<double, kUpSides> margins{};
    for (const int side : sides) {
      margins[static_cast<std::size_t>(side)] =
          CalcStandingMargin(model_, sequence::FindBase(model_.sequence), Vec3(-UpSideAt(side)));
    }
    // The first one is as drawn.
    std::sort(sides.begin() + 1, sides.end());
    std::stable_sort(sides.begin() + 1, sides.end(), [&margins](int a, int b) {
      return margins[static_cast<std::size_t>(a)] > margins[static_cast<std::size_t>(b)];
    });
  }

  const simulation::Model& model_;
  const OrderRuleOptions& options_;
  contact::Scene scene_;
  sequence::SequenceInput input_;
  sequence::Extraction extraction_;
  std::vector<FastenerTool> tools_;  // By occurrence.
  OrderRules rules_;
  std::vector<sequence::Unit> units_;  // Parts of the moves.
  std::map<OccurrenceId, std::size_t> move_of_;
};

}  // namespace

Vec3 UpSideAt(int side) {
  Vec3 up = Vec3::Zero();
  up[side / 2] = side % 2 == 0 ? 1 : -1;
  return up;
}

OrderRules FindOrderRules(const simulation::Model& model, const OrderRuleOptions& options) {
  return RuleFinder(model, options).Find();
}

}  // namespace hvas::orders
