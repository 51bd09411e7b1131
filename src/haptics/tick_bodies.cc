// The part of HapticTick that deals with contacts: of the held part, and of bodies that move
// freely.

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/haptic_tick.h"
#include "haptics/motion_check.h"

namespace hvas::haptics {
namespace {

constexpr double kWakeGap = 20e-6;    // [m]; a loose body is woken by what comes so near
constexpr double kRestSpeed = 1e-4;   // [m/s]; slower bodies are at rest
constexpr double kDepthNoise = 2e-6;  // [m]: what a depth may be wrong by. A choice.

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

double CalcReach(const contact::Shape& shape, const Vec3& p_BQ) noexcept {
  const spatial::Box& box = shape.box_B();
  return (box.centre() - p_BQ).norm() + 0.5 * box.size().norm();
}

}  // namespace

TouchingBody HapticTick::Touch(const contact::Contact& c) noexcept {
  TouchingBody other;
  other.id = c.body.value();
  if (other_ != nullptr && other_->Holds(c.body)) {
    other.index = guest_;
    other.X_WB = scene_->pose(c.body);
    return other;
  }
  if (!bodies_.is_loose(c.body)) {
    return other;
  }
  FreeBody* body = bodies_.FindAwake(c.body);
  if (body == nullptr && FindAwakeElsewhere(c.body) == nullptr && effort_.wakes_bodies &&
      c.distance < kWakeGap && bodies_.Wake(c.body, scene_->pose(c.body), {})) {
    body = bodies_.FindAwake(c.body);
    body->index = solver_.AddBody(bodies_.MakeSolverBody(*body, options_.gravity_W, options_.dt));
  }
  if (body != nullptr) {
    other.index = body->index;
    other.X_WB = body->X_WB;
  }
  return other;
}

void HapticTick::AddQueried(const TouchingBody& body, fits::FrictionSurface surface,
                            double rolling_arm, TickOutput* out) noexcept {
  const ContactOptions& options = options_.contact;
  const double settling = options_.dt + options.settling_time;
  out->is_truncated = out->is_truncated || workspace_.stats().is_truncated;
  points_tested_ += workspace_.stats().points_tested;
  for (const contact::Contact& c : workspace_.contacts()) {
    if (body.index == 0 && FindAwakeElsewhere(c.body) != nullptr) {
      continue;  // its hand's step has this part as a guest
    }
    const auto index = static_cast<std::size_t>(solver_.contact_count());
    const TouchingBody other = Touch(c);
    const BodyProperties* properties = bodies_.properties(c.body);
    const fits::FrictionLaw law = fits::FindFriction(
        surface, properties != nullptr ? properties->surface : fits::FrictionSurface::kUnknown,
        options.friction);
    ConstraintSolver::Contact contact;
    contact.patch = friction_.AddPair(body, other, law, rolling_arm, &solver_);
    // A spring with a dashpot: F = (-phi - settling_time phi') / c. A blow sinks in no deeper than
    // a lasting load.
    const double time = c.distance > 0 ? options_.dt : settling;
    contact.velocity_bias = -std::max(c.distance, -options.max_depth) / time;
    contact.compliance = options.compliance * options_.dt / settling;
    contact.recovery_speed = options.recovery_speed;
    if (contact.patch < 0 || !friction_.AddContact(c, contact, &solver_)) {
      out->is_truncated = true;
      break;
    }
    contacts_[index] = c;
  }
}

void HapticTick::AddContacts(TickOutput* out) noexcept {
  if (options_.condition == Condition::kConstraint) {
    return;
  }
  const ContactOptions& contact = options_.contact;
  const spatial::Twist V = solver_.SolveUnconstrained();
  const double speed = std::min(contact.max_speed, V.v.norm()) +
                       std::min(contact.max_turn_rate, V.w.norm()) * reach_;
  const double margin = contact.min_margin + 1.5 * (speed + GuestSpeed()) * options_.dt;
  clearance_ = margin;
  const spatial::Pose X_WD_ahead = MoveAbout(X_WD_, part_->p_BoBcm_B, V_D_, options_.dt);
  for (std::size_t member = 0; member < shape_count(); ++member) {
    HeldShape held = MakeHeldShape(member, X_WD_, margin);
    held.query.broken_edges = {contact.edge_break, X_WD_ahead * (X_WD_.Inverse() * held.X_WS)};
    scene_->Query(*held.shape, held.X_WS, held.query, &workspace_);
    out->deepest = std::min(out->deepest, workspace_.deepest());
    AddQueried({0, part_->body.value(), X_WD_}, part_->surface, 0, out);
  }
  clearance_ = std::min(margin, out->deepest);
  held_contacts_ = solver_.contact_count();
}

void HapticTick::ShowOther(bool is_shown) noexcept {
  if (other_ != nullptr && other_->part_ != nullptr) {
    other_->ShowInScene(is_shown);
  }
}

void HapticTick::AddGuest() noexcept {
  if (other_ == nullptr || other_->part_ == nullptr) {
    return;
  }
  // But for what this hand pushes it with, it goes on as in its own last step.
  const Answer& answer = other_->answer_;
  Vec6 impulse;
  impulse << options_.dt * other_->F_pushed_.t, options_.dt * other_->F_pushed_.f;
  V_guest_ << answer.V.w, answer.V.v;
  V_guest_ += answer.inverse * (answer.gain - impulse);
  const Vec3 p_WCm = other_->X_WD_ * other_->part_->p_BoBcm_B;
  guest_ = solver_.AddBody(p_WCm, V_guest_, answer.inverse);
}

void HapticTick::RecordAnswer(const Mat3& I_W, double mass,
                              const spatial::Twist& V_before) noexcept {
  answer_ = {true, V_D_, Vec6::Zero(), solver_.matrix(), solver_.inverse()};
  Vec6 gain;
  gain << I_W * (V_D_.w - V_before.w), mass * (V_D_.v - V_before.v);
  // What springs and pushes gave goes on; what contacts and fits bear, they will bear again, and
  // what they stopped is stopped.
  const Vec6 borne = solver_.row_impulse();
  const double given = (gain - borne).tail<3>().norm();
  if (given > 0) {
    answer_.gain = std::max(0.0, 1 - borne.tail<3>().norm() / given) * gain;
  }
}

double HapticTick::GuestSpeed() const noexcept {
  return guest_ == ConstraintSolver::kWorld
             ? 0.0
             : V_guest_.tail<3>().norm() + V_guest_.head<3>().norm() * other_->reach_;
}

void HapticTick::PushGuest() noexcept {
  if (guest_ == ConstraintSolver::kWorld) {
    return;
  }
  const spatial::Twist V = solver_.velocity(guest_);
  Vec6 change;
  change << V.w, V.v;
  change -= V_guest_;
  const Vec6 F = other_->answer_.matrix * change / options_.dt;
  other_->F_pushed_ = {F.head<3>(), F.tail<3>()};
  // Where it will be at the end of the step: what pushes it does not stop at where it was.
  other_->MoveInScene(MoveAbout(other_->X_WD_, other_->part_->p_BoBcm_B, V, options_.dt));
}

void HapticTick::AddFreeBodies() noexcept {
  AddGuest();
  for (FreeBody& body : bodies_.awake()) {
    body.index = solver_.AddBody(bodies_.MakeSolverBody(body, options_.gravity_W, options_.dt));
  }
}

void HapticTick::AddFreeContacts(TickOutput* out) noexcept {
  const ContactOptions& options = options_.contact;
  std::array<contact::BodyId, FreeBodies::kMaxAwake> done;
  // Those that are woken on the way come at the end of the list.
  for (std::size_t i = 0; i < bodies_.awake().size(); ++i) {
    FreeBody& body = bodies_.awake()[i];
    const contact::Shape& shape = scene_->shape(body.id);
    const BodyProperties& properties = *bodies_.properties(body.id);
    contact::QueryOptions query;
    query.self = body.id;
    query.left_out = {done.data(), i};
    query.point_budget = effort_.point_budget;
    query.broken_edges = {options.edge_break, bodies_.Move(body, body.V, options_.dt)};
    const double speed = body.V.v.norm() + body.V.w.norm() * CalcReach(shape, properties.p_BoBcm_B);
    query.margin =
        options.min_margin +
        1.5 * options_.dt * (speed + GuestSpeed() + options_.dt * options_.gravity_W.norm());
    scene_->Query(shape, body.X_WB, query, &workspace_);
    body.clearance = std::min(query.margin, workspace_.deepest());
    AddQueried({body.index, body.id.value(), body.X_WB}, properties.surface, options.rolling_arm,
               out);
    done[i] = body.id;
  }
}

void HapticTick::MoveFreeBodies() noexcept {
  PushGuest();
  const ContactOptions& options = options_.contact;
  for (FreeBody& body : bodies_.awake()) {
    const contact::Shape& shape = scene_->shape(body.id);
    const double reach = CalcReach(shape, bodies_.properties(body.id)->p_BoBcm_B);
    body.V = Limited(solver_.velocity(body.index), options.max_free_speed,
                     options.max_free_speed / reach);
    const double travel = options_.dt * (body.V.v.norm() + body.V.w.norm() * reach);
    contact::QueryOptions query;
    query.self = body.id;
    const double tolerance = AllowedDepth(body.clearance, options);
    const auto at = [&](double share) { return bodies_.Move(body, body.V, share * options_.dt); };
    const double share = FindFreeShare(body.clearance + tolerance, travel, [&](double candidate) {
      return scene_->IsFree(shape, at(candidate), tolerance, query, &workspace_);
    });
    body.X_WB = at(share);
    body.V = {share * body.V.w, share * body.V.v};
    body.time_at_rest = travel < kRestSpeed * options_.dt ? body.time_at_rest + options_.dt : 0;
    scene_->SetPose(body.id, body.X_WB);
  }
  bodies_.Sleep(options.rest_time);
}

void HapticTick::StepFreeBodies(TickOutput* out) noexcept {
  if (bodies_.awake().empty()) {
    return;
  }
  friction_.BeginTick();
  solver_.BeginFree(options_.dt);
  AddFreeBodies();
  AddFreeContacts(out);
  (void)solver_.Solve(effort_.iterations);
  MoveFreeBodies();
  friction_.EndTick(solver_, options_.dt);
}

void HapticTick::MoveDisplayed(const spatial::Twist& V_Cm) noexcept {
  const ContactOptions& options = options_.contact;
  V_D_ = Limited(V_Cm, options.max_speed, options.max_turn_rate);
  double share = 1;
  const auto at = [this](double candidate) {
    return MoveAbout(X_WD_, part_->p_BoBcm_B, V_D_, candidate * options_.dt);
  };
  if (options_.condition != Condition::kConstraint) {
    // Free bodies have moved already; those near have come nearer.
    double speed = V_D_.v.norm() + V_D_.w.norm() * reach_;
    double others = 0;
    for (const FreeBody& body : bodies_.awake()) {
      others = std::max(others, body.V.v.norm());
    }
    const double tolerance = AllowedDepth(clearance_, options);
    share = FindFreeShare(clearance_ + tolerance - options_.dt * others, options_.dt * speed,
                          [&](double s) { return IsFreeAt(at(s), tolerance); });
  }
  X_WD_ = at(share);
  V_D_ = {share * V_D_.w, share * V_D_.v};
}

bool HapticTick::IsFreeAt(const spatial::Pose& X_WB, double tolerance) noexcept {
  for (std::size_t member = 0; member < shape_count(); ++member) {
    const HeldShape held = MakeHeldShape(member, X_WB, 0);
    const bool is_free = scene_->IsFree(*held.shape, held.X_WS, tolerance, held.query, &workspace_);
    points_tested_ += workspace_.stats().points_tested;
    if (!is_free) {
      return false;
    }
  }
  return true;
}

void HapticTick::RecordContacts(TickOutput* out) noexcept {
  double hardest = 0;
  meeting_ = {};
  has_met_ = leads_ && guest_ != ConstraintSolver::kWorld;
  if (is_answered_) {
    const Meeting& meeting = other_->meeting_;
    out->contact_count = meeting.contact_count;
    out->deepest = std::min(out->deepest, meeting.deepest);
    out->p_WC = meeting.p_WC;
    out->f_C_W = -meeting.f_C_W;
    out->contact_body = meeting.body;
    hardest = meeting.f_C_W.norm();
  }
  for (int i = 0; i < held_contacts_; ++i) {
    const contact::Contact& c = contacts_[static_cast<std::size_t>(i)];
    const double force = solver_.normal_force(i);
    if (has_met_ && other_->Holds(c.body)) {
      RecordMeeting(c, solver_.contact_force(i));
    }
    if (force <= 1e-6) {
      continue;
    }
    ++out->contact_count;
    if (force > hardest) {
      hardest = force;
      out->p_WC = c.p_WC;
      out->f_C_W = solver_.contact_force(i);
      out->contact_body = c.body;
    }
  }
}

void HapticTick::RecordMeeting(const contact::Contact& c, const Vec3& f_C_W) noexcept {
  meeting_.body = part_->body;
  meeting_.deepest = std::min(meeting_.deepest, c.distance);
  if (f_C_W.norm() <= 1e-6) {
    return;
  }
  ++meeting_.contact_count;
  if (f_C_W.norm() > meeting_.f_C_W.norm()) {
    meeting_.p_WC = c.p_WC;
    meeting_.f_C_W = f_C_W;
  }
}

}  // namespace hvas::haptics
