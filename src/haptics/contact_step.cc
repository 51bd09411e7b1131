#include "haptics/contact_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "haptics/giving_rows.h"
#include "haptics/motion_check.h"

namespace hvas::haptics {
namespace {

constexpr double kWakeGap = 20e-6;   // [m]; a loose body is woken by what comes so near
constexpr double kRestSpeed = 1e-4;  // [m/s]; slower bodies are at rest
// Parts that move at once, those of groups counted each: a choice. Beyond it the contact of two
// moving bodies is counted twice.
constexpr std::size_t kMaxFreeParts = 128;
constexpr double kDepthNoise = 2e-6;  // [m]: what a depth may be wrong by. A choice.
/** Inertia of a fastener about its axis [kg m^2]: more than real ones have, as the solver needs
 bodies of about the inertia of the hand with its coupling (2e-5 kg m^2). It takes 1 mN m to speed
 it up by 10 rad/s^2. A choice. */
constexpr double kTurnedInertia = 1e-4;
constexpr double kHeldShare = 0.9;  // Of its friction: less does not move a fastener. A choice.
/** Share of a new push on another hand's part, beside that of the tick before, where there are more
 than two hands. With all of it a block between two others goes to and fro from tick to tick, by 4 %
 of the force; with half of it all come to rest (many_hands_test). */
constexpr double kNewShare = 0.5;

/** The first share of what is deeper than allowed already must not become deeper. */
double AllowedDepth(double deepest, const ContactOptions& contact) noexcept {
  return std::max(contact.stop_depth, kDepthNoise - deepest);
}

/** Limits both parts of a velocity, direction kept. */
spatial::Twist Limited(const spatial::Twist& V, double max_speed, double max_turn_rate) noexcept {
  const double speed = V.v.norm();
  const double turn = V.w.norm();
  const double scale =
      std::min({1.0, speed > 0 ? max_speed / speed : 1.0, turn > 0 ? max_turn_rate / turn : 1.0});
  return {scale * V.w, scale * V.v};
}

bool HasBody(std::span<const contact::BodyId> bodies, contact::BodyId id) noexcept {
  return std::find(bodies.begin(), bodies.end(), id) != bodies.end();
}

/** What another hand holds; empty where it holds nothing. */
std::span<const contact::BodyId> ListHeldBy(const HandExchange& other) noexcept {
  return other.is_holding() ? std::span<const contact::BodyId>(other.displayed.part->bodies)
                            : std::span<const contact::BodyId>();
}

/** Whether a loose part moves, as another hand has woken it. */
bool MovesBody(const HandExchange& other, contact::BodyId id) noexcept {
  return std::any_of(other.awake.begin(), other.awake.end(),
                     [id](const FreeBody& body) { return body.id == id; });
}

/** Largest distance of a point of a shape's box from Q [m]. */
double CalcShapeReach(const contact::Shape& shape, const Vec3& p_BQ) noexcept {
  const spatial::Box& box = shape.box_B();
  return (box.centre() - p_BQ).norm() + 0.5 * box.size().norm();
}

}  // namespace

double ContactStep::CalcReach(const HeldPart& part) noexcept {
  const auto reach_of = [&part](const contact::Shape& shape, const spatial::Pose& X_BS) {
    const spatial::Box& box = shape.box_B();
    return (X_BS * box.centre() - part.p_BoBcm_B).norm() + 0.5 * box.size().norm();
  };
  double reach = reach_of(*part.shape, spatial::Pose());
  for (const HeldMember& member : part.members) {
    reach = std::max(reach, reach_of(*member.shape, member.X_BS));
  }
  return reach;
}

void ContactStep::MoveInScene(const HeldPart& part, const spatial::Pose& X_WB) noexcept {
  scene_.SetPose(part.body, X_WB);
  for (const HeldMember& member : part.members) {
    scene_.SetPose(member.body, X_WB * member.X_BS);
  }
}

void ContactStep::Begin(const HeldPart* held, std::span<const HandExchange> others) noexcept {
  held_ = held;
  others_ = others;
  for (const HandExchange& other : others_) {
    OtherPart& part = other_parts_[other.hand];
    const bool has_pushed = part.index != ConstraintSolver::kWorld;
    if (!has_pushed || other.hold != part.hold) {
      part.F_W = {};
    }
    part.index = ConstraintSolver::kWorld;
    part.is_solved_here = false;
  }
  // What was not touched in the last tick has been stopped by its friction.
  for (std::size_t i = turned_count_; i < kMaxTurned; ++i) {
    turned_[i].rate = 0;
  }
  turned_count_ = 0;
  turned_speed_ = 0;
  pressing_count_ = 0;
}

spatial::Wrench ContactStep::CalcPush(std::uint32_t hold) const noexcept {
  spatial::Wrench F_W;
  for (const HandExchange& other : others_) {
    if (other.pushed_hold == hold) {
      F_W.t += other.F_pushed_W.t;
      F_W.f += other.F_pushed_W.f;
    }
  }
  return F_W;
}

void ContactStep::FillExchange(std::size_t to, HandExchange* exchange) const noexcept {
  const OtherPart& part = other_parts_[to];
  exchange->hand = hand_;
  exchange->awake = bodies_.awake();
  exchange->F_pushed_W = part.index == ConstraintSolver::kWorld ? spatial::Wrench() : part.F_W;
  exchange->pushed_hold = part.hold;
  exchange->has_solved_contact = part.is_solved_here;
  exchange->contact = part.mutual;
}

static_assert(contact::kMaxLeftOut == 1 + kMaxHands);

ContactStep::HeldShape ContactStep::MakeHeldShape(const HeldPart& part, std::size_t member,
                                                  const spatial::Pose& X_WB,
                                                  double margin) noexcept {
  HeldShape held;
  held.query.margin = margin;
  held.query.point_budget = effort_.point_budget;
  held.query.bounds_refinement = true;
  held.query.ignored = {ignored_.data(), guide_.CollectIgnored(part, ignored_, member)};
  std::copy(unmet_.begin(), unmet_.end(), held.query.left_out.begin() + 1);
  if (member == 0) {
    held.shape = part.shape.get();
    held.X_WS = X_WB;
    held.query.allowances = part.allowances;
    held.query.left_out[0] = part.left_out;
    held.query.self = part.body;
  } else {
    const HeldMember& other = part.members[member - 1];
    held.shape = other.shape.get();
    held.X_WS = X_WB * other.X_BS;
    held.query.allowances = other.allowances;
    held.query.left_out[0] = other.left_out;
    held.query.self = other.body;
  }
  return held;
}

std::span<const contact::BodyId> ContactStep::ListHeld() const noexcept {
  return held_ != nullptr ? std::span<const contact::BodyId>(held_->bodies)
                          : std::span<const contact::BodyId>();
}

const HandExchange* ContactStep::FindHolder(contact::BodyId id) const noexcept {
  const auto found = std::find_if(others_.begin(), others_.end(), [id](const HandExchange& other) {
    return HasBody(ListHeldBy(other), id);
  });
  return found == others_.end() ? nullptr : &*found;
}

template <typename IsLeft>
void ContactStep::LeaveOut(IsLeft is_left) noexcept {
  unmet_ = {};
  for (const HandExchange& other : others_) {
    if (is_left(other)) {
      unmet_[other.hand] = ListHeldBy(other);
    }
  }
}

bool ContactStep::IsMovedByOther(contact::BodyId id) const noexcept {
  const contact::BodyId leader = bodies_.LeaderOf(id);
  return std::any_of(others_.begin(), others_.end(),
                     [leader](const HandExchange& other) { return MovesBody(other, leader); });
}

bool ContactStep::IsHeldStillByOther(contact::BodyId id) const noexcept {
  return std::any_of(others_.begin(), others_.end(), [id](const HandExchange& other) {
    return other.held_still != nullptr && HasBody(other.held_still->bodies, id);
  });
}

bool ContactStep::IsAtRestAt(const RigidGroup& target, const spatial::Pose& X_WB,
                             std::span<const HandExchange> others) noexcept {
  constexpr double kSamePlace = 1e-6;  // [m], [rad]: parts are put together as exactly. A choice.
  const spatial::Pose& X_now = scene_.pose(target.leader());
  if ((X_now.p() - X_WB.p()).norm() > kSamePlace ||
      spatial::RotationBetween(X_now.q(), X_WB.q()).norm() > kSamePlace) {
    return false;
  }
  const bool is_one = bodies_.group(target.leader()) != nullptr
                          ? bodies_.group(target.leader())->bodies == target.bodies
                          : target.bodies.size() == 1;
  if (!is_one || bodies_.FindAwake(target.leader()) != nullptr) {
    return false;
  }
  return std::none_of(others.begin(), others.end(), [&target](const HandExchange& other) {
    return std::any_of(target.bodies.begin(), target.bodies.end(), [&other](contact::BodyId body) {
      return HasBody(ListHeldBy(other), body) || MovesBody(other, body);
    });
  });
}

double ContactStep::CalcFreeReach(contact::BodyId id) const noexcept {
  const RigidGroup* group = bodies_.group(id);
  if (group == nullptr) {
    return CalcShapeReach(scene_.shape(id), bodies_.properties(id)->p_BoBcm_B);
  }
  double reach = 0;
  for (const RigidGroup::Member& member : group->members) {
    const spatial::Box& box = scene_.shape(member.body).box_B();
    reach = std::max(
        reach, (member.X_BS * box.centre() - group->p_BoBcm_B).norm() + 0.5 * box.size().norm());
  }
  return reach;
}

TouchingBody ContactStep::Touch(const contact::Contact& c, ConstraintSolver* solver) noexcept {
  TouchingBody other;
  other.id = c.body.value();
  if (const HandExchange* holder = FindHolder(c.body)) {
    other.index = other_parts_[holder->hand].index;
    other.X_WB = scene_.pose(c.body);
    return other;
  }
  if (const TurnedFastener* turned = FindTurned(c.body, solver)) {
    other.index = turned->index;
    other.X_WB = scene_.pose(c.body);
    return other;
  }
  if (!bodies_.is_loose(c.body) || IsHeldStillByOther(c.body)) {
    return other;
  }
  const contact::BodyId leader = bodies_.LeaderOf(c.body);
  FreeBody* body = bodies_.FindAwake(leader);
  if (body == nullptr && !IsMovedByOther(c.body) && effort_.wakes_bodies && c.distance < kWakeGap) {
    if (bodies_.Wake(leader, scene_.pose(leader), {})) {
      body = bodies_.FindAwake(leader);
      body->index = solver->AddBody(bodies_.MakeSolverBody(*body, options_.gravity_W, options_.dt));
    } else {
      account_.is_crowded = true;
    }
  }
  if (body != nullptr) {
    other.index = body->index;
    other.X_WB = leader == c.body ? body->X_WB : scene_.pose(c.body);
  }
  return other;
}

const TurnedFastener* ContactStep::FindTurned(contact::BodyId id,
                                              ConstraintSolver* solver) noexcept {
  if (held_ == nullptr || held_->drives.empty()) {
    return nullptr;
  }
  for (std::size_t i = 0; i < turned_count_; ++i) {
    if (turned_[i].drive->body == id) {
      return &turned_[i];
    }
  }
  const auto drive = std::find_if(held_->drives.begin(), held_->drives.end(),
                                  [id](const HeldDrive& one) { return one.body == id; });
  if (drive == held_->drives.end()) {
    return nullptr;
  }
  if (turned_count_ == kMaxTurned) {
    account_.is_crowded = true;
    return nullptr;
  }
  Vec6 axis;
  axis << drive->axis_W, drive->travel * drive->axis_W;
  Vec6 turn;
  turn << drive->axis_W, Vec3::Zero();
  const auto before =
      std::find_if(turned_.begin() + static_cast<std::ptrdiff_t>(turned_count_), turned_.end(),
                   [&drive](const TurnedFastener& one) { return one.drive == &*drive; });
  const double rate = before == turned_.end() ? 0.0 : before->rate;
  TurnedFastener& turned = turned_[turned_count_++];
  if (before != turned_.end()) {
    *before = turned;
  }
  turned.drive = &*drive;
  turned.rate = rate;
  turned.index =
      solver->AddBody(drive->p_WQ, rate * axis, axis * axis.transpose() / kTurnedInertia);
  (void)solver->AddBoundedRow(turn, {-drive->torque, drive->torque}, turned.index);
  return &turned;
}

void ContactStep::MoveTurned(const ConstraintSolver& solver) noexcept {
  for (TurnedFastener& turned : std::span(turned_.data(), turned_count_)) {
    const HeldDrive& drive = *turned.drive;
    double force = 0;  // Of the contacts, along the thread [N m].
    for (std::size_t i = 0; i < static_cast<std::size_t>(held_contacts_); ++i) {
      if (contacts_[i].body == drive.body) {
        const Vec3 f = -solver.contact_force(static_cast<int>(i));
        force += ((contacts_[i].p_WC - drive.p_WQ).cross(f) + drive.travel * f).dot(drive.axis_W);
      }
    }
    // What the solver has not resolved yet would let it creep.
    const bool is_held = std::abs(force) < kHeldShare * drive.torque;
    turned.rate = is_held ? 0.0 : solver.velocity(turned.index).w.dot(drive.axis_W);
    const spatial::Pose& X_WB = scene_.pose(drive.body);
    const double travel = (X_WB.p() - drive.X_WB_seat.p()).dot(drive.axis_W);
    const double step = std::max(options_.dt * turned.rate * drive.travel, -std::max(travel, 0.0));
    const Quat q = spatial::RotationFromVector(options_.dt * turned.rate * drive.axis_W);
    const double reach = CalcShapeReach(scene_.shape(drive.body), X_WB.Inverse() * drive.p_WQ);
    turned_speed_ = std::max(turned_speed_, std::abs(turned.rate) * (reach + drive.travel));
    scene_.SetPose(drive.body, {(q * X_WB.q()).normalized(),
                                drive.p_WQ + q * (X_WB.p() - drive.p_WQ) + step * drive.axis_W});
  }
}

/** @returns false where there is no room for it. */
bool ContactStep::AddContact(const TouchingBody& body, const TouchingBody& other,
                             const fits::FrictionLaw& law, double compliance, double rolling_arm,
                             const contact::Contact& c, ConstraintSolver* solver) noexcept {
  const ContactOptions& options = options_.contact;
  const double settling = options_.dt + options.settling_time;
  const auto index = static_cast<std::size_t>(solver->contact_count());
  ConstraintSolver::Contact contact;
  contact.patch = friction_.AddPair(body, other, law, rolling_arm, solver);
  // A spring with a dashpot: F = (-phi - settling_time phi') / c. A blow sinks in no deeper than
  // a lasting load.
  const double time = c.distance > 0 ? options_.dt : settling;
  contact.velocity_bias = -std::max(c.distance, -options.max_depth) / time;
  contact.compliance = compliance * options_.dt / settling;
  contact.recovery_speed = options.recovery_speed;
  if (contact.patch < 0 || !friction_.AddContact(c, contact, solver)) {
    account_.is_truncated = true;
    return false;
  }
  contacts_[index] = c;
  return true;
}

/** Contacts of shafts with play in their holes. Each mate has friction of its own, that of its fit.
 */
void ContactStep::AddBores(const DisplayedPart& displayed, double margin,
                           ConstraintSolver* solver) noexcept {
  constexpr std::uint32_t kFirstBore = 0x80000000U;  // Ids beyond those of bodies.
  // Stiffness along a surface as a share of that into it, 2 (1 - nu) / (2 - nu) with nu = 0.3:
  // Mindlin, J. Appl. Mech. 16, 1949.
  constexpr double kTangentialShare = 0.82;
  account_.is_truncated = account_.is_truncated || guide_.has_guided_bores();
  const HeldPart& part = *displayed.part;
  const std::size_t count = std::min(part.mates.size(), MateGuide::kMaxMates);
  for (std::size_t i = 0; i < count; ++i) {
    if (!guide_.is_bore(i)) {
      continue;
    }
    const HeldMate& mate = part.mates[i];
    const fits::FitFriction& friction = mate.fit->friction();
    fits::FrictionLaw law{friction.release, friction.slip};
    // Of two contacts, which bear a tilted shaft together.
    law.stiffness = 2 * kTangentialShare / options_.contact.compliance;
    TouchingBody bore;
    bore.id = kFirstBore + static_cast<std::uint32_t>(i);
    BoreContacts found;
    const std::size_t found_count = guide_.CalcContacts(mate, i, displayed.X_WD, margin, &found);
    for (const BoreContact& one : std::span(found.data(), found_count)) {
      contact::Contact c;
      c.body = mate.body;
      c.p_WC = one.p_WC;
      c.nhat_W = one.nhat_W;
      c.distance = one.distance;
      account_.deepest = std::min(account_.deepest, c.distance);
      if (!AddContact({0, part.body.value(), displayed.X_WD}, bore, law,
                      options_.contact.compliance, 0, c, solver)) {
        return;
      }
    }
  }
}

/** @param queried  The body whose shape was queried: `body`, or a member of what is held. */
void ContactStep::AddQueried(const TouchingBody& body, contact::BodyId queried,
                             fits::FrictionSurface surface, double rolling_arm,
                             ConstraintSolver* solver) noexcept {
  const ContactOptions& options = options_.contact;
  account_.is_truncated = account_.is_truncated || workspace_.stats().is_truncated;
  account_.points_tested += workspace_.stats().points_tested;
  for (const contact::Contact& c : workspace_.contacts()) {
    if (body.index == 0 && IsMovedByOther(c.body)) {
      continue;  // its hand's step has this part as a body
    }
    const TouchingBody other = Touch(c, solver);
    const BodyProperties* properties = bodies_.properties(c.body);
    fits::FrictionLaw law = fits::FindFriction(
        surface, properties != nullptr ? properties->surface : fits::FrictionSurface::kUnknown,
        options.friction);
    const ContactPairResponse* stated = pairs_.Find(queried, c.body);
    if (stated != nullptr && stated->friction) {
      law.static_coefficient = law.kinetic_coefficient = *stated->friction;
    }
    const double compliance =
        stated != nullptr ? stated->compliance.value_or(options.compliance) : options.compliance;
    if (!AddContact(body, other, law, compliance, rolling_arm, c, solver)) {
      break;
    }
  }
}

void ContactStep::AddHeldContacts(const DisplayedPart& displayed,
                                  ConstraintSolver* solver) noexcept {
  if (options_.condition == Condition::kConstraint) {
    return;
  }
  LeaveOut([](const HandExchange& other) { return other.has_solved_contact; });
  const HeldPart& part = *displayed.part;
  account_.is_truncated =
      account_.is_truncated || part.gives.size() > GivingRows::kMaxCurves;  // Some do not resist.
  const ContactOptions& contact = options_.contact;
  const spatial::Twist V = solver->SolveUnconstrained();
  const double speed = std::min(contact.max_speed, V.v.norm()) +
                       std::min(contact.max_turn_rate, V.w.norm()) * displayed.reach;
  const double margin = contact.min_margin + 1.5 * (speed + CalcOtherSpeed()) * options_.dt;
  clearance_ = margin;
  const spatial::Pose X_WD_ahead =
      MoveAbout(displayed.X_WD, part.p_BoBcm_B, displayed.V, options_.dt);
  for (std::size_t member = 0; member <= part.members.size(); ++member) {
    HeldShape held = MakeHeldShape(part, member, displayed.X_WD, margin);
    held.query.broken_edges = {contact.edge_break,
                               X_WD_ahead * (displayed.X_WD.Inverse() * held.X_WS)};
    scene_.Query(*held.shape, held.X_WS, held.query, &workspace_);
    account_.deepest = std::min(account_.deepest, workspace_.deepest());
    AddQueried({0, part.body.value(), displayed.X_WD},
               member == 0 ? part.body : part.members[member - 1].body, part.surface, 0, solver);
  }
  clearance_ = std::min(margin, account_.deepest);
  AddBores(displayed, margin, solver);
  held_contacts_ = solver->contact_count();
  unmet_ = {};
}

void ContactStep::AddOtherParts(ConstraintSolver* solver) noexcept {
  for (const HandExchange& other : others_) {
    if (!other.is_holding()) {
      continue;
    }
    OtherPart& part = other_parts_[other.hand];
    // But for what this hand pushes it with, it goes on as in its own last step.
    const HeldResponse& response = other.response;
    Vec6 impulse;
    impulse << options_.dt * part.F_W.t, options_.dt * part.F_W.f;
    part.V << response.V.w, response.V.v;
    part.V += response.inverse * (response.gain - impulse);
    part.hold = other.hold;
    part.index = solver->AddBody(other.displayed.p_WCm(), part.V, response.inverse);
  }
}

double ContactStep::CalcOtherSpeed() const noexcept {
  double speed = 0;
  for (const HandExchange& other : others_) {
    const OtherPart& part = other_parts_[other.hand];
    if (part.index != ConstraintSolver::kWorld) {
      speed = std::max(speed,
                       part.V.tail<3>().norm() + part.V.head<3>().norm() * other.displayed.reach);
    }
  }
  return speed;
}

void ContactStep::PushOtherParts(const ConstraintSolver& solver) noexcept {
  for (const HandExchange& other : others_) {
    OtherPart& part = other_parts_[other.hand];
    if (part.index == ConstraintSolver::kWorld) {
      continue;
    }
    const spatial::Twist V = solver.velocity(part.index);
    Vec6 change;
    change << V.w, V.v;
    change -= part.V;
    const Vec6 F = other.response.matrix * change / options_.dt;
    const double share = others_.size() > 1 ? kNewShare : 1.0;
    part.F_W = {part.F_W.t + share * (F.head<3>() - part.F_W.t),
                part.F_W.f + share * (F.tail<3>() - part.F_W.f)};
    // Where it will be at the end of the step: what pushes it does not stop at where it was.
    const DisplayedPart& displayed = other.displayed;
    MoveInScene(*displayed.part,
                MoveAbout(displayed.X_WD, displayed.part->p_BoBcm_B, V, options_.dt));
  }
}

void ContactStep::AddBodies(ConstraintSolver* solver) noexcept {
  friction_.BeginTick();
  AddOtherParts(solver);
  for (FreeBody& body : bodies_.awake()) {
    body.index = solver->AddBody(bodies_.MakeSolverBody(body, options_.gravity_W, options_.dt));
  }
}

void ContactStep::AddFreeContacts(ConstraintSolver* solver) noexcept {
  const ContactOptions& options = options_.contact;
  std::array<contact::BodyId, kMaxFreeParts> done;
  std::size_t done_count = 0;
  const auto add_done = [&](contact::BodyId part) {
    if (done_count < done.size()) {
      done[done_count++] = part;
    } else {
      account_.is_truncated = true;
    }
  };
  // Those that are woken on the way come at the end of the list.
  for (std::size_t i = 0; i < bodies_.awake().size(); ++i) {
    const FreeBody body = bodies_.awake()[i];
    const std::span<const contact::BodyId> together = bodies_.ListTogether(body.id);
    std::for_each(together.begin(), together.end(), add_done);
    const spatial::Pose X_WB_ahead = bodies_.Move(body, body.V, options_.dt);
    const double speed = body.V.v.norm() + body.V.w.norm() * CalcFreeReach(body.id);
    contact::QueryOptions query;
    query.margin =
        options.min_margin +
        1.5 * options_.dt * (speed + CalcOtherSpeed() + options_.dt * options_.gravity_W.norm());
    query.left_out = {std::span<const contact::BodyId>(done.data(), done_count), ListHeld()};
    query.point_budget = effort_.point_budget;
    query.bounds_refinement = true;
    double clearance = query.margin;
    for (std::size_t k = 0; k < bodies_.CountParts(body.id); ++k) {
      const contact::BodyId part = bodies_.PartOf(body.id, k);
      const spatial::Pose X_WS = bodies_.PoseOfPart(body.id, k, body.X_WB);
      query.self = part;
      query.broken_edges = {options.edge_break, bodies_.PoseOfPart(body.id, k, X_WB_ahead)};
      scene_.Query(scene_.shape(part), X_WS, query, &workspace_);
      clearance = std::min(clearance, workspace_.deepest());
      AddQueried({body.index, part.value(), X_WS}, part, bodies_.properties(part)->surface,
                 options.rolling_arm, solver);
    }
    bodies_.awake()[i].clearance = clearance;
    if (together.empty()) {
      add_done(body.id);
    }
  }
}

bool ContactStep::IsFreeBodyAt(const FreeBody& body, const spatial::Pose& X_WB,
                               double tolerance) noexcept {
  contact::QueryOptions query;
  query.left_out = {ListHeld(), bodies_.ListTogether(body.id)};
  for (std::size_t k = 0; k < bodies_.CountParts(body.id); ++k) {
    query.self = bodies_.PartOf(body.id, k);
    if (!scene_.IsFree(scene_.shape(query.self), bodies_.PoseOfPart(body.id, k, X_WB), tolerance,
                       query, &workspace_)) {
      return false;
    }
  }
  return true;
}

void ContactStep::MoveFreeBodies(const ConstraintSolver& solver) noexcept {
  const ContactOptions& options = options_.contact;
  for (FreeBody& body : bodies_.awake()) {
    const double reach = CalcFreeReach(body.id);
    body.V = Limited(solver.velocity(body.index), options.max_free_speed,
                     options.max_free_speed / reach);
    const double travel = options_.dt * (body.V.v.norm() + body.V.w.norm() * reach);
    const double tolerance = AllowedDepth(body.clearance, options);
    const auto at = [&](double share) { return bodies_.Move(body, body.V, share * options_.dt); };
    const double share = FindFreeShare(body.clearance + tolerance, travel, [&](double candidate) {
      return IsFreeBodyAt(body, at(candidate), tolerance);
    });
    body.X_WB = at(share);
    body.V = {share * body.V.w, share * body.V.v};
    body.time_at_rest = travel < kRestSpeed * options_.dt ? body.time_at_rest + options_.dt : 0;
    for (std::size_t k = 0; k < bodies_.CountParts(body.id); ++k) {
      scene_.SetPose(bodies_.PartOf(body.id, k), bodies_.PoseOfPart(body.id, k, body.X_WB));
    }
  }
  bodies_.Sleep(options.rest_time);
}

void ContactStep::Finish(const ConstraintSolver& solver) noexcept {
  RecordContacts(solver);
  friction_.EndTick(solver, options_.dt);
  PushOtherParts(solver);
  MoveTurned(solver);
  MoveFreeBodies(solver);
}

void ContactStep::StepFreeBodies(ConstraintSolver* solver) noexcept {
  if (bodies_.awake().empty()) {
    return;
  }
  solver->BeginFree(options_.dt);
  AddBodies(solver);
  AddFreeContacts(solver);
  (void)solver->Solve(effort_.iterations);
  PushOtherParts(*solver);
  MoveFreeBodies(*solver);
  friction_.EndTick(*solver, options_.dt);
}

void ContactStep::MoveDisplayed(const spatial::Twist& V_Cm, DisplayedPart* displayed) noexcept {
  const ContactOptions& options = options_.contact;
  const HeldPart& part = *displayed->part;
  const spatial::Pose X_WD = displayed->X_WD;
  const spatial::Twist V = Limited(V_Cm, options.max_speed, options.max_turn_rate);
  double share = 1;
  const auto at = [&](double candidate) {
    return MoveAbout(X_WD, part.p_BoBcm_B, V, candidate * options_.dt);
  };
  // To stop where it meets another hand's part would not keep that one from coming on.
  LeaveOut([this](const HandExchange& other) {
    return other.has_solved_contact ||
           (other_parts_[other.hand].is_solved_here && other.response.yields);
  });
  if (options_.condition != Condition::kConstraint) {
    // Free bodies have moved already; those near have come nearer.
    const double speed = V.v.norm() + V.w.norm() * displayed->reach;
    double others = turned_speed_;
    for (const FreeBody& body : bodies_.awake()) {
      others = std::max(others, body.V.v.norm());
    }
    const double tolerance = AllowedDepth(clearance_, options);
    share = FindFreeShare(clearance_ + tolerance - options_.dt * others, options_.dt * speed,
                          [&](double s) { return IsFreeAt(part, at(s), tolerance); });
  }
  unmet_ = {};
  displayed->X_WD = at(share);
  displayed->V = {share * V.w, share * V.v};
}

bool ContactStep::IsFreeAt(const HeldPart& part, const spatial::Pose& X_WB,
                           double tolerance) noexcept {
  for (std::size_t member = 0; member <= part.members.size(); ++member) {
    const HeldShape held = MakeHeldShape(part, member, X_WB, 0);
    const bool is_free = scene_.IsFree(*held.shape, held.X_WS, tolerance, held.query, &workspace_);
    account_.points_tested += workspace_.stats().points_tested;
    if (!is_free) {
      return false;
    }
  }
  return true;
}

void ContactStep::MeasureDepth(const DisplayedPart& displayed) noexcept {
  const HeldPart& part = *displayed.part;
  for (std::size_t member = 0; member <= part.members.size(); ++member) {
    const HeldShape held = MakeHeldShape(part, member, displayed.X_WD, 0);
    scene_.Query(*held.shape, held.X_WS, held.query, &workspace_);
    account_.points_tested += workspace_.stats().points_tested;
    account_.deepest = std::min(account_.deepest, workspace_.deepest());
  }
}

void ContactStep::RecordContacts(const ConstraintSolver& solver) noexcept {
  double hardest = 0;
  for (const HandExchange& other : others_) {
    OtherPart& part = other_parts_[other.hand];
    part.mutual = {};
    part.is_solved_here = hand_ < other.hand && part.index != ConstraintSolver::kWorld;
    if (!other.has_solved_contact) {
      continue;
    }
    const MutualContact& mutual = other.contact;
    const double force = mutual.f_C_W.norm();
    account_.contact_count += mutual.contact_count;
    account_.deepest = std::min(account_.deepest, mutual.deepest);
    if (force >= hardest) {
      hardest = force;
      account_.p_WC = mutual.p_WC;
      account_.f_C_W = -mutual.f_C_W;
      account_.contact_body = mutual.body;
    }
  }
  for (int i = 0; i < held_contacts_; ++i) {
    const contact::Contact& c = contacts_[static_cast<std::size_t>(i)];
    const double force = solver.normal_force(i);
    const HandExchange* holder = FindHolder(c.body);
    if (holder != nullptr && other_parts_[holder->hand].is_solved_here) {
      RecordMutual(c, solver.contact_force(i), &other_parts_[holder->hand].mutual);
    }
    if (force <= 1e-6) {
      continue;
    }
    ++account_.contact_count;
    pressing_[pressing_count_++] = {c.p_WC, solver.contact_force(i), c.distance, c.body};
    if (force > hardest) {
      hardest = force;
      account_.p_WC = c.p_WC;
      account_.f_C_W = solver.contact_force(i);
      account_.contact_body = c.body;
    }
  }
}

void ContactStep::RecordMutual(const contact::Contact& c, const Vec3& f_C_W,
                               MutualContact* mutual) noexcept {
  mutual->body = held_->body;
  mutual->deepest = std::min(mutual->deepest, c.distance);
  if (f_C_W.norm() <= 1e-6) {
    return;
  }
  ++mutual->contact_count;
  if (f_C_W.norm() > mutual->f_C_W.norm()) {
    mutual->p_WC = c.p_WC;
    mutual->f_C_W = f_C_W;
  }
}

}  // namespace hvas::haptics
