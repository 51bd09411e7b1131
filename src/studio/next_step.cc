#include "studio/next_step.h"

#include <algorithm>

namespace hvas::studio {

using product::OccurrenceId;
using sequence::SequenceStep;
using simulation::Placement;

SequenceStep FindStep(const simulation::Model& model, const LiveState& state, OccurrenceId id,
                      simulation::TakeExtent extent) {
  if (state.parts[id.index()].leader.is_valid()) {
    return MakeTableStep(model, state.parts, id, extent);
  }
  const auto& steps = model.sequence.steps;
  for (std::size_t i = state.next_step; i < steps.size(); ++i) {
    const SequenceStep& step = steps[i];
    const bool has_it = step.occurrence == id || std::find(step.members.begin(), step.members.end(),
                                                           id) != step.members.end();
    const Placement placement = state.parts[step.occurrence.index()].placement;
    const bool is_next = i == state.next_step && step.occurrence == id;
    if (is_next && IsWithinProduct(step.kind) &&
        placement == simulation::PlacementBefore(step.kind)) {
      return step;
    }
    if (IsWithinProduct(step.kind) || step.kind == SequenceStep::Kind::kBase || !has_it ||
        (step.members.empty() && placement != Placement::kLoose)) {
      continue;
    }
    // Only those members of a subassembly move that have been put into it.
    SequenceStep possible = step;
    std::erase_if(possible.members, [&](OccurrenceId member) {
      return state.parts[member.index()].placement == Placement::kLoose;
    });
    return possible;
  }
  if (const SequenceStep* insertion = FindInsertion(model.sequence, id)) {
    SequenceStep move = *insertion;
    const bool is_in_place = state.parts[id.index()].placement == Placement::kPlaced;
    move.kind = is_in_place ? SequenceStep::Kind::kRemove : move.kind;
    return move;
  }
  SequenceStep step;
  step.occurrence = id;
  return step;
}

}  // namespace hvas::studio
