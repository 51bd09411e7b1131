#include "simulation/table_subassembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mates/mate_kind.h"
#include "mates/resolve.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;

bool Contains(const std::vector<OccurrenceId>& ids, OccurrenceId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

OccurrenceId PartnerOf(const product::Mate& mate, OccurrenceId id) {
  return mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
}

/** Index of the step by which a part goes to its place; the end for a base. */
std::size_t TurnOf(const sequence::Sequence& sequence, OccurrenceId id) {
  const sequence::SequenceStep* step = sequence::FindInsertion(sequence, id);
  return step != nullptr ? static_cast<std::size_t>(step - sequence.steps.data()) : 0;
}

/** Height of the lowest point of parts, the first of which is at X_WB [m]. */
double CalcLowest(const Model& model, const std::vector<OccurrenceId>& ids,
                  const spatial::Pose& X_WB) {
  double lowest = std::numeric_limits<double>::infinity();
  const spatial::Pose X_BW = model.bodies[ids.front().index()].X_WB_goal.Inverse();
  for (const OccurrenceId id : ids) {
    const spatial::Pose X_WS = X_WB * (X_BW * model.bodies[id.index()].X_WB_goal);
    for (const Vec3& vertex : model.product->part_of(id).mesh.vertices) {
      lowest = std::min(lowest, (X_WS * vertex).z());
    }
  }
  return lowest;
}

std::vector<OccurrenceId> ListTaken(const sequence::SequenceStep& step) {
  std::vector<OccurrenceId> ids{step.occurrence};
  ids.insert(ids.end(), step.members.begin(), step.members.end());
  return ids;
}

/** The way in to the target, as drawn, by the step of that part of a mate whose turn comes later.
 */
std::optional<sequence::SequenceStep> FindWayIn(const Model& model,
                                                const std::vector<OccurrenceId>& taken,
                                                const std::vector<OccurrenceId>& target) {
  std::optional<sequence::SequenceStep> way;
  for (const OccurrenceId id : taken) {
    for (const product::MateId mate_id : model.mates_of[id.index()]) {
      const product::Mate& mate = model.product->mates[mate_id.index()];
      const OccurrenceId other = PartnerOf(mate, id);
      const bool is_axis = mates::HoldsAcross(mate.kind);
      if (!Contains(target, other) || (way && !is_axis)) {
        continue;
      }
      const bool comes_later = TurnOf(model.sequence, id) > TurnOf(model.sequence, other);
      const sequence::SequenceStep* step =
          sequence::FindInsertion(model.sequence, comes_later ? id : other);
      if (step == nullptr) {
        continue;
      }
      way = *step;
      way->extraction_W = comes_later ? step->extraction_W : Vec3(-step->extraction_W);
      if (is_axis) {
        return way;
      }
    }
  }
  return way;
}

}  // namespace

std::vector<OccurrenceId> ListTogether(const std::vector<PartState>& parts, OccurrenceId id) {
  const OccurrenceId leader = parts[id.index()].leader;
  if (!leader.is_valid()) {
    return {id};
  }
  std::vector<OccurrenceId> ids{leader};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].leader == leader && i != leader.index()) {
      ids.emplace_back(i);
    }
  }
  return ids;
}

void JoinParts(const std::vector<OccurrenceId>& ids, OccurrenceId leader,
               std::vector<PartState>* parts) {
  for (const OccurrenceId id : ids) {
    (*parts)[id.index()].leader = leader;
  }
}

void SeparatePart(OccurrenceId id, std::vector<PartState>* parts) {
  std::vector<OccurrenceId> rest = ListTogether(*parts, id);
  std::erase(rest, id);
  (*parts)[id.index()].leader = OccurrenceId();
  JoinParts(rest, rest.size() > 1 ? rest.front() : OccurrenceId(), parts);
}

sequence::SequenceStep MakeTableStep(const Model& model, const std::vector<PartState>& parts,
                                     OccurrenceId id, TakeExtent extent) {
  const bool is_placed = parts[id.index()].placement == Placement::kPlaced;
  const bool is_alone = extent == TakeExtent::kAlone;
  const std::vector<OccurrenceId> taken =
      is_alone ? std::vector<OccurrenceId>{id} : ListTogether(parts, id);
  const auto has_placed_partner = [&](OccurrenceId member) {
    const auto& mates = model.mates_of[member.index()];
    return std::any_of(mates.begin(), mates.end(), [&](product::MateId mate) {
      const OccurrenceId other = PartnerOf(model.product->mates[mate.index()], member);
      return !Contains(taken, other) && parts[other.index()].placement == Placement::kPlaced;
    });
  };
  // The way of the member that meets the product first; where none does, of the last to come.
  const sequence::SequenceStep* way = nullptr;
  for (const sequence::SequenceStep& step : model.sequence.steps) {
    if (step.kind != sequence::SequenceStep::Kind::kInsert || !Contains(taken, step.occurrence)) {
      continue;
    }
    way = &step;
    if (has_placed_partner(step.occurrence)) {
      break;
    }
  }
  sequence::SequenceStep move = way != nullptr ? *way : sequence::SequenceStep();
  move.kind = is_placed || is_alone ? sequence::SequenceStep::Kind::kRemove
                                    : sequence::SequenceStep::Kind::kInsert;
  move.occurrence = taken.front();
  move.members.assign(taken.begin() + 1, taken.end());
  return move;
}

std::vector<TablePlace> ListTablePlaces(const Model& model, const std::vector<PartState>& parts,
                                        const sequence::SequenceStep& step) {
  constexpr double kTableTolerance = 50e-6;  // [m]: as deep as a part may come on its way home.
  const std::vector<OccurrenceId> taken = ListTaken(step);
  const OccurrenceId own_leader = parts[step.occurrence.index()].leader;
  std::vector<OccurrenceId> leaders;
  for (const OccurrenceId id : taken) {
    for (const product::MateId mate : model.mates_of[id.index()]) {
      const OccurrenceId other = PartnerOf(model.product->mates[mate.index()], id);
      const PartState& state = parts[other.index()];
      if (Contains(taken, other) || state.placement != Placement::kLoose) {
        continue;
      }
      // What stays of the own subassembly is led by what is not taken of it.
      std::vector<OccurrenceId> target = ListTogether(parts, other);
      std::erase_if(target, [&taken](OccurrenceId member) { return Contains(taken, member); });
      if (!Contains(leaders, target.front())) {
        leaders.push_back(target.front());
      }
    }
  }
  std::sort(leaders.begin(), leaders.end());
  std::vector<TablePlace> places;
  const Body& body = model.bodies[step.occurrence.index()];
  for (const OccurrenceId leader : leaders) {
    TablePlace place;
    place.target = ListTogether(parts, leader);
    std::erase_if(place.target, [&taken](OccurrenceId member) { return Contains(taken, member); });
    place.starts_in_place = own_leader.is_valid() && parts[leader.index()].leader == own_leader;
    const spatial::Pose X_WW =
        parts[leader.index()].X_WB * model.bodies[leader.index()].X_WB_goal.Inverse();
    place.X_WB_goal = X_WW * body.X_WB_goal;
    const std::optional<sequence::SequenceStep> way = FindWayIn(model, taken, place.target);
    const bool has_room =
        CalcLowest(model, taken, place.X_WB_goal) > model.table_z - kTableTolerance;
    if (!way || !(has_room || place.starts_in_place)) {
      continue;
    }
    place.insertion_W = X_WW.q() * -way->extraction_W;
    place.engage_distance = way->engage_distance;
    places.push_back(std::move(place));
  }
  return places;
}

std::shared_ptr<const haptics::RigidGroup> GroupStore::Get(const std::vector<OccurrenceId>& ids) {
  std::shared_ptr<const haptics::RigidGroup>& known = groups_[ids];
  if (known == nullptr) {
    sequence::SequenceStep step;
    step.occurrence = ids.front();
    step.members.assign(ids.begin() + 1, ids.end());
    const dynamics::MassProperties mass = CombineMass(model_, step);
    auto group = std::make_shared<haptics::RigidGroup>();
    group->mass = mass.mass;
    group->p_BoBcm_B = mass.p_BoBcm_B;
    group->I_BBcm_B = mass.I_BBcm_B;
    const spatial::Pose X_BW = model_.bodies[ids.front().index()].X_WB_goal.Inverse();
    for (const OccurrenceId id : ids) {
      const contact::BodyId body(id.index());
      const bool leads = id == ids.front();
      group->members.push_back(
          {body, leads ? spatial::Pose() : X_BW * model_.bodies[id.index()].X_WB_goal});
      group->bodies.push_back(body);
    }
    known = std::move(group);
  }
  return known;
}

}  // namespace hvas::simulation
