#include "paths/slide_step.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hvas::paths {
namespace {

using spatial::Pose;

// Sweeps of the solver over all contacts; more change no push by a tenth of the tolerance in the
// puzzles. A choice.
constexpr int kSweeps = 40;
constexpr int kMostPushes = 5;  // Pushes out of contact until a step is given up: a choice.
constexpr std::size_t kMostOfOneQuery = 32;  // The deepest of each group come first.
constexpr double kLeastAhead = 0.05;         // Of the wanted step; a slide that gains less is none.

}  // namespace

PushOut::PushOut(const Probe& probe, const Pose& X_WB_wanted)
    : probe_(probe), X_WB_wanted_(X_WB_wanted) {
  planes_.reserve(kMostPlanes);
}

void PushOut::Add(std::span<const contact::Contact> contacts, double target) {
  const Vec3 centre_W = pose() * probe_.centre_B();
  const std::size_t n = std::min(contacts.size(), kMostOfOneQuery);
  if (planes_.size() + n > kMostPlanes) {
    planes_.erase(planes_.begin(),
                  planes_.begin() + static_cast<std::ptrdiff_t>(planes_.size() + n - kMostPlanes));
    d_.setZero();
    for (const Plane& plane : planes_) {
      d_ += plane.force * plane.row;
    }
  }
  const Vec6 at = d_;
  for (std::size_t i = 0; i < n; ++i) {
    Plane plane;
    plane.row = probe_.RowOf(contacts[i].nhat_W, contacts[i].p_WC, centre_W);
    plane.wanted = target - contacts[i].distance + plane.row.dot(at);
    plane.weight = plane.row.squaredNorm();
    plane.force = 0;
    planes_.push_back(plane);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (Plane& plane : planes_) {
      const double next =
          std::max(0.0, plane.force + (plane.wanted - plane.row.dot(d_)) / plane.weight);
      const double by = next - plane.force;
      if (by != 0) {
        d_ += by * plane.row;
        plane.force = next;
        change = std::max(change, std::abs(by));
      }
    }
    if (change < 1e-7) {  // [m]; far below any tolerance.
      break;
    }
  }
}

Pose PushOut::pose() const {
  return probe_.Move(X_WB_wanted_, {Vec3(d_.tail<3>() / probe_.gyration()), Vec3(d_.head<3>())});
}

double PushTargetOf(double tolerance) {
  return tolerance > 0 ? -0.25 * tolerance : -1.25 * tolerance;
}

std::optional<Pose> SlideStep(Probe* probe, const Pose& X_WB, const Pose& X_WB_wanted,
                              double step) {
  if (probe->IsFree(X_WB_wanted)) {
    return X_WB_wanted;
  }
  const double target = PushTargetOf(probe->tolerance());
  const double margin = std::max(0.0, target);
  const Displacement wanted = probe->CalcDisplacement(X_WB, X_WB_wanted);
  const double wanted_length = probe->CalcLength(wanted);
  const double g2 = probe->gyration() * probe->gyration();
  PushOut out(*probe, X_WB_wanted);
  for (int push = 0; push <= kMostPushes; ++push) {
    if (probe->is_over()) {
      return std::nullopt;
    }
    const Pose X = out.pose();
    if (push > 0) {
      const Displacement made = probe->CalcDisplacement(X_WB, X);
      const double ahead = (made.v_W.dot(wanted.v_W) + g2 * made.w_W.dot(wanted.w_W)) /
                           (wanted_length * wanted_length);
      if (ahead < kLeastAhead || probe->CalcReachOf(made) > 2.5 * step) {
        return std::nullopt;
      }
    }
    const double distance = probe->Query(X, margin);
    if (distance >= -probe->tolerance()) {
      return X;
    }
    if (distance < -2 * step) {
      return std::nullopt;  // Inside a body: the nearest face says nothing.
    }
    out.Add(probe->contacts(), target);
  }
  return std::nullopt;
}

}  // namespace hvas::paths
