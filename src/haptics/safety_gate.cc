#include "haptics/safety_gate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hvas::haptics {
namespace {

// A write changes the force by no more than it may in this time, however late it is; but for a cut
// [s]. Two periods of 1 kHz: a choice.
constexpr double kMaxStep = 2e-3;

bool IsFinite(const spatial::Wrench& F) noexcept {
  return F.f.allFinite() && F.t.allFinite();
}

bool IsUsable(const GateInput& input) noexcept {
  return input.is_valid && input.p.allFinite() && input.V.v.allFinite() && input.V.w.allFinite();
}

/** All of a force up to `hold`, then linearly down to nothing in `fade`; an age that is no number
 is an infinite one. */
double ShareOf(double age, double hold, double fade) noexcept {
  if (age <= hold) {
    return 1;
  }
  const double left = 1 - (age - hold) / fade;
  return left > 0 ? left : 0;
}

/** The norm of v is at most `limit`; false where it was. Also for what has no finite square. */
bool LimitNorm(double limit, Vec3* v) noexcept {
  constexpr double kHuge = 1e100;  // The square of anything up to this is finite.
  if (const double largest = v->cwiseAbs().maxCoeff(); largest > kHuge) {
    *v *= kHuge / largest;
  }
  const double norm = v->norm();
  if (norm <= limit) {
    return false;
  }
  *v *= limit / norm;
  return true;
}

}  // namespace

GateInput MakeGateInput(const device::DeviceState& state, const spatial::Wrench& F_H_D, double dt,
                        std::int64_t* last_sample_ns) noexcept {
  GateInput input;
  input.F = F_H_D;
  input.p = state.X_DH.p();
  input.V = state.V_DH;
  input.dt = dt;
  if (state.sample_ns > 0) {
    const std::int64_t since_ns = state.sample_ns - std::exchange(*last_sample_ns, state.sample_ns);
    input.sample_dt = 1e-9 * static_cast<double>(std::max<std::int64_t>(0, since_ns));
  }
  input.is_valid = state.is_valid && state.condition != device::Condition::kNoForce;
  input.is_held = state.condition != device::Condition::kNotHeld;
  input.is_stopped = state.condition == device::Condition::kStopped;
  input.is_gripping = state.is_gripping;
  input.client_age = 1e-9 * static_cast<double>(state.client_age_ns);
  return input;
}

SafetyLimits MakeSafetyLimits(const device::DeviceProfile& profile) noexcept {
  const auto known = [](double limit) { return limit > 0 ? limit : SafetyLimits::kNever; };
  SafetyLimits limits;
  limits.max_force = profile.max_force;
  limits.max_torque = profile.max_torque;
  limits.max_force_rate = 400;
  limits.max_torque_rate = 40;
  limits.continuous_force = known(profile.continuous_force);
  limits.continuous_torque = known(profile.continuous_torque);
  limits.soft_start_time = 0.5;
  limits.engage_force_rate = 50;
  limits.engage_torque_rate = 5;
  limits.cut_time = 5e-3;
  limits.fade_speed = 1.0;
  limits.cut_speed = 1.2;
  limits.model_hold = 0.02;
  limits.client_hold = 0.002;
  limits.has_detectors = true;
  limits.kick.resolution = profile.position_resolution;
  limits.kick.mass = profile.mass;
  return limits;
}

const char* ToString(GateAction action) noexcept {
  switch (action) {
    case kGatePassed:
      return "nothing was changed";
    case kGateNotFinite:
      return "the computed force was not a number";
    case kGateMagnitude:
      return "the force was limited to what the device can give";
    case kGateRate:
      return "the force changed too fast and was slowed";
    case kGateThermal:
      return "the force was limited to keep the motors cool";
    case kGateSoftStart:
      return "the force comes in slowly after a grasp, a capture or an interruption";
    case kGateSpeed:
      return "the hand was too fast for force";
    case kGateLateModel:
      return "the model was late";
    case kGateLostClient:
      return "the client was not heard of";
    case kGateNoDevice:
      return "the device was not ready: it had no valid position, or showed no force";
    case kGateNotHeld:
      return "nobody held the device";
    case kGateStopped:
      return "the emergency stop was pressed";
    case kGateBuzz:
      return "the device buzzed: open the grip and take the part again";
    case kGateKick:
      return "the device kicked: open the grip and take the part again";
    case kGateStalled:
      return "the program stood still";
  }
  return "unknown";
}

GateActionList ListNewActions(std::uint32_t before, std::uint32_t now) noexcept {
  GateActionList list;
  for (const GateAction action : kGateActions) {
    if ((now & ~before & action) != 0) {
      list.actions[list.count++] = action;
    }
  }
  return list;
}

SafetyGate::Channel SafetyGate::MakeChannel(double peak, double rate, double engage_rate,
                                            double continuous, double thermal_time) noexcept {
  return {peak, rate, engage_rate, ThermalLimit(peak, continuous, thermal_time), 0, 0};
}

SafetyGate::SafetyGate(const SafetyLimits& limits) noexcept
    : limits_(limits),
      force_(MakeChannel(limits.max_force, limits.max_force_rate, limits.engage_force_rate,
                         limits.continuous_force, limits.thermal_time)),
      torque_(MakeChannel(limits.max_torque, limits.max_torque_rate, limits.engage_torque_rate,
                          limits.continuous_torque, limits.thermal_time)),
      buzz_(limits.buzz),
      turn_buzz_(limits.turn_buzz),
      kick_(limits.kick) {}

spatial::Wrench SafetyGate::Pass(const spatial::Wrench& F_W, double dt) noexcept {
  GateInput input;
  input.F = F_W;
  input.dt = dt;
  return Pass(input);
}

spatial::Wrench SafetyGate::Pass(const GateInput& input) noexcept {
  const double dt = input.dt > 0 && std::isfinite(input.dt) ? input.dt : 0.0;
  actions_ = kGatePassed;
  if (IsStall(input.since_write_ns)) {
    actions_ |= kGateStalled;
    Restart();
  }
  Watch(input);
  spatial::Wrench wanted = input.F;
  if (!IsFinite(wanted)) {
    wanted = {};
    actions_ |= kGateNotFinite;
  }
  const std::uint32_t cuts = FindCuts(input);
  actions_ |= cuts;
  const double share = cuts == 0 ? CalcShare(input) : 0;
  if (cuts != 0 && !is_cut_) {
    force_.cut_from = force_.last.norm();
    torque_.cut_from = torque_.last.norm();
  }
  is_cut_ = cuts != 0;
  UpdateStart(input, is_cut_ || (actions_ & (kGateLateModel | kGateLostClient)) != 0, dt);
  if (share < 1) {
    // Not a product with what may be huge: the norm is limited first.
    LimitNorm(force_.peak, &wanted.f);
    LimitNorm(torque_.peak, &wanted.t);
    wanted.f *= share;
    wanted.t *= share;
  }
  Advance(wanted.f, dt, &force_);
  Advance(wanted.t, dt, &torque_);
  return {torque_.last, force_.last};
}

/** The device shows nothing by now: the force begins at zero, and softly. What the hand did
 meanwhile is no kick. A latch stays. */
void SafetyGate::Restart() noexcept {
  for (Channel* channel : {&force_, &torque_}) {
    channel->last.setZero();
    channel->cut_from = 0;
  }
  is_interrupted_ = true;
  start_progress_ = 0;
}

/** Looks for kicks and buzzing under what was given last, and ends a latch. */
void SafetyGate::Watch(const GateInput& input) noexcept {
  if (is_latched()) {
    has_opened_ |= !input.is_gripping;
    if (has_opened_ && input.is_gripping) {
      latch_ = kGatePassed;
    }
    return;
  }
  if (!limits_.has_detectors || !(input.dt > 0) || !std::isfinite(input.dt)) {
    return;
  }
  // A hand that had no force, or another one, finds itself again first; the force is small then.
  constexpr double kFindsItself = 0.3;  // of the soft start
  if (!IsUsable(input) || start_progress_ < kFindsItself) {
    kick_.Reset();
    buzz_.Reset();
    turn_buzz_.Reset();
    return;
  }
  const double dt = input.sample_dt < 0 ? input.dt : input.sample_dt;
  if (!(dt > 0)) {
    return;
  }
  const bool is_buzzing = buzz_.Update(input.V.v, force_.last, dt);
  const bool is_turning = turn_buzz_.Update(input.V.w, torque_.last, dt);
  const Kick kick = kick_.Update(input.p, force_.last, dt);
  latch_ = (is_buzzing || is_turning ? kGateBuzz : kGatePassed) |
           (kick != Kick::kNone ? kGateKick : kGatePassed);
  if (is_latched()) {
    has_opened_ = false;
    kick_.Reset();
    buzz_.Reset();
    turn_buzz_.Reset();
  }
}

std::uint32_t SafetyGate::FindCuts(const GateInput& input) const noexcept {
  return (IsUsable(input) ? kGatePassed : kGateNoDevice) |
         (input.is_held ? kGatePassed : kGateNotHeld) |
         (input.is_stopped ? kGateStopped : kGatePassed) | latch_;
}

/** What age and speed leave of the force. */
double SafetyGate::CalcShare(const GateInput& input) noexcept {
  const double of_model = ShareOf(input.model_age, limits_.model_hold, limits_.model_fade);
  const double of_client = ShareOf(input.client_age, limits_.client_hold, limits_.client_fade);
  const double of_speed =
      ShareOf(input.V.v.norm(), limits_.fade_speed, limits_.cut_speed - limits_.fade_speed);
  actions_ |= (of_model < 1 ? kGateLateModel : kGatePassed) |
              (of_client < 1 ? kGateLostClient : kGatePassed) |
              (of_speed < 1 ? kGateSpeed : kGatePassed);
  return of_model * of_client * of_speed;
}

/** A grasp, a capture, the driver's start and the end of an interruption start softly, from the
 force that there is: nothing dips. */
void SafetyGate::UpdateStart(const GateInput& input, bool is_interrupted, double dt) noexcept {
  if (input.has_engaged || (is_interrupted_ && !is_interrupted)) {
    start_progress_ = 0;
    force_.start_limit = force_.last.norm();
    torque_.start_limit = torque_.last.norm();
  }
  is_interrupted_ = is_interrupted;
  start_progress_ =
      limits_.soft_start_time > 0
          ? std::min(1.0, start_progress_ + std::min(dt, kMaxStep) / limits_.soft_start_time)
          : 1;
}

double SafetyGate::CalcLimit(const Channel& channel, std::uint32_t* why) const noexcept {
  double limit = channel.peak;
  *why = kGateMagnitude;
  if (const double thermal = channel.thermal.limit(); thermal < limit) {
    limit = thermal;
    *why = kGateThermal;
  }
  const double start = channel.start_limit + start_progress_ * (channel.peak - channel.start_limit);
  if (start_progress_ < 1 && start < limit) {
    limit = start;
    *why = kGateSoftStart;
  }
  return limit;
}

void SafetyGate::Advance(const Vec3& wanted, double dt, Channel* channel) noexcept {
  Vec3 target = wanted;
  std::uint32_t why = kGatePassed;
  const double limit = CalcLimit(*channel, &why);
  actions_ |= LimitNorm(limit, &target) ? why : kGatePassed;
  double rate = channel->rate;
  const bool grows = target.norm() > channel->last.norm();
  if (start_progress_ < 1 && grows && channel->engage_rate < rate) {
    rate = channel->engage_rate;
    why = kGateSoftStart;
  } else {
    why = kGateRate;
  }
  if (is_cut_ && limits_.cut_time > 0) {
    rate = std::max(rate, channel->cut_from / limits_.cut_time);
  }
  const Vec3 step = target - channel->last;
  const double size = step.norm();
  const double most = rate * (is_cut_ ? dt : std::min(dt, kMaxStep));
  if (size > most) {
    channel->last += most / size * step;
    actions_ |= why;
  } else {
    channel->last = target;
  }
  channel->thermal.Heat(channel->last.norm(), dt);
}

}  // namespace hvas::haptics
