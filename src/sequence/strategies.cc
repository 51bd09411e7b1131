#include "sequence/strategies.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hvas::sequence {
namespace {

using product::OccurrenceId;

TakenOut OnePart(SequenceStep step) {
  const Unit unit{step.occurrence};
  return {unit, {std::move(step)}};
}

/** What has come out where there is a step. */
std::optional<TakenOut> OnePart(std::optional<SequenceStep> step) {
  return step ? std::optional<TakenOut>(OnePart(*std::move(step))) : std::nullopt;
}

TakenOut TakeUnit(Unit unit, SequenceStep step, Level* level) {
  std::erase_if(level->rest, [&unit](OccurrenceId id) {
    return std::find(unit.begin(), unit.end(), id) != unit.end();
  });
  return {std::move(unit), {std::move(step)}};
}

/** Parts of a level that are connected with what stays only by this one: what stays are the base
 and the fixtures, or the largest part where it is not connected with those. */
Unit ListHanging(OccurrenceId id, const Level& level) {
  Unit others = ListConnected(id, level.WithFixtures(), *level.neighbours);
  std::erase(others, id);
  Unit hanging = others;
  std::erase_if(hanging, [&level](OccurrenceId part) {
    return std::find(level.rest.begin(), level.rest.end(), part) == level.rest.end();
  });
  Unit standing = *level.fixtures;
  if (!hanging.empty()) {
    standing.push_back(hanging.back());  // The base, where it is among them: the largest.
  }
  for (const OccurrenceId stands : standing) {
    for (const OccurrenceId part : ListConnected(stands, others, *level.neighbours)) {
      std::erase(hanging, part);
    }
  }
  return hanging;
}

/** Parts that are there of a subassembly of the file. */
Unit ListPresentBelow(product::SubassemblyId id, const Level& level) {
  Unit unit;
  const product::Subassembly& node = level.product->subassemblies[id.index()];
  std::copy_if(node.occurrences.begin(), node.occurrences.end(), std::back_inserter(unit),
               [&level](OccurrenceId part) { return level.extraction->is_present(part); });
  for (const product::SubassemblyId child : node.subassemblies) {
    const Unit below = ListPresentBelow(child, level);
    unit.insert(unit.end(), below.begin(), below.end());
  }
  return unit;
}

}  // namespace

Unit Level::WithFixtures() const {
  Unit all = rest;
  all.insert(all.end(), fixtures->begin(), fixtures->end());
  return all;
}

BlockingGraph* GraphOf(Level* level) {
  if (!level->graph) {
    level->graph.emplace(level->extraction, level->rest);
  }
  level->graph->Keep(level->rest);
  return &*level->graph;
}

std::optional<TakenOut> StraightStrategy::TryTakeOut(Level* level) const {
  const Unit staying = may_disconnect_ ? Unit() : level->connecting;
  return OnePart(level->extraction->TryRemoveOne(&level->rest, staying));
}

std::optional<TakenOut> HangingStrategy::TryTakeOut(Level* level) const {
  for (const OccurrenceId id : level->rest) {
    if (id == level->rest.back() ||
        !std::binary_search(level->connecting.begin(), level->connecting.end(), id)) {
      continue;
    }
    Unit unit = ListHanging(id, *level);
    if (unit.empty()) {
      continue;
    }
    unit.push_back(id);
    if (std::optional<SequenceStep> step = level->extraction->TryRemove(unit)) {
      return TakeUnit(std::move(unit), *std::move(step), level);
    }
  }
  return std::nullopt;
}

std::optional<TakenOut> SubassemblyStrategy::TryTakeOut(Level* level) const {
  for (const product::Subassembly& node : level->product->subassemblies) {
    Unit unit = ListPresentBelow(node.id, *level);
    const bool has_base = std::find(unit.begin(), unit.end(), level->rest.back()) != unit.end();
    if (unit.size() < 2 || unit.size() >= level->rest.size() || has_base) {
      continue;
    }
    std::stable_sort(unit.begin(), unit.end(), [level](OccurrenceId x, OccurrenceId y) {
      return level->extraction->SizeOf(x) > level->extraction->SizeOf(y);
    });
    if (std::optional<SequenceStep> step = level->extraction->TryRemove(unit)) {
      return TakeUnit(std::move(unit), *std::move(step), level);
    }
  }
  return std::nullopt;
}

std::optional<TakenOut> BodyStrategy::TryTakeOut(Level* level) const {
  BlockingGraph* const graph = GraphOf(level);
  while (std::optional<BlockingGraph::Body> body = graph->FindBody(*level->neighbours)) {
    Unit unit = body->parts;
    std::reverse(unit.begin(), unit.end());  // The largest leads.
    if (auto step = level->extraction->TryRemoveAlong(unit, body->direction)) {
      return TakeUnit(std::move(unit), *std::move(step), level);
    }
    graph->Exclude(*body);
  }
  return std::nullopt;
}

std::optional<TakenOut> AllowanceStrategy::TryTakeOut(Level* level) const {
  if (!level->extraction->AllowBeyondDrawn(level->rest)) {
    return std::nullopt;
  }
  level->graph.reset();
  return TakenOut();
}

std::optional<TakenOut> YieldingStrategy::TryTakeOut(Level* level) const {
  Extraction& extraction = *level->extraction;
  return OnePart(by_ == By::kStatement
                     ? extraction.TryRemoveGiving(&level->rest, level->connecting)
                     : extraction.TryRemoveBending(&level->rest, level->connecting));
}

std::optional<TakenOut> TurningStrategy::TryTakeOut(Level* level) const {
  Extraction& extraction = *level->extraction;
  if (effort_ == Effort::kRings) {
    return OnePart(extraction.TryRemoveRing(&level->rest, level->connecting));
  }
  return OnePart(extraction.TryRemoveTurning(
      &level->rest, level->connecting,
      effort_ == Effort::kBrief ? TurningEffort::kBrief : TurningEffort::kLong));
}

std::optional<TakenOut> SidestepStrategy::TryTakeOut(Level* level) const {
  std::vector<SequenceStep> steps =
      level->extraction->TryRemovePast(&level->rest, level->connecting);
  if (steps.empty()) {
    return std::nullopt;
  }
  return TakenOut{{steps[1].occurrence}, std::move(steps)};
}

std::vector<std::unique_ptr<Strategy>> ListStrategies() {
  using By = YieldingStrategy::By;
  using Effort = TurningStrategy::Effort;
  std::vector<std::unique_ptr<Strategy>> list;
  // Always the smallest that can go, but none that others hang on: what lies on a part goes before
  // the part, or with it.
  list.push_back(std::make_unique<StraightStrategy>(false));
  list.push_back(std::make_unique<HangingStrategy>());
  list.push_back(std::make_unique<SubassemblyStrategy>());
  list.push_back(std::make_unique<StraightStrategy>(true));
  list.push_back(std::make_unique<TurningStrategy>(Effort::kRings));
  list.push_back(std::make_unique<YieldingStrategy>(By::kStatement));
  list.push_back(std::make_unique<AllowanceStrategy>());
  list.push_back(std::make_unique<BodyStrategy>());
  // Straight ways cost less than ways that turn, of which a brief search comes before a wall bends.
  list.push_back(std::make_unique<YieldingStrategy>(By::kForm));
  list.push_back(std::make_unique<TurningStrategy>(Effort::kBrief));
  list.push_back(std::make_unique<SidestepStrategy>());
  list.push_back(std::make_unique<TurningStrategy>(Effort::kLong));
  return list;
}

}  // namespace hvas::sequence
