#include "haptics/guidance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hvas::haptics {
namespace {

constexpr double kFitTakesOver = 2e-3;  // [m] of depth over which attraction gives way

}  // namespace

void Guidance::Begin(const HeldPart& part) noexcept {
  captured_before_ = 0;
  is_stuck_ = false;
  is_attracting_ = false;
  guide_.Reset();
  if (part.starts_in_place) {
    guide_.StartInPlace();
  }
  fit_rows_.Reset();
  giving_rows_.Reset(part.starts_in_place);
  thread_rows_.Reset(part.starts_in_place);
}

void Guidance::Update(const DisplayedPart& displayed, const spatial::Pose& X_WT) noexcept {
  if (options_.condition != Condition::kCollision) {
    guide_.Update(*displayed.part, options_.guidance, displayed.X_WD, X_WT, options_.dt);
  }
}

EnergyCredit Guidance::AddTo(const DisplayedPart& displayed, double weight, double soft_start,
                             ConstraintSolver* solver) noexcept {
  is_stuck_ = false;
  if (options_.renders_fits) {
    giving_rows_.Add(displayed, options_.dt, solver);
    is_stuck_ = giving_rows_.holding_force() > weight;
  }
  guide_.AddSprings(*displayed.part, options_.guidance, solver);
  const bool has_thread = AddThread(displayed, solver);
  if (options_.condition == Condition::kCollision || guide_.captured_count() == 0) {
    is_attracting_ = false;
    fit_rows_.Reset();
    return {};
  }
  const MateGeometry* axis = guide_.axis();
  if (axis == nullptr) {
    fit_rows_.Reset();
    return {};
  }
  // A tool has no place of its own to be attracted to, and a way that turns or bends, as a
  // thread's, does not lead straight to it.
  const bool attracts =
      displayed.part->drives.empty() && !displayed.part->has_bent_way() && !has_thread;
  const EnergyCredit credit =
      attracts ? AddAttraction(displayed, *axis, soft_start, solver) : EnergyCredit();
  if (guide_.is_aligned() && options_.renders_fits) {
    AddFits(displayed, *axis, weight, solver);
  } else {
    fit_rows_.Reset();
  }
  return credit;
}

EnergyCredit Guidance::AddAttraction(const DisplayedPart& displayed, const MateGeometry& axis,
                                     double soft_start, ConstraintSolver* solver) noexcept {
  // X(9): attraction along the axis towards the final pose, and about it. Along it a fit takes over
  // as it engages: what pulls the part in would hold it back on the way out.
  const HeldPart& part = *displayed.part;
  const GuidanceOptions& guidance = options_.guidance;
  const Vec3& a = axis.way_W;
  const double to_go = a.dot(part.X_WB_goal * part.p_BoBcm_B - displayed.p_WCm());
  const double to_turn = a.dot(spatial::RotationBetween(displayed.X_WD.q(), part.X_WB_goal.q()));
  EnergyCredit credit;
  if (!is_attracting_) {
    is_attracting_ = true;
    // The pull is a spring of stiffness `strongest` / start that the step takes explicitly. One
    // that carries the part beyond its place within a tick, with nothing but inertia against it,
    // would throw it to and fro for good: a part that is so near is there.
    const spatial::Twist step =
        solver->CalcFreeMotion({guidance.attraction_torque * a, guidance.attraction_force * a});
    const auto start_of = [](double rest, double overshoot) {
      return std::abs(rest) > overshoot ? std::abs(rest) : 0.0;
    };
    start_distance_ = start_of(to_go, a.dot(step.v));
    start_angle_ = start_of(to_turn, a.dot(step.w));
    const double scale = options_.workspace.mapping.scale;
    credit.force = 0.5 * guidance.attraction_force * start_distance_ / scale;
    credit.torque = 0.5 * guidance.attraction_torque * start_angle_;
  }
  const auto pull = [soft_start](double rest, double start, double strongest) {
    const double share = start > 0 ? std::min(1.0, std::abs(rest) / start) : 0.0;
    return std::copysign(soft_start * share * strongest, rest);
  };
  const bool has_fit = options_.renders_fits && !guidance.attracts_in_fits &&
                       part.mates[guide_.axis_index()].fit != nullptr;
  const double left = has_fit ? std::clamp(1 - axis.depth / kFitTakesOver, 0.0, 1.0) : 1.0;
  solver->AddWrench({pull(to_turn, start_angle_, guidance.attraction_torque) * a,
                     left * pull(to_go, start_distance_, guidance.attraction_force) * a});
  return credit;
}

void Guidance::AddFits(const DisplayedPart& displayed, const MateGeometry& axis, double weight,
                       ConstraintSolver* solver) noexcept {
  // W5, W8, W9: the fit resists motion along and about the axis up to what physics says at this
  // depth, felt through the map; at rest it holds, and never pushes.
  const HeldPart& part = *displayed.part;
  const bool is_out = axis.way_W.dot(part.insertion_W) <= 0;
  fit_axis_.out_W = is_out ? axis.way_W : Vec3(-axis.way_W);
  fit_axis_.p_CmQ_W = axis.p_WQ - displayed.p_WCm();
  fit_axis_.radius = part.mates[guide_.axis_index()].radius;
  fit_axis_.weight_out = weight * options_.gravity_W.normalized().dot(fit_axis_.out_W);
  const spatial::Twist& V = displayed.V;
  const double speed = fit_axis_.out_W.dot(V.v + V.w.cross(fit_axis_.p_CmQ_W));
  FitLoad load = guide_.CalcFitLoad(part, speed, options_.paper_factors);
  is_stuck_ = is_stuck_ || std::min(load.in, load.out) > weight;
  const double friction = options_.contact.friction.kinetic_coefficient * guide_.lateral_force();
  for (double* sum : {&load.in, &load.out, &load.shown_in, &load.shown_out}) {
    *sum += friction;
  }
  load.torque += friction * fit_axis_.radius;
  fit_rows_.Add(load, fit_axis_, solver);
}

bool Guidance::AddThread(const DisplayedPart& displayed, ConstraintSolver* solver) noexcept {
  if (!options_.guidance.threads_turn || !options_.renders_fits ||
      options_.condition == Condition::kCollision) {
    return false;
  }
  const std::vector<HeldMate>& mates = displayed.part->mates;
  const HeldMate* deepest = nullptr;
  std::size_t index = 0;
  for (std::size_t i = 0; i < std::min(mates.size(), MateGuide::kMaxMates); ++i) {
    if (mates[i].thread && guide_.is_captured(i) &&
        (deepest == nullptr || guide_.geometry(i).depth > guide_.geometry(index).depth)) {
      deepest = &mates[i];
      index = i;
    }
  }
  if (deepest == nullptr) {
    thread_rows_.Reset(false);
    return false;
  }
  thread_rows_.Add(displayed, *deepest, guide_.geometry(index), options_.contact, options_.dt,
                   solver);
  is_stuck_ = is_stuck_ || thread_rows_.is_in();
  return true;
}

void Guidance::Finish(const ConstraintSolver& solver, TickOutput* out) noexcept {
  const FitForces forces = fit_rows_.Finish(solver);
  const GivingRows::Forces giving = giving_rows_.Finish(solver);
  out->axial_felt = forces.axial_felt + giving.felt;
  out->axial_true = forces.axial_true + giving.truth;
  out->F_true_W.f += (giving.truth - giving.felt) * giving_rows_.out_W();
  const Vec3 f = (forces.axial_true - forces.axial_felt) * fit_axis_.out_W;
  out->F_true_W.f += f;
  out->F_true_W.t +=
      fit_axis_.p_CmQ_W.cross(f) + (forces.torque_true - forces.torque_felt) * fit_axis_.out_W;
  const ThreadForces thread = thread_rows_.Finish(solver);
  out->F_true_W.t += (thread.torque_true - thread.torque_felt) * thread_rows_.out_W();
  out->preload = thread.preload;
  out->tightening = std::abs(thread.torque_true);
  out->is_thread_crossed = thread_rows_.is_crossed();
  out->insertion_depth = guide_.insertion_depth();
}

GuidedAxis Guidance::DescribeAxis(const HeldPart& part) const noexcept {
  const MateGeometry* geometry = guide_.axis();
  if (geometry == nullptr) {
    return {};
  }
  const HeldMate& mate = part.mates[guide_.axis_index()];
  GuidedAxis axis;
  axis.mate = mate.id;
  axis.p_WQ = geometry->p_WQ;
  axis.axis_W = geometry->way_W;
  axis.tilt = geometry->angle;
  axis.offset = geometry->distance;
  axis.depth = geometry->depth;
  axis.depth_goal = CalcMateGeometry(mate, part.X_WB_goal).engaged;
  return axis;
}

bool Guidance::HasCapturedMore() noexcept {
  const int before = std::exchange(captured_before_, guide_.captured_count());
  return guide_.captured_count() > before;
}

}  // namespace hvas::haptics
