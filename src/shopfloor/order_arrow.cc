#include "shopfloor/order_arrow.h"

#include <algorithm>

namespace hvas::shopfloor {
namespace {

using orders::FreeMove;
using orders::OrderedWay;
using orders::OrderRules;
using sequence::Obstacle;

bool StandsInAllWays(const FreeMove& move, std::size_t other) {
  return std::all_of(move.ways.begin(), move.ways.end(), [other](const OrderedWay& way) {
    return std::binary_search(way.moves.begin(), way.moves.end(), other);
  });
}

/** Says why a move comes before another one, by what stands in its planned way. */
void Explain(const FreeMove& move, const FreeMove& then, OrderArrow* arrow) {
  const std::vector<Obstacle>& obstacles = move.ways.front().obstacles;
  const auto found = std::find_if(obstacles.begin(), obstacles.end(), [&then](const Obstacle& o) {
    return std::find(then.parts.begin(), then.parts.end(), o.occurrence) != then.parts.end();
  });
  if (found != obstacles.end()) {
    arrow->reason = found->mate.is_valid() ? ArrowReason::kMate : ArrowReason::kMeets;
    arrow->other = found->occurrence;
    arrow->travelled = found->travelled;
  } else if (move.aside) {
    arrow->reason = ArrowReason::kMovedAside;
    arrow->other = move.aside->occurrence;
  } else {
    arrow->reason =
        move.ways.front().step.way.empty() ? ArrowReason::kGiving : ArrowReason::kTurning;
  }
}

void MarkImplied(std::size_t moves, std::vector<OrderArrow>* arrows) {
  std::vector<std::vector<std::size_t>> after(moves);
  for (const OrderArrow& arrow : *arrows) {
    after[arrow.first].push_back(arrow.then);
  }
  for (OrderArrow& arrow : *arrows) {
    const std::vector<std::size_t>& others = after[arrow.first];
    arrow.is_implied = std::any_of(others.begin(), others.end(), [&](std::size_t between) {
      const std::vector<std::size_t>& next = after[between];
      return std::find(next.begin(), next.end(), arrow.then) != next.end();
    });
  }
}

}  // namespace

std::vector<OrderArrow> ListArrows(const OrderRules& rules) {
  std::vector<OrderArrow> arrows;
  for (std::size_t m = 0; m < rules.moves.size(); ++m) {
    const FreeMove& move = rules.moves[m];
    for (const std::size_t other : move.ways.front().moves) {
      OrderArrow arrow;
      arrow.first = m;
      arrow.then = other;
      arrow.then_part = rules.moves[other].parts.front();
      arrow.is_certain = StandsInAllWays(move, other);
      Explain(move, rules.moves[other], &arrow);
      arrows.push_back(arrow);
    }
  }
  MarkImplied(rules.moves.size(), &arrows);
  return arrows;
}

}  // namespace hvas::shopfloor
