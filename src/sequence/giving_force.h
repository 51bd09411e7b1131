#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "haptics/giving_curve.h"
#include "sequence/bending_form.h"
#include "sequence/sequence.h"

/** What it takes to pass a part that gives: docs/algorithms/flexible.md. */
namespace hvas::sequence {

/** Normals of contact that differ by more than 120 degrees are on opposite sides: their dot. A
 choice. */
inline constexpr double kOppositeNormals = -0.5;

/** What of a face lies in another part on the way. */
struct MetFace {
  contact::Contact contact{};    ///< The deepest.
  double travelled{0};           ///< Where on the way that is [m].
  contact::Contact opposite{};   ///< One on the opposite side; its distance is 0 where none is.
  double opposite_travelled{0};  ///< [m]
};

/** How far two parts overlap across the way of one of them. */
struct GivingSamples {
  double spacing{1};          ///< [m]
  std::vector<double> given;  ///< Overlap at each sample, from the part's place outwards, >= 0 [m].
  double breadth{0};          ///< How broad they overlap, across way and deflection [m].
  contact::Contact deepest{};                ///< Its distance is 0 where they do not overlap.
  double travelled{0};                       ///< Where on the way that is [m].
  std::map<std::uint32_t, MetFace> by_face;  ///< Faces of the part that gives.
};

/** The forces of a pair along the way of the part that is moved; null where no formula is known for
 its kind, or its dimensions are not to be had.
 @param bending  The arm, where the part that gives is a hook or a wall; else null. */
[[nodiscard]] std::shared_ptr<const haptics::GivingCurve> MakeGivingCurve(
    const product::Product& product, const GivingPair& give, const GivingSamples& samples,
    const Bending* bending);

/** Kinetic coefficient of the friction of two parts on each other. */
[[nodiscard]] double FindKineticFriction(const product::Product& product, product::OccurrenceId a,
                                         product::OccurrenceId b);

/** Makes no slope of a curve steeper than 60 degrees, by what lies before it: faces that are drawn
 steeper have an edge that is not. Leaves out what gives nothing at its end.
 @param spacing  Of the samples [m]. @param given  As of haptics::GivingCurve. */
void FinishGiven(double spacing, std::vector<double>* given);

}  // namespace hvas::sequence
