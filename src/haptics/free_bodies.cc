#include "haptics/free_bodies.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace hvas::haptics {

spatial::Pose MoveAbout(const spatial::Pose& X_WB, const Vec3& p_BQ, const spatial::Twist& V_Q,
                        double time) noexcept {
  const Quat q = (spatial::RotationFromVector(V_Q.w * time) * X_WB.q()).normalized();
  return {q, X_WB * p_BQ + V_Q.v * time - q * p_BQ};
}

void FreeBodies::SetProperties(contact::BodyId id, const BodyProperties& properties) {
  entries_.resize(std::max(entries_.size(), id.index() + 1));
  entries_[id.index()].properties = properties;
}

void FreeBodies::SetLoose(contact::BodyId id, bool is_loose) noexcept {
  if (!id.is_valid() || id.index() >= entries_.size()) {
    return;
  }
  Entry& entry = entries_[id.index()];
  if (const RigidGroup* apart = entry.group) {
    const bool was_loose = entry.is_loose || entry.is_held_still;
    for (const contact::BodyId body : apart->bodies) {
      entries_[body.index()].group = nullptr;
      SetLoose(body, false);
      entries_[body.index()].is_loose = was_loose && body != id;
    }
  }
  entry.is_held_still = false;
  entry.is_loose = is_loose && entry.properties.mass > 0;
  if (!is_loose) {
    const auto end = awake_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto rest =
        std::remove_if(awake_.begin(), end, [id](const FreeBody& body) { return body.id == id; });
    count_ -= static_cast<std::size_t>(end - rest);
  }
}

void FreeBodies::SetTogether(const RigidGroup& group, bool is_loose) noexcept {
  for (const contact::BodyId body : group.bodies) {
    SetLoose(body, false);
  }
  for (const contact::BodyId body : group.bodies) {
    Entry& entry = entries_[body.index()];
    entry.group = group.bodies.size() > 1 ? &group : nullptr;
    entry.is_loose = is_loose;
    entry.is_held_still = !is_loose;
  }
}

void FreeBodies::Join(const RigidGroup& group) noexcept {
  SetTogether(group, true);
}

void FreeBodies::HoldStill(const RigidGroup& group) noexcept {
  SetTogether(group, false);
}

bool FreeBodies::LetLoose(const RigidGroup& group) noexcept {
  const auto is_still = [this](contact::BodyId body) {
    return entries_[body.index()].is_held_still;
  };
  if (!std::all_of(group.bodies.begin(), group.bodies.end(), is_still)) {
    return false;
  }
  SetTogether(group, true);
  return true;
}

FreeBodies::Inertia FreeBodies::InertiaOf(contact::BodyId id) const noexcept {
  const Entry& entry = entries_[id.index()];
  if (entry.group != nullptr) {
    return {entry.group->mass, entry.group->p_BoBcm_B, entry.group->I_BBcm_B};
  }
  return {entry.properties.mass, entry.properties.p_BoBcm_B, entry.properties.I_BBcm_B};
}

bool FreeBodies::Wake(contact::BodyId id, const spatial::Pose& X_WB,
                      const spatial::Twist& V) noexcept {
  if (!is_loose(id) || FindAwake(id) != nullptr || count_ == awake_.size()) {
    return false;
  }
  awake_[count_++] = {id, X_WB, V, 0, -1};
  return true;
}

void FreeBodies::WakeFirst(contact::BodyId id, const spatial::Pose& X_WB,
                           const spatial::Twist& V) noexcept {
  if (count_ == awake_.size()) {
    const auto calmest = std::max_element(
        awake_.begin(), awake_.end(),
        [](const FreeBody& a, const FreeBody& b) { return a.time_at_rest < b.time_at_rest; });
    *calmest = awake_[--count_];
  }
  (void)Wake(id, X_WB, V);
}

FreeBody* FreeBodies::FindAwake(contact::BodyId id) noexcept {
  const std::span<FreeBody> all = awake();
  const auto found =
      std::find_if(all.begin(), all.end(), [id](const FreeBody& body) { return body.id == id; });
  return found == all.end() ? nullptr : &*found;
}

void FreeBodies::Sleep(double rest_time) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (awake_[i].time_at_rest < rest_time) {
      awake_[kept++] = awake_[i];
    }
  }
  count_ = kept;
}

ConstraintSolver::Body FreeBodies::MakeSolverBody(const FreeBody& body, const Vec3& gravity_W,
                                                  double dt) const noexcept {
  const Inertia inertia = InertiaOf(body.id);
  const Mat3 R_WB = body.X_WB.R();
  ConstraintSolver::Body out;
  out.mass = inertia.mass;
  out.I_W = R_WB * inertia.I_BBcm_B * R_WB.transpose();
  out.p_WCm = body.X_WB * inertia.p_BoBcm_B;
  out.V_0 = body.V;
  out.F_Cm_W.f = inertia.mass * gravity_W;
  // Of its own a body keeps its angular momentum, and never turns with more energy than before.
  const Vec3& w = body.V.w;
  const Vec3 turned = w - dt * out.I_W.ldlt().solve(w.cross(out.I_W * w));
  const double before = w.dot(out.I_W * w);
  const double after = turned.dot(out.I_W * turned);
  out.V_0.w = after > before ? Vec3(std::sqrt(before / after) * turned) : turned;
  return out;
}

spatial::Pose FreeBodies::Move(const FreeBody& body, const spatial::Twist& V,
                               double time) const noexcept {
  return MoveAbout(body.X_WB, InertiaOf(body.id).p_BoBcm_B, V, time);
}

}  // namespace hvas::haptics
