#include "simulation/disassembly_plan.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace hvas::simulation {
namespace {

using product::OccurrenceId;

/** Parts that come out, sorted. */
using PartSet = std::vector<OccurrenceId>;

/** A straight way out of a part, and the parts that are in it. */
struct WayOut {
  Vec3 direction{Vec3::Zero()};
  std::vector<sequence::Obstacle> obstacles;
  PartSet parts;          // Of the obstacles.
  bool is_closed{false};  // The base is in the way.
};

/** A set of parts to take out, of which some still need a way. */
struct Candidate {
  PartSet parts;
  PartSet open;           // Those of them whose way is not chosen.
  std::size_t number{0};  // The earlier one goes first where two are as large.
};

struct IsLarger {
  bool operator()(const Candidate& x, const Candidate& y) const {
    return std::pair(x.parts.size(), x.number) > std::pair(y.parts.size(), y.number);
  }
};

bool Contains(const PartSet& set, OccurrenceId id) {
  return std::binary_search(set.begin(), set.end(), id);
}

bool Includes(const PartSet& set, const PartSet& part) {
  return std::includes(set.begin(), set.end(), part.begin(), part.end());
}

class DisassemblyPlanner {
 public:
  DisassemblyPlanner(const Model& model, const DisassemblyOptions& options)
      : model_(model),
        options_(options),
        input_(MakeSequenceInput(model, &scene_)),
        extraction_(input_, &model.sequence),
        base_(sequence::FindBase(model.sequence)) {
    for (const Body& body : model.bodies) {
      if (body.role != BodyRole::kPart) {
        continue;  // Tools and fixtures are no parts of the product.
      }
      const bool is_in_place =
          options.is_in_place.empty() || options.is_in_place[body.occurrence.index()];
      (is_in_place ? in_place_ : elsewhere_).push_back(body.occurrence);
    }
    ShowAll();
  }

  DisassemblyPlan Plan();

 private:
  /** Puts back what has been taken out. */
  void ShowAll() {
    extraction_.SetPresent(in_place_, true);
    extraction_.SetPresent(elsewhere_, false);
  }

  void PlanAll(DisassemblyPlan* plan);
  /** Takes parts out of `rest`, with nothing else there, until none can go. */
  void TakeApart(sequence::Unit rest, DisassemblyPlan* plan);
  /** Takes a subassembly that is put together first out as one body. */
  [[nodiscard]] bool TakeOutSubassembly(sequence::Unit* rest, DisassemblyPlan* plan);
  /** Takes out a part that another one lets pass. */
  [[nodiscard]] bool TakeOutPast(sequence::Unit* rest, DisassemblyPlan* plan);
  void AddRemoval(sequence::SequenceStep step, DisassemblyPlan* plan);
  /** Reports the progress where so many parts have been looked at. */
  void Report(std::size_t parts) const;
  void PlanTarget(DisassemblyPlan* plan);
  /** Ways out of a part with all others in place; none that is in vain beside another. */
  const std::vector<WayOut>& WaysOf(OccurrenceId id);
  /** The smallest set of parts that come out in some order, the target among them; empty where
   there is none. */
  [[nodiscard]] PartSet FindSmallestSet(DisassemblyPlan* plan);
  /** Parts of the set in an order in which each has a free way when its turn comes, with that way;
   parts without one are left out. */
  [[nodiscard]] std::vector<std::pair<OccurrenceId, const WayOut*>> PutInOrder(const PartSet& set);
  /** Set that PlanAll would take out before the target, without those that are not needed. */
  [[nodiscard]] PartSet FindSetInOrder();
  [[nodiscard]] std::string ExplainStuck(OccurrenceId id);
  /** Lists the parts that can come out, of a part and all that are in its way and in theirs. */
  [[nodiscard]] PartSet ListFree(OccurrenceId id);

  /** What keeps a part in on a way out; null: nothing does on any. */
  struct Wall {
    const WayOut* way{nullptr};
    const sequence::Obstacle* obstacle{nullptr};
  };

  /** Finds what keeps a part in where it comes farthest, besides parts that are free. */
  [[nodiscard]] Wall FindWall(OccurrenceId part, const PartSet& free);

  const Model& model_;
  const DisassemblyOptions& options_;
  contact::Scene scene_;
  sequence::SequenceInput input_;
  sequence::Extraction extraction_;
  OccurrenceId base_;
  sequence::Unit in_place_;   // Parts that are in their place before anything comes out.
  sequence::Unit elsewhere_;  // Parts that are not.
  std::map<OccurrenceId, std::vector<WayOut>> ways_;
};

DisassemblyPlan DisassemblyPlanner::Plan() {
  DisassemblyPlan plan;
  plan.base = base_;
  if (options_.target.is_valid()) {
    PlanTarget(&plan);
  } else {
    PlanAll(&plan);
  }
  Report(model_.bodies.size());
  return plan;
}

void DisassemblyPlanner::AddRemoval(sequence::SequenceStep step, DisassemblyPlan* plan) {
  Removal removal;
  if (sequence::IsWithinProduct(step.kind)) {
    removal.way_length = step.engage_distance;
  } else {
    step.kind = sequence::SequenceStep::Kind::kRemove;
    std::vector<bool> is_in_place;
    for (const Body& body : model_.bodies) {
      is_in_place.push_back(extraction_.is_present(body.occurrence));
    }
    removal.way_length = extraction_.CalcWayLength(sequence::UnitOf(step), step.extraction_W);
    removal.breakaway = CalcBreakaway(model_, step, is_in_place);
  }
  removal.step = std::move(step);
  plan->removals.push_back(std::move(removal));
  if (!options_.target.is_valid()) {
    Report(plan->removals.size());
  }
}

void DisassemblyPlanner::Report(std::size_t parts) const {
  if (options_.progress) {
    options_.progress(static_cast<double>(parts) / static_cast<double>(model_.bodies.size()));
  }
}

bool DisassemblyPlanner::TakeOutSubassembly(sequence::Unit* rest, DisassemblyPlan* plan) {
  for (const sequence::SequenceStep& park : model_.sequence.steps) {
    if (park.kind != sequence::SequenceStep::Kind::kPark) {
      continue;
    }
    const sequence::Unit unit = sequence::UnitOf(park);
    const bool is_there = std::all_of(unit.begin(), unit.end(), [rest](OccurrenceId id) {
      return std::find(rest->begin(), rest->end(), id) != rest->end();
    });
    if (!is_there || unit.size() >= rest->size()) {
      continue;
    }
    std::optional<sequence::SequenceStep> step = extraction_.TryRemove(unit);
    if (!step) {
      continue;
    }
    std::erase_if(*rest, [&unit](OccurrenceId id) {
      return std::find(unit.begin(), unit.end(), id) != unit.end();
    });
    AddRemoval(std::move(*step), plan);
    return true;
  }
  return false;
}

bool DisassemblyPlanner::TakeOutPast(sequence::Unit* rest, DisassemblyPlan* plan) {
  std::vector<sequence::SequenceStep> steps = extraction_.TryRemovePast(rest, {});
  for (sequence::SequenceStep& step : steps) {
    AddRemoval(std::move(step), plan);
  }
  return !steps.empty();
}

void DisassemblyPlanner::TakeApart(sequence::Unit rest, DisassemblyPlan* plan) {
  // Small parts first; the largest, the base, is the last and stays.
  std::stable_sort(rest.begin(), rest.end(), [this](OccurrenceId x, OccurrenceId y) {
    return std::pair(x == base_, extraction_.SizeOf(x)) <
           std::pair(y == base_, extraction_.SizeOf(y));
  });
  extraction_.Forget(rest);
  while (rest.size() > 1) {
    if (std::optional<sequence::SequenceStep> step = extraction_.TryRemoveOne(&rest)) {
      AddRemoval(std::move(*step), plan);
    } else if (!TakeOutSubassembly(&rest, plan) && !TakeOutPast(&rest, plan)) {
      break;
    }
  }
  for (std::size_t i = 0; i + 1 < rest.size(); ++i) {
    plan->stuck.push_back({rest[i], extraction_.ExplainStuck(rest[i])});
  }
}

void DisassemblyPlanner::PlanAll(DisassemblyPlan* plan) {
  TakeApart(in_place_, plan);
  ShowAll();
  OccurrenceId aside;  // It is no obstacle to the part that it lets pass.
  for (Removal& removal : plan->removals) {
    if (removal.step.kind == sequence::SequenceStep::Kind::kRemove) {
      removal.waits_for =
          extraction_.ListObstacles(sequence::UnitOf(removal.step), removal.step.extraction_W, {});
      std::erase_if(removal.waits_for, [aside](const sequence::Obstacle& obstacle) {
        return aside.is_valid() && obstacle.occurrence == aside;
      });
    }
    const bool goes_aside = removal.step.kind == sequence::SequenceStep::Kind::kAside;
    aside = goes_aside ? removal.step.occurrence : OccurrenceId();
  }
}

const std::vector<WayOut>& DisassemblyPlanner::WaysOf(OccurrenceId id) {
  const auto [entry, is_new] = ways_.try_emplace(id);
  if (!is_new) {
    return entry->second;
  }
  std::vector<WayOut>& ways = entry->second;
  for (const Vec3& direction : extraction_.ListDirections({id})) {
    WayOut way;
    way.direction = direction;
    way.obstacles = extraction_.ListObstacles({id}, direction, base_);
    for (const sequence::Obstacle& obstacle : way.obstacles) {
      way.is_closed = way.is_closed || obstacle.occurrence == base_;
      way.parts.push_back(obstacle.occurrence);
    }
    std::sort(way.parts.begin(), way.parts.end());
    ways.push_back(std::move(way));
    if (ways.back().parts.empty()) {
      break;  // no other way can be better
    }
  }
  Report(ways_.size() - 1);
  // Of ways that need more than another, the other one is always as good.
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const bool is_first = ways[k].parts != ways[i].parts || k < i;
      if (k != i && is_first && !ways[k].is_closed && !ways[i].is_closed &&
          Includes(ways[i].parts, ways[k].parts)) {
        ways.erase(ways.begin() + static_cast<std::ptrdiff_t>(i--));
        break;
      }
    }
  }
  return ways;
}

std::vector<std::pair<OccurrenceId, const WayOut*>> DisassemblyPlanner::PutInOrder(
    const PartSet& set) {
  sequence::Unit rest = set;
  std::stable_sort(rest.begin(), rest.end(), [this](OccurrenceId x, OccurrenceId y) {
    return std::pair(x == options_.target, extraction_.SizeOf(x)) <
           std::pair(y == options_.target, extraction_.SizeOf(y));
  });
  std::vector<std::pair<OccurrenceId, const WayOut*>> order;
  PartSet gone;
  for (bool is_moving = true; is_moving && !rest.empty();) {
    is_moving = false;
    for (std::size_t i = 0; i < rest.size() && !is_moving; ++i) {
      for (const WayOut& way : WaysOf(rest[i])) {
        if (!way.is_closed && Includes(gone, way.parts)) {
          order.emplace_back(rest[i], &way);
          gone.insert(std::upper_bound(gone.begin(), gone.end(), rest[i]), rest[i]);
          rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
          is_moving = true;
          break;
        }
      }
    }
  }
  return order;
}

PartSet DisassemblyPlanner::FindSmallestSet(DisassemblyPlan* plan) {
  std::priority_queue<Candidate, std::vector<Candidate>, IsLarger> queue;
  std::set<std::pair<PartSet, PartSet>> known;
  std::size_t number = 0;
  queue.push({{options_.target}, {options_.target}, number});
  while (!queue.empty()) {
    const Candidate candidate = queue.top();
    queue.pop();
    if (candidate.open.empty()) {
      if (PutInOrder(candidate.parts).size() == candidate.parts.size()) {
        return candidate.parts;
      }
      continue;  // each waits for another one
    }
    if (static_cast<int>(known.size()) > options_.max_sets) {
      plan->is_smallest = false;
      return FindSetInOrder();
    }
    const OccurrenceId id = candidate.open.front();
    for (const WayOut& way : WaysOf(id)) {
      if (way.is_closed) {
        continue;
      }
      Candidate next;
      std::set_union(candidate.parts.begin(), candidate.parts.end(), way.parts.begin(),
                     way.parts.end(), std::back_inserter(next.parts));
      std::copy_if(next.parts.begin(), next.parts.end(), std::back_inserter(next.open),
                   [&](OccurrenceId part) {
                     return part != id &&
                            (Contains(candidate.open, part) || !Contains(candidate.parts, part));
                   });
      if (known.emplace(next.parts, next.open).second) {
        next.number = ++number;
        queue.push(std::move(next));
      }
    }
  }
  return {};
}

PartSet DisassemblyPlanner::FindSetInOrder() {
  DisassemblyPlan all;
  PlanAll(&all);
  PartSet set;
  for (const Removal& removal : all.removals) {
    if (removal.step.kind != sequence::SequenceStep::Kind::kRemove) {
      return {};  // Only moves out of the product are looked at here.
    }
    set.push_back(removal.step.occurrence);
    if (removal.step.occurrence == options_.target) {
      break;
    }
  }
  PartSet sorted = set;
  std::sort(sorted.begin(), sorted.end());
  if (!Contains(sorted, options_.target) || PutInOrder(sorted).size() != sorted.size()) {
    return {};  // it comes out with others as one body, or not at all
  }
  for (std::size_t i = set.size(); i-- > 0;) {
    PartSet less = set;
    less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
    std::sort(less.begin(), less.end());
    const bool has_target = Contains(less, options_.target);
    if (has_target && PutInOrder(less).size() == less.size()) {
      set.erase(set.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  std::sort(set.begin(), set.end());
  return set;
}

void DisassemblyPlanner::PlanTarget(DisassemblyPlan* plan) {
  const PartSet set = FindSmallestSet(plan);
  if (set.empty()) {
    plan->stuck.push_back({options_.target, ExplainStuck(options_.target)});
    return;
  }
  for (const auto& [id, way] : PutInOrder(set)) {
    sequence::SequenceStep step;
    step.occurrence = id;
    step.extraction_W = way->direction;
    step.engage_distance = extraction_.CalcEngageDistance({id}, way->direction);
    AddRemoval(std::move(step), plan);
    plan->removals.back().waits_for = way->obstacles;
    extraction_.SetPresent({id}, false);
  }
}

PartSet DisassemblyPlanner::ListFree(OccurrenceId id) {
  PartSet all{id};  // With all that are in its way, and in theirs.
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const WayOut& way : WaysOf(all[i])) {
      std::copy_if(way.parts.begin(), way.parts.end(), std::back_inserter(all),
                   [&](OccurrenceId part) {
                     return part != base_ && std::find(all.begin(), all.end(), part) == all.end();
                   });
    }
  }
  std::sort(all.begin(), all.end());
  PartSet free;
  for (const auto& [part, way] : PutInOrder(all)) {
    free.push_back(part);
  }
  std::sort(free.begin(), free.end());
  return free;
}

DisassemblyPlanner::Wall DisassemblyPlanner::FindWall(OccurrenceId part, const PartSet& free) {
  Wall wall;
  for (const WayOut& way : WaysOf(part)) {
    // Of each way the first part that stays; of all ways the one that leads farthest to it.
    const auto first = std::find_if(
        way.obstacles.begin(), way.obstacles.end(),
        [&](const sequence::Obstacle& obstacle) { return !Contains(free, obstacle.occurrence); });
    if (first != way.obstacles.end() &&
        (wall.obstacle == nullptr || first->travelled > wall.obstacle->travelled)) {
      wall = {&way, &*first};
    }
  }
  return wall;
}

std::string DisassemblyPlanner::ExplainStuck(OccurrenceId id) {
  const PartSet free = ListFree(id);
  std::string text;
  PartSet explained;
  for (OccurrenceId part = id; part.is_valid();) {
    explained.insert(std::upper_bound(explained.begin(), explained.end(), part), part);
    const Wall wall = FindWall(part, free);
    if (wall.obstacle == nullptr) {
      return text;
    }
    const OccurrenceId next = wall.obstacle->occurrence;
    text += (text.empty() ? "" : ", which ") +
            extraction_.ExplainObstacle(part, *wall.obstacle, wall.way->direction);
    if (next == base_) {
      return text + ", the base, which stays in the fixture";
    }
    part = Contains(explained, next) ? OccurrenceId() : next;
  }
  return text + ": each of them waits for the other";
}

}  // namespace

DisassemblyPlan PlanDisassembly(const Model& model, const DisassemblyOptions& options) {
  return DisassemblyPlanner(model, options).Plan();
}

double CalcBreakaway(const Model& model, const sequence::SequenceStep& step,
                     const std::vector<bool>& is_in_place) {
  sequence::Unit unit = step.members;
  unit.push_back(step.occurrence);
  double force = 0;
  for (const OccurrenceId id : unit) {
    for (const product::MateId mate_id : model.mates_of[id.index()]) {
      const product::Mate& mate = model.product->mates[mate_id.index()];
      const auto& fit = model.mates[mate_id.index()].fit;
      const OccurrenceId other = mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
      if (fit != nullptr && is_in_place[other.index()] &&
          std::find(unit.begin(), unit.end(), other) == unit.end()) {
        force += fit->CalcReleaseForce(fit->length());
      }
    }
  }
  return force;
}

}  // namespace hvas::simulation
