#include "simulation/passage_watch.h"

#include <algorithm>
#include <vector>

#include "sequence/thread_faces.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;

constexpr double kLeastDepth = 0.1e-3;  // [m]; parts that touch may lie so deep in one another.
// Of the size of a part, likewise: two rims that cross meet between their samples, which are a
// hundredth of a round apart. Seen: 2e-4, a peg of 0.2 m and 150 kg that rolls on the rim of its
// bore (WeightTest).
constexpr double kLeastDepthOfSize = 3e-4;

/** A thread whose flanks are drawn: it is screwed in, for which going straight along it stands. */
bool IsModelledThread(const product::Product& product, const product::Mate& mate) {
  if (!mate.fit || mate.fit->kind != product::FitKind::kThread || !sequence::IsDrawnThread(mate)) {
    return false;
  }
  const auto is_modelled = [&product](const product::Connector& side) {
    return product.part_of(side.occurrence).features[side.feature.index()].thread ==
           product::ThreadKind::kModelled;
  };
  return is_modelled(mate.a) && is_modelled(mate.b);
}

/** Depth from which on a part passes through another [m]. */
double LeastDepthOf(const product::Part& part) {
  return std::max(kLeastDepth, kLeastDepthOfSize * part.box_B.size().norm());
}

}  // namespace

PassageWatch::PassageWatch(const Model& model)
    : model_(model), threads_(model.bodies.size()), passages_(model.bodies.size()) {
  for (const Body& body : model.bodies) {
    scene_.Add(body.shape, body.X_WB_goal);
  }
  for (const product::Mate& mate : model.product->mates) {
    if (IsModelledThread(*model.product, mate)) {
      const std::size_t a = mate.a.occurrence.index();
      const std::size_t b = mate.b.occurrence.index();
      const ModelMate& faces = model.mates[mate.id.index()];
      threads_[a].push_back({contact::BodyId(b), faces.faces_a->mating, faces.faces_b->mating});
      threads_[b].push_back({contact::BodyId(a), faces.faces_b->mating, faces.faces_a->mating});
    }
  }
}

void PassageWatch::Look(const PhysicsSide& physics, std::size_t hand) {
  const haptics::HeldPart* held = physics.held(hand);
  const haptics::TickOutput& tick = physics.tick(hand);
  if (held == nullptr || tick.occurrence != held->occurrence) {
    return;
  }
  PlaceOthers(physics);
  LookAt(held->occurrence, held->occurrence, tick.X_WD);
  for (const haptics::HeldMember& member : held->members) {
    LookAt(held->occurrence, member.occurrence, tick.X_WD * member.X_BS);
  }
}

void PassageWatch::PlaceOthers(const PhysicsSide& physics) {
  for (const Body& body : model_.bodies) {
    const contact::BodyId id(body.occurrence.index());
    const bool is_placed = physics.placement(body.occurrence) == Placement::kPlaced;
    if (is_placed != scene_.is_enabled(id)) {
      scene_.SetPose(id, physics.pose(body.occurrence));
      scene_.SetEnabled(id, is_placed);
    }
  }
}

void PassageWatch::LookAt(OccurrenceId leader, OccurrenceId id, const spatial::Pose& X_WB) {
  Query(id, X_WB);
  const double least_depth = LeastDepthOf(model_.product->part_of(id));
  std::vector<Passage> met;
  for (const contact::Contact& contact : workspace_.contacts()) {
    if (contact.body.is_valid() && contact.distance < -least_depth) {
      met.push_back({OccurrenceId(contact.body.index()), -contact.distance});
    }
  }
  Passage& deepest = passages_[leader.index()];
  for (const Passage& passage : met) {
    if (passage.depth > deepest.depth) {
      const double beyond = passage.depth - FindDrawnDepth(id, passage.through);
      deepest = beyond > deepest.depth ? Passage{passage.through, beyond} : deepest;
    }
  }
}

PassageWatch::Touch PassageWatch::FindTouch(const PhysicsSide& physics, OccurrenceId id,
                                            const spatial::Pose& X_WB, OccurrenceId with) {
  constexpr double kNear =
      0.1e-3;  // [m]; what pressed on it was let go and may have moved by that.
  PlaceOthers(physics);
  contact::QueryOptions query;
  query.margin = kNear;
  query.self = contact::BodyId(id.index());
  scene_.Query(*model_.bodies[id.index()].shape, X_WB, query, &workspace_);
  Touch touch;
  double least = kNear;
  for (const contact::Contact& contact : workspace_.contacts()) {
    const bool is_meant =
        contact.body.is_valid() && (!with.is_valid() || contact.body.index() == with.index());
    if (is_meant && contact.distance < least) {
      least = contact.distance;
      touch = {OccurrenceId(contact.body.index()), contact.held_face, contact.scene_face};
    }
  }
  return touch;
}

void PassageWatch::Query(OccurrenceId id, const spatial::Pose& X_WB) {
  contact::QueryOptions query;
  query.margin = -LeastDepthOf(model_.product->part_of(id));
  query.self = contact::BodyId(id.index());
  query.ignored = threads_[id.index()];
  scene_.Query(*model_.bodies[id.index()].shape, X_WB, query, &workspace_);
}

double PassageWatch::FindDrawnDepth(OccurrenceId id, OccurrenceId other) {
  const auto [entry, is_new] = drawn_depths_.try_emplace(std::minmax(id, other), 0.0);
  if (is_new) {
    for (std::size_t i = 0; i < scene_.size(); ++i) {
      scene_.SetEnabled(contact::BodyId(i), i == other.index());
    }
    scene_.SetPose(contact::BodyId(other.index()), model_.bodies[other.index()].X_WB_goal);
    Query(id, model_.bodies[id.index()].X_WB_goal);
    for (const contact::Contact& contact : workspace_.contacts()) {
      entry->second = std::max(entry->second, -contact.distance);
    }
  }
  return entry->second;
}

}  // namespace hvas::simulation
