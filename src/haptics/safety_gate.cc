#include "haptics/safety_gate.h"

namespace hvas::haptics {
namespace {

/** Moves `last` towards `wanted` under a norm and a step limit; returns what had to be limited. */
std::uint32_t Limit(const Vec3& wanted, double max_norm, double max_step, Vec3* last) noexcept {
  std::uint32_t actions = kGatePassed;
  Vec3 target = wanted;
  constexpr double kHuge = 1e100;  // The square of anything up to this is finite.
  if (const double largest = target.cwiseAbs().maxCoeff(); largest > kHuge) {
    target *= kHuge / largest;
  }
  const double norm = target.norm();
  if (norm > max_norm) {
    target *= max_norm / norm;
    actions |= kGateMagnitude;
  }
  const Vec3 step = target - *last;
  const double size = step.norm();
  if (size > max_step) {
    *last += max_step / size * step;
    actions |= kGateRate;
  } else {
    *last = target;
  }
  return actions;
}

}  // namespace

spatial::Wrench SafetyGate::Pass(const spatial::Wrench& F_W, double dt) noexcept {
  spatial::Wrench wanted = F_W;
  actions_ = kGatePassed;
  if (!wanted.f.allFinite() || !wanted.t.allFinite()) {
    wanted = {};
    actions_ |= kGateNotFinite;
  }
  const double step = dt > 0 ? dt : 0.0;  // Also for a dt that is no number.
  actions_ |= Limit(wanted.f, limits_.max_force, limits_.max_force_rate * step, &last_.f);
  actions_ |= Limit(wanted.t, limits_.max_torque, limits_.max_torque_rate * step, &last_.t);
  return last_;
}

}  // namespace hvas::haptics
