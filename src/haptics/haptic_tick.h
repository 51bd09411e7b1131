#pragma once

#include <cstdint>
#include <span>

#include "contact/scene.h"
#include "device/device.h"
#include "haptics/constraint_solver.h"
#include "haptics/contact_step.h"
#include "haptics/coupling.h"
#include "haptics/device_output.h"
#include "haptics/displayed_part.h"
#include "haptics/force_map.h"
#include "haptics/guidance.h"
#include "haptics/hand_exchange.h"
#include "haptics/options.h"
#include "haptics/seating.h"
#include "haptics/tick_output.h"

namespace hvas::haptics {

/** How a part was let go. */
struct LetGo {
  spatial::Pose X_WB;  ///< Its exact place where it is in place.
  bool is_in_place{false};
  bool is_falling{false};  ///< It is a loose part that moves from now on.
  double to_place{0};      ///< Distance of its centre of mass from its place [m].
  /** How far the part was from its place when it was moved exactly there; zero where it was not. */
  Seating::Remainder arrival;
  /** It has been put to loose parts on the table (X1): they are one loose body now. Null: it was
   not. */
  const RigidGroup* joined{nullptr};
};

/** The haptic tick of one hand: X(1), X(2) coupling, contact on the displayed part (X7), guidance
 (X8..X10), fit (W5, W8, W9), weight and friction (X11), one force map (N4), gate (N6).

 One thread owns it. Take and Drop allocate nothing but must not run during Tick. The hands
 of one scene, kMaxHands at most, tick in turn on the same thread, and each is given what the others
 gave after their last ticks; what is held stays in the scene where it is displayed, and a loose
 part that moves belongs to the hand that woke it. */
class HapticTick {
 public:
  /** @param scene  Bodies in the world; outlives this object. Free bodies and what is held are
   moved in it.
   @param hand  Index of the hand among those of the scene, in the order in which they tick. */
  HapticTick(const TickOptions& options, contact::Scene* scene, std::size_t hand = 0) noexcept;
  HapticTick(const HapticTick&) = delete;
  HapticTick& operator=(const HapticTick&) = delete;

  /** What is known of a body of the scene: without it, the body is of unknown material and never
   moves. Allocates: before the first tick. */
  void SetProperties(contact::BodyId id, const BodyProperties& properties) {
    contacts_.SetProperties(id, properties);
  }

  /** How the contact of two bodies answers, instead of TickOptions. Allocates: before the first
   * tick.
   */
  void SetPair(const ContactPairResponse& response) { contacts_.SetPair(response); }

  /** A loose body moves when something touches it; the part that is taken up, and what is put in
   its place, is not loose. RT-safe. */
  void SetLoose(contact::BodyId id, bool is_loose) noexcept { contacts_.SetLoose(id, is_loose); }

  /** Makes parts one loose body, which sleeps where they are. RT-safe. */
  void Join(const RigidGroup& group) noexcept { contacts_.Join(group); }

  /** Bodies that move by themselves now; their poses are those of the scene. */
  [[nodiscard]] std::span<const FreeBody> awake() const noexcept { return contacts_.awake(); }

  /** Fasteners that the held tool touched in the last tick; their poses are those of the scene. */
  [[nodiscard]] std::span<const TurnedFastener> turned() const noexcept {
    return contacts_.turned();
  }

  /** Takes up a part where it lies; the hand's present pose becomes its grip. Where there is
   another hand, none of the part's bodies is loose for it any more: the caller tells it so
   afterwards.
   @param part   Outlives the hold.
   @param others  What the other hands gave. RT-safe. */
  void Take(const HeldPart* part, std::span<const HandExchange> others = {}) noexcept;

  /** Takes hold of what another hand holds as well: both are coupled to it, and each feels what it
   gives. The other hand's weight, mates and contact stay with it. Ends when that hand lets go.
   @pre this hand holds nothing.
   @param other  What that hand gave. RT-safe. */
  void Help(const HandExchange& other) noexcept;

  /** Lets go of what another hand holds. RT-safe. */
  void StopHelping() noexcept { helped_hold_ = 0; }

  [[nodiscard]] bool is_helping() const noexcept { return helped_hold_ != 0; }

  /** The held part has come into its place, in the product or on the table, or has not left it yet.
   */
  [[nodiscard]] bool is_in_place() const noexcept {
    return state_ == HoldState::kSeated || seating_.leaves_place();
  }

  /** Lets go: the part falls, unless it is in its place or its fits hold it. One that is close to
   its place may be moved there (GuidanceOptions::finish_distance). RT-safe. */
  LetGo Drop() noexcept;

  /** Sets how much a tick does from the next one on. RT-safe. */
  void SetEffort(const Effort& effort) noexcept { contacts_.SetEffort(effort); }

  /** One tick. Always returns a safe wrench.
   @param others  What the other hands gave. RT-safe. */
  TickOutput Tick(const device::DeviceState& state, const TickContext& context = {},
                  std::span<const HandExchange> others = {}) noexcept;

  /** What this hand gives the hand of index `to` now. RT-safe. */
  [[nodiscard]] HandExchange Exchange(std::size_t to) const noexcept;

  /** ContactStep::pressing(). */
  [[nodiscard]] std::span<const PressingContact> pressing() const noexcept {
    return contacts_.pressing();
  }

  [[nodiscard]] const HeldPart* held() const noexcept { return displayed_.part; }

  [[nodiscard]] HoldState state() const noexcept { return state_; }

  [[nodiscard]] const TickOptions& options() const noexcept { return options_; }

 private:
  /** Makes what goes to the device's output: the wrench, with the energy stored behind it. */
  [[nodiscard]] DeviceOutput::Input MakeOutputInput(const spatial::Wrench& F_H_W, bool is_usable,
                                                    const DisplayedPart* helped) noexcept;
  void ChoosePlace(std::span<const HandExchange> others) noexcept;
  void GoTo(const HeldPart& place) noexcept;
  /** Weight of a part as the hand feels it [N]. */
  [[nodiscard]] double CalcFeltWeight(const HeldPart& part) const noexcept;
  void CreditWeight() noexcept;
  [[nodiscard]] double CalcStoredEnergy() const noexcept;
  /** Finds the part of another hand that this one holds as well; null: none. */
  [[nodiscard]] const DisplayedPart* FindHelped(
      std::span<const HandExchange> others) const noexcept;
  /** A tick of a hand that holds what another hand holds. */
  void HoldAlong(const DisplayedPart& displayed, TickOutput* out) noexcept;
  /** Moves the felt wrench to the hand's point: the coupling acts at the centre of mass. */
  void FeelAtHand(const HeldPart& part, TickOutput* out) const noexcept;
  void Hold(std::span<const HandExchange> others, TickOutput* out) noexcept;
  void Step(std::span<const HandExchange> others, TickOutput* out) noexcept;
  void RecordResponse(const Mat3& I_W, double mass, const spatial::Twist& V_before) noexcept;
  /** Credits the energy by which the part pulls the hand as it goes home. */
  void CreditWayHome(const Seating::Remainder& way) noexcept;
  void UpdateState() noexcept;

  const TickOptions options_;
  const contact::Scene& scene_;
  Workspace workspace_;
  ForceMap force_map_;
  ConstraintSolver solver_;
  Coupling coupling_;
  Guidance guidance_;
  ContactStep contacts_;
  Seating seating_;
  DeviceOutput output_;

  Hand hand_;  ///< Hand at the last valid sample.
  HoldState state_{HoldState::kEmpty};
  DisplayedPart displayed_;         ///< Has the place that the part is for now.
  const HeldPart* taken_{nullptr};  ///< The part as it was taken, with all its places.
  std::uint32_t hold_{0};           ///< Number of the present hold, or the last one.
  double soft_start_{0};            ///< 0..1 over the first moments of a hold.
  double weight_felt_{0};           ///< [N]
  bool has_engaged_{false};         ///< A part was taken or a mate captured since the last tick.
  HeldResponse response_;
  std::size_t helped_hand_{0};    ///< Hand whose part this one holds as well.
  std::uint32_t helped_hold_{0};  ///< That hold of it; 0: none.
  bool pulls_along_{false};       ///< It pulled on that part in the last tick.
};

}  // namespace hvas::haptics
