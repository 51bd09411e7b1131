#pragma once

#include <array>
#include <span>
#include <utility>

#include "contact/scene.h"
#include "haptics/constraint_solver.h"
#include "haptics/contact_pairs.h"
#include "haptics/displayed_part.h"
#include "haptics/free_bodies.h"
#include "haptics/friction_memory.h"
#include "haptics/hand_exchange.h"
#include "haptics/mate_guide.h"
#include "haptics/options.h"
#include "haptics/tick_output.h"

namespace hvas::haptics {

/** A fastener that the held tool turns in a tick. */
struct TurnedFastener {
  const HeldDrive* drive{nullptr};
  int index{ConstraintSolver::kWorld};  ///< Index in this tick's solver.
  double rate{0};                       ///< Counter-clockwise about its axis [rad/s].
};

/** Contacts in one step of a hand: of the held part, of loose parts that move, and of the parts
 that other hands hold, which join the step as bodies with their own responses. Finds them, gives
 them to the solver with their friction, and moves what was solved as far as it may go (X7, X11).

 All but SetProperties is RT-safe. */
class ContactStep {
 public:
  /** @param scene  Bodies in the world. What is held stays in it and is left out of queries; loose
   bodies are moved in it.
   @param guide  Mates of the held part: contact leaves their faces to them.
   All three outlive this object.
   @param hand  Index of the hand. Of two hands the one with the lower index ticks first, and solves
   the contact of their held parts. */
  ContactStep(const TickOptions& options, contact::Scene* scene, const MateGuide* guide,
              std::size_t hand) noexcept
      : options_(options), scene_(*scene), guide_(*guide), hand_(hand) {}

  void SetProperties(contact::BodyId id, const BodyProperties& properties) {
    bodies_.SetProperties(id, properties);
  }

  void SetPair(const ContactPairResponse& response) { pairs_.Set(response); }

  void SetLoose(contact::BodyId id, bool is_loose) noexcept { bodies_.SetLoose(id, is_loose); }

  void SetEffort(const Effort& effort) noexcept { effort_ = effort; }

  [[nodiscard]] const Effort& effort() const noexcept { return effort_; }

  /** Fasteners that can be turned at once: a tool has two ends. */
  static constexpr std::size_t kMaxTurned = 2;

  /** Fasteners that the held tool touched in the last tick; their poses are those of the scene. */
  [[nodiscard]] std::span<const TurnedFastener> turned() const noexcept {
    return {turned_.data(), turned_count_};
  }

  /** Loose parts that move by themselves now, as this hand has woken them. */
  [[nodiscard]] std::span<const FreeBody> awake() const noexcept { return bodies_.awake(); }

  /** A body that this hand moves; null where it moves no such one. */
  [[nodiscard]] const FreeBody* FindAwake(contact::BodyId id) noexcept {
    return bodies_.FindAwake(id);
  }

  /** Makes a part loose that goes on at a velocity of its centre of mass. */
  void LetGo(contact::BodyId id, const spatial::Pose& X_WB, const spatial::Twist& V) noexcept {
    bodies_.SetLoose(id, true);
    account_.is_crowded = account_.is_crowded || bodies_.awake().size() == FreeBodies::kMaxAwake;
    bodies_.WakeFirst(id, X_WB, V);
  }

  /** Makes parts that are together loose; they go on as one body, at a velocity of their common
   centre of mass. */
  void LetGo(const RigidGroup& group, const spatial::Pose& X_WB, const spatial::Twist& V) noexcept {
    bodies_.Join(group);
    account_.is_crowded = account_.is_crowded || bodies_.awake().size() == FreeBodies::kMaxAwake;
    bodies_.WakeFirst(group.leader(), X_WB, V);
  }

  /** Makes parts that are together loose where they are; they sleep. */
  void Join(const RigidGroup& group) noexcept { bodies_.Join(group); }

  /** Lets loose parts stand still where they are, as in a vice, while the held part is put to
   them. */
  void HoldStill(const RigidGroup& target) noexcept { bodies_.HoldStill(target); }

  /** Makes parts loose again that stand still since HoldStill().
   @param wakes  They may have lost what they stood by: they move. */
  void LetLoose(const RigidGroup& target, bool wakes) noexcept {
    if (bodies_.LetLoose(target) && wakes) {
      bodies_.WakeFirst(target.leader(), scene_.pose(target.leader()), {});
    }
  }

  /** Whether loose parts rest at a pose of the first of them, and no other hand has or moves any.
   */
  [[nodiscard]] bool IsAtRestAt(const RigidGroup& target, const spatial::Pose& X_WB,
                                std::span<const HandExchange> others) noexcept;

  /** Largest distance of a point of the part, with its members, from its centre of mass [m]. */
  [[nodiscard]] static double CalcReach(const HeldPart& part) noexcept;

  /** Moves a held part in the scene, with its members. */
  void MoveInScene(const HeldPart& part, const spatial::Pose& X_WB) noexcept;

  /** A tick begins.
   @param held   What this hand holds; null: nothing.
   @param others  What the other hands gave after their last ticks, for use until End(). */
  void Begin(const HeldPart* held, std::span<const HandExchange> others) noexcept;

  /** Adds loose bodies that move, and the parts of other hands, to the step. */
  void AddBodies(ConstraintSolver* solver) noexcept;

  /** Adds contacts of the held part to the step. */
  void AddHeldContacts(const DisplayedPart& displayed, ConstraintSolver* solver) noexcept;

  /** Adds contacts of the loose bodies that move, and of those that they wake. */
  void AddFreeContacts(ConstraintSolver* solver) noexcept;

  /** Takes over forces and friction from the solution, and moves the loose bodies. */
  void Finish(const ConstraintSolver& solver) noexcept;

  /** Moves the displayed part as far as it may go at a velocity of its centre of mass. */
  void MoveDisplayed(const spatial::Twist& V_Cm, DisplayedPart* displayed) noexcept;

  /** One step of the loose bodies without a held part. */
  void StepFreeBodies(ConstraintSolver* solver) noexcept;

  /** The part comes no deeper than the tolerance into anything there [m]. */
  [[nodiscard]] bool IsFreeAt(const HeldPart& part, const spatial::Pose& X_WB,
                              double tolerance) noexcept;

  /** Adds the depth of a part that is moved without a step to the account. */
  void MeasureDepth(const DisplayedPart& displayed) noexcept;

  /** Ends the tick: what Begin was given is used no more.
   @returns the account of the held part's contacts since the last tick ended. */
  ContactAccount End() noexcept {
    held_ = nullptr;
    others_ = {};
    return std::exchange(account_, ContactAccount());
  }

  /** Contacts that pressed on the held part in the last tick, but for those with parts
   of other hands that their steps have solved. */
  [[nodiscard]] std::span<const PressingContact> pressing() const noexcept {
    return {pressing_.data(), pressing_count_};
  }

  /** Wrench that the last steps of other hands had on the held part, at its centre of mass. */
  [[nodiscard]] spatial::Wrench CalcPush(std::uint32_t hold) const noexcept;

  /** Fills in what this step has for the hand of index `to`. */
  void FillExchange(std::size_t to, HandExchange* exchange) const noexcept;

 private:
  /** A shape of what is held: of the part itself, or of a member of its subassembly. */
  struct HeldShape {
    const contact::Shape* shape;
    spatial::Pose X_WS;
    contact::QueryOptions query;
  };

  [[nodiscard]] HeldShape MakeHeldShape(const HeldPart& part, std::size_t member,
                                        const spatial::Pose& X_WB, double margin) noexcept;
  [[nodiscard]] std::span<const contact::BodyId> ListHeld() const noexcept;

  /** What this hand has with another one. */
  struct OtherPart {
    int index{ConstraintSolver::kWorld};  ///< Its part in the solver, in this tick.
    Vec6 V{Vec6::Zero()};        ///< Velocity of its part without what touches it in this step.
    spatial::Wrench F_W;         ///< Wrench of the last step on its part, at the centre of mass.
    std::uint32_t hold{0};       ///< Its hold that this was for.
    bool is_solved_here{false};  ///< This step has solved the contact of the two held parts.
    MutualContact mutual;        ///< That contact.
  };

  /** The hand that holds a body; null where none of the others does. */
  [[nodiscard]] const HandExchange* FindHolder(contact::BodyId id) const noexcept;
  /** Leaves the parts of some other hands out of queries of the held part, until
   unmet_ is cleared.
   @param is_left  Whether the part of a hand is left out. */
  template <typename IsLeft>
  void LeaveOut(IsLeft is_left) noexcept;

  [[nodiscard]] bool IsMovedByOther(contact::BodyId id) const noexcept;
  [[nodiscard]] bool IsHeldStillByOther(contact::BodyId id) const noexcept;
  [[nodiscard]] double CalcFreeReach(contact::BodyId id) const noexcept;
  [[nodiscard]] TouchingBody Touch(const contact::Contact& c, ConstraintSolver* solver) noexcept;
  [[nodiscard]] const TurnedFastener* FindTurned(contact::BodyId id,
                                                 ConstraintSolver* solver) noexcept;
  void MoveTurned(const ConstraintSolver& solver) noexcept;
  void AddQueried(const TouchingBody& body, contact::BodyId queried, fits::FrictionSurface surface,
                  double rolling_arm, ConstraintSolver* solver) noexcept;
  void AddBores(const DisplayedPart& displayed, double margin, ConstraintSolver* solver) noexcept;
  bool AddContact(const TouchingBody& body, const TouchingBody& other, const fits::FrictionLaw& law,
                  double compliance, double rolling_arm, const contact::Contact& c,
                  ConstraintSolver* solver) noexcept;
  void AddOtherParts(ConstraintSolver* solver) noexcept;
  /** Largest speed of a point of a part in another hand [m/s]. */
  [[nodiscard]] double CalcOtherSpeed() const noexcept;
  void PushOtherParts(const ConstraintSolver& solver) noexcept;
  [[nodiscard]] bool IsFreeBodyAt(const FreeBody& body, const spatial::Pose& X_WB,
                                  double tolerance) noexcept;
  void MoveFreeBodies(const ConstraintSolver& solver) noexcept;
  void RecordContacts(const ConstraintSolver& solver) noexcept;
  void RecordMutual(const contact::Contact& c, const Vec3& f_C_W, MutualContact* mutual) noexcept;

  const TickOptions& options_;
  contact::Scene& scene_;
  const MateGuide& guide_;
  const std::size_t hand_;
  Effort effort_;
  contact::QueryWorkspace workspace_{contact::QueryMemory::kOfMotion};
  FrictionMemory friction_;
  FreeBodies bodies_;
  ContactPairs pairs_;
  std::array<TurnedFastener, kMaxTurned> turned_;
  std::size_t turned_count_{0};
  double turned_speed_{0};  ///< Largest speed of a point of what was turned in this tick [m/s].
  std::array<contact::IgnoredPair, MateGuide::kPairsPerMate * MateGuide::kMaxMates> ignored_;
  std::array<contact::Contact, ConstraintSolver::kMaxContacts> contacts_;  ///< Those in the solver.

  std::array<PressingContact, ConstraintSolver::kMaxContacts> pressing_;
  std::size_t pressing_count_{0};

  // Values of the present tick.
  const HeldPart* held_{nullptr};         ///< Null between ticks.
  std::span<const HandExchange> others_;  ///< Empty between ticks.
  ContactAccount account_;
  int held_contacts_{0};  ///< Contacts of the held part in the solver; the first ones.
  double clearance_{0};   ///< Least distance of the held part before the step, or the margin [m].
  /** Bodies that the held part does not meet now, by the index of the hand that has them. */
  std::array<std::span<const contact::BodyId>, kMaxHands> unmet_{};

  std::array<OtherPart, kMaxHands> other_parts_;  ///< Indexed by hand.
};

}  // namespace hvas::haptics
