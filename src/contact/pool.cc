#include "contact/pool.h"

#include <limits>

#include "contact/scene.h"

namespace hvas::contact {

spatial::Wrench ContactLayer::CalcWrench(double stiffness, const Vec3& p_WQ) const noexcept {
  if (depth_ < std::numeric_limits<double>::min()) {
    return {};
  }
  const double scale = stiffness / depth_;
  return {scale * (torque_ - p_WQ.cross(force_)), scale * force_};
}

PooledWrench CalcPooledWrench(std::span<const Contact> contacts, const Vec3& p_WQ,
                              double stiffness) noexcept {
  PooledWrench pooled;
  for (const Contact& contact : contacts) {
    if (contact.distance >= 0) {
      continue;
    }
    Vec6 J;
    J << (contact.p_WC - p_WQ).cross(contact.nhat_W), contact.nhat_W;
    const Vec6 force = -stiffness * contact.distance * J;
    pooled.F_W += {force.head<3>(), force.tail<3>()};
    pooled.K.noalias() += J * J.transpose();
  }
  pooled.K *= stiffness;
  return pooled;
}

}  // namespace hvas::contact
