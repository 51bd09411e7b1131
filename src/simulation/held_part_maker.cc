#include "simulation/held_part_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fits/paper_scales.h"
#include "mates/capture.h"
#include "mates/resolve.h"
#include "simulation/fit_of_mate.h"

namespace hvas::simulation {
namespace {

using product::MateKind;
using product::OccurrenceId;

constexpr double kApproach = 0.01;   // [m] before its place, where a part's mates are resolved from
constexpr double kStopCosine = 0.5;  // a plane facing the way in ends it; one along it guides

double PaperFactorOf(const product::Mate& mate) {
  if (!mate.fit || mate.fit->kind == product::FitKind::kThread) {
    return 1;
  }
  switch (mate.fit->kind) {
    case product::FitKind::kInterference:
      return fits::FindPaperScale(fits::FitKind::kInterference).factor;
    case product::FitKind::kTransition:
      return fits::FindPaperScale(fits::FitKind::kTransition).factor;
    default:
      return fits::FindPaperScale(fits::FitKind::kClearance).factor;
  }
}

}  // namespace

std::shared_ptr<const haptics::HeldPart> HeldPartMaker::Make(const SequenceStep& step) const {
  const OccurrenceId id = step.occurrence;
  const Body& body = model_.bodies[id.index()];
  const dynamics::MassProperties mass = CombineMass(model_, step);
  auto held = std::make_shared<haptics::HeldPart>();
  held->occurrence = id;
  held->body = contact::BodyId(id.index());
  held->shape = body.shape;
  held->mass = mass.mass;
  held->p_BoBcm_B = mass.p_BoBcm_B;
  held->I_BBcm_B = mass.I_BBcm_B;
  held->surface = SurfaceOf(model_.product->part_of(id).material);
  held->falls_when_dropped = step.members.empty() && step.kind != SequenceStep::Kind::kPark;
  held->starts_in_place = step.kind == SequenceStep::Kind::kRemove;
  const bool lies_on_table = step.members.empty() && !held->starts_in_place;
  held->X_WB_start = lies_on_table ? CalcPoseAboveTable(id) : parts_[id.index()].X_WB;
  held->insertion_W = -step.extraction_W;
  held->left_out = ListLeftOut(id, step);
  AddMembers(step, held.get());
  held->bodies = {held->body};
  for (const haptics::HeldMember& member : held->members) {
    held->bodies.push_back(member.body);
  }
  if (step.kind == SequenceStep::Kind::kPark) {
    held->X_WB_goal = {body.X_WB_goal.q(), body.X_WB_goal.p() + step.offset_W};
    return held;
  }
  for (std::size_t member = 0; member <= step.members.size(); ++member) {
    AddMates(step, member, held.get());
  }
  held->lacks_partners = held->mates.empty() && FindMissingPartner(step).is_valid();
  if (held->starts_in_place) {
    held->X_WB_goal = held->X_WB_start;
    return held;
  }
  held->X_WB_goal = CalcPlace(*held);
  return held;
}

spatial::Pose HeldPartMaker::CalcPlace(const haptics::HeldPart& held) const {
  // The place is where the mates say; what they leave free is taken from the drawing (X9).
  const spatial::Pose& X_WB_drawn = model_.bodies[held.occurrence.index()].X_WB_goal;
  std::vector<mates::MateConstraint> constraints;
  for (const haptics::HeldMate& mate : held.mates) {
    constraints.push_back({mate.capture.kind, mate.X_WM, mate.X_BN});
  }
  if (constraints.empty()) {
    return X_WB_drawn;
  }
  const spatial::Pose X_before(X_WB_drawn.q(), X_WB_drawn.p() - kApproach * held.insertion_W);
  return mates::ResolveToward(constraints, X_before, X_WB_drawn).X_WB;
}

void HeldPartMaker::AddMembers(const SequenceStep& step, haptics::HeldPart* held) const {
  const spatial::Pose X_BW = model_.bodies[step.occurrence.index()].X_WB_goal.Inverse();
  for (const OccurrenceId id : step.members) {
    haptics::HeldMember member;
    member.occurrence = id;
    member.body = contact::BodyId(id.index());
    member.shape = model_.bodies[id.index()].shape;
    member.X_BS = X_BW * model_.bodies[id.index()].X_WB_goal;
    member.left_out = ListLeftOut(id, step);
    held->members.push_back(std::move(member));
  }
}

void HeldPartMaker::AddMates(const SequenceStep& step, std::size_t member,
                             haptics::HeldPart* held) const {
  const OccurrenceId id = member == 0 ? step.occurrence : step.members[member - 1];
  const spatial::Pose X_BS = member == 0 ? spatial::Pose() : held->members[member - 1].X_BS;
  for (const product::MateId mate_id : model_.mates_of[id.index()]) {
    const product::Mate& mate = model_.product->mates[mate_id.index()];
    const ModelMate& compiled = model_.mates[mate_id.index()];
    const bool is_a = mate.a.occurrence == id;
    const OccurrenceId other = is_a ? mate.b.occurrence : mate.a.occurrence;
    const bool is_own =
        other == step.occurrence ||
        std::find(step.members.begin(), step.members.end(), other) != step.members.end();
    if (is_own || parts_[other.index()].placement != Placement::kPlaced) {
      continue;
    }
    const mates::MateConstraint constraint =
        mates::MakeConstraint(mate, id, parts_[other.index()].X_WB);
    haptics::HeldMate entry;
    entry.id = mate_id;
    entry.X_WM = constraint.X_WM;
    entry.X_BN = X_BS * constraint.X_BN;
    entry.member = member;
    entry.capture = mates::MakeCaptureMate(mate, id);
    entry.radius = mate.hole_radius;
    const double facing = std::abs((constraint.X_WM.q() * Vec3::UnitZ()).dot(held->insertion_W));
    entry.is_stop = mate.kind == MateKind::kFaceFace && facing > kStopCosine;
    entry.fit = compiled.fit;
    entry.paper_factor = PaperFactorOf(mate);
    entry.body = contact::BodyId(other.index());
    entry.held_faces = is_a ? compiled.faces_a : compiled.faces_b;
    entry.placed_faces = is_a ? compiled.faces_b : compiled.faces_a;
    held->mates.push_back(std::move(entry));
  }
}

std::vector<contact::BodyId> HeldPartMaker::ListLeftOut(OccurrenceId id,
                                                        const SequenceStep& step) const {
  std::vector<contact::BodyId> bodies;
  for (const DrawnOverlap& overlap : model_.sequence.overlaps) {
    if (overlap.a == id || overlap.b == id) {
      bodies.emplace_back((overlap.a == id ? overlap.b : overlap.a).index());
    }
  }
  if (!step.members.empty()) {
    bodies.emplace_back(step.occurrence.index());
    for (const OccurrenceId member : step.members) {
      bodies.emplace_back(member.index());
    }
  }
  return bodies;
}

spatial::Pose HeldPartMaker::CalcPoseAboveTable(OccurrenceId id) const {
  // Free bodies are hulls with few corners; the exact shape may reach a little below the table.
  constexpr double kGap = 10e-6;  // [m]
  const spatial::Pose& X_WB = parts_[id.index()].X_WB;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : model_.product->part_of(id).mesh.vertices) {
    lowest = std::min(lowest, (X_WB * vertex).z());
  }
  const double lift = std::max(0.0, model_.table_z + kGap - lowest);
  return {X_WB.q(), X_WB.p() + Vec3(0, 0, lift)};
}

OccurrenceId HeldPartMaker::FindMissingPartner(const SequenceStep& step) const {
  const auto& steps = model_.sequence.steps;
  const auto is_before = [&](OccurrenceId id) {
    for (const SequenceStep& other : steps) {
      if (other.occurrence == step.occurrence && other.kind == SequenceStep::Kind::kInsert) {
        return false;
      }
      if (other.occurrence == id && other.kind != SequenceStep::Kind::kPark) {
        return true;
      }
    }
    return false;
  };
  const auto is_own = [&step](OccurrenceId id) {
    return id == step.occurrence ||
           std::find(step.members.begin(), step.members.end(), id) != step.members.end();
  };
  OccurrenceId missing;
  for (std::size_t i = 0; i <= step.members.size(); ++i) {
    const OccurrenceId id = i == 0 ? step.occurrence : step.members[i - 1];
    for (const product::MateId mate_id : model_.mates_of[id.index()]) {
      const product::Mate& mate = model_.product->mates[mate_id.index()];
      const OccurrenceId other = mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
      if (is_own(other) || !is_before(other)) {
        continue;
      }
      if (parts_[other.index()].placement == Placement::kPlaced) {
        return {};
      }
      missing = missing.is_valid() ? missing : other;
    }
  }
  return missing;
}

}  // namespace hvas::simulation
