#include "device/drivers/limit_wrench.h"

#include "device/force_withdrawal.h"

namespace hvas::device {
namespace {

void LimitNorm(double limit, Vec3* v) noexcept {
  const double norm = v->norm();
  if (norm > limit) {
    *v *= limit / norm;
  }
}

}  // namespace

spatial::Wrench LimitWrench(const spatial::Wrench& F, const DeviceProfile& profile) noexcept {
  if (!F.f.allFinite() || !F.t.allFinite() || AreForcesWithdrawn()) {
    return {};
  }
  spatial::Wrench limited = F;
  LimitNorm(profile.max_force, &limited.f);
  LimitNorm(profile.max_torque, &limited.t);
  return limited;
}

}  // namespace hvas::device
