#include "orders/tool_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "base/check.h"
#include "base/units.h"
#include "haptics/constraint_solver.h"
#include "haptics/free_bodies.h"
#include "haptics/motion_check.h"

namespace hvas::orders {
namespace {

using haptics::ConstraintSolver;

constexpr double kTurnPeriod = 1e-3;  // [s]: X4.
constexpr int kSamplePeriod = 10;     // Ticks between samples that are kept: a choice.
constexpr int kTurnIterations = 100;  // Of the solver: there is no deadline. A choice.
constexpr double kLiftSpeed = 20e-3;  // [m/s] along the axis: a choice.
constexpr double kAirRate = 2.0;      // [rad/s] with the tool in the air: a choice.
constexpr double kOutside = 2e-3;     // [m] beyond the drive, where the tool is turned in the air.
constexpr double kArcMargin = units::FromDeg(1);  // Kept from the ends of the arc: a choice.
constexpr double kMostTwist = 1.0;  // [rad]: the hand runs no further ahead of the tool. A choice.
constexpr double kPressing = 0.2;   // [N]: less is no contact with an obstacle. A choice.
constexpr int kMostStrokes = 200;   // So that a run ends: 33 turns of a hexagon. A choice.
/** Inertia of a fastener in its thread [kg m^2]: its momentum is lost in friction in each tick, so
 it only bounds by how much the torque of the contacts exceeds the friction, at 0.5 rad/s by 1 mN m.
 */
constexpr double kFastenerInertia = 2e-6;

/** A wanted place of the hand: angle about the axis and lift along it. */
struct HandPlace {
  double angle{0};
  double lift{0};
};

class Turner {
 public:
  Turner(contact::Scene* scene, const ReachQuery& query, const simulation::ToolMate& mate,
         const spatial::Pose& X_WF, const TurnOptions& options)
      : scene_(*scene),
        query_(query),
        mate_(mate),
        X_WF_(X_WF),
        options_(options),
        z_W_(X_WF.q() * -mate.fastener.axis_B),
        p_WQ_(X_WF * mate.fastener.origin_B) {
    const spatial::Box& box = query.tool->box_B();
    reach_ = (box.centre() - options.p_BoBcm_B).norm() + 0.5 * box.size().norm();
  }

  TurnResult Run(const FreeArc* arc);

 private:
  /** Moves the hand evenly to a place; ends early when `is_done` says so after a tick. */
  template <typename IsDone>
  void MoveTo(const HandPlace& place, const IsDone& is_done);

  void MoveTo(const HandPlace& place) {
    MoveTo(place, [] { return false; });
  }

  void Wait(double time);
  void Tick(const HandPlace& before);
  void StartStep(const spatial::Pose& X_WT, const spatial::Pose& X_before);
  /** Adds the contacts of the last query, those with the fastener to body `fastener`. */
  void AddContacts(int fastener);
  [[nodiscard]] double CalcFastenerForce() const;
  [[nodiscard]] Vec6 CalcScrewAxis() const;
  void MoveFastener(double rate);
  void MoveTool(const spatial::Twist& V, double clearance);
  void Keep(const spatial::Pose& X_WT);

  [[nodiscard]] spatial::Pose PoseOf(const HandPlace& place) const {
    return CalcToolPose(mate_, X_WF_, place.angle, place.lift + travel_);
  }

  [[nodiscard]] double CalcToolAngle() const;

  [[nodiscard]] bool HasArrived() const { return direction_ * (options_.angle - angle_) <= 0; }

  [[nodiscard]] std::optional<double> ChooseStart(const FreeArc* arc) const;

  contact::Scene& scene_;
  const ReachQuery& query_;
  const simulation::ToolMate& mate_;
  const spatial::Pose X_WF_;
  const TurnOptions& options_;
  const Vec3 z_W_;   ///< Out of the fastener.
  const Vec3 p_WQ_;  ///< On its axis.
  double reach_{0};
  double direction_{1};

  HandPlace hand_;
  spatial::Pose X_WD_;
  spatial::Twist V_;
  double tool_angle_{0};
  double angle_{0};   ///< Of the fastener.
  double travel_{0};  ///< Of the fastener, outwards [m].
  std::int64_t ticks_{0};
  TurnSample sample_;
  TurnResult result_;
  contact::QueryWorkspace workspace_;
  std::vector<contact::Contact> contacts_;
  std::unique_ptr<ConstraintSolver> solver_ = std::make_unique<ConstraintSolver>();
};

double Turner::CalcToolAngle() const {
  // About the axis, from where flats were parallel, next to the last angle.
  const Quat q = X_WD_.q() * CalcToolPose(mate_, X_WF_, tool_angle_, 0).q().conjugate();
  return tool_angle_ + spatial::RotationVector(q.normalized()).dot(z_W_);
}

void Turner::StartStep(const spatial::Pose& X_WT, const spatial::Pose& X_before) {
  const Mat3 R = X_WD_.R();
  const Vec3 p_WCm = X_WD_ * options_.p_BoBcm_B;
  const Vec3 p_target = X_WT * options_.p_BoBcm_B;
  const haptics::CouplingGains& gains = options_.coupling;
  solver_->Begin(options_.mass, R * options_.I_BBcm_B * R.transpose(), p_WCm, V_, kTurnPeriod);
  solver_->AddPointSpring(p_WCm, gains.k_lin * (p_target - p_WCm), gains.k_lin * Mat3::Identity());
  solver_->AddAngularSpring(gains.k_rot * spatial::RotationBetween(X_WD_.q(), X_WT.q()),
                            gains.k_rot * Mat3::Identity());
  solver_->AddPointDamper(p_WCm, (p_target - X_before * options_.p_BoBcm_B) / kTurnPeriod,
                          gains.b_lin);
  solver_->AddAngularDamper(spatial::RotationBetween(X_before.q(), X_WT.q()) / kTurnPeriod,
                            gains.b_rot);
}

void Turner::AddContacts(int fastener) {
  const haptics::ContactOptions& contact = options_.contact;
  const double settling = kTurnPeriod + contact.settling_time;
  std::map<contact::BodyId, int> patches;
  for (const contact::Contact& c : contacts_) {
    auto found = patches.find(c.body);
    if (found == patches.end()) {
      ConstraintSolver::Patch patch;
      patch.other = c.body == query_.fastener ? fastener : ConstraintSolver::kWorld;
      patch.coefficient = contact.friction.kinetic_coefficient;
      found = patches.emplace(c.body, solver_->AddPatch(patch)).first;
    }
    ConstraintSolver::Contact row;
    row.patch = found->second;
    row.p_WC = c.p_WC;
    row.nhat_W = c.nhat_W;
    row.velocity_bias =
        -std::max(c.distance, -contact.max_depth) / (c.distance > 0 ? kTurnPeriod : settling);
    row.compliance = contact.compliance * kTurnPeriod / settling;
    row.recovery_speed = contact.recovery_speed;
    if (row.patch < 0 || solver_->AddContact(row) < 0) {
      result_.is_truncated = true;
      return;
    }
  }
}

Vec6 Turner::CalcScrewAxis() const {
  // A right-hand thread comes out as it turns counter-clockwise.
  const double lead = options_.lead / units::kTurn;
  Vec6 axis;
  axis << z_W_, lead * z_W_;
  return axis;
}

double Turner::CalcFastenerForce() const {
  double force = 0;
  const Vec6 axis = CalcScrewAxis();
  for (int i = 0; i < solver_->contact_count(); ++i) {
    const contact::Contact& c = contacts_[static_cast<std::size_t>(i)];
    if (c.body == query_.fastener) {
      const Vec3 f = -solver_->contact_force(i);
      force += (c.p_WC - p_WQ_).cross(f).dot(axis.head<3>()) + f.dot(axis.tail<3>());
    }
  }
  return force;
}

void Turner::MoveFastener(double rate) {
  angle_ += kTurnPeriod * rate;
  travel_ = std::max(0.0, travel_ + kTurnPeriod * rate * options_.lead / units::kTurn);
  const Quat turn(Eigen::AngleAxisd(angle_, z_W_));
  scene_.SetPose(query_.fastener, {(turn * X_WF_.q()).normalized(),
                                   p_WQ_ + turn * (X_WF_.p() - p_WQ_) + travel_ * z_W_});
}

void Turner::MoveTool(const spatial::Twist& V, double clearance) {
  contact::QueryOptions free;
  free.margin = 0;
  const double tolerance = std::max(options_.contact.stop_depth, 2e-6 - clearance);
  const auto at = [&](double share) {
    return haptics::MoveAbout(X_WD_, options_.p_BoBcm_B, V, share * kTurnPeriod);
  };
  const double travel = kTurnPeriod * (V.v.norm() + V.w.norm() * reach_);
  const double share = haptics::FindFreeShare(clearance + tolerance, travel, [&](double s) {
    return scene_.IsFree(*query_.tool, at(s), tolerance, free, &workspace_);
  });
  X_WD_ = at(share);
  V_ = {share * V.w, share * V.v};
  tool_angle_ = CalcToolAngle();
}

void Turner::Tick(const HandPlace& before) {
  const spatial::Pose X_WT = PoseOf(hand_);
  const spatial::Pose X_before = PoseOf(before);
  StartStep(X_WT, X_before);
  const spatial::Twist V_free = solver_->SolveUnconstrained();
  contact::QueryOptions query;
  query.margin = options_.contact.min_margin +
                 1.5 * kTurnPeriod * (V_free.v.norm() + V_free.w.norm() * reach_);
  query.broken_edges = {options_.contact.edge_break,
                        haptics::MoveAbout(X_WD_, options_.p_BoBcm_B, V_, kTurnPeriod)};
  scene_.Query(*query_.tool, X_WD_, query, &workspace_);
  result_.is_truncated = result_.is_truncated || workspace_.stats().is_truncated;
  contacts_.assign(workspace_.contacts().begin(), workspace_.contacts().end());
  const double clearance = std::min(query.margin, workspace_.deepest());
  result_.deepest = std::max(result_.deepest, -clearance);

  // Dry friction holds the fastener unless its contacts turn it harder than that.
  AddContacts(ConstraintSolver::kWorld);
  spatial::Twist V = solver_->Solve(kTurnIterations);
  double rate = 0;
  const double force = CalcFastenerForce();
  if (std::abs(force) > options_.torque) {
    const Vec6 axis = CalcScrewAxis();
    const double against = std::copysign(options_.torque, force);
    StartStep(X_WT, X_before);
    const int body = solver_->AddBody(p_WQ_, -against * kTurnPeriod / kFastenerInertia * axis,
                                      axis * axis.transpose() / kFastenerInertia);
    AddContacts(body);
    V = solver_->Solve(kTurnIterations);
    rate = solver_->velocity(body).w.dot(z_W_);
    rate = rate * force > 0 ? rate : 0;
  }
  Keep(X_WT);
  MoveFastener(rate);
  MoveTool(V, clearance);
}

void Turner::Keep(const spatial::Pose& X_WT) {
  sample_ = {};
  sample_.time = kTurnPeriod * static_cast<double>(ticks_);
  sample_.lift = hand_.lift;
  sample_.hand_angle = hand_.angle;
  sample_.tool_angle = tool_angle_;
  sample_.fastener_angle = angle_;
  sample_.fastener_travel = travel_;
  sample_.torque = CalcFastenerForce();
  const Vec3 p_WCm = X_WD_ * options_.p_BoBcm_B;
  const Vec3 f = options_.coupling.k_lin * (X_WT * options_.p_BoBcm_B - p_WCm);
  const Vec3 t = options_.coupling.k_rot * spatial::RotationBetween(X_WD_.q(), X_WT.q());
  sample_.hand_torque = -((p_WCm - p_WQ_).cross(f) + t).dot(z_W_);
  std::map<contact::BodyId, double> forces;
  for (int i = 0; i < solver_->contact_count(); ++i) {
    const contact::Contact& c = contacts_[static_cast<std::size_t>(i)];
    const double force = solver_->normal_force(i);
    if (c.body == query_.fastener) {
      sample_.contact_count += force > 1e-6 ? 1 : 0;
    } else {
      forces[c.body] += force;
    }
  }
  for (const auto& [body, force] : forces) {
    if (force > std::max(kPressing, sample_.obstacle_force)) {
      sample_.obstacle = body;
      sample_.obstacle_force = force;
    }
  }
  result_.peak_torque = std::max(result_.peak_torque, std::abs(sample_.torque));
  if (ticks_ % kSamplePeriod == 0) {
    result_.samples.push_back(sample_);
  }
  ++ticks_;
}

template <typename IsDone>
void Turner::MoveTo(const HandPlace& place, const IsDone& is_done) {
  const double rate = hand_.lift > mate_.engaged ? kAirRate : options_.turn_rate;
  const double time = std::max(std::abs(place.angle - hand_.angle) / rate,
                               std::abs(place.lift - hand_.lift) / kLiftSpeed);
  const HandPlace from = hand_;
  const int count = std::max(1, static_cast<int>(std::ceil(time / kTurnPeriod)));
  for (int i = 1; i <= count; ++i) {
    const HandPlace before = hand_;
    const double share = static_cast<double>(i) / count;
    hand_ = {from.angle + share * (place.angle - from.angle),
             from.lift + share * (place.lift - from.lift)};
    Tick(before);
    if (is_done()) {
      return;
    }
  }
}

void Turner::Wait(double time) {
  for (int i = 0; i < static_cast<int>(std::lround(time / kTurnPeriod)); ++i) {
    Tick(hand_);
  }
}

std::optional<double> Turner::ChooseStart(const FreeArc* arc) const {
  if (arc == nullptr || arc->is_full) {
    return angle_;
  }
  // The way of putting it on that is nearest to where the stroke begins.
  const double begin = direction_ > 0 ? arc->from + kArcMargin : arc->to - kArcMargin;
  const double end = direction_ > 0 ? arc->to - kArcMargin : arc->from + kArcMargin;
  const double steps = std::ceil(direction_ * (begin - angle_) / mate_.pitch);
  const double start = angle_ + direction_ * steps * mate_.pitch;
  return direction_ * (end - start) > mate_.play ? std::optional(start) : std::nullopt;
}

TurnResult Turner::Run(const FreeArc* arc) {
  direction_ = options_.angle < 0 ? -1 : 1;
  const double outside = mate_.engaged + kOutside;
  auto start = ChooseStart(arc);
  hand_ = {start.value_or(0), outside};
  X_WD_ = PoseOf(hand_);
  tool_angle_ = hand_.angle;
  const auto has_obstacle = [this] { return sample_.obstacle.is_valid(); };
  while (start && !HasArrived() && result_.strokes < kMostStrokes) {
    const double angle_before = angle_;
    MoveTo({*start, outside});
    MoveTo({*start, 0});
    Wait(0.05);
    ++result_.strokes;
    const double end = arc == nullptr || arc->is_full
                           ? direction_ * units::kTurn * 1e3
                           : (direction_ > 0 ? arc->to - kArcMargin : arc->from + kArcMargin);
    const double offset = *start - angle_;
    bool is_stopped = false;
    MoveTo({hand_.angle + direction_ * (std::abs(end - hand_.angle) + kMostTwist), 0}, [&] {
      const bool is_far = direction_ * (hand_.angle - tool_angle_) > kMostTwist;
      is_stopped = is_far && has_obstacle();
      result_.has_slipped = std::abs(tool_angle_ - angle_ - offset) > 0.25 * mate_.pitch;
      return HasArrived() || is_far || result_.has_slipped || direction_ * (tool_angle_ - end) >= 0;
    });
    if (is_stopped) {
      result_.obstacle = sample_.obstacle;
      result_.obstacle_angle = tool_angle_;
    }
    MoveTo({tool_angle_, 0});  // Without twist, so that friction does not hold the tool.
    MoveTo({hand_.angle, outside});
    constexpr double kProgress = units::FromDeg(0.5);  // A stroke that turns less is in vain.
    if (is_stopped || result_.has_slipped || std::abs(angle_ - angle_before) < kProgress) {
      break;
    }
    start = ChooseStart(arc);
  }
  result_.angle = angle_;
  result_.travel = travel_;
  result_.is_complete = HasArrived();
  return std::move(result_);
}

}  // namespace

TurnResult TurnByContact(contact::Scene* scene, const ReachQuery& query,
                         const simulation::ToolMate& mate, const spatial::Pose& X_WF,
                         const FreeArc* arc, const TurnOptions& options) {
  HVAS_DEMAND(arc != nullptr || options.is_blind);
  return Turner(scene, query, mate, X_WF, options).Run(options.is_blind ? nullptr : arc);
}

}  // namespace hvas::orders
