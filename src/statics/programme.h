#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "statics/equilibrium.h"
#include "statics/problem.h"

namespace hvas::statics {

/** The linear programme of a problem (docs/algorithms/statics.md). It is solved again with other
 bodies held from where it ended. */
class Programme {
 public:
  /** @pre CheckProblem passes. @param problem  Outlives this object. */
  Programme(const StaticProblem& problem, const StaticOptions& options);
  ~Programme();
  Programme(const Programme&) = delete;
  Programme& operator=(const Programme&) = delete;

  /** Solves it with some bodies held, as if they were fixed. `hold_wrenches_W` has what they hold.
   Errors: kInternal where it is not solved to the end. */
  [[nodiscard]] Result<Equilibrium> Solve(const std::vector<bool>& is_held);

  /** Groups of bodies that move together in the last answer, each of which is a proof by itself. */
  [[nodiscard]] const std::vector<std::vector<int>>& moving_groups() const { return groups_; }

  /** What the last answer holds of each body, in weights, and in weights times size. */
  [[nodiscard]] const std::vector<double>& hold_sizes() const { return hold_sizes_; }

 private:
  struct Data;

  /** Adds the bodies that move in the proof that the last answer does not stand. */
  void AddProof(const std::vector<bool>& is_held, Equilibrium* found);

  std::unique_ptr<Data> data_;
  std::vector<std::vector<int>> groups_;
  std::vector<double> hold_sizes_;
};

}  // namespace hvas::statics
