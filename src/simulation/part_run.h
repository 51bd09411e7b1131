#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "simulation/arm.h"
#include "simulation/executors.h"
#include "simulation/passage_watch.h"
#include "simulation/pressed_pairs.h"
#include "simulation/simulation.h"
#include "simulation/task_operator.h"

namespace hvas::simulation {

/** What a part needs to get to its place beyond what the drawing leaves free: without it there
 is no way. */
struct PartAllowance {
  enum class Kind : std::uint8_t {
    kDrawn,  ///< The two lie in one another as drawn.
    kGive,   ///< One of the two gives.
  };

  Kind kind{Kind::kDrawn};
  product::OccurrenceId own;               ///< The part, or the member of its subassembly.
  product::OccurrenceId other;             ///< The part that was in its place before.
  double depth{0};                         ///< [m]
  bool is_beyond{false};                   ///< kDrawn: contact begins deeper than drawn.
  std::vector<std::uint32_t> own_faces;    ///< kDrawn: the faces that overlap.
  std::vector<std::uint32_t> other_faces;  ///< kDrawn: those of the other part.
  product::OccurrenceId flexible;          ///< kGive: the one that gives.
  product::FlexibleKind flexible_kind{product::FlexibleKind::kStated};  ///< kGive: why it may.
  double strain{0};           ///< kGive: the largest of what bends; 0 where it is not known.
  double bearable_strain{0};  ///< kGive: what its material bears of it.
  /** kGive: the largest forces that it takes, in and out, true [N]; 0 where none is known. */
  haptics::GivingPeak force{};
};

/** How one part fared. */
struct PartResult {
  product::OccurrenceId occurrence;
  bool is_seated{false};
  /** It could not be brought to its place, and was put where the drawing has it, so that the parts
   after it could be tried. */
  bool is_assumed{false};
  std::string reason;                     ///< Why not, when it is not seated.
  std::string note;                       ///< What was odd about it although it is; may be empty.
  std::vector<PartAllowance> allowances;  ///< It is in its place only by these.
  std::vector<PressedPair> presses;       ///< What it presses together.
  double time{0};                         ///< Time from taking it up to letting go [s].
  double path{0};                         ///< [m]
  double peak_true{0};                    ///< [N]
  double peak_felt{0};                    ///< [N]
  double fit_true{0};                     ///< Largest axial force of its fits, true [N].
  double fit_felt{0};                     ///< Largest axial force of its fits, as felt [N].
  double preload{0};                      ///< Largest force in it as a screw or nut, true [N].
  double tightening{0};                   ///< Largest torque of its thread and head, true [N m].
  double deepest{0};                      ///< Deepest penetration met [m].
  Passage passage;                        ///< What it passed through, beyond what is drawn.
  double insertion{0};                    ///< Longest that a mate's shaft was in its hole [m].
  std::size_t hand{0};                    ///< That let go of it last.
  int mates{0};                           ///< Mates with parts that were in place.
  /** It was put into a fixture, or had a mate with a part in its place, or touched one, when it got
   to its own place. */
  bool has_touched{false};
  /** Distance from its place to which the hand brought it, before it was moved exactly there [m].
   */
  double arrival{0};
  double arrival_angle{0};  ///< [rad]
  /** Distance of the origin from the file's pose [m]: what the resolver of the mates leaves, as a
   seated part stands where they say. */
  double pose_error{0};
  double pose_error_angle{0};  ///< [rad]

  /** Its fits take more than kMostHandForce. */
  [[nodiscard]] bool needs_press() const { return fit_true > kMostHandForce; }
};

/** How far an assembly has come. */
struct AssemblyProgress {
  std::size_t tried{0};  ///< Parts that have had their turn.
  std::size_t done{0};   ///< Parts that are where they were to go, of those tried.
  std::size_t total{0};
  std::int64_t t_ns{0};  ///< Session time.
};

/** What does the tasks, by hand; null where a real person has that hand, or there is none. */
using TaskOperators = std::array<TaskOperator*, haptics::kMaxHands>;

/** A run of a simulation in which parts have their turn one after the other, with the results of
 each: the base of AssemblyRun and DisassemblyRun. As a Sink the run stands between the loops and
 the record. */
class PartRun : public Sink {
 public:
  /** @param downstream  Gets everything too; may be null. */
  PartRun(Simulation* simulation, Sink* downstream);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const SimulationEvent& event) override;
  void OnFlight(const std::vector<FlightTick>& ticks) override;

  /** Describes this run for an executor: advanced until it is done, with these in the hands.
   @param limit_s  Of session time [s]. */
  [[nodiscard]] Execution MakeExecution(const Operators& hands, double limit_s);

  /** Describes the run of a simulation with one hand. */
  [[nodiscard]] Execution MakeExecution(Operator* hand, double limit_s) {
    return MakeExecution(Operators{hand}, limit_s);
  }

  /** Gives a worker who is free the next part. To be called after every physics step, on its
   * thread. */
  virtual void Advance() = 0;

  [[nodiscard]] bool is_done() const { return is_done_; }

  [[nodiscard]] const std::vector<PartResult>& results() const { return results_; }

  /** Called after every step with the result of the part that moved. */
  std::function<void(const AssemblyProgress&, const PartResult&)> on_part;

 protected:
  /** Called with each event of a part that was let go, after the last one of this part has been
   kept. */
  virtual void OnDropped(const SimulationEvent& dropped) = 0;

  [[nodiscard]] const Model& model() const { return simulation_->model(); }

  [[nodiscard]] PhysicsSide& physics() { return simulation_->physics(); }

  [[nodiscard]] const PhysicsSide& physics() const { return simulation_->physics(); }

  [[nodiscard]] std::size_t hand_count() const { return simulation_->hand_count(); }

  [[nodiscard]] PartResult& ResultOf(product::OccurrenceId id);
  /** Adds what the last hold of a part amounted to, if there was one, to its result. */
  void AddHold(product::OccurrenceId id);
  /** Puts a part where the drawing has it although nothing has brought it there. */
  void Assume(product::OccurrenceId id);
  /** Sets where a part is now in its result. */
  void Update(product::OccurrenceId id);
  [[nodiscard]] const std::string& PathOf(product::OccurrenceId id) const;
  /** Lists what moves in a step is allowed with the parts that are in their places. */
  [[nodiscard]] std::vector<PartAllowance> ListPartAllowances(
      const sequence::SequenceStep& step) const;
  /** Finds which of two parts a step moves while the other one is in its place: whether it is the
   first; none where it is not so. */
  [[nodiscard]] std::optional<bool> FindMoved(const sequence::SequenceStep& step,
                                              product::OccurrenceId a,
                                              product::OccurrenceId b) const;
  /** Lists what moves in a step presses together in its place. */
  [[nodiscard]] std::vector<PressedPair> ListPresses(const sequence::SequenceStep& step) const;
  /** Describes what is pressed hardest, as in "presses spring together by 3.00 mm: 82.5 N (G d^4 /
   (8 D^3 n), Wahl)"; empty where it is nothing. */
  [[nodiscard]] std::string DescribePresses(const std::vector<PressedPair>& presses) const;
  /** Names the deepest allowance of each kind, with its depth. */
  [[nodiscard]] std::string DescribeAllowances(const std::vector<PartAllowance>& allowances) const;
  [[nodiscard]] std::string DescribeAllowance(const PartAllowance& allowance, bool is_beyond,
                                              const std::string& more) const;
  /** Counts the parts in their place that hold what moves in a step, where it is to go. */
  [[nodiscard]] std::size_t CountNeighboursInPlace(const sequence::SequenceStep& step) const;
  /** Names the part that was pressed hardest in a hold, with the force. */
  [[nodiscard]] std::string DescribeHardest(const HoldMetrics& metrics) const;
  /** Whether no mate with a part in its place but planes guides what moves in a step. */
  [[nodiscard]] bool IsGuidedByPlanes(const sequence::SequenceStep& step) const;
  /** Whether all fits of a part with parts in their places have play. */
  [[nodiscard]] bool HasOnlyPlay(const sequence::SequenceStep& step) const;
  /** Whether a part that a step moves within the product is not where the step begins. */
  [[nodiscard]] bool HasNothingToMove(const sequence::SequenceStep& step) const;
  /** The way of what moves in a step; empty where it is straight. A thread's is a helix where
   threads turn. */
  [[nodiscard]] paths::Path WayOf(const sequence::SequenceStep& step);
  /** The task of a person who puts in or takes out what moves in a step. */
  [[nodiscard]] PersonTask MakeTask(const sequence::SequenceStep& step);

  std::array<haptics::HoldState, haptics::kMaxHands> states_{};  ///< One for each hand.
  std::vector<std::optional<SimulationEvent>> dropped_;  ///< Last of each part, by OccurrenceId.
  std::vector<bool> has_touched_;  ///< PartResult::has_touched, by OccurrenceId.
  std::vector<bool> is_assumed_;   ///< PartResult::is_assumed, by OccurrenceId.
  std::vector<PartResult> results_;
  bool is_done_{false};

 private:
  Simulation* simulation_;
  Sink* downstream_;
  double lift_height_{0.05};
  std::deque<sequence::GripWay> ways_;  // Of the tasks that were made.
};

/** Where a person stands who has all parts on the table in front: the first pose of the hand. */
[[nodiscard]] spatial::Pose StartOfHand(const Model& model);

}  // namespace hvas::simulation
