#include "sequence/sequence.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "mates/drawing_errors.h"
#include "sequence/base_choice.h"
#include "sequence/extraction.h"
#include "sequence/strategies.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;
using product::Product;

class Planner {
 public:
  explicit Planner(const SequenceInput& input)
      : input_(input),
        product_(*input.product),
        extraction_(input, nullptr),
        neighbours_(FindNeighbours(product_, *input.scene, input.absent, input.stop)),
        strategies_(ListStrategies()) {}

  Sequence Plan();

 private:
  /** The part of these, sorted by size, that stays in the fixture. */
  [[nodiscard]] OccurrenceId ChooseBase(const Unit& rest) const;
  /** Takes apart the parts given, with nothing else there; appends the steps that put them
   together, those of subassemblies first. */
  void PlanLevel(Unit parts, Sequence* sequence);
  /** Takes out of a level what comes out by the cheapest strategy. */
  [[nodiscard]] std::optional<TakenOut> TakeOut(Level* level) const;
  /** Appends the steps of what has come out to `removed`. What are several parts is put together by
   itself, with nothing else there, then set aside until its turn.
   @param others  Parts of the level that are still there. */
  void PutAside(TakenOut out, const Unit& others, std::vector<SequenceStep>* removed,
                Sequence* sequence);
  /** Gives up a part: it is assumed to come out. */
  void GiveUp(OccurrenceId id, std::string reason, Level* level, std::vector<SequenceStep>* removed,
              Sequence* sequence);
  /** Gives up the part whose absence lets most others come out, or the smallest. */
  void GiveUpOne(Level* level, std::vector<SequenceStep>* removed, Sequence* sequence);
  /** A part of a pair that is drawn in one another (product::DrawingError), for which no further
   way is searched, and the pair; null where there is none. */
  [[nodiscard]] std::pair<OccurrenceId, const product::DrawingError*> FindError(
      const Level& level) const;

  const SequenceInput& input_;
  const Product& product_;
  Extraction extraction_;
  Neighbours neighbours_;
  std::vector<std::unique_ptr<Strategy>> strategies_;
  std::size_t planned_{0};
};

void Planner::PutAside(TakenOut out, const Unit& others, std::vector<SequenceStep>* removed,
                       Sequence* sequence) {
  if (out.unit.size() == 1) {
    removed->insert(removed->end(), out.steps.rbegin(), out.steps.rend());
    return;
  }
  SequenceStep step = std::move(out.steps.front());
  extraction_.SetPresent(others, false);
  extraction_.SetPresent(out.unit, true);
  const std::size_t first = sequence->steps.size();
  PlanLevel(out.unit, sequence);
  extraction_.SetPresent(out.unit, false);
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

void Planner::GiveUpOne(Level* level, std::vector<SequenceStep>* removed, Sequence* sequence) {
  BlockingGraph* const graph = GraphOf(level);
  const OccurrenceId blocker = graph->FindGreatestBlocker();
  const OccurrenceId id = blocker.is_valid() ? blocker : level->rest.front();
  const std::string no_room = extraction_.ExplainBending(id);
  std::string reason = extraction_.ExplainStuck(id) + (no_room.empty() ? "" : "; " + no_room) +
                       extraction_.ExplainTurning(id) + extraction_.ExplainPassing();
  if (graph->is_limited()) {
    reason += "; the search for parts that come out together was ended";
  }
  GiveUp(id, std::move(reason), level, removed, sequence);
}

void Planner::GiveUp(OccurrenceId id, std::string reason, Level* level,
                     std::vector<SequenceStep>* removed, Sequence* sequence) {
  sequence->gaps.push_back({id, std::move(reason)});
  SequenceStep assumed;
  assumed.kind = SequenceStep::Kind::kAssume;
  assumed.occurrence = id;
  removed->push_back(std::move(assumed));
  extraction_.SetPresent({id}, false);
  std::erase(level->rest, id);
}

std::pair<OccurrenceId, const product::DrawingError*> Planner::FindError(const Level& level) const {
  const Unit present = level.WithFixtures();
  const auto is_in = [](const Unit& unit, OccurrenceId id) {
    return std::find(unit.begin(), unit.end(), id) != unit.end();
  };
  // Of a chain of pairs the largest part that has to go, so that few have to.
  std::pair<OccurrenceId, const product::DrawingError*> found{{}, nullptr};
  for (const product::DrawingError& error : product_.drawing_errors) {
    const OccurrenceId smaller = mates::SmallerOf(product_, error);
    const auto can_go = [&](OccurrenceId id) {
      return is_in(level.rest, id) && id != level.rest.back();  // The base stays.
    };
    const OccurrenceId id = can_go(smaller) ? smaller : (smaller == error.a ? error.b : error.a);
    if (is_in(present, error.a) && is_in(present, error.b) && can_go(id) &&
        (found.second == nullptr || extraction_.SizeOf(id) > extraction_.SizeOf(found.first))) {
      found = {id, &error};
    }
  }
  return found;
}

std::optional<TakenOut> Planner::TakeOut(Level* level) const {
  level->connecting = ListCutParts(level->WithFixtures(), neighbours_);
  for (const std::unique_ptr<Strategy>& strategy : strategies_) {
    if (!strategy->goes_straight() && FindError(*level).second != nullptr) {
      return std::nullopt;
    }
    if (std::optional<TakenOut> out = strategy->TryTakeOut(level)) {
      return out;
    }
  }
  return std::nullopt;
}

OccurrenceId Planner::ChooseBase(const Unit& rest) const {
  return std::find(rest.begin(), rest.end(), input_.base) != rest.end()
             ? input_.base
             : sequence::ChooseBase(product_, rest, neighbours_);
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
  Level level{&product_, &extraction_, &neighbours_, &input_.fixtures, std::move(rest), {}, {}};
  while (level.rest.size() > 1 && !input_.stop.stop_requested()) {
    std::optional<TakenOut> out = TakeOut(&level);
    if (const auto [id, error] = FindError(level); !out && error != nullptr) {
      GiveUp(id, "an error of the drawing: " + mates::DescribeDrawingError(product_, *error),
             &level, &removed, sequence);
    } else if (!out) {
      GiveUpOne(&level, &removed, sequence);
    } else if (!out->unit.empty()) {
      PutAside(*std::move(out), level.rest, &removed, sequence);
    }
    if (input_.progress) {
      input_.progress(std::min(
          1.0, static_cast<double>(++planned_) / static_cast<double>(product_.occurrences.size())));
    }
  }
  SequenceStep base;
  base.kind = SequenceStep::Kind::kBase;
  base.occurrence = level.rest.front();
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

}  // namespace hvas::sequence
