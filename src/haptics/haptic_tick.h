#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "contact/scene.h"
#include "device/device.h"
#include "haptics/constraint_solver.h"
#include "haptics/fit_rows.h"
#include "haptics/force_map.h"
#include "haptics/free_bodies.h"
#include "haptics/friction_memory.h"
#include "haptics/held_part.h"
#include "haptics/mate_guide.h"
#include "haptics/options.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"

namespace hvas::haptics {

/** States of a held part, in the order in which an assembly passes through them. */
enum class HoldState : std::uint8_t {
  kEmpty,     ///< Nothing in the hand.
  kFree,      ///< Held, no mate in range.
  kNear,      ///< A mate is close.
  kCaptured,  ///< A mate guides the part onto its axis.
  kMating,    ///< On the axis; the faces of the mate answer by their fit.
  kSeated,    ///< In its place; moves exactly there and stays.
};

[[nodiscard]] const char* ToString(HoldState state) noexcept;

/** How the held part stands to the mate whose axis guides it. */
struct GuidedAxis {
  product::MateId mate;  ///< Invalid: none does.
  Vec3 p_WQ{Vec3::Zero()};
  Vec3 axis_W{Vec3::UnitZ()};
  double tilt{0};        ///< [rad]
  double offset{0};      ///< Across the axis [m].
  double depth{0};       ///< Of insertion; negative by how far it is from the hole [m].
  double depth_goal{0};  ///< In its place [m].
};

/** What else the loop knows at a tick. */
struct TickContext {
  std::int64_t model_age_ns{0};  ///< Since the physics loop last answered.
  bool is_stopped{false};        ///< Somebody has switched all forces off.
  int effort_level{0};           ///< What SetEffort was told, by the loop's own count.
};

/** What a tick gives: the wrench for the device, and everything a record wants to know. */
struct TickOutput {
  spatial::Wrench F_H_D;  ///< For the device: after the gate, about the hand's point, in its base.
  spatial::Wrench F_H_W;  ///< The same in W.
  spatial::Pose X_WH;     ///< The hand.
  spatial::Wrench
      F_true_W;  ///< As physics has it, before the map, about the displayed centre of mass.
  spatial::Wrench F_felt_W;  ///< After the map, before the gate, about the same point.
  spatial::Pose X_WT;        ///< Tracked part (or the hand, when it is empty).
  spatial::Pose X_WD;        ///< Displayed part (or the hand).
  HoldState state{HoldState::kEmpty};
  product::OccurrenceId occurrence;
  double insertion_depth{0};  ///< l [m].
  double axial_true{0};       ///< Of the fits, along their axis; positive against going in [N].
  double axial_felt{0};
  double deepest{0};        ///< Deepest contact [m], negative inside; +inf where none is near.
  int contact_count{0};     ///< Contacts that press.
  Vec3 p_WC{Vec3::Zero()};  ///< The contact that presses hardest.
  Vec3 f_C_W{Vec3::Zero()};
  contact::BodyId contact_body;  ///< And the body it is with; invalid for the ground or none.
  std::uint32_t gate_actions{0};
  bool is_truncated{false};         ///< A contact query met its budget.
  std::uint32_t points_tested{0};   ///< By all contact queries of the tick: what it cost.
  WorkspaceMapping workspace;       ///< How the handle moved the hand.
  PassivityAccount energy;          ///< Of forces so far, where passivity is controlled.
  PassivityAccount turning_energy;  ///< Of torques.
  GuidedAxis axis;
  TickContext context;  ///< As it was given.
};

/** How a part was let go. */
struct LetGo {
  spatial::Pose X_WB;  ///< Its exact place where it is in place.
  bool is_in_place{false};
  double to_place{0};  ///< How far its centre of mass is from its place [m].
};

/** The haptic tick of one hand: X(1), X(2) coupling, contact on the displayed part (X7), guidance
 (X8..X10), fit (W5, W8, W9), weight and friction (X11), one force map (N4), gate (N6).

 Owned by one thread. Take and Drop allocate nothing but must not run during Tick. */
class HapticTick {
 public:
  /** @param scene  Bodies in the world; outlives this object. What is held is disabled in it, and
   free bodies are moved. */
  HapticTick(const TickOptions& options, contact::Scene* scene);

  /** What is known of a body of the scene: without it, it is of unknown material and never moves.
   Allocates: before the first tick. */
  void SetProperties(contact::BodyId id, const BodyProperties& properties) {
    bodies_.SetProperties(id, properties);
  }

  /** A loose body moves when something touches it; the part that is taken up, and what is put in
   its place, is not loose. RT-safe. */
  void SetLoose(contact::BodyId id, bool is_loose) noexcept { bodies_.SetLoose(id, is_loose); }

  /** Another hand works in the same scene, and ticks in turn with this one on the same thread.
   What one of them holds stays in the scene where it is displayed. A body that moves by itself
   belongs to the hand that woke it. To be called for both, before the first tick.
   @param leads  This one ticks first, and answers for the contact of the two held parts. */
  void ShareSceneWith(HapticTick* other, bool leads) noexcept {
    other_ = other;
    leads_ = leads;
  }

  /** Those that move by themselves now; their poses are those of the scene. */
  [[nodiscard]] std::span<const FreeBody> awake() const noexcept { return bodies_.awake(); }

  /** Takes up a part where it lies; the hand's present pose becomes its grip. `part` outlives the
   hold. RT-safe. */
  void Take(const HeldPart* part) noexcept;

  /** The held part has come into its place, or has not left it yet. */
  [[nodiscard]] bool is_in_place() const noexcept {
    return state_ == HoldState::kSeated || leaves_place_;
  }

  /** Lets go: the part is in the scene again, and falls, unless it is in its place or its fits hold
   it. One that is close to its place may be moved there (GuidanceOptions::finish_distance).
   RT-safe. */
  LetGo Drop() noexcept;

  /** From the next tick on. RT-safe. */
  void SetEffort(const Effort& effort) noexcept { effort_ = effort; }

  /** One tick. Always returns a safe wrench. RT-safe. */
  TickOutput Tick(const device::DeviceState& state, const TickContext& context = {}) noexcept;

  [[nodiscard]] const HeldPart* held() const noexcept { return part_; }

  [[nodiscard]] HoldState state() const noexcept { return state_; }

  [[nodiscard]] const TickOptions& options() const noexcept { return options_; }

 private:
  struct Tracked {
    spatial::Pose X_WT;
    spatial::Twist V_T;  ///< At the part's centre of mass, in W.
  };

  /** How far the tracked part is from the displayed one, and the coupling there: softer where it
   would give more than the device can. */
  struct Stretch {
    Vec3 e_W;      ///< Between the centres of mass [m].
    Vec3 theta_W;  ///< [rad]
    CouplingGains gains;
  };

  [[nodiscard]] spatial::Wrench MakeSafe(const device::DeviceState& state,
                                         const TickContext& context, bool is_usable,
                                         const TickOutput& out) noexcept;
  [[nodiscard]] Vec3 ShowTorque(const spatial::Wrench& F_H_D, const Quat& q_DH) const noexcept;
  void CreditPotentials() noexcept;
  [[nodiscard]] double StoredEnergy() const noexcept;
  [[nodiscard]] double StoredTurningEnergy() const noexcept;

  [[nodiscard]] Tracked CalcTracked(const Hand& hand) const noexcept;
  void Hold(const Tracked& tracked, TickOutput* out) noexcept;
  [[nodiscard]] Stretch CalcStretch(const Tracked& tracked) const noexcept;
  void AddCoupling(const Tracked& tracked, const Vec3& p_WCm) noexcept;
  void AddGuidance(const Vec3& p_WCm) noexcept;
  void AddFits(const MateGeometry& axis, const Vec3& p_WCm) noexcept;
  void RecordFits(TickOutput* out) noexcept;
  [[nodiscard]] GuidedAxis DescribeAxis() const noexcept;
  void AddContacts(TickOutput* out) noexcept;

  /** A part that is in the hand: the one itself, or a member of its subassembly. */
  struct HeldShape {
    const contact::Shape* shape;
    spatial::Pose X_WS;
    contact::QueryOptions query;
  };

  [[nodiscard]] std::size_t shape_count() const noexcept { return 1 + part_->members.size(); }

  [[nodiscard]] HeldShape MakeHeldShape(std::size_t member, const spatial::Pose& X_WB,
                                        double margin) noexcept;
  [[nodiscard]] contact::BodyId BodyOf(std::size_t member) const noexcept;
  [[nodiscard]] bool Holds(contact::BodyId id) const noexcept;
  void MoveInScene(const spatial::Pose& X_WB) noexcept;
  void ShowInScene(bool is_shown) noexcept;
  void SetLooseForAll(contact::BodyId id, bool is_loose) noexcept;
  [[nodiscard]] FreeBody* FindAwakeElsewhere(contact::BodyId id) noexcept;
  void ShowOther(bool is_shown) noexcept;
  void AddGuest() noexcept;
  void PushGuest() noexcept;
  void RecordAnswer(const Mat3& I_W, double mass, const spatial::Twist& V_before) noexcept;
  [[nodiscard]] double GuestSpeed() const noexcept;
  [[nodiscard]] bool IsFreeAt(const spatial::Pose& X_WB, double tolerance) noexcept;
  void MeasureDepth(TickOutput* out) noexcept;
  void MoveDisplayed(const spatial::Twist& V_Cm) noexcept;

  void AddQueried(const TouchingBody& body, fits::FrictionSurface surface, double rolling_arm,
                  TickOutput* out) noexcept;
  [[nodiscard]] TouchingBody Touch(const contact::Contact& c) noexcept;
  void StepFreeBodies(TickOutput* out) noexcept;
  void AddFreeBodies() noexcept;
  void AddFreeContacts(TickOutput* out) noexcept;
  void MoveFreeBodies() noexcept;
  void UpdateState() noexcept;
  [[nodiscard]] bool HasArrived() noexcept;

  /** How far the displayed part is from its place. */
  struct Remainder {
    Vec3 d_W;      ///< The centre of mass, from where it belongs [m].
    double angle;  ///< [rad]
  };

  [[nodiscard]] Remainder CalcRemainder() const noexcept;
  /** Nothing is on the straight way from here into its place. */
  [[nodiscard]] bool IsWayHomeFree() noexcept;
  /** Close to its place, nothing in between, and no fit that would have to be overcome. */
  [[nodiscard]] bool CanFinish() noexcept;
  /** Was taken up in its place, and the hand leads it outwards: it may bounce there, and comes home
   only with a hand that brings it. */
  [[nodiscard]] bool IsDrawnOut() const noexcept;
  [[nodiscard]] spatial::Pose CalcSeatPose(double progress) const noexcept;
  void MoveIntoPlace(TickOutput* out) noexcept;
  [[nodiscard]] spatial::Wrench CalcCouplingWrench(const Tracked& tracked) const noexcept;
  void RecordContacts(TickOutput* out) noexcept;
  void RecordMeeting(const contact::Contact& c, const Vec3& f_C_W) noexcept;

  TickOptions options_;
  Effort effort_;
  Workspace handle_space_;
  contact::Scene* scene_;
  HapticTick* other_{nullptr};  ///< Of the other hand; null: there is none.
  bool leads_{false};
  contact::QueryWorkspace workspace_;
  ForceMap force_map_;
  FitRows fit_rows_;
  PassivityController passivity_;
  SafetyGate gate_;
  ConstraintSolver solver_;
  FrictionMemory friction_;
  FreeBodies bodies_;
  MateGuide guide_;
  std::array<contact::IgnoredPair, 2 * MateGuide::kMaxMates> ignored_;
  std::array<contact::Contact, ConstraintSolver::kMaxContacts>
      contacts_;  // As given to the solver.

  const HeldPart* part_{nullptr};
  HoldState state_{HoldState::kEmpty};
  int held_contacts_{0};  ///< Of those in the solver; the first ones.
  double clearance_{0};   ///< Least distance of the held part before the step, or the margin [m].
  double reach_{0};       ///< Largest distance of a held point from the centre of mass [m].
  Hand hand_;             ///< Of the last valid sample.
  std::int64_t last_sample_ns_{0};
  bool is_first_tick_{true};
  bool is_solved_{false};  ///< In this tick, together with the held part.
  spatial::Pose X_HB_;     ///< Grip: the tracked part in the hand.
  spatial::Pose X_WD_;
  spatial::Twist V_D_;        ///< Displayed, at the centre of mass, in W.
  double soft_start_{0};      ///< 0..1 over the first moments of a hold.
  double start_distance_{0};  ///< d_0 of X(9) [m].
  double start_angle_{0};
  bool has_start_{false};
  double seat_progress_{0};
  spatial::Pose X_WD_seat_start_;
  FitAxis fit_axis_;
  bool leaves_place_{false};  ///< Was taken up in its place, and is not out of it yet.
  bool is_stuck_{false};      ///< Its fits hold more than its weight.
  bool has_engaged_{false};   ///< In this tick a part was taken or a mate captured.
  int captured_before_{0};
  Tracked tracked_;  ///< Of the last tick with a part.
  double weight_true_{0};
  double weight_felt_{0};
  std::uint32_t points_tested_{0};  ///< Of the present tick.

  /** How the held part moves, and answers to a further impulse, for the other hand's step: a guest
   there. Zero for one that goes its way whatever pushes it. */
  struct Answer {
    bool yields{false};
    spatial::Twist V;         ///< At the centre of mass.
    Vec6 gain{Vec6::Zero()};  ///< Of momentum in the last step, that will go on in the next.
    Mat6 matrix{Mat6::Zero()};
    Mat6 inverse{Mat6::Zero()};
  };

  /** Contact of the two held parts, as the leading hand found it. */
  struct Meeting {
    int contact_count{0};
    double deepest{std::numeric_limits<double>::infinity()};
    Vec3 p_WC{Vec3::Zero()};
    Vec3 f_C_W{Vec3::Zero()};  ///< On the leading hand's part.
    contact::BodyId body;      ///< Of the leading hand.
  };

  Answer answer_;
  spatial::Wrench F_pushed_;  ///< On the held part at its centre of mass, by the other's last step.
  bool is_answered_{false};   ///< In this tick by the other hand: the contact with its part.
  bool has_met_{false};       ///< In this tick this hand answers for it.
  Meeting meeting_;
  int guest_{ConstraintSolver::kWorld};  ///< The other hand's part in this tick's solver.
  Vec6 V_guest_{Vec6::Zero()};           ///< Without what touches it in this step.
};

}  // namespace hvas::haptics
