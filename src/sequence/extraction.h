#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/scene.h"
#include "paths/path.h"
#include "paths/way.h"
#include "sequence/bending_form.h"
#include "sequence/face_reliefs.h"
#include "sequence/giving_force.h"
#include "sequence/search_budget.h"
#include "sequence/sequence.h"

namespace hvas::sequence {

/** Parts that move as one: a single part, or what is there of a subassembly. The first leads. */
using Unit = std::vector<product::OccurrenceId>;

/** The parts that move in a step, the leading one first. */
[[nodiscard]] Unit UnitOf(const SequenceStep& step);

/** A part that stands in the way of a unit along a direction. */
struct Obstacle {
  product::OccurrenceId occurrence;  ///< Invalid: the table.
  double travelled{0};               ///< Length of the way before it is met [m].
  product::MateId mate;              ///< Mate that forbids the direction; invalid: contact.
};

/** How long ways that turn are searched for. */
enum class TurningEffort : std::uint8_t {
  kBrief,  ///< Some seconds for a part.
  kLong,   ///< Up to kWayLooks for a part.
};

/** Two faces that meet on a way, deeper than a way is free with. */
struct MetFaces {
  std::uint32_t own_face{contact::kNoFace};  ///< kNoFace: inside, where contact does not know it.
  product::OccurrenceId other;               ///< Invalid: the table.
  std::uint32_t other_face{contact::kNoFace};
  double depth{0};      ///< The largest depth of contact on the way [m].
  double travelled{0};  ///< Length of the way before they meet [m].
};

/** Finds the straight ways along which parts can be drawn out of a product while others are in
 their place. A part can be drawn out along a direction when no mate with a part that is present
 forbids it and when it meets no part that is present until their boxes are apart. */
class Extraction {
 public:
  /** @param input  Outlives this object; all its parts are present.
   @param known  Has the overlaps and reliefs found before; null: they are found here. */
  Extraction(const SequenceInput& input, const Sequence* known);

  /** Pairs of parts that interpenetrate as drawn, and what lets them pass one another. */
  [[nodiscard]] const std::vector<DrawnOverlap>& overlaps() const { return overlaps_; }

  /** Parts that gave on ways that TryRemoveGiving found. */
  [[nodiscard]] const std::vector<GivingPair>& gives() const { return gives_; }

  /** Pairs that were taken apart along a screw that no mate describes. */
  [[nodiscard]] const std::vector<ScrewPair>& screws() const { return screws_; }

  /** Lets the faces give way that parts meet on their ways by less than what a way is free with.
   The scene has the parts as made. Presence of parts changes. Returns false where there is none. */
  bool RelieveWays(const std::vector<SequenceStep>& steps);

  /** Faces that give way: where parts lie in one another as drawn by up to half a millimetre, and
   those of RelieveWays(). */
  [[nodiscard]] std::vector<FaceRelief> ListReliefs() const { return reliefs_.List(); }

  [[nodiscard]] bool is_present(product::OccurrenceId id) const { return is_present_[id.index()]; }

  void SetPresent(const Unit& unit, bool is_present);

  /** The size of a part [m^3], as base_choice.h has it. */
  [[nodiscard]] double SizeOf(product::OccurrenceId id) const;

  [[nodiscard]] std::string Describe(product::OccurrenceId id) const;

  /** Lists the directions that are worth a try for parts that are present: those that rub along the
   fewest mated faces first, of these the upward ones. */
  [[nodiscard]] std::vector<Vec3> ListDirections(const Unit& unit);

  /** Lists directions that the contacts of a part as drawn leave free: along the normals of touched
   faces, between them, and along the edges of two of them, which are the edges of the cone of free
   motion. At most 24, upward ones first. */
  [[nodiscard]] std::vector<Vec3> ListContactDirections(product::OccurrenceId id);

  /** Lists all parts present that stand in the way of a unit along a direction, those with a mate
   that forbids it first. The search ends at `fixed`, which is then the last one; invalid: it never
   ends early. */
  [[nodiscard]] std::vector<Obstacle> ListObstacles(const Unit& unit, const Vec3& direction,
                                                    product::OccurrenceId fixed);

  /** Distance along a way out until the boxes of a unit and of all parts present are apart [m]. */
  [[nodiscard]] double CalcWayLength(const Unit& unit, const Vec3& direction);

  /** Distance along a way out until nothing is engaged any more [m]. */
  [[nodiscard]] double CalcEngageDistance(const Unit& unit, const Vec3& direction);

  /** Takes a unit out along the first direction that is free; it is not present then. The step is
   an insertion, by the reverse of that direction. A unit that could not go before is tried again
   only when something has changed. */
  [[nodiscard]] std::optional<SequenceStep> TryRemove(const Unit& unit);

  /** Takes a unit out along this direction if it is free; it is not present then. The step is as
   that of TryRemove. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveAlong(const Unit& unit, const Vec3& direction);

  /** Takes out the first of these parts that can go, the last of them excepted, and erases it from
   them. Parts that could not go before are tried again only when something has changed.
   @param staying  Sorted; parts that are not tried. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveOne(Unit* rest, const Unit& staying = {});

  /** Takes out the first of these parts that can go where it, or what is in its way, gives by no
   more than SequenceInput::give_limits has, in depth and in width (giving_width.h), and erases it
   from them.
   @param deferred  Sorted; parts that are tried after all others. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveGiving(Unit* rest, const Unit& deferred);

  /** Takes out the first of these parts that can go where a wall or an arm bends aside, of it or of
   what is in its way, by no more than its form bears (bending_form.h), and erases it from them.
   Where a brief search finds a way that turns, it goes along that one instead. Parts that are
   stated to be rigid do not bend.
   @param deferred  Sorted; parts that are tried after all others. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveBending(Unit* rest, const Unit& deferred);

  /** Takes out the first of these rings of round section that can go along a way that turns without
   giving: links of a chain, as no file says that they are of rubber. Each is looked at once,
   briefly.
   @param deferred  As of TryRemoveTurning(). */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveRing(Unit* rest, const Unit& deferred);

  /** Takes out the first of these parts that can go along a way of several pieces, or one that
   turns, and erases it from them. Parts that are held by more than clearance as drawn are not
   tried, nor those that are proven to have no way (gap_proof.h). A search is made again only with
   more queries, or when a part near to where it got is there no more; all of them take what is left
   of SequenceInput::queries, in a long search each part an equal share of it, those first that
   have least to go.
   @param deferred  Sorted; parts that are tried after all others. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveTurning(Unit* rest, const Unit& deferred,
                                                             TurningEffort effort);

  /** Takes out the first of these parts that can go once another one is moved a part of its way,
   along a straight line or about the axis of its mates, and erases it from them: a bolt is slid
   aside, a drawer is opened, a lid is turned up. The part that is moved goes back, so that all else
   is as before. Parts that are held by more than clearance are not moved, and all searches together
   take no more than a quarter of SequenceInput::queries.
   @param deferred  Sorted; parts that are tried after all others.
   @returns the steps in the order of assembly: aside, the part's own, back; empty: none can go. */
  [[nodiscard]] std::vector<SequenceStep> TryRemovePast(Unit* rest, const Unit& deferred);

  /** Says that the search for what can be moved aside was ended; empty where it was not. */
  [[nodiscard]] std::string ExplainPassing() const;

  /** Moves a part that is present to a pose beside its place, where its mates hold nothing. */
  void MoveAside(product::OccurrenceId id, const spatial::Pose& X_WB);

  /** Moves it back into its place. */
  void MoveBack(product::OccurrenceId id);

  /** What the search for ways that turn found of a part that it did not take out; empty where it
   did not look. */
  [[nodiscard]] std::string ExplainTurning(product::OccurrenceId id) const;

  /** Takes a part out where contact with `others` begins `clearance` deeper [m] than drawn, as if
   the part, or they, were smaller by that all over; nothing lies in them deeper than that. What the
   two block of one another, seen along the way, is no wider than that (giving_width.h): a
   thin wall is not passed. Nothing is noted of what was met. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveCleared(product::OccurrenceId id,
                                                             const Unit& others, double clearance);

  /** Takes a part out as TryRemoveGiving does, where neither part has to go through the other with
   its whole width, as a thin rod through a plate; nothing is noted of what was met. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveWithLimits(product::OccurrenceId id);

  /** Lists the faces that a part meets deeper than a way is free with, all along a straight way
   out, by what allowances let pass less; the deepest first. */
  [[nodiscard]] std::vector<MetFaces> MeasureFaces(product::OccurrenceId id, const Vec3& direction);

  /** Lists the mates with parts present that forbid a direction. */
  [[nodiscard]] std::vector<product::MateId> ListForbidding(product::OccurrenceId id,
                                                            const Vec3& direction) const;

  /** Whether a way of poses X_WB of a part meets nothing that is there, deeper than it may. */
  [[nodiscard]] bool IsWayFree(product::OccurrenceId id,
                               const std::vector<spatial::Pose>& way) const;

  /** How many contact queries all calls have taken so far. */
  [[nodiscard]] std::uint64_t looks() const { return looks_; }

  /** What the search for an order may take, and has taken. */
  [[nodiscard]] const SearchBudget& budget() const { return budget_; }

  /** Allows those of these parts that overlap as drawn, and block one another's ways, half a
   millimetre more than the drawn depth, with all their faces. Returns false where there are none.
   */
  bool AllowBeyondDrawn(const Unit& parts);

  /** Forgets what TryRemoveOne and TryRemoveGiving have tried with these parts, and TryRemove with
   any unit. */
  void Forget(const Unit& parts);

  /** Explains why TryRemoveOne did not find a way out for a part. */
  [[nodiscard]] std::string ExplainStuck(product::OccurrenceId id) const;

  /** Explains that a part would go if a wall bent that has no room to; empty where none is known.
   */
  [[nodiscard]] std::string ExplainBending(product::OccurrenceId id) const;

  /** Explains that a part meets an obstacle, with both diameters where a shaft of one would have to
   pass a smaller hole of the other. */
  [[nodiscard]] std::string ExplainObstacle(product::OccurrenceId id, const Obstacle& obstacle,
                                            const Vec3& direction) const;

 private:
  struct MateView {
    const product::Mate* mate;
    product::OccurrenceId other;
    Vec3 axis_W;  // axis, or outward normal of this part's face, or across the walls
    Vec3 way_W;   // way out of this part by a prismatic mate
    bool is_a;
    double cos_half_angle;  // of a conical seat
  };

  /** A part of a unit on its way. */
  struct Member {
    product::OccurrenceId id;
    std::vector<contact::IgnoredPair> ignored;
    std::vector<contact::Allowance> allowances;
    std::vector<contact::BodyId> left_out;
  };

  struct Attempt {
    Vec3 direction;
    std::optional<Obstacle> blocker;  // none: the mates forbid it
  };

  /** How far parts may give where they meet. */
  enum class Giving : std::uint8_t {
    kNone,
    kAsKnown,      ///< They give by what SequenceInput::give_limits has.
    kByForm,       ///< They give by what a wall that bends may at most.
    kByLimits,     ///< They give so, but what is blocked is not the outline of one of the two.
    kByClearance,  ///< Parts of TryRemoveCleared are smaller all over.
  };

  /** A contact with a normal across the way, at the drawn place of the other part. */
  struct MeetingSide {
    contact::Contact contact{};
    double travelled{0};  ///< Where on the way it is [m].
  };

  /** What a part meets of another one on its way out. */
  struct Meeting {
    double depth{0};                 ///< Largest depth of contact [m].
    std::vector<MeetingSide> sides;  ///< The deepest contact of each direction of normals.

    void Add(const MeetingSide& side);
    /** The deepest side; its distance is 0 where there is none. */
    [[nodiscard]] MeetingSide deepest() const;
  };

  /** What was tried last, so that it is tried again only when something has changed. */
  struct Memory {
    std::vector<Attempt> attempts;
    std::ptrdiff_t mates_around{-1};
  };

  /** Lets the faces give way that a unit meets on its way out, as far as it goes on it [m]. */
  void RelieveWay(const Unit& unit, const Vec3& direction, double length);
  /** The parts of a unit that goes along a direction, with what contact leaves out. */
  [[nodiscard]] std::vector<Member> ListMembers(const Unit& unit, const Vec3& direction) const;
  /** The query for what a member meets deeper than `depth` [m]; spans of the member. */
  [[nodiscard]] static contact::QueryOptions MakeQuery(const Member& member, double depth);
  /** Where a part is when it has moved from its drawn pose by `travel_W` [m]. */
  [[nodiscard]] spatial::Pose CalcPoseAlong(product::OccurrenceId id, const Vec3& travel_W) const;
  /** Distance between looks along a way. @param length  Of the way [m]. */
  [[nodiscard]] double CalcStep(const Unit& unit, double length) const;
  [[nodiscard]] std::vector<contact::Allowance> CollectAllowances(product::OccurrenceId id) const;
  /** Whether a part that gives gets past a face that it touches in its place, or off a shaft that
   it does not go all the way round. */
  [[nodiscard]] bool MayPass(const MateView& view, product::OccurrenceId id,
                             const Vec3& direction) const;
  /** Whether a part gives, or one that was found in its way. */
  [[nodiscard]] bool MayGive(product::OccurrenceId id) const;
  /** How far two parts may give when they pass one another [m]. */
  [[nodiscard]] double CalcGiveLimit(product::OccurrenceId id, product::OccurrenceId other) const;
  /** Takes out the first part of `rest` that can go while parts give. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveWith(Giving giving, Unit* rest,
                                                          const Unit& deferred);
  /** Calls `visit` with all contacts deeper than a way is free with, at each look along a straight
   way out. @pre The part is in the unit. */
  void VisitContacts(
      product::OccurrenceId id, const Vec3& direction,
      const std::function<void(const contact::Contact& contact, double travelled)>& visit);
  /** Calls it for looks number 0 to `last`, which are `step` apart [m]. */
  void VisitContacts(
      product::OccurrenceId id, const Vec3& direction, const contact::QueryOptions& query,
      double step, int last,
      const std::function<void(const contact::Contact& contact, double travelled)>& visit);
  /** The width that two parts may block of one another where a depth is given [m]. */
  [[nodiscard]] double CalcWidestGiven(product::OccurrenceId id, product::OccurrenceId other,
                                       const Vec3& direction, double limit) const;
  /** What a part meets on its way out. @pre It is in the unit. */
  [[nodiscard]] std::map<product::OccurrenceId, Meeting> MeasureMeetings(product::OccurrenceId id,
                                                                         const Vec3& direction);
  /** Which of two parts bends where they meet; none where neither bears it, or has room. */
  [[nodiscard]] BendingAnswer FindWhatBends(product::OccurrenceId id, product::OccurrenceId other,
                                            const MeetingSide& side, const Vec3& direction,
                                            double width) const;
  /** Whether one of two parts bends where they meet deepest, and has room wherever it would have
   to. Notes where it has none. */
  [[nodiscard]] bool MayBend(product::OccurrenceId id, product::OccurrenceId other,
                             const Meeting& meeting, const Vec3& direction, double width);
  /** Whether one of two parts is known to give so far [m]. */
  [[nodiscard]] bool GivesAsKnown(product::OccurrenceId id, product::OccurrenceId other,
                                  double width) const;
  /** A way that turns, of a part that would go if walls bent: it is looked for briefly, once among
   the same parts. The part is not present. */
  [[nodiscard]] std::optional<SequenceStep> FindRigidWay(product::OccurrenceId id);
  /** How far a part and another one overlap across the way, all along it. */
  [[nodiscard]] GivingSamples SampleGiving(product::OccurrenceId id, product::OccurrenceId other,
                                           bool gives_itself, const Vec3& direction);
  /** Notes what of a part that gives bends, or which side of it is squeezed. */
  void NoteForm(const GivingSamples& samples, const WhatBends* arm, const Vec3& direction,
                GivingPair* give) const;
  /** What squeezes an O-ring on its way between two parts by more than its section bears: stretched
   over one of them alone it gives far more. @pre As VisitContacts(). */
  [[nodiscard]] std::optional<Obstacle> FindSqueezed(product::OccurrenceId id,
                                                     const Vec3& direction);
  /** Finds what is in the way of a part on more of its width than the two may give, a wall that it
   would have to go through, or what does not bend. @pre It is in the unit, and parts give. */
  [[nodiscard]] std::optional<Obstacle> FindTooWide(product::OccurrenceId id,
                                                    const Vec3& direction);
  /** Notes how far a part, or what it passes, gives on its way out. */
  void NoteGives(product::OccurrenceId id, const Vec3& direction);

  [[nodiscard]] bool IsAround(product::OccurrenceId id) const {
    return is_present_[id.index()] && !is_in_unit_[id.index()];
  }

  /** Whether mates with a part hold: it is there, in its place. */
  [[nodiscard]] bool IsMated(product::OccurrenceId id) const {
    return IsAround(id) && !is_aside_[id.index()];
  }

  void SetUnit(const Unit& unit, bool is_in_unit);
  /** Faces of the mates of a part that fits answer for. Those of an axis that the part leaves
   across it have contact. */
  [[nodiscard]] std::vector<contact::IgnoredPair> CollectIgnored(
      product::OccurrenceId id, const Vec3& direction = Vec3::Zero()) const;
  /** Whether a direction is across the axis of a mate, whose hole is open to a side. */
  [[nodiscard]] bool IsAcrossOpenAxis(const MateView& view, const Vec3& direction) const;
  [[nodiscard]] SequenceStep MakeStep(const Unit& unit, const Vec3& direction) const;
  /** Normals of the faces that a part touches, out of them. */
  [[nodiscard]] std::vector<Vec3> CollectContactNormals(product::OccurrenceId id);
  [[nodiscard]] std::vector<Vec3> CollectDirections(const Unit& unit) const;
  /** Whether a mate leaves this direction free. */
  [[nodiscard]] static bool IsAllowed(const MateView& view, const Vec3& direction);
  [[nodiscard]] bool MatesAllow(const Unit& unit, const Vec3& direction) const;
  [[nodiscard]] double CalcExitDistance(const Unit& unit, const Vec3& direction) const;
  /** Distance along a way out until a wall and what it guides are past each other [m]. */
  [[nodiscard]] double CalcWallTravel(const MateView& view, product::OccurrenceId id,
                                      const Vec3& direction) const;
  [[nodiscard]] double CalcEngagement(const Unit& unit, const Vec3& direction) const;
  /** Finds the first part that a unit meets, from `from` on [m], these excepted. */
  [[nodiscard]] std::optional<Obstacle> FindBlocker(const Unit& unit, const Vec3& direction,
                                                    double from,
                                                    std::span<const contact::BodyId> excepted);
  [[nodiscard]] std::optional<SequenceStep> TryRemove(const Unit& unit, Memory* memory);
  /** Where two parts lie in one another as drawn: says by how much. Else empty. */
  [[nodiscard]] std::string ExplainOverlap(product::OccurrenceId id,
                                           product::OccurrenceId other) const;

  const SequenceInput& input_;
  const product::Product& product_;
  std::vector<bool> is_present_;
  std::vector<bool> is_in_unit_;
  std::vector<bool> is_aside_;
  std::vector<std::vector<MateView>> mates_of_;
  std::vector<std::vector<Vec3>> plane_lines_;  // By occurrence, in its frame.
  std::vector<spatial::Box> boxes_;
  std::vector<DrawnOverlap> overlaps_;
  std::vector<GivingPair> gives_;
  std::vector<ScrewPair> screws_;
  std::vector<std::vector<contact::Allowance>> allowances_;  // by occurrence
  std::vector<Memory> memories_;                             // by occurrence
  std::vector<Memory> giving_memories_;                      // by occurrence
  std::map<Unit, Memory> unit_memories_;
  FaceReliefs reliefs_;
  std::vector<Memory> bending_memories_;              // by occurrence
  std::map<product::OccurrenceId, NoRoom> no_rooms_;  // By the part that cannot go.

  /** A search for a way that turns that found none. */
  struct Search {
    std::uint64_t looks{0};
    std::vector<bool> is_present;  // What was there, by occurrence.
    double gone{0};                // The farthest that it got [m].
    double to_go{0};               // How far boxes still overlap there [m].
    bool is_proven{false};         // Contacts hold the part, or a cage: it was not searched for.
    product::OccurrenceId stopped_by;
  };

  /** A part among those that are there, with what it is allowed. */
  [[nodiscard]] paths::WayProblem MakeWayProblem(product::OccurrenceId id) const;
  /** Searches for a way that turns, with as many looks at most. */
  [[nodiscard]] std::optional<SequenceStep> FindTurningWay(product::OccurrenceId id,
                                                           std::uint64_t budget);
  /** Searches briefly with those parts that are to be tried, with so many looks for each. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveTurning(
      Unit* rest, const Unit& deferred, std::uint64_t budget,
      const std::function<bool(product::OccurrenceId)>& is_tried);
  /** Searches with what is left of the budget. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveTurningLong(Unit* rest, const Unit& deferred);
  /** Takes a part out along a way that turns, and erases it from `rest`. */
  [[nodiscard]] std::optional<SequenceStep> TryRemoveTurning(product::OccurrenceId id,
                                                             std::uint64_t budget, Unit* rest);
  /** Whether a search with so many looks at most may find more than the last one. */
  [[nodiscard]] bool IsWorthSearching(product::OccurrenceId id, std::uint64_t budget) const;
  /** Whether another part than before is there, or not there, where the last search got. */
  [[nodiscard]] bool HasChangedNearby(product::OccurrenceId id) const;
  /** Whether it is proven that a part has no way as long as the others stay. */
  [[nodiscard]] bool IsProvenStuck(product::OccurrenceId id, bool is_long) const;
  /** Whether a mate holds a part by more than clearance: ways along it alone are true. */
  [[nodiscard]] bool IsHeldFirmly(product::OccurrenceId id) const;

  std::vector<Search> searches_;  // By occurrence.

  /** Whether a part stands in a way of another one that was tried, or has a mate with it. */
  [[nodiscard]] bool MayStandInTheWay(product::OccurrenceId id, product::OccurrenceId of) const;

  /** A motion of a part that its mates leave free. */
  struct InnerMotion {
    paths::Path way;  ///< Poses X_WB from its place on.
    Vec3 direction;   ///< Unit; zero: it turns.
  };

  /** The straight motions of a part, then its turns about the axis of its mates. */
  [[nodiscard]] std::vector<InnerMotion> ListInnerMotions(product::OccurrenceId id);
  /** Whether mates with parts present leave a turn about an axis free. */
  [[nodiscard]] bool MayTurn(product::OccurrenceId id, const Vec3& axis_W) const;
  /** The beginning of a motion, in short steps, as far as nothing is met deeper than a way is free
   with. */
  [[nodiscard]] paths::Path FindFreeWay(product::OccurrenceId id, const InnerMotion& motion);

  /** The step of a part that can go once another one is at a place on its way. */
  struct Passing {
    SequenceStep step;
    std::size_t place{0};  ///< Index on the way, where the other part is out of the way best.
  };

  /** Finds the first of the parts that are blocked that can go while another one is on its way.
   None is taken out. */
  [[nodiscard]] std::optional<Passing> FindPassing(product::OccurrenceId moved,
                                                   const paths::Path& way, const Unit& blocked);
  /** Takes out the first of the parts that are blocked that can go once this one is moved. */
  [[nodiscard]] std::vector<SequenceStep> TryRemovePast(product::OccurrenceId moved,
                                                        const Unit& blocked);
  /** The step of a part with another one aside; it stays where it is. */
  [[nodiscard]] std::optional<SequenceStep> FindWayPast(product::OccurrenceId id);

  [[nodiscard]] bool IsPassingOver() const {
    return budget_.is_over() || passing_spent_ >= budget_.total() / 4;
  }

  /** Counts the last query of the workspace. */
  void CountQuery() {
    ++looks_;
    budget_.Spend(1, workspace_.stats().points_tested);
  }

  SearchBudget budget_;
  std::uint64_t passing_spent_{0};  // Of the budget.
  std::uint64_t looks_{0};
  double clearance_{0};           // Of kByClearance [m].
  std::vector<bool> is_cleared_;  // Of kByClearance, by occurrence.
  Giving giving_{Giving::kNone};
  contact::QueryWorkspace workspace_;
};

}  // namespace hvas::sequence
