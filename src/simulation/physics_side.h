#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/triple_buffer.h"
#include "haptics/held_part.h"
#include "simulation/handover.h"
#include "simulation/held_part_maker.h"
#include "simulation/model.h"
#include "simulation/part_state.h"

namespace hvas::simulation {

/** What the physics thread alone touches of a simulation: who holds what, and where all parts are.
 */
class PhysicsSide {
 public:
  using CommandListener = std::function<void(const GivenCommand&)>;

  /** @param handover  To and from the haptic loop.
   @param frames  For the publishing thread. Both outlive this object. */
  PhysicsSide(std::shared_ptr<const Model> model, const std::vector<haptics::TickOptions>& hands,
              Handover* handover, TripleBuffer<Frame>* frames);

  /** One step: taking up and letting go, where loose parts have come to. `sink` may be null. */
  void Step(Sink* sink);

  /** States of all parts, indexed by OccurrenceId. */
  [[nodiscard]] const std::vector<PartState>& parts() const { return parts_; }

  [[nodiscard]] Placement placement(product::OccurrenceId id) const {
    return parts_[id.index()].placement;
  }

  [[nodiscard]] const spatial::Pose& pose(product::OccurrenceId id) const {
    return parts_[id.index()].X_WB;
  }

  /** Something is in this hand, or on its way into it. */
  [[nodiscard]] bool is_holding(std::size_t hand) const { return hands_[hand].held != nullptr; }

  /** What is in this hand, or on its way into it; null: nothing. */
  [[nodiscard]] const haptics::HeldPart* held(std::size_t hand) const {
    return hands_[hand].held.get();
  }

  /** The last tick of this hand that has been reported. */
  [[nodiscard]] const haptics::TickOutput& tick(std::size_t hand) const {
    return handover_.reports[hand].value().out;
  }

  /** Puts a part in its place without a hand: the base in its fixture. */
  void PlaceInFixture(product::OccurrenceId id);

  /** What the next part that a hand takes up is for: its place, its way in, and what moves with it.
   Parts that were not prepared go to their drawn place by their step of the sequence. */
  void Prepare(const sequence::SequenceStep& step, std::size_t hand = 0) {
    hands_[hand].prepared = step;
  }

  /** Lets a hand take hold of what another hand holds as well, when it next closes within reach of
   the middle of its mass. */
  void PrepareHelp(std::size_t other, std::size_t hand) { hands_[hand].helps_next = other; }

  /** What a hand would have in it in this step, with the parts where they are now. */
  [[nodiscard]] std::shared_ptr<const haptics::HeldPart> Describe(
      const sequence::SequenceStep& step) {
    return maker_.Make(step, false);
  }

  /** Asks HeldPartMaker for where the parts are now. */
  [[nodiscard]] product::OccurrenceId FindMissingPartner(const sequence::SequenceStep& step) const {
    return maker_.FindMissingPartner(step);
  }

  /** Lets a hand that is closed already take nothing until it has been open: it is closed on
   something else. Only before the loops run. */
  void AwaitOpenGrip(std::size_t hand) { hands_[hand].is_waiting_for_grip_to_open = true; }

  /** Lets this hand, where it closes on no loose part, take the nearest one that is in its place
   out again (X16). Only before the loops run. */
  void AllowTakingOut(std::size_t hand) { hands_[hand].takes_out = true; }

  /** Lets what this hand takes be put to loose parts on the table, which makes a subassembly (X1).
   Only before the loops run. */
  void AllowJoining(std::size_t hand) { hands_[hand].can_join = true; }

  /** Loose parts that are together; they live as long as this object. */
  [[nodiscard]] std::vector<const haptics::RigidGroup*> ListLooseGroups();

  /** Sets what is called with each command before a tick can carry it out. Only before the loops
   * run.
   */
  void SetCommandListener(CommandListener listener) { on_command_ = std::move(listener); }

  /** Keeps in `log` the parts that are taken up. Only before the loops run. */
  void KeepLog(TickLog* log) { log_ = log; }

  /** Goes on from where all parts were; what was held is loose where it was. Only before the loops
   run. */
  void Restore(const std::vector<PartState>& parts);

  /** The command that was given when parts were as it says. It is not sent.
   @param held_before  Keeps what the hand held until the caller has had the command carried out. */
  [[nodiscard]] TickCommand RemakeCommand(const GivenCommand& given,
                                          std::shared_ptr<const haptics::HeldPart>* held_before);

  [[nodiscard]] const Model& model() const { return *model_; }

 private:
  struct Hand {
    std::shared_ptr<const haptics::HeldPart> held;  ///< Kept until haptics has let go of it.
    sequence::SequenceStep held_step;
    std::optional<sequence::SequenceStep> prepared;
    std::optional<std::size_t> helps_next;  ///< Whose part it takes hold of next.
    std::optional<std::size_t> helps;       ///< Whose part it has taken hold of.
    bool is_waiting_for_grip_to_open{false};
    bool takes_out{false};
    bool can_join{false};
    bool reports_energy{false};
    std::int64_t next_energy_ns{0};
  };

  /** @param step  What is taken; of what is placed or held by two the occurrence alone. */
  void Send(const TickCommand& command, const sequence::SequenceStep& step, bool can_join);
  /** @returns whether the hand takes hold of another one's part. */
  bool TryHelp(std::size_t hand, const Vec3& p_WH);
  void FlushCommands();
  void HandleDrop(const SimulationEvent& event);
  void HandleReport(std::size_t hand);
  void ReportEnergy(std::size_t hand, Sink* sink);
  /** Moves a loose part with all that it is together with; it leads them. */
  void MoveTogether(product::OccurrenceId id, const spatial::Pose& X_WB);
  void PublishFrame();
  void TakeNearest(std::size_t hand, const Vec3& p_WH);
  void Take(std::size_t hand, const sequence::SequenceStep& step);
  /** The nearest part of this placement within reach of a hand; invalid where there is none. */
  [[nodiscard]] product::OccurrenceId FindNearest(const Vec3& p_WH, Placement placement) const;
  [[nodiscard]] bool CanTake(const sequence::SequenceStep& step, const Vec3& p_WH) const;

  std::shared_ptr<const Model> model_;
  Handover& handover_;
  TripleBuffer<Frame>& frames_;
  std::vector<PartState> parts_;
  HeldPartMaker maker_;
  std::deque<Hand> hands_;
  CommandListener on_command_;
  TickLog* log_{nullptr};
  std::uint32_t given_commands_{0};
  std::deque<TickCommand> waiting_commands_;  ///< The ring has no room for them yet.
};

}  // namespace hvas::simulation
