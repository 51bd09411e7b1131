#include "simulation/held_part_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/units.h"
#include "fits/paper_scales.h"
#include "haptics/mate_guide.h"
#include "mates/capture.h"
#include "mates/prismatic_fits.h"
#include "mates/resolve.h"
#include "mates/thread_joints.h"
#include "sequence/fit_of_mate.h"
#include "simulation/bolt_circle.h"
#include "simulation/tool_mates.h"

namespace hvas::simulation {
namespace {

using product::MateKind;
using product::OccurrenceId;

constexpr double kApproach = 0.01;  // [m] before its place, where a part's mates are resolved from

/** How far a point of a part goes straight along a way from its place, without a turn [m]; infinite
 where the way has no poses. */
double CalcStraightEnd(const std::vector<spatial::Pose>& way, const Vec3& p_B) {
  constexpr double kOffStraight = 50e-6;  // [m]: paths are free to this. A choice.
  constexpr double kTurnedOff = 1e-3;     // [rad]: a choice.
  if (way.size() < 2) {
    return std::numeric_limits<double>::infinity();
  }
  const Vec3 place = way.front() * p_B;
  const Vec3 outward = (way[1] * p_B - place).normalized();
  double end = 0;
  for (const spatial::Pose& X_WB : way) {
    const Vec3 gone = X_WB * p_B - place;
    const double along = gone.dot(outward);
    if ((gone - along * outward).norm() > kOffStraight ||
        spatial::RotationBetween(way.front().q(), X_WB.q()).norm() > kTurnedOff) {
      return end;
    }
    end = along;
  }
  return end;
}

/** The mate by which the hand is guided onto a fastener's axis. It answers for no faces: contact
 stays, and turns the fastener. */
haptics::HeldMate MakeDriveMate(const ToolMate& mate, OccurrenceId fastener,
                                const spatial::Pose& X_WF) {
  static const auto no_faces = std::make_shared<const haptics::MateFaces>();
  const auto frame = [](const Vec3& z, const Vec3& p) {
    return spatial::Pose(spatial::FrameFromZ(z), p);
  };
  haptics::HeldMate held;
  held.X_WM = X_WF * frame(mate.fastener.axis_B, mate.fastener.origin_B);
  held.X_BN = frame(-mate.tool.axis_B, mate.tool.origin_B);
  held.capture.kind = MateKind::kAxisHole;
  held.capture.placed_high = mate.fastener.depth;
  held.capture.held_low = -mate.tool.depth;
  held.radius = 0.5 * mate.fastener.width;
  held.body = contact::BodyId(fastener.index());
  held.held_faces = no_faces;
  held.placed_faces = no_faces;
  return held;
}

/** A prismatic mate with the way by which a step takes the inner part out of the outer one; others
 as they are. @param way_W  That way as the parts stand. @param q_DW  Rotation of the standing part
 to where it is drawn. */
product::Mate TurnToStep(const product::Product& product, const product::Mate& mate,
                         const Vec3& way_W, const Quat& q_DW) {
  return mate.kind == MateKind::kPrismatic ? mates::TurnToWay(product, mate, q_DW * way_W) : mate;
}

/** All bodies that move in a step; empty for a part alone. */
std::vector<contact::BodyId> ListTogetherBodies(const sequence::SequenceStep& step) {
  std::vector<contact::BodyId> bodies;
  if (!step.members.empty()) {
    bodies.emplace_back(step.occurrence.index());
    for (const OccurrenceId member : step.members) {
      bodies.emplace_back(member.index());
    }
  }
  return bodies;
}

/** Whether a mate holds a part that is aside as it holds it in its place: one that leads the part
 there does. */
bool HoldsAside(const mates::MateConstraint& mate, const spatial::Pose& X_WB_place,
                const spatial::Pose& X_WB_aside) {
  constexpr double kTolerance = 0.1e-3;  // [m]: more than shapes drawn for each other differ by.
  const std::span<const mates::MateConstraint> one(&mate, 1);
  return mates::CalcResidual(one, X_WB_aside) < mates::CalcResidual(one, X_WB_place) + kTolerance;
}

/** A thread without anything to clamp. */
haptics::HeldThread MakeHeldThread(const mates::ThreadJoint& joint) {
  // Of a thread that no table has, as of metric ones.
  fits::Thread thread;
  thread.diameter = joint.diameter;
  thread.pitch = joint.pitch;
  if (joint.thread != nullptr) {
    thread = *joint.thread;
  }
  haptics::HeldThread held;
  held.lead = joint.is_left_handed ? -joint.pitch : joint.pitch;
  held.play = fits::CalcMeanFlankPlay(thread);
  held.pitch_diameter = thread.pitch_diameter();
  held.friction = mates::kThreadFriction;
  held.head_radius = 0.5 * mates::kHeadContact * joint.diameter;
  return held;
}

/** From where the held part rests, by a plane that ends its way in, to the first turn of its thread
 that is engaged; none where no plane does [m]. */
std::optional<double> FindClampedLength(const haptics::HeldPart& held,
                                        const haptics::HeldMate& thread) {
  constexpr double kLeast = 0.5;  // Of the diameter: a head on the very hole, too, gives. A choice.
  const haptics::MateGeometry in_place = haptics::CalcMateGeometry(thread, held.X_WB_goal);
  std::optional<double> least;
  for (const haptics::HeldMate& mate : held.mates) {
    if (mate.is_stop) {
      const double to_middle = std::abs((in_place.p_WQ - mate.X_WM.p()).dot(in_place.way_W));
      const double clamped =
          std::max(to_middle - 0.5 * in_place.engaged, kLeast * 2 * thread.radius);
      least = std::min(least.value_or(clamped), clamped);
    }
  }
  return least;
}

std::shared_ptr<const haptics::MateFaces> WithoutNeighbours(const haptics::MateFaces& faces) {
  return std::make_shared<haptics::MateFaces>(haptics::MateFaces{faces.mating, faces.mating});
}

/** Whether a step moves a part: as its own, or with it. */
bool IsMovedBy(const sequence::SequenceStep& step, OccurrenceId id) {
  return id == step.occurrence ||
         std::find(step.members.begin(), step.members.end(), id) != step.members.end();
}

}  // namespace

bool IsStop(const product::Mate& mate, const Vec3& axis_W, const Vec3& insertion_W) {
  constexpr double kStopCosine = 0.5;  // A plane along the way in guides.
  return mate.kind == MateKind::kFaceFace && std::abs(axis_W.dot(insertion_W)) > kStopCosine;
}

std::shared_ptr<const haptics::HeldPart> HeldPartMaker::Make(const sequence::SequenceStep& step,
                                                             bool can_join) {
  const OccurrenceId id = step.occurrence;
  const Body& body = model_.bodies[id.index()];
  const PartState& state = parts_[id.index()];
  const dynamics::MassProperties mass = CombineMass(model_, step);
  const bool is_on_table = state.leader.is_valid() && state.placement == Placement::kLoose;
  const bool is_table_group = state.leader.is_valid() && !step.members.empty();
  auto held = std::make_shared<haptics::HeldPart>();
  held->occurrence = id;
  held->body = contact::BodyId(id.index());
  held->shape = body.shape;
  held->mass = mass.mass;
  held->p_BoBcm_B = mass.p_BoBcm_B;
  held->I_BBcm_B = mass.I_BBcm_B;
  held->surface = sequence::SurfaceOf(model_.product->part_of(id).material);
  held->falls_when_dropped = (step.members.empty() || is_table_group) &&
                             step.kind != sequence::SequenceStep::Kind::kPark &&
                             !sequence::IsWithinProduct(step.kind);
  held->starts_in_place = step.kind == sequence::SequenceStep::Kind::kRemove && !is_on_table;
  const bool lies_on_table = is_on_table ? is_table_group
                                         : step.members.empty() && !held->starts_in_place &&
                                               !sequence::IsWithinProduct(step.kind);
  held->X_WB_start = lies_on_table ? CalcPoseAboveTable(step) : state.X_WB;
  held->insertion_W = -step.extraction_W;
  held->straight_end = CalcStraightEnd(step.way, held->p_BoBcm_B);
  held->left_out = ListTogetherBodies(step);
  held->allowances = sequence::ListAllowances(model_.sequence.overlaps, model_.sequence.gives, id);
  AddGives(id, held.get());
  AddMembers(step, held.get());
  AddPresses(step, held.get());
  held->bodies = {held->body};
  for (const haptics::HeldMember& member : held->members) {
    held->bodies.push_back(member.body);
  }
  if (step.kind == sequence::SequenceStep::Kind::kPark) {
    held->X_WB_goal = sequence::GoalOf(step, body.X_WB_goal);
    return held;
  }
  if (body.role == BodyRole::kTool) {
    held->lacks_partners = true;
    AddDrives(step, held.get());
    return held;
  }
  if (is_table_group) {
    held->group = GroupOf(ListTogether(parts_, id));
  }
  AddMates(step, Placement::kPlaced, nullptr, held.get());
  held->lacks_partners = step.kind != sequence::SequenceStep::Kind::kAside && held->mates.empty() &&
                         FindMissingPartner(step).is_valid();
  held->X_WB_goal = held->starts_in_place
                        ? held->X_WB_start
                        : CalcPlace(*held, sequence::GoalOf(step, body.X_WB_goal));
  AddThreads(held.get());
  if (can_join && !sequence::IsWithinProduct(step.kind)) {
    AddTablePlaces(step, held.get());
  }
  return held;
}

void HeldPartMaker::AddTablePlaces(const sequence::SequenceStep& step, haptics::HeldPart* held) {
  constexpr double kRoom =
      0.03;  // [m] from where the target stands still before it is met: a choice
  std::vector<OccurrenceId> taken{step.occurrence};
  taken.insert(taken.end(), step.members.begin(), step.members.end());
  const auto reach_of = [this](const std::vector<OccurrenceId>& ids) {
    double reach = 0;
    for (const OccurrenceId id : ids) {
      reach += model_.bodies[id.index()].shape->box_B().size().norm();
    }
    return reach;
  };
  const haptics::HeldPart in_product = *held;
  for (const TablePlace& place : ListTablePlaces(model_, parts_, step)) {
    auto there = std::make_shared<haptics::HeldPart>(in_product);
    there->mates.clear();
    there->smallest_guide = std::numeric_limits<double>::infinity();
    there->lacks_partners = false;
    there->insertion_W = place.insertion_W;
    there->straight_end = std::numeric_limits<double>::infinity();
    there->X_WB_goal = place.X_WB_goal;
    there->starts_in_place = place.starts_in_place;
    there->target = GroupOf(place.target);
    there->X_WT_target = parts_[place.target.front().index()].X_WB;
    there->target_range = reach_of(taken) + reach_of(place.target) + kRoom;
    std::vector<OccurrenceId> all = place.target;
    all.insert(all.end(), taken.begin(), taken.end());
    std::sort(all.begin() + 1, all.end());
    there->joined = GroupOf(all);
    AddMates(step, Placement::kLoose, &place.target, there.get());
    AddThreads(there.get());
    if (place.starts_in_place && place.target.size() > 1) {
      held->left_behind = there->target;
    }
    held->table_places.push_back(std::move(there));
  }
}

void HeldPartMaker::AddMates(const sequence::SequenceStep& step, Placement placement,
                             const std::vector<OccurrenceId>* target,
                             haptics::HeldPart* held) const {
  for (std::size_t member = 0; member <= step.members.size(); ++member) {
    AddMatesOf(step, member, placement, target, held);
  }
}

void HeldPartMaker::AddThreads(haptics::HeldPart* held) const {
  for (haptics::HeldMate& mate : held->mates) {
    const mates::ThreadJoint* joint = model_.mates[mate.id.index()].thread.get();
    if (joint == nullptr || joint->pitch <= 0) {
      continue;
    }
    mate.thread = MakeHeldThread(*joint);
    const std::optional<double> clamped = FindClampedLength(*held, mate);
    if (clamped && joint->thread != nullptr && joint->tightening.preload > 0) {
      const product::Mate& drawn = model_.product->mates[mate.id.index()];
      mate.thread->stiffness = SoftenByGaskets(*model_.product, drawn.b.occurrence,
                                               fits::CalcJointStiffness(*joint->thread, *clamped),
                                               joint->tightening.preload);
      mate.thread->preload = joint->tightening.preload;
    }
  }
}

spatial::Pose HeldPartMaker::CalcPlace(const haptics::HeldPart& held,
                                       const spatial::Pose& X_WB_wanted) {
  // The place is where the mates say; what they leave free is taken from the drawing (X9).
  std::vector<mates::MateConstraint> constraints;
  for (const haptics::HeldMate& mate : held.mates) {
    constraints.push_back({mate.capture.kind, mate.X_WM, mate.X_BN});
  }
  if (constraints.empty()) {
    return X_WB_wanted;
  }
  const spatial::Pose X_before(X_WB_wanted.q(), X_WB_wanted.p() - kApproach * held.insertion_W);
  return mates::ResolveToward(constraints, X_before, X_WB_wanted).X_WB;
}

void HeldPartMaker::AddDrives(const sequence::SequenceStep& step, haptics::HeldPart* held) const {
  const Body& tool = model_.bodies[step.occurrence.index()];
  if (tool.role != BodyRole::kTool) {
    return;
  }
  // It has no place to go to: one far away, at the same height, which it never reaches.
  constexpr double kFarAway = 100;  // [m]
  held->insertion_W = Vec3::UnitX();
  held->X_WB_goal = {held->X_WB_start.q(), held->X_WB_start.p() + kFarAway * Vec3::UnitX()};
  for (const Body& fastener : model_.bodies) {
    const PartState& state = parts_[fastener.occurrence.index()];
    if (fastener.role != BodyRole::kPart || state.placement != Placement::kPlaced) {
      continue;
    }
    const auto tool_mates = ListToolMates(fastener.drives, tool.drives);
    if (tool_mates.empty()) {
      continue;
    }
    for (const ToolMate& mate : tool_mates) {
      held->mates.push_back(MakeDriveMate(mate, fastener.occurrence, state.X_WB));
    }
    haptics::HeldDrive drive;
    drive.body = contact::BodyId(fastener.occurrence.index());
    drive.X_WB_seat = fastener.X_WB_goal;
    drive.p_WQ = fastener.X_WB_goal * tool_mates.front().fastener.origin_B;
    drive.axis_W = fastener.X_WB_goal.q() * -tool_mates.front().fastener.axis_B;
    drive.travel = FindLead(model_.product->part_of(fastener.occurrence)) / units::kTurn;
    drive.torque = model_.accessories.fastener_torque;
    held->drives.push_back(drive);
  }
}

void HeldPartMaker::AddGives(OccurrenceId id, haptics::HeldPart* held) const {
  for (const sequence::GivingPair& give : model_.sequence.gives) {
    const OccurrenceId partner = give.flexible == id ? give.other : give.flexible;
    if (give.moved == id && give.curve && parts_[partner.index()].placement == Placement::kPlaced) {
      held->gives.push_back({give.curve, std::max(give.width, give.depth)});
    }
  }
}

void HeldPartMaker::AddPresses(const sequence::SequenceStep& step, haptics::HeldPart* held) const {
  if (step.kind != sequence::SequenceStep::Kind::kInsert &&
      step.kind != sequence::SequenceStep::Kind::kRemove) {
    return;
  }
  const auto is_there = [&](OccurrenceId id) {
    return parts_[id.index()].placement == Placement::kPlaced || id == step.occurrence ||
           std::find(step.members.begin(), step.members.end(), id) != step.members.end();
  };
  for (const PressedPair& pair : model_.presses) {
    if (pair.moved == step.occurrence && is_there(pair.support) &&
        std::all_of(pair.parts.begin(), pair.parts.end(), is_there)) {
      held->gives.push_back({pair.curve, pair.compression});
    }
  }
}

void HeldPartMaker::AddMembers(const sequence::SequenceStep& step, haptics::HeldPart* held) const {
  const spatial::Pose X_BW = model_.bodies[step.occurrence.index()].X_WB_goal.Inverse();
  for (const OccurrenceId id : step.members) {
    haptics::HeldMember member;
    member.occurrence = id;
    member.body = contact::BodyId(id.index());
    member.shape = model_.bodies[id.index()].shape;
    member.X_BS = X_BW * model_.bodies[id.index()].X_WB_goal;
    member.left_out = ListTogetherBodies(step);
    member.allowances =
        sequence::ListAllowances(model_.sequence.overlaps, model_.sequence.gives, id);
    held->members.push_back(std::move(member));
  }
}

void HeldPartMaker::AddMatesOf(const sequence::SequenceStep& step, std::size_t member,
                               Placement placement, const std::vector<OccurrenceId>* target,
                               haptics::HeldPart* held) const {
  const OccurrenceId id = member == 0 ? step.occurrence : step.members[member - 1];
  for (const product::MateId mate_id : model_.mates_of[id.index()]) {
    const product::Mate& drawn = model_.product->mates[mate_id.index()];
    const OccurrenceId other = drawn.a.occurrence == id ? drawn.b.occurrence : drawn.a.occurrence;
    const bool is_meant =
        target == nullptr || std::find(target->begin(), target->end(), other) != target->end();
    if (IsMovedBy(step, other) || !is_meant || parts_[other.index()].placement != placement) {
      continue;
    }
    if (std::optional<haptics::HeldMate> entry = MakeHeldMate(step, member, drawn, *held)) {
      if (entry->radius > 0) {
        held->smallest_guide = std::min(held->smallest_guide, 2 * entry->radius);
      }
      held->mates.push_back(*std::move(entry));
    }
  }
}

std::optional<haptics::HeldMate> HeldPartMaker::MakeHeldMate(const sequence::SequenceStep& step,
                                                             std::size_t member,
                                                             const product::Mate& drawn,
                                                             const haptics::HeldPart& held) const {
  const OccurrenceId id = member == 0 ? step.occurrence : step.members[member - 1];
  const spatial::Pose X_BS = member == 0 ? spatial::Pose() : held.members[member - 1].X_BS;
  const ModelMate& compiled = model_.mates[drawn.id.index()];
  const bool is_a = drawn.a.occurrence == id;
  const OccurrenceId other = is_a ? drawn.b.occurrence : drawn.a.occurrence;
  const spatial::Pose& X_WO = parts_[other.index()].X_WB;
  const product::Mate mate =
      TurnToStep(*model_.product, drawn, is_a ? held.insertion_W : Vec3(-held.insertion_W),
                 model_.bodies[other.index()].X_WB_goal.q() * X_WO.q().conjugate());
  const mates::MateConstraint constraint = mates::MakeConstraint(mate, id, X_WO);
  const spatial::Pose& X_WB_drawn = model_.bodies[id.index()].X_WB_goal;
  if (step.kind == sequence::SequenceStep::Kind::kAside &&
      !HoldsAside(constraint, X_WB_drawn, sequence::GoalOf(step, X_WB_drawn))) {
    return std::nullopt;
  }
  haptics::HeldMate entry;
  entry.id = drawn.id;
  entry.X_WM = constraint.X_WM;
  entry.X_BN = X_BS * constraint.X_BN;
  entry.member = member;
  entry.capture = mates::MakeCaptureMate(mate, id);
  entry.radius = mate.hole_radius;
  entry.breadth = mate.breadth;
  entry.has_shaft = !is_a;
  if (mate.kind == MateKind::kPrismatic) {
    entry.shift = (is_a ? -1 : 1) * mates::CalcDrawnShift(*model_.product, mate);
  }
  entry.is_stop = IsStop(mate, constraint.X_WM.q() * Vec3::UnitZ(), held.insertion_W);
  if (mate.kind == MateKind::kFaceFace && !entry.is_stop) {
    entry.capture.reach += step.engage_distance;  // A wall guides from where the way in begins.
  }
  entry.fit = compiled.fit;
  if (mate.fit && product::IsIsoFit(mate.fit->kind)) {
    entry.fit_kind = sequence::ToFitsKind(mate.fit->kind);
  }
  entry.body = contact::BodyId(other.index());
  entry.held_faces = is_a ? compiled.faces_a : compiled.faces_b;
  entry.placed_faces = is_a ? compiled.faces_b : compiled.faces_a;
  if (!step.way.empty()) {
    // On a way that turns, what borders on the faces of a mate may be what is in the way.
    entry.held_faces = WithoutNeighbours(*entry.held_faces);
    entry.placed_faces = WithoutNeighbours(*entry.placed_faces);
  }
  return entry;
}

spatial::Pose HeldPartMaker::CalcPoseAboveTable(const sequence::SequenceStep& step) const {
  // Free bodies are hulls with few corners; the exact shape may reach a little below the table.
  constexpr double kGap = 10e-6;  // [m]
  const spatial::Pose& X_WB = parts_[step.occurrence.index()].X_WB;
  double lowest = std::numeric_limits<double>::infinity();
  const auto add = [&](OccurrenceId id) {
    const spatial::Pose& X_WS = parts_[id.index()].X_WB;
    for (const Vec3& vertex : model_.product->part_of(id).mesh.vertices) {
      lowest = std::min(lowest, (X_WS * vertex).z());
    }
  };
  add(step.occurrence);
  std::for_each(step.members.begin(), step.members.end(), add);
  const double lift = std::max(0.0, model_.table_z + kGap - lowest);
  return {X_WB.q(), X_WB.p() + Vec3(0, 0, lift)};
}

bool HeldPartMaker::IsMeantBefore(OccurrenceId id, OccurrenceId later) const {
  const auto& gaps = model_.sequence.gaps;
  const auto& steps = model_.sequence.steps;
  const bool has_step =
      std::any_of(steps.begin(), steps.end(),
                  [id](const sequence::SequenceStep& step) { return step.occurrence == id; });
  if (!has_step && std::any_of(gaps.begin(), gaps.end(), [id](const sequence::SequenceGap& gap) {
        return gap.occurrence == id;
      })) {
    return true;
  }
  for (const sequence::SequenceStep& step : steps) {
    if (step.occurrence == later && step.kind == sequence::SequenceStep::Kind::kInsert) {
      return false;
    }
    if (step.occurrence == id && step.kind != sequence::SequenceStep::Kind::kPark) {
      return true;
    }
  }
  return false;
}

OccurrenceId HeldPartMaker::FindMissingPartner(const sequence::SequenceStep& step) const {
  OccurrenceId missing;
  const sequence::SequenceStep* aside = sequence::FindAside(model_.sequence, step.occurrence);
  const auto is_held_by = [&](OccurrenceId other) {
    if (aside != nullptr && aside->occurrence == other) {
      return true;  // It comes back.
    }
    if (IsMovedBy(step, other)) {
      return false;
    }
    if (parts_[other.index()].placement == Placement::kPlaced) {
      return true;
    }
    missing = missing.is_valid() || !IsMeantBefore(other, step.occurrence) ? missing : other;
    return false;
  };
  for (std::size_t i = 0; i <= step.members.size(); ++i) {
    const OccurrenceId id = i == 0 ? step.occurrence : step.members[i - 1];
    // Partners of mates come first, so that the one that is missing is one of them if possible.
    for (const product::MateId mate_id : model_.mates_of[id.index()]) {
      const product::Mate& mate = model_.product->mates[mate_id.index()];
      if (is_held_by(mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence)) {
        return {};
      }
    }
    const std::vector<OccurrenceId>& touching = model_.sequence.neighbours[id.index()];
    if (std::any_of(touching.begin(), touching.end(), is_held_by)) {
      return {};
    }
  }
  return missing;
}

}  // namespace hvas::simulation
