#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "haptics/rigid_group.h"
#include "simulation/model.h"
#include "simulation/part_state.h"

namespace hvas::simulation {

/** How much of a subassembly a hand takes. */
enum class TakeExtent : std::uint8_t {
  kWhole,  ///< All parts that the part is put together with.
  kAlone,  ///< The part alone; the others stay together.
};

/** Parts that are put together with this one, its leader first and the others by their ids; the
 part itself where it is by itself. */
[[nodiscard]] std::vector<product::OccurrenceId> ListTogether(const std::vector<PartState>& parts,
                                                              product::OccurrenceId id);

/** Puts parts together: `leader` leads them all. */
void JoinParts(const std::vector<product::OccurrenceId>& ids, product::OccurrenceId leader,
               std::vector<PartState>* parts);

/** Takes a part out of the subassembly that was put together on the table; the others stay
 together, and one that is left over is by itself. */
void SeparatePart(product::OccurrenceId id, std::vector<PartState>* parts);

/** The move of a part that was put together with others: its subassembly as one body, into its
 place or out of it (kRemove), by the way of the member whose mates lead there; or the part alone,
 out of its subassembly (kRemove). @pre the part has a leader. */
[[nodiscard]] sequence::SequenceStep MakeTableStep(const Model& model,
                                                   const std::vector<PartState>& parts,
                                                   product::OccurrenceId id, TakeExtent extent);

/** A place of what a hand takes at loose parts on the table: as drawn, in their present pose. */
struct TablePlace {
  std::vector<product::OccurrenceId> target;  ///< Loose parts that stand together, leader first.
  spatial::Pose X_WB_goal;                    ///< Place of the step's part.
  Vec3 insertion_W{-Vec3::UnitZ()};           ///< Unit, the way in.
  double engage_distance{0};                  ///< Distance until nothing is engaged [m].
  bool starts_in_place{false};                ///< It is taken out of there.
};

/** Lists places at loose parts that have a mate with what the step takes, and to which the table
 leaves room. In the order of the targets' leaders. */
[[nodiscard]] std::vector<TablePlace> ListTablePlaces(const Model& model,
                                                      const std::vector<PartState>& parts,
                                                      const sequence::SequenceStep& step);

/** Rigid groups of a model's parts, each made once: what moves on the haptic thread refers to them
 as long as the simulation is there. */
class GroupStore {
 public:
  explicit GroupStore(const Model& model) : model_(model) {}

  /** @param ids  At least one; the first leads. Poses are those drawn. */
  [[nodiscard]] std::shared_ptr<const haptics::RigidGroup> Get(
      const std::vector<product::OccurrenceId>& ids);

 private:
  const Model& model_;
  std::map<std::vector<product::OccurrenceId>, std::shared_ptr<const haptics::RigidGroup>> groups_;
};

}  // namespace hvas::simulation
