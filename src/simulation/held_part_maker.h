#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "haptics/held_part.h"
#include "simulation/model.h"
#include "simulation/part_state.h"
#include "simulation/table_subassembly.h"

namespace hvas::simulation {

/** A mate of two planes that face the way in or out, which ends the insertion.
 @param axis_W  Unit, normal of the mate. @param insertion_W  Unit, the way in or out. */
[[nodiscard]] bool IsStop(const product::Mate& mate, const Vec3& axis_W, const Vec3& insertion_W);

/** Makes what the tick needs to know of a part that is taken up: its shape and mass with those of
 its subassembly, its mates with parts that are in their place, and its own place; where it may be
 put to loose parts on the table, its places there as well (X1). The same model, parts and step give
 the same. */
class HeldPartMaker {
 public:
  /** @param parts  By OccurrenceId, where they are now. Both outlive this object. */
  HeldPartMaker(const Model& model, const std::vector<PartState>& parts)
      : model_(model), parts_(parts), groups_(model) {}

  /** @param can_join  The part may be put to loose parts on the table. */
  [[nodiscard]] std::shared_ptr<const haptics::HeldPart> Make(const sequence::SequenceStep& step,
                                                              bool can_join);

  /** Loose parts that are together, as one body. */
  [[nodiscard]] std::shared_ptr<const haptics::RigidGroup> GroupOf(
      const std::vector<product::OccurrenceId>& ids) {
    return groups_.Get(ids);
  }

  /** A part that would hold what moves in a step, by a mate or because they touch as drawn, and
   that comes before it in the order, but is not in its place; invalid where there is none, or where
   any part that would hold it is in its place. */
  [[nodiscard]] product::OccurrenceId FindMissingPartner(const sequence::SequenceStep& step) const;

 private:
  /** Adds the fasteners in their place that a tool fits. */
  void AddDrives(const sequence::SequenceStep& step, haptics::HeldPart* held) const;
  /** Adds what gives on its way against parts in their places. */
  void AddGives(product::OccurrenceId id, haptics::HeldPart* held) const;
  /** Adds what the part presses together in its place. @pre Its members are known. */
  void AddPresses(const sequence::SequenceStep& step, haptics::HeldPart* held) const;
  void AddMembers(const sequence::SequenceStep& step, haptics::HeldPart* held) const;
  /** Adds mates with parts of this placement.
   @param target  Null: any of them; else these alone. */
  void AddMates(const sequence::SequenceStep& step, Placement placement,
                const std::vector<product::OccurrenceId>* target, haptics::HeldPart* held) const;
  void AddMatesOf(const sequence::SequenceStep& step, std::size_t member, Placement placement,
                  const std::vector<product::OccurrenceId>* target, haptics::HeldPart* held) const;
  /** Makes the entry of a mate with a part in its place; none where a part that is moved aside does
   not keep to the mate. */
  [[nodiscard]] std::optional<haptics::HeldMate> MakeHeldMate(const sequence::SequenceStep& step,
                                                              std::size_t member,
                                                              const product::Mate& drawn,
                                                              const haptics::HeldPart& held) const;
  /** Whether the order has a part before the insertion of a later one, or has given it up. */
  [[nodiscard]] bool IsMeantBefore(product::OccurrenceId id, product::OccurrenceId later) const;
  /** Threads of the mates that were added. */
  void AddThreads(haptics::HeldPart* held) const;
  void AddTablePlaces(const sequence::SequenceStep& step, haptics::HeldPart* held);
  /** The place that the mates have, near a wanted one. */
  [[nodiscard]] static spatial::Pose CalcPlace(const haptics::HeldPart& held,
                                               const spatial::Pose& X_WB_wanted);
  [[nodiscard]] spatial::Pose CalcPoseAboveTable(const sequence::SequenceStep& step) const;

  const Model& model_;
  const std::vector<PartState>& parts_;
  GroupStore groups_;
};

}  // namespace hvas::simulation
