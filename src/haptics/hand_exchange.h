#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "contact/scene.h"
#include "haptics/displayed_part.h"
#include "haptics/free_bodies.h"

namespace hvas::haptics {

class Coupling;

/** How a held part moves, and answers to a further impulse. Zero for a part that goes its way
 whatever pushes it. */
struct HeldResponse {
  bool yields{false};
  spatial::Twist V;         ///< Velocity of the centre of mass, in W.
  Vec6 gain{Vec6::Zero()};  ///< Momentum that the last step gave and the next one will give again.
  Mat6 matrix{Mat6::Zero()};   ///< Impulse for a change of V, as [turn; shift].
  Mat6 inverse{Mat6::Zero()};  ///< Change of V for an impulse.
};

/** Contact of the parts that two hands hold, as the leading hand found it. */
struct MutualContact {
  int contact_count{0};
  double deepest{std::numeric_limits<double>::infinity()};  ///< [m]
  Vec3 p_WC{Vec3::Zero()};
  Vec3 f_C_W{Vec3::Zero()};  ///< Force on the leading hand's part [N].
  contact::BodyId body;      ///< The leading hand's part.
};

/** What a hand gives another one that works in the same scene, after each of its ticks. */
struct HandExchange {
  std::size_t hand{0};                    ///< Index of the hand that gives.
  DisplayedPart displayed;                ///< What it holds, as it stands in the scene.
  std::uint32_t hold{0};                  ///< Number of this hold, counted from 1.
  HeldResponse response;                  ///< The displayed part's.
  std::span<const FreeBody> awake;        ///< Loose parts that this hand moves.
  const RigidGroup* held_still{nullptr};  ///< Loose parts that its part is being put to.
  /** Wrench of its last step on the receiver's part, at the centre of mass. */
  spatial::Wrench F_pushed_W;
  std::uint32_t pushed_hold{0};  ///< The receiver's hold that F_pushed_W is for.
  /** Coupling of its hand to what the receiver holds, where it holds that as well; else null. */
  const Coupling* coupling{nullptr};
  std::uint32_t coupled_hold{0};   ///< The receiver's hold that the coupling is for.
  bool has_solved_contact{false};  ///< Its last step has solved the contact of the two parts.
  MutualContact contact;           ///< That contact.

  [[nodiscard]] bool is_holding() const noexcept { return displayed.part != nullptr; }
};

}  // namespace hvas::haptics
