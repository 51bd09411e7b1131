#include "haptics/haptic_tick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hvas::haptics {
namespace {

// [s]: fades the weight in (haptics.md, section 3). A choice.
constexpr double kSoftStartTime = 0.3;
constexpr double kMinVirtualMass = 0.05;   // [kg]; lighter parts are felt as this inertia
constexpr double kSeatTolerance = 50e-6;   // [m]; no deeper on the last bit into place
constexpr double kMaxCouplingShare = 0.9;  // of the device's force; more than fits are felt with
constexpr double kLeastTorque = 0.2;       // [N m]; turns the part where no torque is shown
constexpr double kLeaveFactor = 2;         // of the limits of being seated, to be out of place
constexpr double kFitTakesOver = 2e-3;     // [m] of depth over which attraction gives way

double MinimumJerk(double s) noexcept {
  return s * s * s * (10 + s * (-15 + 6 * s));
}

/** Rotational inertia for a virtual mass: the part's own shape, never thinner than a small ball. */
Mat3 VirtualInertia(const HeldPart& part, double virtual_mass) noexcept {
  const double scale = part.mass > 0 ? virtual_mass / part.mass : 0.0;
  constexpr double kBallRadius = 0.02;  // [m]: the ball's of haptics.md, section 2. A choice.
  return scale * part.I_BBcm_B + 0.4 * virtual_mass * kBallRadius * kBallRadius * Mat3::Identity();
}

SafetyLimits MakeGateLimits(const TickOptions& options) noexcept {
  if (options.limits) {
    return *options.limits;
  }
  SafetyLimits limits;
  limits.max_force = options.device.max_force;
  limits.max_torque = options.device.max_torque;
  limits.max_torque_rate = 40;
  return limits;
}

}  // namespace

const char* ToString(HoldState state) noexcept {
  switch (state) {
    case HoldState::kEmpty:
      return "empty";
    case HoldState::kFree:
      return "free";
    case HoldState::kNear:
      return "near";
    case HoldState::kCaptured:
      return "captured";
    case HoldState::kMating:
      return "mating";
    case HoldState::kSeated:
      return "seated";
  }
  return "unknown";
}

HapticTick::HapticTick(const TickOptions& options, contact::Scene* scene)
    : options_(options),
      handle_space_(options.workspace),
      scene_(scene),
      force_map_(MakeForceMap(options.device)),
      fit_rows_(options.force_map, options.device),
      passivity_(MakePassivityController(options.device, options.dt)),
      gate_(MakeGateLimits(options)) {}

void HapticTick::Take(const HeldPart* part) noexcept {
  part_ = part;
  has_engaged_ = true;
  captured_before_ = 0;
  CreditPotentials();
  state_ = HoldState::kFree;
  is_stuck_ = false;
  is_first_tick_ = true;
  is_solved_ = false;
  const FreeBody* own = bodies_.FindAwake(part->body);
  const FreeBody* falling = own != nullptr ? own : FindAwakeElsewhere(part->body);
  X_WD_ = falling != nullptr ? falling->X_WB : part->X_WB_start;
  V_D_ = {};
  soft_start_ = 0;
  has_start_ = false;
  seat_progress_ = 0;
  guide_.Reset();
  leaves_place_ = part->starts_in_place;
  if (leaves_place_) {
    guide_.StartInPlace();
  }
  fit_rows_.Reset();
  reach_ = 0;
  for (std::size_t member = 0; member < shape_count(); ++member) {
    const HeldShape held = MakeHeldShape(member, spatial::Pose(), 0);
    const spatial::Box& box = held.shape->box_B();
    reach_ = std::max(
        reach_, (held.X_WS * box.centre() - part->p_BoBcm_B).norm() + 0.5 * box.size().norm());
    // What it lay on or beside is free to move.
    SetLooseForAll(held.query.self, false);
  }
  ShowInScene(other_ != nullptr);
  answer_ = {};
  F_pushed_ = {};
}

LetGo HapticTick::Drop() noexcept {
  LetGo drop;
  drop.is_in_place = is_in_place() || CanFinish();
  drop.X_WB = drop.is_in_place ? part_->X_WB_goal : X_WD_;
  drop.to_place = drop.is_in_place ? 0 : CalcRemainder().d_W.norm();
  MoveInScene(drop.X_WB);
  ShowInScene(true);
  if (part_->falls_when_dropped && !drop.is_in_place && !is_stuck_) {
    SetLooseForAll(part_->body, true);
    bodies_.WakeFirst(part_->body, drop.X_WB, V_D_);
  }
  part_ = nullptr;
  leaves_place_ = false;
  state_ = HoldState::kEmpty;
  return drop;
}

void HapticTick::MoveInScene(const spatial::Pose& X_WB) noexcept {
  for (std::size_t member = 0; member < shape_count(); ++member) {
    scene_->SetPose(BodyOf(member), member == 0 ? X_WB : X_WB * part_->members[member - 1].X_BS);
  }
}

void HapticTick::ShowInScene(bool is_shown) noexcept {
  for (std::size_t member = 0; member < shape_count(); ++member) {
    scene_->SetEnabled(BodyOf(member), is_shown);
  }
}

contact::BodyId HapticTick::BodyOf(std::size_t member) const noexcept {
  return member == 0 ? part_->body : part_->members[member - 1].body;
}

bool HapticTick::Holds(contact::BodyId id) const noexcept {
  for (std::size_t member = 0; part_ != nullptr && member < shape_count(); ++member) {
    if (BodyOf(member) == id) {
      return true;
    }
  }
  return false;
}

void HapticTick::SetLooseForAll(contact::BodyId id, bool is_loose) noexcept {
  bodies_.SetLoose(id, is_loose);
  if (other_ != nullptr) {
    other_->bodies_.SetLoose(id, is_loose);
  }
}

FreeBody* HapticTick::FindAwakeElsewhere(contact::BodyId id) noexcept {
  return other_ != nullptr ? other_->bodies_.FindAwake(id) : nullptr;
}

HapticTick::Tracked HapticTick::CalcTracked(const Hand& hand) const noexcept {
  const spatial::Pose X_WT = hand.X_WH * X_HB_;
  const Vec3 r = X_WT * part_->p_BoBcm_B - hand.X_WH.p();
  return {X_WT, {hand.V_WH.w, hand.V_WH.v + hand.V_WH.w.cross(r)}};
}

TickOutput HapticTick::Tick(const device::DeviceState& state, const TickContext& context) noexcept {
  TickOutput out;
  out.context = context;
  out.deepest = std::numeric_limits<double>::infinity();
  const bool is_usable = state.is_valid && spatial::IsFinite(state.X_DH) &&
                         state.V_DH.v.allFinite() && state.V_DH.w.allFinite();
  if (is_usable) {
    hand_ = handle_space_.Update(state, options_.dt);
  } else {
    handle_space_.Lose();
  }
  const bool is_shared = other_ != nullptr && part_ != nullptr;
  if (is_shared) {
    ShowInScene(false);  // to itself it is no obstacle
    answer_ = {};
  }
  is_answered_ = other_ != nullptr && other_->has_met_;
  has_met_ = false;
  guest_ = ConstraintSolver::kWorld;
  const Hand& hand = hand_;
  out.X_WH = hand.X_WH;
  out.X_WT = hand.X_WH;
  out.X_WD = out.X_WT;
  if (part_ != nullptr) {
    out.occurrence = part_->occurrence;
    if (is_usable) {
      if (is_first_tick_) {
        X_HB_ = hand.X_WH.Inverse() * X_WD_;
        is_first_tick_ = false;
      }
      const Tracked tracked = CalcTracked(hand);
      tracked_ = tracked;
      out.X_WT = tracked.X_WT;
      Hold(tracked, &out);
      // About the hand's point: the coupling acts at the centre of mass.
      out.F_H_W = out.F_felt_W;
      out.F_H_W.t += (tracked.X_WT * part_->p_BoBcm_B - hand.X_WH.p()).cross(out.F_felt_W.f);
    }
    out.X_WD = X_WD_;
  }
  if (!is_solved_) {
    StepFreeBodies(&out);
  }
  is_solved_ = false;
  if (is_shared) {
    MoveInScene(X_WD_);
    ShowInScene(true);
  }
  if (other_ != nullptr && guest_ == ConstraintSolver::kWorld) {
    other_->F_pushed_ = {};
  }
  out.state = state_;
  out.points_tested = std::exchange(points_tested_, 0);
  out.workspace = handle_space_.mapping();
  out.F_H_D = MakeSafe(state, context, is_usable, out);
  out.F_H_W = {out.workspace.X_WD.q() * out.F_H_D.t, out.workspace.X_WD.q() * out.F_H_D.f};
  out.energy = passivity_.force().account();
  out.turning_energy = passivity_.torque().account();
  out.gate_actions = gate_.actions();
  return out;
}

spatial::Wrench HapticTick::MakeSafe(const device::DeviceState& state, const TickContext& context,
                                     bool is_usable, const TickOutput& out) noexcept {
  spatial::Wrench F_H_D = handle_space_.ToDevice(out.F_H_W);
  if (options_.controls_passivity) {
    F_H_D.f += ShowTorque(F_H_D, state.X_DH.q());
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const spatial::Pose nowhere(Vec3::Constant(kNan));
    F_H_D = passivity_.Limit(is_usable ? state.X_DH : nowhere, F_H_D, StoredEnergy(),
                             StoredTurningEnergy(), options_.dt);
  }
  GateInput input = MakeGateInput(state, F_H_D, options_.dt, &last_sample_ns_);
  input.is_valid = input.is_valid && is_usable;
  input.is_stopped = input.is_stopped || context.is_stopped;
  input.has_engaged = std::exchange(has_engaged_, false);
  input.model_age = 1e-9 * static_cast<double>(context.model_age_ns);
  spatial::Wrench given = gate_.Pass(input);
  if (options_.controls_passivity) {
    passivity_.Write(given);
    // The border moves the scene under the hand: work that the handle would have done (X5).
    const double drift_work =
        -given.f.dot(handle_space_.drift_D()) * options_.dt / options_.workspace.mapping.scale;
    if (drift_work > 0) {
      passivity_.AddCredit(drift_work);
    }
  }
  return given;
}

Vec3 HapticTick::ShowTorque(const spatial::Wrench& F_H_D, const Quat& q_DH) const noexcept {
  // The force at the handle's point that turns the hand, which holds it at G, by this torque; what
  // lies along the lever cannot be shown.
  const double lever = options_.p_HG.norm();
  if (!(lever > 0)) {
    return Vec3::Zero();
  }
  constexpr double kCueShare = 0.06;  // of the force: a cue, that moves no part aside
  const Vec3 r_D = q_DH * Vec3(-options_.p_HG);
  const Vec3 f = F_H_D.t.cross(r_D) / (lever * lever);
  const double most = kCueShare * options_.device.max_force;
  return f * std::min(1.0, most / std::max(f.norm(), most));
}

void HapticTick::CreditPotentials() noexcept {
  // What the hand is owed on the part's way to its place: weight that goes down with it.
  const double drop = part_->X_WB_start.p().z() - part_->X_WB_goal.p().z();
  const double weight = force_map_.Felt(part_->mass * options_.gravity_W.norm());
  passivity_.AddCredit(weight * std::max(0.0, drop) / options_.workspace.mapping.scale);
}

// As if the coupling were never saturated: what counts as stored is never forgotten, so too much
// here only makes the controller remember longer.
double HapticTick::StoredEnergy() const noexcept {
  if (part_ == nullptr) {
    return 0;
  }
  const Vec3 e = tracked_.X_WT * part_->p_BoBcm_B - X_WD_ * part_->p_BoBcm_B;
  const double virtual_mass = std::clamp(part_->mass, kMinVirtualMass, options_.max_virtual_mass);
  const double height = (X_WD_.p() - part_->X_WB_start.p()).dot(-options_.gravity_W.normalized());
  const double energy = 0.5 * options_.coupling.k_lin * e.squaredNorm() +
                        0.5 * virtual_mass * V_D_.v.squaredNorm() +
                        weight_felt_ * std::max(0.0, height);
  return energy / options_.workspace.mapping.scale;
}

double HapticTick::StoredTurningEnergy() const noexcept {
  if (part_ == nullptr) {
    return 0;
  }
  const Vec3 theta = spatial::RotationBetween(X_WD_.q(), tracked_.X_WT.q());
  return 0.5 * options_.coupling.k_rot * theta.squaredNorm();
}

void HapticTick::Hold(const Tracked& tracked, TickOutput* out) noexcept {
  soft_start_ = std::min(1.0, soft_start_ + options_.dt / kSoftStartTime);
  if (state_ == HoldState::kSeated) {
    MoveIntoPlace(out);
    answer_.V = V_D_;
    out->F_felt_W = CalcCouplingWrench(tracked);
    out->F_true_W = out->F_felt_W;
    return;
  }
  if (options_.condition != Condition::kCollision) {
    guide_.Update(*part_, options_.guidance, X_WD_, tracked.X_WT, options_.dt);
  }
  const Vec3 p_WCm = X_WD_ * part_->p_BoBcm_B;
  const double virtual_mass = std::clamp(part_->mass, kMinVirtualMass, options_.max_virtual_mass);
  const Mat3 R_WB = X_WD_.R();
  friction_.BeginTick();
  const Mat3 I_W = R_WB * VirtualInertia(*part_, virtual_mass) * R_WB.transpose();
  const spatial::Twist V_before = V_D_;
  solver_.Begin(virtual_mass, I_W, p_WCm, V_D_, options_.dt);
  AddCoupling(tracked, p_WCm);
  weight_true_ = part_->mass * options_.gravity_W.norm();
  weight_felt_ = soft_start_ * force_map_.Felt(weight_true_);
  solver_.AddWrench({Vec3::Zero(), weight_felt_ * options_.gravity_W.normalized()});
  solver_.AddWrench(F_pushed_);
  AddGuidance(p_WCm);
  AddFreeBodies();
  ShowOther(!is_answered_);
  AddContacts(out);
  ShowOther(true);
  AddFreeContacts(out);
  const spatial::Twist V = solver_.Solve(effort_.iterations);
  RecordContacts(out);
  friction_.EndTick(solver_, options_.dt);
  MoveFreeBodies();
  // To stop where it meets the other's part would not keep that one from coming on.
  ShowOther(!is_answered_ && !(has_met_ && other_->answer_.yields));
  MoveDisplayed(V);
  ShowOther(true);
  is_solved_ = true;
  RecordAnswer(I_W, virtual_mass, V_before);

  out->F_felt_W = CalcCouplingWrench(tracked);
  out->F_true_W = out->F_felt_W;
  out->F_true_W.f += (weight_true_ * soft_start_ - weight_felt_) * options_.gravity_W.normalized();
  RecordFits(out);
  out->axis = DescribeAxis();
  UpdateState();
  has_engaged_ = has_engaged_ || guide_.captured_count() > captured_before_;
  captured_before_ = guide_.captured_count();
}

void HapticTick::AddCoupling(const Tracked& tracked, const Vec3& p_WCm) noexcept {
  // X(1), X(2), with the damper's sign mended, and never more than the device can give.
  const Stretch stretch = CalcStretch(tracked);
  const CouplingGains& now = stretch.gains;
  solver_.AddPointSpring(p_WCm, now.k_lin * stretch.e_W, now.k_lin * Mat3::Identity());
  solver_.AddPointDamper(p_WCm, tracked.V_T.v, now.b_lin);
  solver_.AddAngularSpring(now.k_rot * stretch.theta_W, now.k_rot * Mat3::Identity());
  solver_.AddAngularDamper(tracked.V_T.w, now.b_rot);
}

HapticTick::Stretch HapticTick::CalcStretch(const Tracked& tracked) const noexcept {
  const CouplingGains& gains = options_.coupling;
  Stretch stretch;
  stretch.e_W = tracked.X_WT * part_->p_BoBcm_B - X_WD_ * part_->p_BoBcm_B;
  stretch.theta_W = spatial::RotationBetween(X_WD_.q(), tracked.X_WT.q());
  const double max_force = kMaxCouplingShare * options_.device.max_force;
  const double max_torque = kMaxCouplingShare * std::max(kLeastTorque, options_.device.max_torque);
  const auto saturate = [](double k, double stretched, double most) {
    return stretched * k > most ? most / stretched : k;
  };
  CouplingGains& now = stretch.gains;
  now.k_lin = saturate(gains.k_lin, stretch.e_W.norm(), max_force);
  now.k_rot = saturate(gains.k_rot, stretch.theta_W.norm(), max_torque);
  now.b_lin = gains.b_lin * now.k_lin / gains.k_lin;
  now.b_rot = gains.b_rot * now.k_rot / gains.k_rot;
  return stretch;
}

spatial::Wrench HapticTick::CalcCouplingWrench(const Tracked& tracked) const noexcept {
  const Stretch stretch = CalcStretch(tracked);
  const CouplingGains& now = stretch.gains;
  return {now.b_rot * (V_D_.w - tracked.V_T.w) - now.k_rot * stretch.theta_W,
          now.b_lin * (V_D_.v - tracked.V_T.v) - now.k_lin * stretch.e_W};
}

void HapticTick::AddGuidance(const Vec3& p_WCm) noexcept {
  is_stuck_ = false;
  if (options_.condition == Condition::kCollision || guide_.captured_count() == 0) {
    has_start_ = false;
    fit_rows_.Reset();
    guide_.AddSprings(*part_, options_.guidance, &solver_);
    return;
  }
  guide_.AddSprings(*part_, options_.guidance, &solver_);
  const MateGeometry* axis = guide_.axis();
  if (axis == nullptr) {
    fit_rows_.Reset();
    return;
  }
  // X(9): attraction along the axis towards the final pose, and about it. Along it a fit takes over
  // as it engages: what pulls the part in would hold it back on the way out.
  const Vec3& a = axis->axis_W;
  const double to_go = a.dot(part_->X_WB_goal * part_->p_BoBcm_B - p_WCm);
  const double to_turn = a.dot(spatial::RotationBetween(X_WD_.q(), part_->X_WB_goal.q()));
  if (!has_start_) {
    has_start_ = true;
    start_distance_ = std::abs(to_go);
    start_angle_ = std::abs(to_turn);
    const double scale = options_.workspace.mapping.scale;
    passivity_.AddCredit(0.5 * options_.guidance.attraction_force * start_distance_ / scale);
    passivity_.AddTurningCredit(0.5 * options_.guidance.attraction_torque * start_angle_);
  }
  const auto pull = [this](double rest, double start, double strongest) {
    const double share = start > 0 ? std::min(1.0, std::abs(rest) / start) : 0.0;
    return std::copysign(soft_start_ * share * strongest, rest);
  };
  const bool has_fit = options_.renders_fits && part_->mates[guide_.axis_index()].fit != nullptr;
  const double left = has_fit ? std::clamp(1 - axis->depth / kFitTakesOver, 0.0, 1.0) : 1.0;
  solver_.AddWrench({pull(to_turn, start_angle_, options_.guidance.attraction_torque) * a,
                     left * pull(to_go, start_distance_, options_.guidance.attraction_force) * a});
  if (guide_.is_aligned() && options_.renders_fits) {
    AddFits(*axis, p_WCm);
  } else {
    fit_rows_.Reset();
  }
}

void HapticTick::AddFits(const MateGeometry& axis, const Vec3& p_WCm) noexcept {
  // W5, W8, W9: the fit resists motion along and about the axis up to what physics says at this
  // depth, felt through the map; at rest it holds, and never pushes.
  const bool is_out = axis.axis_W.dot(part_->insertion_W) <= 0;
  fit_axis_.out_W = is_out ? axis.axis_W : Vec3(-axis.axis_W);
  fit_axis_.p_CmQ_W = axis.p_WQ - p_WCm;
  fit_axis_.radius = part_->mates[guide_.axis_index()].radius;
  fit_axis_.weight_out = weight_true_ * options_.gravity_W.normalized().dot(fit_axis_.out_W);
  const double speed = fit_axis_.out_W.dot(V_D_.v + V_D_.w.cross(fit_axis_.p_CmQ_W));
  FitLoad load = guide_.CalcFitLoad(*part_, speed);
  is_stuck_ = std::min(load.in, load.out) > weight_true_;
  const double friction = options_.contact.friction.kinetic_coefficient * guide_.lateral_force();
  for (double* sum : {&load.in, &load.out, &load.shown_in, &load.shown_out}) {
    *sum += friction;
  }
  load.torque += friction * fit_axis_.radius;
  fit_rows_.Add(load, fit_axis_, &solver_);
}

void HapticTick::RecordFits(TickOutput* out) noexcept {
  const FitForces forces = fit_rows_.Finish(solver_);
  out->axial_felt = forces.axial_felt;
  out->axial_true = forces.axial_true;
  const Vec3 f = (forces.axial_true - forces.axial_felt) * fit_axis_.out_W;
  out->F_true_W.f += f;
  out->F_true_W.t +=
      fit_axis_.p_CmQ_W.cross(f) + (forces.torque_true - forces.torque_felt) * fit_axis_.out_W;
  out->insertion_depth = guide_.insertion_depth();
}

GuidedAxis HapticTick::DescribeAxis() const noexcept {
  const MateGeometry* geometry = guide_.axis();
  if (geometry == nullptr) {
    return {};
  }
  const HeldMate& mate = part_->mates[guide_.axis_index()];
  GuidedAxis axis;
  axis.mate = mate.id;
  axis.p_WQ = geometry->p_WQ;
  axis.axis_W = geometry->axis_W;
  axis.tilt = geometry->angle;
  axis.offset = geometry->distance;
  axis.depth = geometry->depth;
  axis.depth_goal = CalcMateGeometry(mate, part_->X_WB_goal).engaged;
  return axis;
}

HapticTick::HeldShape HapticTick::MakeHeldShape(std::size_t member, const spatial::Pose& X_WB,
                                                double margin) noexcept {
  HeldShape held;
  held.query.margin = margin;
  held.query.point_budget = effort_.point_budget;
  held.query.ignored = {ignored_.data(), guide_.CollectIgnored(*part_, ignored_, member)};
  if (member == 0) {
    held.shape = part_->shape.get();
    held.X_WS = X_WB;
    held.query.left_out = part_->left_out;
    held.query.self = part_->body;
  } else {
    const HeldMember& other = part_->members[member - 1];
    held.shape = other.shape.get();
    held.X_WS = X_WB * other.X_BS;
    held.query.left_out = other.left_out;
    held.query.self = other.body;
  }
  return held;
}

void HapticTick::MeasureDepth(TickOutput* out) noexcept {
  for (std::size_t member = 0; member < shape_count(); ++member) {
    const HeldShape held = MakeHeldShape(member, X_WD_, 0);
    scene_->Query(*held.shape, held.X_WS, held.query, &workspace_);
    points_tested_ += workspace_.stats().points_tested;
    out->deepest = std::min(out->deepest, workspace_.deepest());
  }
}

HapticTick::Remainder HapticTick::CalcRemainder() const noexcept {
  return {X_WD_ * part_->p_BoBcm_B - part_->X_WB_goal * part_->p_BoBcm_B,
          spatial::RotationBetween(X_WD_.q(), part_->X_WB_goal.q()).norm()};
}

bool HapticTick::HasArrived() noexcept {
  const GuidanceOptions& guidance = options_.guidance;
  if (part_->lacks_partners) {
    return false;
  }
  const auto [d, angle] = CalcRemainder();
  leaves_place_ = leaves_place_ && d.norm() < kLeaveFactor * guidance.loose_seat_distance &&
                  angle < kLeaveFactor * guidance.seat_angle;
  if (leaves_place_ || IsDrawnOut()) {
    return false;
  }
  if (d.norm() > guidance.loose_seat_distance || angle > guidance.seat_angle) {
    return false;
  }
  X_WD_seat_start_ = X_WD_;
  if (d.norm() <= guidance.seat_distance) {
    return true;  // wherever the hand is by now
  }
  const bool is_guided = guide_.captured_count() > 0;
  const bool needs_guide = !part_->mates.empty() && options_.condition != Condition::kCollision;
  if (needs_guide && !is_guided) {
    return false;
  }
  // Along the way in, and across an axis, a part is home or it is not; where only planes or nothing
  // at all hold it, it is set straight over the last bit, if nothing is there.
  const double along = std::abs(d.dot(part_->insertion_W));
  const double tight = guide_.axis() != nullptr ? d.norm() : along;
  if (is_guided && tight > guidance.seat_distance) {
    return false;
  }
  return IsWayHomeFree();
}

bool HapticTick::IsWayHomeFree() noexcept {
  if (options_.condition == Condition::kConstraint) {
    return true;
  }
  constexpr double kSamples[] = {0.25, 0.5, 0.75};  // Shares of the way: a choice, not measured.
  for (const double s : kSamples) {
    if (!IsFreeAt(CalcSeatPose(s), kSeatTolerance)) {
      return false;
    }
  }
  return true;
}

bool HapticTick::CanFinish() noexcept {
  if (part_->lacks_partners || is_stuck_ || IsDrawnOut()) {
    return false;
  }
  const auto [d, angle] = CalcRemainder();
  if (d.norm() > options_.guidance.finish_distance || angle > options_.guidance.seat_angle) {
    return false;
  }
  X_WD_seat_start_ = X_WD_;
  return IsWayHomeFree();
}

bool HapticTick::IsDrawnOut() const noexcept {
  const Vec3& p_BoBcm_B = part_->p_BoBcm_B;
  const Vec3 lead = tracked_.X_WT * p_BoBcm_B - part_->X_WB_goal * p_BoBcm_B;
  return part_->starts_in_place &&
         lead.dot(part_->insertion_W) < -options_.guidance.loose_seat_distance;
}

void HapticTick::UpdateState() noexcept {
  if (HasArrived()) {
    state_ = HoldState::kSeated;
    seat_progress_ = 0;
    const double to_go = CalcRemainder().d_W.norm();
    passivity_.AddCredit(0.5 * options_.coupling.k_lin * to_go * to_go /
                         options_.workspace.mapping.scale);
    X_WD_seat_start_ = X_WD_;
  } else if (guide_.captured_count() > 0) {
    state_ = guide_.is_aligned() ? HoldState::kMating : HoldState::kCaptured;
  } else {
    state_ = guide_.is_near() ? HoldState::kNear : HoldState::kFree;
  }
}

spatial::Pose HapticTick::CalcSeatPose(double progress) const noexcept {
  if (progress >= 1) {
    return part_->X_WB_goal;
  }
  const double s = MinimumJerk(progress);
  const Vec3& p_BoBcm_B = part_->p_BoBcm_B;
  const Vec3 p_from = X_WD_seat_start_ * p_BoBcm_B;
  const Vec3 theta = spatial::RotationBetween(X_WD_seat_start_.q(), part_->X_WB_goal.q());
  const Quat q = spatial::RotationFromVector(s * theta) * X_WD_seat_start_.q();
  return {q, p_from + s * (part_->X_WB_goal * p_BoBcm_B - p_from) - q * p_BoBcm_B};
}

void HapticTick::MoveIntoPlace(TickOutput* out) noexcept {
  // The last fraction of a millimetre, to the exact pose that the mates resolve to (X9).
  const spatial::Pose X_before = X_WD_;
  seat_progress_ = std::min(1.0, seat_progress_ + options_.dt / options_.guidance.seat_time);
  X_WD_ = CalcSeatPose(seat_progress_);
  V_D_.w = spatial::RotationBetween(X_before.q(), X_WD_.q()) / options_.dt;
  V_D_.v = (X_WD_ * part_->p_BoBcm_B - X_before * part_->p_BoBcm_B) / options_.dt;
  if (seat_progress_ < 1 && options_.condition != Condition::kConstraint) {
    MeasureDepth(out);
  }
}

}  // namespace hvas::haptics
