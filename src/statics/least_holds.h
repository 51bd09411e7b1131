#pragma once

#include <vector>

#include "base/result.h"
#include "statics/equilibrium.h"
#include "statics/problem.h"

namespace hvas::statics {

/** Bodies to hold, by hand or by a fixture, so that all stand. */
struct LeastHolds {
  std::vector<int> bodies;  ///< Sorted; empty where all stand by themselves.
  int least{0};             ///< It is proved that fewer than these do not suffice.
  bool is_proven{false};    ///< `bodies` are as few as `least`.
  int programmes{0};        ///< Linear programmes that were solved.
  Equilibrium unheld;       ///< The answer where nothing is held, as SolveEquilibrium() gives it.
};

/** Finds the least number of bodies that have to be held. A hold takes any wrench.

 In each proof that bodies fall, some body that moves in it has to be held: else the proof stays. So
 the fewest bodies that hit all proofs known are held, and either all stands, and fewer do not
 suffice, or there is another proof (the implicit hitting set of Moreno-Centeno and Karp, Operations
 Research 61(2), 2013). Where the programmes of the options do not suffice, what each programme
 would hold is held as well until all stands, and holds that are not needed are taken away one by
 one. Errors: those of SolveEquilibrium. */
[[nodiscard]] Result<LeastHolds> FindLeastHolds(const StaticProblem& problem,
                                                const StaticOptions& options = {});

}  // namespace hvas::statics
