#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "contact/scene.h"
#include "haptics/held_part.h"
#include "product/product.h"
#include "sequence/neighbours.h"
#include "sequence/screw_mates.h"
#include "spatial/pose.h"

namespace hvas::sequence {

/** One move of the assembly. */
struct SequenceStep {
  enum class Kind {
    kBase,    ///< The first part of a product or subassembly: it is put into the fixture.
    kInsert,  ///< The part goes from the table, or from the shelf, into its place.
    kPark,    ///< A finished subassembly goes as one body onto the shelf, out of the way.
    kRemove,  ///< Out of its place again, by the way it came. Not planned: a person's own wish.
    kAside,   ///< A part goes from its place to one beside it, where the next part can pass it.
    kReturn,  ///< It goes back from there into its place.
    kAssume,  ///< No way in was found: the part is put where the drawing has it, for the others.
  };
  Kind kind{Kind::kInsert};
  product::OccurrenceId occurrence;            ///< The part, or the base of the subassembly.
  std::vector<product::OccurrenceId> members;  ///< What else moves with it (X3).
  Vec3 extraction_W{Vec3::UnitZ()};            ///< Unit; the way out. The way in is the reverse.
  /** Where the way is not straight: poses X_WB of the part from its place outward, evenly from one
   to the next; the last piece is straight, and goes on. Then extraction_W is the first piece's. */
  std::vector<spatial::Pose> way{};
  double engage_distance{0};  ///< Distance from the goal until nothing is engaged [m].
  /** kPark: from the drawn place to the shelf; kAside: to the place beside it [m]. */
  Vec3 offset_W{Vec3::Zero()};
};

/** Whether a step moves a part that is in the product from one place there to another. */
[[nodiscard]] constexpr bool IsWithinProduct(SequenceStep::Kind kind) {
  return kind == SequenceStep::Kind::kAside || kind == SequenceStep::Kind::kReturn;
}

/** Where a step brings its part. @param X_WB_drawn  The part's place as drawn. */
[[nodiscard]] spatial::Pose GoalOf(const SequenceStep& step, const spatial::Pose& X_WB_drawn);

/** What pairs that block one another are allowed beyond the drawn depth, as far as faces can give
 way [m]: a choice. */
inline constexpr double kBeyondDrawn = 0.5e-3;

/** Two parts that lie in one another as drawn, deeper than 50 um and beyond what a mate between
 them explains. */
struct DrawnOverlap {
  /** What lets the parts pass one another; no deeper than drawn, and nowhere else. */
  enum class Answer : std::uint8_t {
    kRelief,     ///< The faces that overlap give way, each by half of the depth.
    kAllowance,  ///< Contact of the faces that overlap, and of those next to them, begins deeper.
    kNone,       ///< No face looks at one of the other part: one part runs through the other.
  };

  product::OccurrenceId a;
  product::OccurrenceId b;
  double depth{0};  ///< [m]
  Answer answer{Answer::kNone};
  double allowed{0};                     ///< kAllowance: contact begins this deep [m].
  double largest{0};                     ///< The most that a joint of the two may be allowed [m].
  bool is_beyond{false};                 ///< More is allowed than drawn: no way was found without.
  std::vector<std::uint32_t> faces_a;    ///< Faces of a that overlap; sorted.
  std::vector<std::uint32_t> faces_b;    ///< Faces of b.
  std::vector<std::uint32_t> passing_a;  ///< kAllowance: faces of a that may pass; sorted.
  std::vector<std::uint32_t> passing_b;  ///< Faces of b.

  [[nodiscard]] bool Joins(product::OccurrenceId x, product::OccurrenceId y) const {
    return (a == x && b == y) || (a == y && b == x);
  }
};

/** An arm or a wall of a part that bends aside, in the part's frame B. */
struct BentArm {
  Vec3 root_B{Vec3::Zero()};       ///< Middle of its section at the root.
  Vec3 axis_B{Vec3::UnitZ()};      ///< Unit, from the root to the tip.
  Vec3 aside_B{Vec3::UnitX()};     ///< Unit, across the axis: where it bends.
  double length{0};                ///< Distance from the root to where it is pushed aside [m].
  std::array<double, 2> range{};   ///< Least and largest distance from the root along aside_B [m].
  std::array<double, 2> across{};  ///< Likewise along axis_B x aside_B [m].
  /** It goes all the way round an axis through `root_B`: then `range` has its radii, and aside_B
   points to where it is pushed. */
  bool is_round{false};
  bool bends_inwards{false};  ///< Round: towards the axis.
};

/** A part that gives while it passes another one: a snap hook, a retaining ring, an O-ring. */
struct GivingPair {
  product::OccurrenceId flexible;
  product::OccurrenceId other;
  double depth{0};  ///< Depth of contact on the way [m].
  double width{0};  ///< How far it gives sideways [m] (CalcGivingWidth).
  product::FlexibleKind kind{product::FlexibleKind::kStated};  ///< Why it may.
  product::OccurrenceId moved;                                 ///< The one on its way.
  double strain{0};           ///< Where it bends or opens: the largest; 0: it is not known.
  double bearable_strain{0};  ///< What its material bears of it.
  /** What it takes, along the way of the one that is moved; null where no formula is known for it.
   */
  std::shared_ptr<const haptics::GivingCurve> curve;
  std::vector<BentArm> arms;  ///< Hook, wall: what of it bends; empty where that is not found.
  /** O-ring: what squeezes it passes outside of it; else inside. */
  bool is_outside{false};
};

/** How far a face gives way where it lies in another part as drawn, or would on its way in. */
struct FaceRelief {
  product::OccurrenceId occurrence;
  std::uint32_t face{0};  ///< Index in its part.
  double depth{0};        ///< [m]
};

/** A part that cannot be brought in, and why. Where the order has its place, a step kAssume puts it
 there. */
struct SequenceGap {
  product::OccurrenceId occurrence;
  std::string reason;
};

struct Sequence {
  std::vector<SequenceStep> steps;  ///< Steps in the order of assembly.
  std::vector<SequenceGap> gaps;
  std::vector<DrawnOverlap> overlaps;
  std::vector<FaceRelief> reliefs;  ///< Reliefs of faces, one of each.
  std::vector<GivingPair> gives;    ///< Parts that give on their way, one of each pair.
  std::vector<ScrewPair> screws;    ///< Pairs that come apart along a screw that no mate describes.
  Neighbours neighbours;            ///< Neighbours of all parts in the assembled product.
};

/** The move by which a part goes to its place, alone or with what moves with it; null where it has
 none: it is put into a fixture, or cannot be brought in. */
[[nodiscard]] const SequenceStep* FindInsertion(const Sequence& sequence, product::OccurrenceId id);

/** The move by which another part lets this one pass; null where none has to. */
[[nodiscard]] const SequenceStep* FindAside(const Sequence& sequence, product::OccurrenceId id);

/** What a part is allowed with others: by overlaps as drawn, and by parts that give. One for each
 other part; the spans are those of the arguments. */
[[nodiscard]] std::vector<contact::Allowance> ListAllowances(std::span<const DrawnOverlap> overlaps,
                                                             std::span<const GivingPair> gives,
                                                             product::OccurrenceId id);

/** How many contact queries the search for an order takes in all of a product: half a minute. A
 choice, as a person waits; docs/algorithms/sequence.md has what is lost by it. */
inline constexpr std::uint64_t kSearchQueries = 1'200'000;

/** How many times as many it takes where somebody asks for it: a choice. */
inline constexpr std::uint64_t kThoroughness = 10;

/** How many looks at a part the search for ways that turn takes at most. Of 22 pairs drawn for it,
 * 20 have their way within 60,000, two within 1,900,000. */
inline constexpr std::uint64_t kWayLooks = 2'000'000;

/** Why a part cannot be brought in; empty where no reason is known. */
[[nodiscard]] std::string FindGapReason(const Sequence& sequence, product::OccurrenceId id);

/** Whether other parts are put onto this one: in the fixture, or in a subassembly. */
[[nodiscard]] bool IsBase(const Sequence& sequence, product::OccurrenceId id);

/** The part that stays in the fixture. */
[[nodiscard]] product::OccurrenceId FindBase(const Sequence& sequence);

struct SequenceInput {
  const product::Product* product{nullptr};
  contact::Scene* scene{
      nullptr};  ///< All parts at their drawn poses; body index = occurrence index.
  std::vector<std::shared_ptr<const haptics::MateFaces>> faces_a;  ///< Indexed by MateId.
  std::vector<std::shared_ptr<const haptics::MateFaces>> faces_b;
  /** Indexed by OccurrenceId; empty: no face gives way. */
  std::vector<std::shared_ptr<const contact::Shape>> shapes;
  /** How far each part may give to pass others [m], by OccurrenceId; empty: all are rigid. */
  std::vector<double> give_limits;
  /** How many looks at a part the search for ways that turn may take; 0: none are searched for. */
  std::uint64_t way_looks{kWayLooks};
  std::uint64_t queries{kSearchQueries};        ///< Limits the search, in all of the product.
  product::OccurrenceId base;                   ///< What stays in the fixture; invalid: found.
  std::vector<product::OccurrenceId> absent;    ///< Tools, and what is not ready: not there.
  std::vector<product::OccurrenceId> fixtures;  ///< They stay where they are.
  std::function<void(double fraction)> progress;
  std::stop_token stop;  ///< Ends the planning early; the sequence is then incomplete.
};

/** Takes the product apart along straight lines that its mates leave free, nothing in the way, and
 turns the order round (X17, N10). Where no single part comes out, a subassembly of the file may
 come out as one body (X3); then it is put together first, by itself, and set on a shelf until its
 turn. Deterministic. Disables bodies of the scene as it goes. */
[[nodiscard]] Sequence PlanSequence(const SequenceInput& input);

/** Describes a direction for people: "+z" along an axis of W, else the components. */
[[nodiscard]] std::string DescribeDirection(const Vec3& direction_W);

/** Re-orders: parts named (or given by path or index "o12") first, in the order given; the others
 follow in the order found. Subassemblies that are put together first stay first, and the moves by
 which another part lets one pass stay with it.
 Errors: kNotFound for a name that matches nothing that can be moved; kInvalid where a part would
 come before the one that has to be moved aside for it. */
Result<Sequence> Reorder(const product::Product& product, const Sequence& sequence,
                         const std::vector<std::string>& names);

}  // namespace hvas::sequence
