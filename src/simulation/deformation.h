#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "haptics/giving_curve.h"
#include "product/product.h"
#include "sequence/sequence.h"
#include "spatial/pose.h"

/** How parts that give are drawn: docs/algorithms/flexible.md, "Drawn deformed". All of it follows
 from a model and the poses of its parts, without a memory, so a record and its replay have it by
 the poses that they have. */
namespace hvas::simulation {

struct PressedPair;

/** How a part changes its form. */
enum class DeformationKind : std::uint8_t {
  kBend,    ///< An arm bends aside like a cantilever.
  kFlare,   ///< A wall that goes all the way round an axis bends outwards, or inwards.
  kRadial,  ///< A closed ring or tube gets wider or narrower.
  kOpen,    ///< An open ring gets wider and stays round, so its gap opens; a slit pin closes.
  kPress,   ///< A part gets longer or shorter between its ends.
  kCone,    ///< A disc spring rises at its inner or its outer edge.
  kHelix,   ///< The ends of an open ring part along its axis, as those of a lock washer.
  kShift,   ///< A part is carried along an axis by the others of a stack that get longer.
};

/** The names of the kinds, in their order. */
inline constexpr std::array kDeformationNames{"bend",  "flare", "radial", "open",
                                              "press", "cone",  "helix",  "shift"};

[[nodiscard]] constexpr const char* ToString(DeformationKind kind) {
  return kDeformationNames.at(static_cast<std::size_t>(kind));
}

/** Where and along what a part changes its form, in its frame B. */
struct DeformationForm {
  DeformationKind kind{DeformationKind::kShift};
  /** kBend, kFlare: of the root, on the axis; kPress: of the end that stays; else a point of the
   axis. */
  Vec3 origin_B{Vec3::Zero()};
  /** Unit. kBend, kFlare: from the root to the tip; kPress, kCone, kHelix: from the end that
   stays to the other; kShift: the way; else of the ring. */
  Vec3 axis_B{Vec3::UnitZ()};
  /** Unit, across the axis. kBend: the way aside; kOpen, kHelix: from the axis to the back of the
   ring, opposite of its gap. */
  Vec3 aside_B{Vec3::UnitX()};
  /** kBend, kFlare: from the root to where it is pushed aside; kPress: as drawn, between the ends;
   kOpen: radius of the middle of its section [m]. */
  double length{1};
  /** kBend: least and largest distance from the origin along aside_B that belongs to the arm;
   kFlare, kRadial, kCone: inner and outer radius [m]. */
  std::array<double, 2> range{0, 0};
  /** kBend: as `range`, along axis_B x aside_B [m]. */
  std::array<double, 2> across{0, 0};
  /** kFlare: first, 1 outwards and -1 inwards; kHelix: first, 1 where it rises counter-clockwise
   about the axis, else -1; kRadial, kCone: how far the inner and the outer radius grow, or its
   edges rise, for each metre of the amount. */
  std::array<double, 2> shares{1, 1};
};

/** Where a point of a part goes when the part is deformed by an amount y [m]. An amount of 0 gives
 the point as it is, to the bit.

 | kind | where a point goes |
 |---|---|
 | kBend | aside, from the root on, by y (3 x^2 l - x^3) / (2 l^3); beyond l y (3 x - l) / (2 l) |
 | kFlare | along the radius, by the same |
 | kRadial | along the radius, linear between the inner and the outer radius |
 | kOpen | radius r to r + y, angle from the back by r_m / (r_m + y): the gap opens by 2 pi y |
 | kPress | along the axis, by y times the share of the length from the end that stays |
 | kCone | along the axis, linear between the inner and the outer radius |
 | kHelix | along the axis, linear in the angle from end to end |
 | kShift | along the axis |

 Sources. kBend and kFlare, strip by strip: a cantilever with a force at its end (Timoshenko,
 Strength of Materials I). kOpen: round and as long as it was, as fits::CalcSpreadStiffness() has
 it. kPress: a spring of constant pitch, a block of constant strain. kCone: a section that turns as
 a rigid one (Almen and Laszlo). kHelix: constant torsion (Wahl). kRadial: a choice.

 @param amount  kPress: how much longer, kOpen: how much wider in radius; negative: shorter,
 narrower. */
[[nodiscard]] Vec3 Deform(const DeformationForm& form, double amount, const Vec3& p_B);

/** What deforms a part: another one on its way to its place, or itself on its way. */
struct DeformationSource {
  product::OccurrenceId moved;    ///< The part on its way.
  product::OccurrenceId against;  ///< The part relative to whose place the way counts.
  Vec3 out_W{Vec3::UnitZ()};      ///< Unit, the way out, with `against` as drawn.
  double widest{0};               ///< The furthest that it gives, or is pressed [m].
  std::shared_ptr<const haptics::GivingCurve> curve;
  /** How far this part of a stack is pressed, at equal steps of how far all are [m]; empty: it is
   by itself. */
  std::vector<double> own;
};

/** A part that is drawn deformed. */
struct Deformable {
  product::OccurrenceId occurrence;
  DeformationForm form;
  double free{0};  ///< Amount where nothing gives or is pressed [m].
  double sign{1};  ///< Amount for each metre that the part gives: 1 or -1.
  /** The one that gives most counts. kShift: none but `against`, by which it knows its place. */
  std::vector<DeformationSource> sources;
  std::vector<std::size_t> below;  ///< kShift: what carries it, as indices of this list.
};

/** Lists the parts of a model that are drawn deformed: those of its giving pairs and of what is
 pressed, by its order of assembly. */
[[nodiscard]] std::vector<Deformable> ListDeformables(const product::Product& product,
                                                      const sequence::Sequence& sequence,
                                                      const std::vector<PressedPair>& presses);

/** How far what a source deforms gives now, or is pressed together [m]; 0 where the part that moves
 is not on its way. For a stack: this part of it alone.
 @param product  Has the places of the parts, as drawn. @param X_WB  Poses by occurrence. */
[[nodiscard]] double CalcGiven(const product::Product& product, const DeformationSource& source,
                               std::span<const spatial::Pose> X_WB);

/** How far each part is deformed [m], by the index in `deformables`; what nothing reaches has its
 free form.
 @param product  Has the places of the parts, as drawn. @param X_WB  Poses by occurrence.
 @param present  Whether a part is there, by occurrence; null: all are. */
[[nodiscard]] std::vector<double> CalcDeformations(const product::Product& product,
                                                   const std::vector<Deformable>& deformables,
                                                   std::span<const spatial::Pose> X_WB,
                                                   const std::vector<bool>* present = nullptr);

/** Where the points of a part go, in its frame B, with all that deforms it; null where nothing
 does.
 @param deformables  Outlive the result. @param amounts  As CalcDeformations() gives them. */
[[nodiscard]] std::function<Vec3(const Vec3& p_B)> MakePointMap(
    const std::vector<Deformable>& deformables, const std::vector<double>& amounts,
    product::OccurrenceId id);

/** A smaller amount is not drawn [m]: no more than a display resolves. A choice. */
inline constexpr double kLeastDrawn = 0.5e-6;

}  // namespace hvas::simulation
