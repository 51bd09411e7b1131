#include "haptics/friction_memory.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {
namespace {

constexpr double kLength = 0.02;      // [m]; turns count as shifts at this distance
constexpr double kSmallest = 1e-10;   // of the largest: what contacts do not fix is forgotten
constexpr double kSlipMemory = 5e-3;  // [s]; friction follows the speed with this lag

/** Shift at p of a small motion [turn; shift] about c. */
Vec3 ShiftAt(const Vec6& bend, const Vec3& c, const Vec3& p) noexcept {
  return bend.tail<3>() + bend.head<3>().cross(p - c);
}

Vec6 Turned(const Quat& q, const Vec6& v) noexcept {
  Vec6 out;
  out << q * v.head<3>(), q * v.tail<3>();
  return out;
}

}  // namespace

Vec3 BendBristle(const Vec3& z, const Vec3& v, double z_max, double dt) noexcept {
  Vec3 bent = z + dt * v;
  if (bent.squaredNorm() <= z_max * z_max) {
    return bent;
  }
  const double speed = v.norm();
  if (z_max <= 0) {
    return Vec3::Zero();
  }
  bent = z;
  if (speed > 0) {
    const Vec3 end = z_max / speed * v;
    bent = end + std::exp(-speed * dt / z_max) * (z - end);
  }
  const double size = bent.norm();
  return size > z_max ? Vec3(z_max / size * bent) : bent;
}

void FrictionMemory::BeginTick() noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    if (pairs_[i].patch >= 0 && pairs_[i].load > 0) {
      pairs_[i].patch = -1;
      if (kept != i) {
        pairs_[kept] = pairs_[i];
      }
      ++kept;
    }
  }
  size_ = kept;
}

int FrictionMemory::AddPair(const TouchingBody& body, const TouchingBody& other,
                            const fits::FrictionLaw& law, double rolling_arm,
                            ConstraintSolver* solver) noexcept {
  std::size_t i = 0;
  while (i < size_ && (pairs_[i].id != body.id || pairs_[i].other != other.id)) {
    ++i;
  }
  if (i == pairs_.size()) {
    return -1;
  }
  if (i == size_) {
    pairs_[i] = {};
    pairs_[i].id = body.id;
    pairs_[i].other = other.id;
  }
  Pair& pair = pairs_[i];
  if (pair.patch >= 0) {
    return pair.patch;
  }
  const int patch = solver->AddPatch(
      {body.index, other.index, law.CalcCoefficient(pair.slip), law.stiffness, rolling_arm});
  if (patch < 0) {
    return -1;
  }
  size_ = std::max(size_, i + 1);
  pair.patch = patch;
  pair.law = law;
  pair.X_WO = other.X_WB;
  pair.p_W = pair.X_WO * pair.p;
  pair.bend_W = Turned(pair.X_WO.q(), pair.bend);
  pair_of_patch_[static_cast<std::size_t>(patch)] = i;
  return patch;
}

bool FrictionMemory::AddContact(const contact::Contact& c, ConstraintSolver::Contact contact,
                                ConstraintSolver* solver) noexcept {
  const Pair& pair = pairs_[pair_of_patch_[static_cast<std::size_t>(contact.patch)]];
  contact.p_WC = c.p_WC;
  contact.nhat_W = c.nhat_W;
  contact.stick_W = ShiftAt(pair.bend_W, pair.p_W, c.p_WC);
  const int index = solver->AddContact(contact);
  if (index < 0) {
    return false;
  }
  points_[static_cast<std::size_t>(index)] = c.p_WC;
  normals_[static_cast<std::size_t>(index)] = c.nhat_W;
  return true;
}

void FrictionMemory::EndTick(const ConstraintSolver& solver, double dt) noexcept {
  const auto patch_count = static_cast<std::size_t>(solver.patch_count());
  if (patch_count == 0) {
    return;  // As in most ticks: room for the fits is not even cleared.
  }
  std::array<Fit, kMaxPairs> fits;
  std::array<double, kMaxPairs> z_max{};
  for (std::size_t k = 0; k < patch_count; ++k) {
    Pair& pair = pairs_[pair_of_patch_[k]];
    pair.load = 0;
    fits[k].p_W.setZero();
  }
  for (int i = 0; i < solver.contact_count(); ++i) {
    const auto k = static_cast<std::size_t>(solver.patch_of(i));
    pairs_[pair_of_patch_[k]].load += solver.normal_force(i);
    fits[k].p_W += solver.normal_force(i) * points_[static_cast<std::size_t>(i)];
  }
  for (std::size_t k = 0; k < patch_count; ++k) {
    const Pair& pair = pairs_[pair_of_patch_[k]];
    z_max[k] = pair.law.CalcCoefficient(pair.slip) * pair.load / pair.law.stiffness;
    fits[k].p_W /= std::max(pair.load, std::numeric_limits<double>::min());
  }
  for (int i = 0; i < solver.contact_count(); ++i) {
    const double force = solver.normal_force(i);
    if (force <= 0) {
      continue;
    }
    const auto k = static_cast<std::size_t>(solver.patch_of(i));
    const Pair& pair = pairs_[pair_of_patch_[k]];
    Fit& fit = fits[k];
    const Vec3& p = points_[static_cast<std::size_t>(i)];
    const Vec3& n = normals_[static_cast<std::size_t>(i)];
    const auto along = [&n](const Vec3& a) { return Vec3(a - a.dot(n) * n); };
    const Vec3 v = along(solver.contact_velocity(i));
    const Vec3 z = BendBristle(along(ShiftAt(pair.bend_W, pair.p_W, p)), v, z_max[k], dt);
    const double share = force / pair.load;
    Eigen::Matrix<double, 3, 6> P;  // Shift along the surface by [turn; shift] about the middle.
    P << -spatial::Skew(p - fit.p_W) / kLength, Mat3::Identity();
    P -= (n * (n.transpose() * P)).eval();
    fit.matrix.noalias() += share * P.transpose() * P;
    fit.rhs.noalias() += share * P.transpose() * z;
    fit.slip += share * v.norm();
  }
  for (std::size_t k = 0; k < patch_count; ++k) {
    Store(fits[k], dt, &pairs_[pair_of_patch_[k]]);
  }
}

void FrictionMemory::Store(const Fit& fit, double dt, Pair* pair) noexcept {
  pair->bend.setZero();
  if (pair->load <= 0) {
    pair->slip = 0;
    return;
  }
  pair->slip += (fit.slip - pair->slip) * -std::expm1(-dt / kSlipMemory);
  Mat6 matrix = fit.matrix;
  matrix.diagonal().array() += kSmallest * matrix.trace();
  Vec6 bend = matrix.llt().solve(fit.rhs);
  bend.head<3>() /= kLength;
  const spatial::Pose X_OW = pair->X_WO.Inverse();
  pair->bend = Turned(X_OW.q(), bend);
  pair->p = X_OW * fit.p_W;
}

}  // namespace hvas::haptics
