#include "simulation/sequence.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "mates/drawing_errors.h"
#include "simulation/base_choice.h"
#include "simulation/blocking_graph.h"
#include "simulation/extraction.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;
using product::Product;

class Planner {
 public:
  explicit Planner(const SequenceInput& input)
      : input_(input),
        product_(*input.product),
        extraction_(input, nullptr),
        neighbours_(FindNeighbours(product_, *input.scene, input.absent, input.stop)) {}

  Sequence Plan();

 private:
  /** The part of these, sorted by size, that stays in the fixture. */
  [[nodiscard]] OccurrenceId ChooseBase(const Unit& rest) const;
  /** Takes apart the parts given, with nothing else there; appends the steps that put them
   together, those of subassemblies first. */
  void PlanLevel(Unit parts, Sequence* sequence);
  /** Takes out of `rest` what can go next, or gives up a part. */
  void TakeOutNext(std::optional<BlockingGraph>* graph, Unit* rest,
                   std::vector<SequenceStep>* removed, Sequence* sequence);
  /** Finds a part that comes out of `rest` as one body with those that would hang in the air
   without it, and plans them. */
  [[nodiscard]] bool TakeOutWithHanging(const Unit& connecting, Unit* rest,
                                        std::vector<SequenceStep>* removed, Sequence* sequence);
  /** Finds a subassembly that comes out of `rest` as one body, and plans it. */
  [[nodiscard]] bool TakeOutSubassembly(Unit* rest, std::vector<SequenceStep>* removed,
                                        Sequence* sequence);
  /** Finds several parts that come out of `rest` as one body although the file has no subassembly
   of them, or a part that comes out along a direction of another one, and plans them. */
  [[nodiscard]] bool TakeOutBody(BlockingGraph* graph, Unit* rest,
                                 std::vector<SequenceStep>* removed, Sequence* sequence);
  /** Plans a unit that has come out of `rest` in one step: put together by itself, with nothing
   else there, then set aside until its turn. */
  void PutAside(const Unit& unit, SequenceStep step, Unit* rest, std::vector<SequenceStep>* removed,
                Sequence* sequence);
  /** Gives up a part: it is assumed to come out. */
  void GiveUp(OccurrenceId id, std::string reason, Unit* rest, std::vector<SequenceStep>* removed,
              Sequence* sequence);
  /** Gives up the part whose absence lets most others come out, or the smallest. */
  void GiveUpOne(BlockingGraph* graph, Unit* rest, std::vector<SequenceStep>* removed,
                 Sequence* sequence);
  /** Gives up one part of a pair that is drawn in one another (product::DrawingError), for which no
   further way is searched. False where there is no such pair. */
  [[nodiscard]] bool GiveUpError(Unit* rest, std::vector<SequenceStep>* removed,
                                 Sequence* sequence);
  /** Parts of which others would hang in the air if they came out before them, sorted. */
  [[nodiscard]] Unit ListConnecting(const Unit& rest) const;
  /** Parts of `rest` that are connected with what stays only by this one: what stays are the base
   and the fixtures, or the largest part where it is not connected with those. */
  [[nodiscard]] Unit ListHanging(OccurrenceId id, const Unit& rest) const;
  /** `rest`, and the fixtures. */
  [[nodiscard]] Unit WithFixtures(const Unit& rest) const;
  [[nodiscard]] Unit PresentBelow(product::SubassemblyId id) const;

  const SequenceInput& input_;
  const Product& product_;
  Extraction extraction_;
  Neighbours neighbours_;
  std::size_t planned_{0};
};

Unit Planner::PresentBelow(product::SubassemblyId id) const {
  Unit unit;
  const product::Subassembly& node = product_.subassemblies[id.index()];
  for (const OccurrenceId occurrence : node.occurrences) {
    if (extraction_.is_present(occurrence)) {
      unit.push_back(occurrence);
    }
  }
  for (const product::SubassemblyId child : node.subassemblies) {
    const Unit below = PresentBelow(child);
    unit.insert(unit.end(), below.begin(), below.end());
  }
  return unit;
}

bool Planner::TakeOutWithHanging(const Unit& connecting, Unit* rest,
                                 std::vector<SequenceStep>* removed, Sequence* sequence) {
  for (const OccurrenceId id : *rest) {
    if (id == rest->back() || !std::binary_search(connecting.begin(), connecting.end(), id)) {
      continue;
    }
    Unit unit = ListHanging(id, *rest);
    if (unit.empty()) {
      continue;
    }
    unit.push_back(id);
    std::optional<SequenceStep> step = extraction_.TryRemove(unit);
    if (step) {
      PutAside(unit, std::move(*step), rest, removed, sequence);
      return true;
    }
  }
  return false;
}

bool Planner::TakeOutSubassembly(Unit* rest, std::vector<SequenceStep>* removed,
                                 Sequence* sequence) {
  for (const product::Subassembly& node : product_.subassemblies) {
    Unit unit = PresentBelow(node.id);
    const bool has_base = std::find(unit.begin(), unit.end(), rest->back()) != unit.end();
    if (unit.size() < 2 || unit.size() >= rest->size() || has_base) {
      continue;
    }
    std::stable_sort(unit.begin(), unit.end(), [this](OccurrenceId x, OccurrenceId y) {
      return extraction_.SizeOf(x) > extraction_.SizeOf(y);
    });
    std::optional<SequenceStep> step = extraction_.TryRemove(unit);
    if (!step) {
      continue;
    }
    PutAside(unit, std::move(*step), rest, removed, sequence);
    return true;
  }
  return false;
}

void Planner::PutAside(const Unit& unit, SequenceStep step, Unit* rest,
                       std::vector<SequenceStep>* removed, Sequence* sequence) {
  std::erase_if(*rest, [&unit](OccurrenceId id) {
    return std::find(unit.begin(), unit.end(), id) != unit.end();
  });
  const Unit others = *rest;
  extraction_.SetPresent(others, false);
  extraction_.SetPresent(unit, true);
  const std::size_t first = sequence->steps.size();
  PlanLevel(unit, sequence);
  extraction_.SetPresent(unit, false);
  extraction_.SetPresent(others, true);
  // Only what went into it moves with it, led by its base: the last one that was put in a fixture.
  std::set<OccurrenceId> members;
  for (std::size_t i = first; i < sequence->steps.size(); ++i) {
    members.insert(sequence->steps[i].occurrence);
    if (sequence->steps[i].kind == SequenceStep::Kind::kBase) {
      step.occurrence = sequence->steps[i].occurrence;
    }
  }
  members.erase(step.occurrence);
  step.members.assign(members.begin(), members.end());
  if (members.empty()) {
    sequence->steps.resize(first);  // It goes from the table into its place, as a single part does.
    removed->push_back(std::move(step));
    return;
  }
  SequenceStep park = step;
  park.kind = SequenceStep::Kind::kPark;
  park.extraction_W = Vec3::UnitY();
  park.engage_distance = 0;
  sequence->steps.push_back(std::move(park));
  removed->push_back(std::move(step));
}

bool Planner::TakeOutBody(BlockingGraph* graph, Unit* rest, std::vector<SequenceStep>* removed,
                          Sequence* sequence) {
  while (std::optional<BlockingGraph::Body> body = graph->FindBody(neighbours_)) {
    Unit unit = body->parts;
    std::reverse(unit.begin(), unit.end());  // the largest leads
    std::optional<SequenceStep> step = extraction_.TryRemoveAlong(unit, body->direction);
    if (step && unit.size() == 1) {
      std::erase(*rest, unit.front());
      removed->push_back(std::move(*step));
      return true;
    }
    if (step) {
      PutAside(unit, std::move(*step), rest, removed, sequence);
      return true;
    }
    graph->Exclude(*body);
  }
  return false;
}

void Planner::GiveUpOne(BlockingGraph* graph, Unit* rest, std::vector<SequenceStep>* removed,
                        Sequence* sequence) {
  const OccurrenceId blocker = graph->FindGreatestBlocker();
  const OccurrenceId id = blocker.is_valid() ? blocker : rest->front();
  std::string reason =
      extraction_.ExplainStuck(id) + extraction_.ExplainTurning(id) + extraction_.ExplainPassing();
  if (graph->is_limited()) {
    reason += fmt::format("; of the ways of parts that might come out together, only {} were tried",
                          BlockingGraph::kMostWays);
  }
  GiveUp(id, std::move(reason), rest, removed, sequence);
}

void Planner::GiveUp(OccurrenceId id, std::string reason, Unit* rest,
                     std::vector<SequenceStep>* removed, Sequence* sequence) {
  sequence->gaps.push_back({id, std::move(reason)});
  SequenceStep assumed;
  assumed.kind = SequenceStep::Kind::kAssume;
  assumed.occurrence = id;
  removed->push_back(std::move(assumed));
  extraction_.SetPresent({id}, false);
  std::erase(*rest, id);
}

bool Planner::GiveUpError(Unit* rest, std::vector<SequenceStep>* removed, Sequence* sequence) {
  const Unit present = WithFixtures(*rest);
  const auto is_in = [](const Unit& unit, OccurrenceId id) {
    return std::find(unit.begin(), unit.end(), id) != unit.end();
  };
  // Of a chain of pairs the largest part that has to go, so that few have to.
  const product::DrawingError* found = nullptr;
  OccurrenceId out;
  for (const product::DrawingError& error : product_.drawing_errors) {
    const OccurrenceId smaller = mates::SmallerOf(product_, error);
    const bool can_go = is_in(*rest, smaller) && smaller != rest->back();  // The base stays.
    const OccurrenceId id = can_go ? smaller : (smaller == error.a ? error.b : error.a);
    if (is_in(present, error.a) && is_in(present, error.b) && is_in(*rest, id) &&
        id != rest->back() &&
        (found == nullptr || extraction_.SizeOf(id) > extraction_.SizeOf(out))) {
      found = &error;
      out = id;
    }
  }
  if (found != nullptr) {
    GiveUp(out, "an error of the drawing: " + mates::DescribeDrawingError(product_, *found), rest,
           removed, sequence);
  }
  return found != nullptr;
}

Unit Planner::WithFixtures(const Unit& rest) const {
  Unit all = rest;
  all.insert(all.end(), input_.fixtures.begin(), input_.fixtures.end());
  return all;
}

Unit Planner::ListConnecting(const Unit& rest) const {
  return ListCutParts(WithFixtures(rest), neighbours_);
}

Unit Planner::ListHanging(OccurrenceId id, const Unit& rest) const {
  Unit others = ListConnected(id, WithFixtures(rest), neighbours_);
  std::erase(others, id);
  Unit hanging = others;
  std::erase_if(hanging, [&rest](OccurrenceId part) {
    return std::find(rest.begin(), rest.end(), part) == rest.end();
  });
  Unit standing = input_.fixtures;
  if (!hanging.empty()) {
    standing.push_back(hanging.back());  // the base, where it is among them: the largest
  }
  for (const OccurrenceId stands : standing) {
    for (const OccurrenceId part : ListConnected(stands, others, neighbours_)) {
      std::erase(hanging, part);
    }
  }
  return hanging;
}

void Planner::TakeOutNext(std::optional<BlockingGraph>* graph, Unit* rest,
                          std::vector<SequenceStep>* removed, Sequence* sequence) {
  // Always the smallest that can go, but none that others hang on: what lies on a part goes before
  // the part, or with it.
  const Unit connecting = ListConnecting(*rest);
  std::optional<SequenceStep> step = extraction_.TryRemoveOne(rest, connecting);
  if (!step && (TakeOutWithHanging(connecting, rest, removed, sequence) ||
                TakeOutSubassembly(rest, removed, sequence))) {
    return;
  }
  if (!step) {
    step = extraction_.TryRemoveOne(rest);
  }
  if (step) {
    removed->push_back(std::move(*step));
    return;
  }
  if (GiveUpError(rest, removed, sequence)) {
    graph->reset();
    return;
  }
  if (std::optional<SequenceStep> turning = extraction_.TryRemoveRing(rest, connecting)) {
    removed->push_back(std::move(*turning));
    return;
  }
  if (std::optional<SequenceStep> giving = extraction_.TryRemoveGiving(rest, connecting)) {
    removed->push_back(std::move(*giving));
    return;
  }
  if (extraction_.AllowBeyondDrawn(*rest)) {
    graph->reset();
    return;
  }
  if (!*graph) {
    graph->emplace(&extraction_, *rest);
  }
  (*graph)->Keep(*rest);
  if (TakeOutBody(&**graph, rest, removed, sequence)) {
    return;
  }
  if (std::optional<SequenceStep> turning =
          extraction_.TryRemoveTurning(rest, connecting, TurningEffort::kBrief)) {
    removed->push_back(std::move(*turning));
    return;
  }
  if (std::vector<SequenceStep> passing = extraction_.TryRemovePast(rest, connecting);
      !passing.empty()) {
    removed->insert(removed->end(), passing.rbegin(), passing.rend());
    return;
  }
  if (std::optional<SequenceStep> turning =
          extraction_.TryRemoveTurning(rest, connecting, TurningEffort::kLong)) {
    removed->push_back(std::move(*turning));
    return;
  }
  if (std::optional<SequenceStep> bending = extraction_.TryRemoveBending(rest, connecting)) {
    removed->push_back(std::move(*bending));
    return;
  }
  GiveUpOne(&**graph, rest, removed, sequence);
}

OccurrenceId Planner::ChooseBase(const Unit& rest) const {
  return std::find(rest.begin(), rest.end(), input_.base) != rest.end()
             ? input_.base
             : simulation::ChooseBase(product_, rest, neighbours_);
}

void Planner::PlanLevel(Unit rest, Sequence* sequence) {
  // Small parts come off first (they go in last); the base stays.
  std::stable_sort(rest.begin(), rest.end(), [this](OccurrenceId x, OccurrenceId y) {
    return extraction_.SizeOf(x) < extraction_.SizeOf(y);
  });
  const auto staying = std::find(rest.begin(), rest.end(), ChooseBase(rest));
  std::rotate(staying, staying + 1, rest.end());
  extraction_.Forget(rest);
  std::vector<SequenceStep> removed;
  std::optional<BlockingGraph> graph;
  while (rest.size() > 1 && !input_.stop.stop_requested()) {
    TakeOutNext(&graph, &rest, &removed, sequence);
    if (input_.progress) {
      input_.progress(std::min(
          1.0, static_cast<double>(++planned_) / static_cast<double>(product_.occurrences.size())));
    }
  }
  SequenceStep base;
  base.kind = SequenceStep::Kind::kBase;
  base.occurrence = rest.front();
  sequence->steps.push_back(base);
  sequence->steps.insert(sequence->steps.end(), removed.rbegin(), removed.rend());
}

Sequence Planner::Plan() {
  Sequence sequence;
  sequence.neighbours = neighbours_;
  Unit all;
  extraction_.SetPresent(input_.absent, false);
  const auto is_in = [](const Unit& unit, OccurrenceId id) {
    return std::find(unit.begin(), unit.end(), id) != unit.end();
  };
  for (const product::Occurrence& occurrence : product_.occurrences) {
    if (!is_in(input_.absent, occurrence.id) && !is_in(input_.fixtures, occurrence.id)) {
      all.push_back(occurrence.id);
    }
  }
  extraction_.SetPresent(all, true);
  PlanLevel(all, &sequence);
  sequence.overlaps = extraction_.overlaps();
  sequence.gives = extraction_.gives();
  sequence.screws = extraction_.screws();
  sequence.reliefs = extraction_.ListReliefs();
  return sequence;
}

}  // namespace

Sequence PlanSequence(const SequenceInput& input) {
  return Planner(input).Plan();
}

const SequenceStep* FindInsertion(const Sequence& sequence, OccurrenceId id) {
  const auto found =
      std::find_if(sequence.steps.begin(), sequence.steps.end(), [id](const SequenceStep& step) {
        return step.occurrence == id && step.kind == SequenceStep::Kind::kInsert;
      });
  return found == sequence.steps.end() ? nullptr : &*found;
}

const SequenceStep* FindAside(const Sequence& sequence, OccurrenceId id) {
  const SequenceStep* insertion = FindInsertion(sequence, id);
  const bool is_let_past = insertion != nullptr && insertion != sequence.steps.data() &&
                           (insertion - 1)->kind == SequenceStep::Kind::kAside;
  return is_let_past ? insertion - 1 : nullptr;
}

spatial::Pose GoalOf(const SequenceStep& step, const spatial::Pose& X_WB_drawn) {
  if (step.kind == SequenceStep::Kind::kAside && !step.way.empty()) {
    return step.way.front();
  }
  return {X_WB_drawn.q(), X_WB_drawn.p() + step.offset_W};
}

std::vector<contact::Allowance> ListAllowances(std::span<const DrawnOverlap> overlaps,
                                               std::span<const GivingPair> gives, OccurrenceId id) {
  constexpr double kRoom = 60e-6;  // [m] that is left to a part that gives: a choice.
  std::vector<contact::Allowance> allowances;
  for (const GivingPair& give : gives) {
    if (give.flexible != id && give.other != id) {
      continue;
    }
    const OccurrenceId other = give.flexible == id ? give.other : give.flexible;
    double depth = give.depth + kRoom;
    for (const DrawnOverlap& overlap : overlaps) {
      depth = overlap.Joins(id, other) ? std::max(depth, overlap.allowed) : depth;
    }
    allowances.push_back({contact::BodyId(other.index()), depth, {}, {}});
  }
  for (const DrawnOverlap& overlap : overlaps) {
    const bool is_a = overlap.a == id;
    if (overlap.answer != DrawnOverlap::Answer::kAllowance || (!is_a && overlap.b != id)) {
      continue;
    }
    allowances.push_back({contact::BodyId((is_a ? overlap.b : overlap.a).index()), overlap.allowed,
                          is_a ? overlap.passing_a : overlap.passing_b,
                          is_a ? overlap.passing_b : overlap.passing_a});
  }
  return allowances;
}

std::string FindGapReason(const Sequence& sequence, OccurrenceId id) {
  const auto gap = std::find_if(sequence.gaps.begin(), sequence.gaps.end(),
                                [id](const SequenceGap& item) { return item.occurrence == id; });
  return gap == sequence.gaps.end() ? std::string() : gap->reason;
}

bool IsBase(const Sequence& sequence, OccurrenceId id) {
  return std::any_of(sequence.steps.begin(), sequence.steps.end(), [id](const SequenceStep& step) {
    return step.kind == SequenceStep::Kind::kBase && step.occurrence == id;
  });
}

OccurrenceId FindBase(const Sequence& sequence) {
  const auto base =
      std::find_if(sequence.steps.rbegin(), sequence.steps.rend(),
                   [](const SequenceStep& step) { return step.kind == SequenceStep::Kind::kBase; });
  return base == sequence.steps.rend() ? OccurrenceId() : base->occurrence;
}

std::string DescribeDirection(const Vec3& direction_W) {
  constexpr double kAlong = 1 - 1e-6;  // Cosine that counts as along an axis: 0.1 degrees.
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction_W[k]) > kAlong) {
      return fmt::format("{}{}", direction_W[k] > 0 ? "+" : "-", kNames[k]);
    }
  }
  return fmt::format("{:.2f} {:.2f} {:.2f}", direction_W.x(), direction_W.y(), direction_W.z());
}

namespace {

/** Steps that stay together: one of its own, or a part with those by which another lets it pass. */
using StepBlock = std::vector<SequenceStep>;

std::vector<StepBlock> ListBlocks(std::span<const SequenceStep> steps) {
  std::vector<StepBlock> blocks;
  bool is_open = false;  // A part is aside.
  for (const SequenceStep& step : steps) {
    if (!is_open) {
      blocks.emplace_back();
    }
    blocks.back().push_back(step);
    is_open = step.kind == SequenceStep::Kind::kAside ||
              (is_open && step.kind != SequenceStep::Kind::kReturn);
  }
  return blocks;
}

/** The step of a block by which a part, or a subassembly, goes to its place. */
const SequenceStep& OwnStepOf(const StepBlock& block) {
  return block.front().kind == SequenceStep::Kind::kAside ? block[1] : block.front();
}

/** Checks that what is moved aside is in its place before. */
Result<void> CheckAside(const Product& product, std::span<const SequenceStep> steps) {
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const OccurrenceId id = steps[i].occurrence;
    const bool is_aside = steps[i].kind == SequenceStep::Kind::kAside;
    const auto comes_before = [&](const SequenceStep& step) {
      return step.occurrence == id && step.kind == SequenceStep::Kind::kInsert;
    };
    if (is_aside &&
        std::none_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(i), comes_before)) {
      const std::string& moved = product.occurrences[id.index()].path;
      const std::string& passing = product.occurrences[steps[i + 1].occurrence.index()].path;
      return Fail(ErrorCode::kInvalid,
                  fmt::format("'{}' cannot come before '{}', which is moved aside to let it pass",
                              passing, moved),
                  product.source, fmt::format("name '{}' before it", moved));
    }
  }
  return {};
}

}  // namespace

Result<Sequence> Reorder(const product::Product& product, const Sequence& sequence,
                         const std::vector<std::string>& names) {
  Sequence result;
  result.gaps = sequence.gaps;
  result.overlaps = sequence.overlaps;
  result.gives = sequence.gives;
  result.reliefs = sequence.reliefs;
  result.neighbours = sequence.neighbours;
  // Subassemblies are put together before the product's base is in the fixture; they stay there.
  const auto last_park =
      std::find_if(sequence.steps.rbegin(), sequence.steps.rend(),
                   [](const SequenceStep& step) { return step.kind == SequenceStep::Kind::kPark; });
  result.steps.assign(sequence.steps.begin(), last_park.base());
  const std::span<const SequenceStep> after(last_park.base(), sequence.steps.end());
  std::vector<StepBlock> rest = ListBlocks(after);
  const auto append = [&result](const StepBlock& block) {
    result.steps.insert(result.steps.end(), block.begin(), block.end());
  };
  append(rest.front());  // The base stays first, named or not.
  for (const std::string& name : names) {
    const auto found = std::find_if(rest.begin(), rest.end(), [&](const StepBlock& block) {
      const OccurrenceId id = OwnStepOf(block).occurrence;
      const product::Occurrence& occurrence = product.occurrences[id.index()];
      return occurrence.path == name || occurrence.name == name ||
             fmt::format("o{}", id.value()) == name;
    });
    if (found == rest.begin()) {
      continue;
    }
    if (found == rest.end()) {
      return Fail(ErrorCode::kNotFound, fmt::format("no part left to order is called '{}'", name),
                  product.source, "hvas inspect lists names and ids");
    }
    append(*found);
    rest.erase(found);
  }
  std::for_each(rest.begin() + 1, rest.end(), append);
  if (auto checked = CheckAside(product, result.steps); !checked) {
    return Unexpected(checked.error());
  }
  return result;
}

}  // namespace hvas::simulation
