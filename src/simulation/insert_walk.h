#pragma once

#include <algorithm>
#include <vector>

#include "product/product.h"
#include "sequence/sequence.h"

namespace hvas::simulation {

/** What springs and rubber press on comes along an axis within 10 degrees: the cosine. A choice. */
inline constexpr double kAlongAxis = 0.985;
/** A part that is pressed by less is not [m]: no more than a file resolves. A choice. */
inline constexpr double kLeastPressed = 1e-6;

/** The parts that are there while a straight step brings its part in, and those that move. */
struct InsertStep {
  const sequence::SequenceStep* step{nullptr};
  std::vector<product::OccurrenceId> unit;  ///< The parts that move as one.
  const std::vector<bool>* placed{
      nullptr};  ///< Whether a part, by occurrence, is in its place before the step.

  [[nodiscard]] bool Moves(product::OccurrenceId id) const {
    return std::find(unit.begin(), unit.end(), id) != unit.end();
  }

  [[nodiscard]] bool HasPlaced(product::OccurrenceId id) const { return (*placed)[id.index()]; }
};

/** Goes through an order of assembly, and looks at each step that brings a part in straight. */
template <typename Look>
void WalkInserts(const product::Product& product, const sequence::Sequence& sequence,
                 const Look& look) {
  std::vector<bool> placed(product.occurrences.size(), false);
  for (const sequence::SequenceStep& step : sequence.steps) {
    InsertStep insert{&step, step.members, &placed};
    insert.unit.push_back(step.occurrence);
    if (step.kind == sequence::SequenceStep::Kind::kInsert && step.way.empty()) {
      look(insert);
    }
    for (const product::OccurrenceId id : insert.unit) {
      placed[id.index()] = true;
    }
  }
}

}  // namespace hvas::simulation
