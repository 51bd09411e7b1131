#pragma once

#include "haptics/contact_step.h"
#include "haptics/displayed_part.h"
#include "haptics/guidance.h"
#include "haptics/options.h"

namespace hvas::haptics {

/** The end of an insertion: whether the held part has come to its place, and its last, exact,
 movement there (X9). RT-safe. */
class Seating {
 public:
  /** How far the displayed part is from its place. */
  struct Remainder {
    Vec3 d_W{Vec3::Zero()};  ///< Vector from where its centre of mass belongs to where it is [m].
    double angle{0};         ///< [rad]
  };

  Seating(const TickOptions& options, const Guidance* guidance, ContactStep* contacts) noexcept
      : options_(options), guidance_(*guidance), contacts_(*contacts) {}

  void Begin(const HeldPart& part) noexcept;

  /** The hand has let go. */
  void End() noexcept { leaves_place_ = false; }

  /** The part was taken up in its place, and is not out of it yet. */
  [[nodiscard]] bool leaves_place() const noexcept { return leaves_place_; }

  /** The displayed part is in its place by its pose: it may be moved exactly there. Notes whether
   it is matched. */
  [[nodiscard]] bool HasArrived(const DisplayedPart& displayed,
                                const TrackedPart& tracked) noexcept;

  /** The part is so near to its place, with nothing in between, that it is drawn home (W7). */
  [[nodiscard]] bool is_matched() const noexcept { return is_matched_; }

  /** The part is matched, and no axis leads it. */
  [[nodiscard]] bool IsDrawingHome(const HeldPart& part) const noexcept {
    return is_matched_ && !HasAxis(part);
  }

  /** Draws a matched part home where no axis leads it: across its way in as mates guide, along it
   as X(9) attracts, which no fit and nothing that gives yields to. */
  void AddHoming(const DisplayedPart& displayed, ConstraintSolver* solver) noexcept;

  /** A part that is let go may be moved into its place: it is close, nothing is in between, and no
   fit would have to be overcome. */
  [[nodiscard]] bool CanFinish(const DisplayedPart& displayed, const TrackedPart& tracked) noexcept;

  /** Begins the last movement where the part is displayed now. */
  void Start(const DisplayedPart& displayed) noexcept;

  /** Moves the part on by one tick. */
  void Advance(DisplayedPart* displayed) noexcept;

  [[nodiscard]] bool is_finished() const noexcept { return progress_ >= 1; }

  /** How far the part was from its place when the last movement began. */
  [[nodiscard]] const Remainder& arrival() const noexcept { return arrival_; }

  [[nodiscard]] static Remainder CalcRemainder(const DisplayedPart& displayed) noexcept;

 private:
  /** How far the part is across its axis beyond the play, in the hole: a long part that leans in it
   is further off elsewhere [m]. @pre The mates hold an axis. */
  [[nodiscard]] double CalcBeyondPlay(const DisplayedPart& displayed) const noexcept;
  /** An axis holds the part across its way in. */
  [[nodiscard]] bool HasAxis(const HeldPart& part) const noexcept;
  /** Distance from its place at which a part is in it [m]. */
  [[nodiscard]] double CalcTolerance(const HeldPart& part) const noexcept;
  /** The straight way from here into the part's place is free. */
  [[nodiscard]] bool IsWayHomeFree(const DisplayedPart& displayed) noexcept;
  /** The part was taken up in its place, and the hand leads it outwards: it may bounce there, and
   comes home only with a hand that brings it. */
  [[nodiscard]] bool IsDrawnOut(const HeldPart& part, const TrackedPart& tracked) const noexcept;
  [[nodiscard]] spatial::Pose CalcPose(const HeldPart& part, double progress) const noexcept;

  const TickOptions& options_;
  const Guidance& guidance_;
  ContactStep& contacts_;
  Remainder arrival_;
  double progress_{0};        ///< 0..1 of the last movement.
  spatial::Pose X_WD_start_;  ///< Where the last movement begins.
  bool leaves_place_{false};
  bool is_matched_{false};
  double homing_{0};  ///< 0..1 since the part was matched.
};

}  // namespace hvas::haptics
