#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulation/executors.h"
#include "simulation/simulated_person.h"
#include "simulation/simulation.h"

namespace hvas::simulation {

/** How one part fared. */
struct PartResult {
  product::OccurrenceId occurrence;
  bool is_seated{false};
  std::string reason;   ///< Why not, when it is not seated.
  std::string note;     ///< What was odd about it although it is; may be empty.
  double time{0};       ///< Time from taking it up to letting go [s].
  double path{0};       ///< [m]
  double peak_true{0};  ///< [N]
  double peak_felt{0};  ///< [N]
  double fit_true{0};   ///< Largest axial force of its fits, true [N].
  double fit_felt{0};   ///< Largest axial force of its fits, as felt [N].
  double deepest{0};    ///< Deepest penetration met [m].
  double insertion{0};  ///< Longest that a mate's shaft was in its hole [m].
  std::size_t hand{0};  ///< That let go of it last.
  int mates{0};         ///< Mates with parts that were in place.
  /** Distance from its place to which the hand brought it, before it was moved exactly there [m].
   */
  double arrival{0};
  double arrival_angle{0};  ///< [rad]
  /** Distance of the origin from the file's pose [m]: what the resolver of the mates leaves, as a
   seated part stands where they say. */
  double pose_error{0};
  double pose_error_angle{0};  ///< [rad]
};

/** How far an assembly has come. */
struct AssemblyProgress {
  std::size_t tried{0};   ///< Parts that have had their turn.
  std::size_t seated{0};  ///< Parts in their place, of those tried.
  std::size_t total{0};
  std::int64_t t_ns{0};  ///< Session time.
};

/** The simulated persons, by hand; null where a real one has that hand, or there is none. */
using Persons = std::array<SimulatedPerson*, 2>;

/** Has a model assembled, one part after the other in the order that was found, and keeps the
 account: by simulated persons, or by the user of the device. Two persons take turns. While one
 puts a part in, the other begins with the next one where their ways in are apart: neither stands
 in the other's way, whichever comes first. A real hand beside a simulated one does what it likes;
 what it puts in its place is done. As a Sink the run stands between the loops and the record. */
class AssemblyRun final : public Sink {
 public:
  /** @param person  Null: a real one, who puts each part in its place in their own time.
   @param downstream  Gets everything too; may be null. */
  AssemblyRun(Simulation* simulation, SimulatedPerson* person, Sink* downstream)
      : AssemblyRun(simulation, Persons{person, nullptr}, downstream) {}

  AssemblyRun(Simulation* simulation, const Persons& persons, Sink* downstream);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const SimulationEvent& event) override;
  void OnFlight(const std::vector<FlightTick>& ticks) override;

  /** Limits a run that has not begun to these steps of the sequence; what comes before them is in
 place. */
  void Only(std::size_t first, std::size_t count) {
    first_step_ = first;
    end_step_ = first + count;
  }

  /** Describes this run for an executor: advanced until it is done, with these in the hands.
   @param limit_s  Of session time [s].
   @param second_hand  Of a simulation with two; else null. */
  [[nodiscard]] Execution MakeExecution(Operator* hand, double limit_s,
                                        Operator* second_hand = nullptr);

  /** Lets a run that has not begun go on with this step; what came before it was done already. */
  void Resume(std::size_t next_step) { next_step_ = next_step; }

  /** The first step of the sequence that is not done; their number when all are. */
  [[nodiscard]] std::size_t next_step() const;

  /** Gives a worker who is free the next part. To be called after every physics step, on its
   * thread. */
  void Advance();

  [[nodiscard]] bool is_done() const { return is_done_; }

  [[nodiscard]] const std::vector<PartResult>& results() const { return results_; }

  /** Called after every step with the result of the part that moved. */
  std::function<void(const AssemblyProgress&, const PartResult&)> on_part;

 private:
  /** Who does the steps, one at a time: a simulated person, or the user of the devices. */
  struct Worker {
    SimulatedPerson* person{nullptr};
    std::size_t hand{0};  ///< The person's.
    const SequenceStep* step{nullptr};
    int finished_before{0};
  };

  [[nodiscard]] PartResult& ResultOf(product::OccurrenceId id);
  [[nodiscard]] std::string ExplainFailure(const SequenceStep& step, const Worker& worker) const;
  [[nodiscard]] bool HasFinished(const Worker& worker) const;
  /** Another hand than the worker's has put it in its place. */
  [[nodiscard]] bool IsDoneByAnother(const SequenceStep& step, const Worker& worker) const;
  /** The part was in its place before the run began. */
  [[nodiscard]] bool IsInPlaceAlready(const SequenceStep& step) const;
  /** Its step is to be done again where the part was in its place before. */
  void GoBackTo(const SimulationEvent& dropped);
  void FinishStep(const SequenceStep& step, const Worker& worker);
  /** Null where the step has to wait. */
  [[nodiscard]] Worker* FindWorkerFor(const SequenceStep& step);
  /** Around the part in its place and on its way there, where it engages. */
  [[nodiscard]] spatial::Box WayIn(const SequenceStep& step) const;
  [[nodiscard]] bool CanGoOnBeside(const SequenceStep& step, const Worker& busy) const;
  /** False when the worker could not take it on now. */
  bool Begin(const SequenceStep& step, Worker* worker);
  void FinishAll();
  void Update(product::OccurrenceId id);
  [[nodiscard]] std::string DescribeOverlaps(product::OccurrenceId id) const;
  [[nodiscard]] PersonTask MakeTask(const SequenceStep& step) const;

  Simulation* simulation_;
  PhysicsSide& physics_;
  std::vector<Worker> workers_;
  std::size_t last_worker_;  ///< That began a step last.
  Sink* downstream_;
  std::vector<PartResult> results_;
  std::vector<bool> is_finished_;  ///< One for each step.
  std::size_t next_step_{0};
  std::size_t first_step_{0};
  std::size_t end_step_{std::numeric_limits<std::size_t>::max()};
  std::size_t total_{0};
  std::array<haptics::HoldState, 2> states_{};           ///< One for each hand.
  std::vector<std::optional<SimulationEvent>> dropped_;  ///< Last of each part, by OccurrenceId.
  double lift_height_{0.05};
  bool is_done_{false};
};

/** Where a person stands who has all parts on the table in front: the first pose of the hand. */
[[nodiscard]] spatial::Pose StartOfHand(const Model& model);

}  // namespace hvas::simulation
