#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "haptics/options.h"
#include "person/arm_hand.h"
#include "simulation/executors.h"
#include "simulation/model.h"
#include "simulation/simulation.h"

namespace hvas::assembly {

/** What a hand takes up, and how the tick answers it. */
struct SteppedOptions {
  /** Index into Sequence::steps of what the hand is to bring to its place: everything that steps
   before it move is where they bring it. */
  std::size_t step{1};
  /** Where the part is when the hand takes it; none: where it lies on the table. */
  std::optional<spatial::Pose> X_WB_start;
  haptics::Condition condition{haptics::Condition::kHybrid};
  /** A shaft with play touches its hole (GuidanceOptions::contact_in_holes). */
  bool contact_in_holes{false};
  /** Threads go in by turning, and are tightened (GuidanceOptions::threads_turn). */
  bool threads_turn{false};
  person::PersonOptions arm;  ///< Impedance of the arm; its other habits are not used.
  double rate_hz{1000};       ///< Rate of the haptic tick, 1000 to 8000 [Hz].
};

/** One tick in plain numbers: programs in other languages read them where they are. Positions in m,
 quaternions as w, x, y, z, forces in N before torques in N m, all in W. */
struct TickRow {
  double t_s{0};             ///< Session time at the beginning of the tick.
  double X_WH[7]{};          ///< The hand.
  double X_WB[7]{};          ///< The part as displayed; the hand where nothing is held.
  double F_felt_W[6]{};      ///< Wrench that the hand is given, about the hand.
  double F_true_W[6]{};      ///< Wrench of physics, about the part's centre of mass.
  double p_WC[3]{};          ///< The contact that presses hardest; zero where there is none.
  double f_C_W[3]{};         ///< Its force on the part.
  double deepest{0};         ///< Distance of the deepest contact, negative inside; infinite: none.
  double insertion{0};       ///< Depth of the shaft in its hole [m].
  double axial_true{0};      ///< Resistance of the fits along their axis [N].
  double preload{0};         ///< Force in a screw or nut that is being tightened [N].
  double tightening{0};      ///< Torque of its thread and head [N m].
  double offset{0};          ///< Distance from the axis that guides the part [m]; 0: none does.
  double tilt{0};            ///< Angle to that axis [rad].
  std::int32_t contacts{0};  ///< Contacts that press.
  std::int32_t state{0};     ///< haptics::HoldState.
};

/** A contact that presses on the part, in plain numbers, in W. */
struct ContactRow {
  double p_WC[3]{};
  double f_C_W[3]{};       ///< Force on the part [N].
  double distance{0};      ///< Distance before the tick; negative inside [m].
  std::int32_t other{-1};  ///< OccurrenceId of the part that it is with; -1: none.
};

/** An assembly that a program runs tick by tick in virtual time, with a hand that it leads itself:
 for policies that learn or are written, in C++ or in other languages. One step of the sequence,
 from taking the part until it is let go or in its place. The same model, options and references
 give the same rows, bit for bit. */
class SteppedRun {
 public:
  /** Prepares a run, with the part in the hand.
   Errors: kInvalid for a step that puts nothing in or does not exist, a pose that is not finite, a
   rate outside 1000 to 8000 Hz, or a part that cannot be taken there. */
  [[nodiscard]] static Result<std::unique_ptr<SteppedRun>> Create(
      std::shared_ptr<const simulation::Model> model, const SteppedOptions& options);

  SteppedRun(const SteppedRun&) = delete;
  SteppedRun& operator=(const SteppedRun&) = delete;

  /** Runs ticks with the hand led to the reference; returns their rows, which are valid until the
   next call. */
  std::span<const TickRow> Step(const simulation::HandReference& reference, std::size_t ticks);

  /** Row of the last tick. */
  [[nodiscard]] const TickRow& last() const { return rows_.back(); }

  /** Contacts that pressed in the last tick; valid until the next step. */
  [[nodiscard]] std::span<const ContactRow> contacts() const { return contacts_; }

  [[nodiscard]] bool is_seated() const {
    return rows_.back().state == static_cast<std::int32_t>(haptics::HoldState::kSeated);
  }

  /** Where the part is to go: its pose in W. */
  [[nodiscard]] const spatial::Pose& goal() const { return X_WB_goal_; }

  /** Pose of the part in the hand, as it was taken. */
  [[nodiscard]] const spatial::Pose& X_HB() const { return X_HB_; }

  [[nodiscard]] const simulation::Model& model() const { return *model_; }

  [[nodiscard]] const sequence::SequenceStep& step() const {
    return model_->sequence.steps[options_.step];
  }

  /** Where all parts are, by OccurrenceId, as the physics loop knows it; what is in the hand as
   displayed. */
  [[nodiscard]] std::vector<simulation::PartState> ListParts() const;

 private:
  // Keeps a row of each tick.
  class RowKeeper;

  SteppedRun(std::shared_ptr<const simulation::Model> model, const SteppedOptions& options);
  [[nodiscard]] std::vector<simulation::PartState> ListBeginning() const;
  [[nodiscard]] bool TakeUp();

  std::shared_ptr<const simulation::Model> model_;
  SteppedOptions options_;
  spatial::Pose X_WB_goal_;
  spatial::Pose X_HB_;
  std::vector<TickRow> rows_;
  std::vector<ContactRow> contacts_;
  std::unique_ptr<simulation::Simulation> simulation_;
  std::unique_ptr<person::ArmHand> hand_;
  std::shared_ptr<RowKeeper> keeper_;
  std::unique_ptr<simulation::Lockstep> lockstep_;
};

}  // namespace hvas::assembly
