#pragma once

#include <memory>
#include <vector>

#include "haptics/held_part.h"
#include "simulation/model.h"
#include "simulation/part_state.h"

namespace hvas::simulation {

/** Makes what the tick needs to know of a part that is taken up: its shape and mass with those of
 its subassembly, its mates with parts that are in their place, and its own place. Pure: the same
 model, parts and step give the same. */
class HeldPartMaker {
 public:
  /** @param parts  By OccurrenceId, where they are now. Both outlive this object. */
  HeldPartMaker(const Model& model, const std::vector<PartState>& parts)
      : model_(model), parts_(parts) {}

  [[nodiscard]] std::shared_ptr<const haptics::HeldPart> Make(const SequenceStep& step) const;

  /** A part that has a mate with this one and comes before it in the order, but is not in its
   place; invalid where there is none, or where another such part is in its place. */
  [[nodiscard]] product::OccurrenceId FindMissingPartner(const SequenceStep& step) const;

 private:
  void AddMembers(const SequenceStep& step, haptics::HeldPart* held) const;
  void AddMates(const SequenceStep& step, std::size_t member, haptics::HeldPart* held) const;
  [[nodiscard]] spatial::Pose CalcPlace(const haptics::HeldPart& held) const;
  [[nodiscard]] std::vector<contact::BodyId> ListLeftOut(product::OccurrenceId id,
                                                         const SequenceStep& step) const;
  [[nodiscard]] spatial::Pose CalcPoseAboveTable(product::OccurrenceId id) const;

  const Model& model_;
  const std::vector<PartState>& parts_;
};

}  // namespace hvas::simulation
