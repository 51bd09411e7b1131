#include "sequence/mate_way.h"

#include <algorithm>
#include <iterator>

namespace hvas::sequence {
namespace {

bool Moves(const SequenceStep& step, product::OccurrenceId id) {
  return step.occurrence == id ||
         std::find(step.members.begin(), step.members.end(), id) != step.members.end();
}

}  // namespace

Vec3 FindWayOut(const Sequence& sequence, const product::Mate& mate) {
  // The last move of one without the other joins them; after it they move together.
  for (auto step = sequence.steps.rbegin(); step != sequence.steps.rend(); ++step) {
    const bool moves_outer = Moves(*step, mate.a.occurrence);
    if (step->kind == SequenceStep::Kind::kReturn) {
      // What went past the part that was aside is joined to it by its return.
      const bool joins =
          (moves_outer && Moves(*std::next(step), mate.b.occurrence)) ||
          (Moves(*step, mate.b.occurrence) && Moves(*std::next(step), mate.a.occurrence));
      if (joins) {
        return moves_outer ? Vec3(-step->extraction_W) : step->extraction_W;
      }
      continue;
    }
    if (step->kind == SequenceStep::Kind::kInsert &&
        moves_outer != Moves(*step, mate.b.occurrence)) {
      return moves_outer ? Vec3(-step->extraction_W) : step->extraction_W;
    }
  }
  return Vec3::Zero();
}

}  // namespace hvas::sequence
