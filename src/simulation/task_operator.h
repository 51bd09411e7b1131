#pragma once

#include <string>

#include "simulation/operator.h"
#include "simulation/person_task.h"

namespace hvas::simulation {

/** An operator that is given one part after the other: a simulated person, or a guided hand. */
class TaskOperator : public Operator {
 public:
  /** Gives it a part to do, which is begun when the last one is done. One other thread may call
   this while Step runs. False when too many wait already. */
  virtual bool Assign(const PersonTask& task) noexcept = 0;

  /** Parts that were begun and let go again, in their place or not. Any thread. */
  [[nodiscard]] virtual int finished_count() const noexcept = 0;

  /** Whether it let the last part go elsewhere than in its place. Any thread. */
  [[nodiscard]] virtual bool gave_up() const noexcept = 0;

  /** How often it is given a part that it did not bring in: its next try may go otherwise. */
  [[nodiscard]] virtual int most_tries() const { return 1; }

  /** Says what it did before it gave a part up, as in "gave up after 3 searches". */
  [[nodiscard]] virtual std::string DescribeEffort() const = 0;
};

}  // namespace hvas::simulation
