#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sequence/extraction.h"
#include "sequence/sequence.h"
#include "simulation/model.h"

namespace hvas::simulation {

/** One move of a disassembly: a part, or a subassembly as one body, comes out; or a part is moved
 within the product, to let the next one pass. */
struct Removal {
  sequence::SequenceStep step;  ///< Step of kind kRemove, kAside or kReturn.
  std::vector<sequence::Obstacle>
      waits_for;         ///< Parts in its way when all are in place; each comes first.
  double way_length{0};  ///< Way until it is clear of the boxes of all that is in place [m].
  double breakaway{0};   ///< kRemove: CalcBreakaway() when its turn comes [N].
};

/** How a product is taken apart, or how one part is got out of it. */
struct DisassemblyPlan {
  product::OccurrenceId base;                ///< Stays in the fixture.
  std::vector<Removal> removals;             ///< Moves in the order of disassembly.
  std::vector<sequence::SequenceGap> stuck;  ///< Parts that cannot come out, and why.
  /** No smaller set of parts gets the part out; false where the search was ended early. */
  bool is_smallest{true};
};

/** Options of a plan. */
struct DisassemblyOptions {
  product::OccurrenceId target;   ///< The part to get out; invalid: all of them.
  std::vector<bool> is_in_place;  ///< Parts that are there, by OccurrenceId; empty: all.
  std::function<void(double fraction)> progress;  ///< May be null.
  /** Sets of parts tried for the smallest one. 20,000 take about a second: a choice. */
  int max_sets{20000};
};

/** Plans the disassembly of a model: all its parts, or the smallest set of parts that has to come
 out for one of them, along straight lines that mates and other parts leave free (X16).
 Deterministic. docs/algorithms/sequence.md has the method. */
[[nodiscard]] DisassemblyPlan PlanDisassembly(const Model& model,
                                              const DisassemblyOptions& options);

/** Calculates the force that breaks the fits of all that moves in a step loose at their full depth
 [N]: the sum over the mates with parts that are in place and do not move.
 @param is_in_place  By OccurrenceId. */
[[nodiscard]] double CalcBreakaway(const Model& model, const sequence::SequenceStep& step,
                                   const std::vector<bool>& is_in_place);

}  // namespace hvas::simulation
