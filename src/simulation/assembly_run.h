#pragma once

#include <limits>
#include <string>
#include <vector>

#include "simulation/part_run.h"

namespace hvas::simulation {

/** Has a model assembled, one part after the other in the order that was found, and keeps the
 account: by simulated persons, or by the user of the device. Several persons take turns. While one
 puts a part in, the other begins with the next one where their ways in are apart: neither stands
 in the other's way, whichever comes first. A real hand beside a simulated one does what it likes;
 what it puts in its place is done.

 What has no way in, or could not be brought in, is put where the drawing has it (kAssume,
 PartResult::is_assumed), so that one part does not take others with it. A simulated person, whose
 hand may miss, tries each part up to three times before. */
class AssemblyRun final : public PartRun {
 public:
  /** @param mover  Null: a real person, who puts each part in its place in their own time.
   @param downstream  Gets everything too; may be null. */
  AssemblyRun(Simulation* simulation, TaskOperator* mover, Sink* downstream)
      : AssemblyRun(simulation, TaskOperators{mover}, downstream) {}

  AssemblyRun(Simulation* simulation, const TaskOperators& movers, Sink* downstream);

  /** Limits a run that has not begun to these steps of the sequence; what comes before them is in
 place. */
  void Only(std::size_t first, std::size_t count) {
    first_step_ = first;
    end_step_ = first + count;
  }

  /** Lets a run that has not begun go on with this step; what came before it was done already. */
  void Resume(std::size_t next_step) { next_step_ = next_step; }

  /** The first step of the sequence that is not done; their number when all are. */
  [[nodiscard]] std::size_t next_step() const;

  void Advance() override;

 private:
  /** Who does the steps, one at a time: an operator that is given tasks, or the user of the
   * devices. */
  struct Worker {
    TaskOperator* mover{nullptr};
    std::size_t hand{0};  ///< The mover's.
    const sequence::SequenceStep* step{nullptr};
    int finished_before{0};
  };

  /** How the step of one part, or of a subassembly, went. */
  struct Turn {
    bool is_finished{false};
    int tries{0};        ///< Times that it has been taken up.
    std::string reason;  ///< Why the first try failed.
  };

  /** Leader of what the part was put together with on the table; invalid: it is by itself. */
  [[nodiscard]] product::OccurrenceId LeaderOf(product::OccurrenceId id) const;
  /** How the part was let go last, alone or as a member of a subassembly of the table. */
  [[nodiscard]] const std::optional<SimulationEvent>& DropOf(product::OccurrenceId id) const;
  [[nodiscard]] std::string ExplainFailure(const sequence::SequenceStep& step,
                                           const Worker& worker);
  /** Says where a part was let go, and which of its faces touched which one there. */
  [[nodiscard]] std::string DescribeWhere(const SimulationEvent& dropped);
  [[nodiscard]] bool HasFinished(const Worker& worker) const;
  /** Another hand than the worker's has put it in its place. */
  [[nodiscard]] bool IsDoneByAnother(const sequence::SequenceStep& step,
                                     const Worker& worker) const;
  /** The part was in its place before the run began. */
  [[nodiscard]] bool IsInPlaceAlready(const sequence::SequenceStep& step) const;
  /** A move within the product has nothing to move, or nothing to let pass. */
  [[nodiscard]] bool IsInVain(const sequence::SequenceStep& step) const;
  /** The step of a part that was in its place before is to be done again. */
  void OnDropped(const SimulationEvent& dropped) override;
  void FinishStep(const sequence::SequenceStep& step, const Worker& worker);
  /** Whether a step that has failed is begun again by the same worker. */
  [[nodiscard]] bool TryAgain(const sequence::SequenceStep& step, Worker* worker);
  /** Calls on_part for a part whose turn is over. */
  void TellPart(product::OccurrenceId id, std::int64_t t_ns);
  /** Puts what a step moves where the drawing has it. */
  void AssumeStep(const sequence::SequenceStep& step);
  [[nodiscard]] std::size_t IndexOf(const sequence::SequenceStep& step) const;
  /** Sets how a step that is finished went, and gives the reason why the part is not in its place.
   */
  [[nodiscard]] std::string FinishTurn(const sequence::SequenceStep& step, const Worker& worker,
                                       bool was_seated);
  /** Explains why a part touches nothing when it gets to its place; empty where it does. */
  [[nodiscard]] std::string ExplainUntouched(product::OccurrenceId id) const;
  /** Explains what a part went through on its way, beyond what the two are allowed; empty where
   that is nothing. */
  [[nodiscard]] std::string ExplainPassage(const PartResult& result) const;
  /** Says which part is moved aside to let this one pass; empty where none is. */
  [[nodiscard]] std::string DescribeAside(product::OccurrenceId id) const;
  /** Says that a part takes more than a hand; empty where it does not. */
  [[nodiscard]] static std::string DescribePress(const PartResult& result);
  /** What is odd about a part's place. */
  [[nodiscard]] std::string MakeNote(const PartResult& result) const;
  /** Does the step whose turn it is; false where it has to wait. */
  [[nodiscard]] bool DoNext(const sequence::SequenceStep& step);
  /** Null where the step has to wait. */
  [[nodiscard]] Worker* FindWorkerFor(const sequence::SequenceStep& step);
  /** Around the part in its place and on its way there, where it engages. */
  [[nodiscard]] spatial::Box WayIn(const sequence::SequenceStep& step) const;
  [[nodiscard]] bool CanGoOnBeside(const sequence::SequenceStep& step, const Worker& busy) const;
  /** False when the worker could not take it on now. */
  bool Begin(const sequence::SequenceStep& step, Worker* worker);
  void FinishAll();

  std::vector<Worker> workers_;
  std::size_t last_worker_;  ///< That began a step last.
  std::vector<Turn> turns_;  ///< One for each step.
  PassageWatch passages_;
  std::size_t next_step_{0};
  std::size_t first_step_{0};
  std::size_t end_step_{std::numeric_limits<std::size_t>::max()};
};

}  // namespace hvas::simulation
